//! A robot and options that were found in order, and how one target is solved with them.

use super::attempt::Run;
use super::nearest::bring_near;
use super::solution::Solution;
use super::{Prefer, SolveOptions};
use crate::error::{Error, Result};
use crate::kinematics::Beyond;
use crate::limits::{Field, Limits};
use crate::objective::{Bounds, Objective, Point};
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{Criterion, Goals, Target, Task};

/// A robot and options that were found in order, ready for any number of targets.
#[derive(Debug)]
pub(crate) struct Prepared<'a> {
    robot: &'a Robot,
    /// The robot with the tool of the task, where it has one; boxed, since what is prepared is moved about.
    with_tool: Option<Box<Robot>>,
    options: &'a SolveOptions,
    criterion: Criterion,
    goals: Goals,
    bounds: Bounds,
}

impl<'a> Prepared<'a> {
    /// Checks what all targets have in common, but for [`SolveOptions::start`]: that is an argument of each.
    ///
    /// # Errors
    /// Any [`Error`] for wrong options.
    pub(crate) fn new(robot: &'a Robot, options: &'a SolveOptions) -> Result<Self> {
        options.solver.validate()?;
        options.stop.validate()?;
        options.task.as_ref().map_or(Ok(()), Task::validate)?;
        let criterion = options.task.map_or(options.tolerance.into(), |task| task.criterion(options.tolerance));
        criterion.validate()?;
        options.goals.iter().try_for_each(|goal| goal.validate(robot))?;
        if options.prefer == Prefer::Nearest && !options.goals.is_empty() {
            return Err(Error::Contradiction {
                problem: "prefer=\"nearest\" is a goal itself: leave goals out".into(),
            });
        }
        if options.prefer == Prefer::Best && options.goals.is_empty() {
            return Err(Error::Contradiction { problem: "prefer=\"best\" needs goals: best for what?".into() });
        }
        let bounds = position_box(robot, options.limits.as_ref())?;
        let with_tool = options.task.map_or(Ok(None), |task| task.robot(robot))?.map(Box::new);
        let goals = Goals::new(&options.goals, with_tool.as_deref().unwrap_or(robot), &bounds);
        Ok(Self { robot, with_tool, options, criterion, goals, bounds })
    }

    pub(super) fn robot(&self) -> &Robot {
        self.with_tool.as_deref().unwrap_or(self.robot)
    }

    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    pub(super) fn goals(&self) -> &Goals {
        &self.goals
    }

    pub(super) fn criterion(&self) -> &Criterion {
        &self.criterion
    }

    pub(super) fn options(&self) -> &SolveOptions {
        self.options
    }

    pub(super) fn problem<'p>(&'p self, target: &'p Target) -> Problem<'p> {
        Problem::new(self.robot(), target, self.criterion).disregarding_turns()
    }

    /// What of `wanted` the task asks for, checked.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::WrongTarget`].
    pub(crate) fn read(&self, wanted: &Target) -> Result<Target> {
        wanted.validate()?;
        self.options.task.map_or(Ok(*wanted), |task| task.target(wanted))
    }

    /// Checks a start.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`] or [`Error::OutsideLimits`].
    pub(crate) fn check_start(&self, q: &[f64]) -> Result<()> {
        self.robot().check("start", q)?;
        self.robot().require_within("start", q, self.bounds.lower(), self.bounds.upper())
    }

    /// Checks that there is a start where the nearest solution is asked for.
    ///
    /// # Errors
    /// [`Error::Contradiction`].
    pub(crate) fn require_reference(&self, start: Option<&[f64]>) -> Result<()> {
        match (self.options.prefer, start) {
            (Prefer::Nearest, None) => {
                Err(Error::Contradiction { problem: "prefer=\"nearest\" needs a start: nearest to what?".into() })
            }
            _ => Ok(()),
        }
    }

    /// Solves for a target and a start that are in order, drawing from `stream` of the seed.
    pub(crate) fn run(
        &self,
        target: &Target,
        start: Option<&[f64]>,
        stream: u64,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        let solution = self.search(target, start, stream, monitor);
        self.marked_if_blocked(target, solution)
    }

    /// The solution with status [`Status::HeldInRegion`] where it is solved, but the region keeps the tip from the target itself.
    pub(super) fn marked_if_blocked(&self, target: &Target, solution: Solution) -> Solution {
        match self.criterion.blocked_by_region(target) {
            Some(obstruction) if solution.status == Status::Solved => {
                Solution { status: Status::HeldInRegion, obstruction, ..solution }
            }
            _ => solution,
        }
    }

    fn search(&self, target: &Target, start: Option<&[f64]>, stream: u64, monitor: &mut dyn Monitor) -> Solution {
        let mut rng = rng::stream(self.options.seed, stream);
        if let (Prefer::Nearest, Some(start)) = (self.options.prefer, start) {
            return self.run_nearest(target, start, &mut rng, monitor);
        }
        if self.options.prefer == Prefer::Best {
            return self.run_best(target, start, &mut rng, monitor);
        }
        let mut problem = self.problem(target);
        let x0 = self.first_start(&mut problem, start, &mut rng);
        let mut run = Run::new(self.options.stop);
        let mut solution = run.attempt(self, &mut problem, &x0, &mut rng, monitor);
        if solution.status == Status::Solved && !self.goals.is_empty() {
            let q = &mut solution.q;
            if let Some(start) = start {
                bring_near(self.robot(), &self.bounds, start, q);
            }
            self.descend_to(&mut problem, &mut self.goals.clone(), &mut run, q);
            return run.solution(Status::Solved, solution.q, &problem);
        }
        solution
    }

    /// Where the first attempt begins: at the caller's start, or at the best that is known of.
    pub(super) fn first_start(&self, problem: &mut Problem<'_>, start: Option<&[f64]>, rng: &mut LazyRng) -> Point {
        let Some(start) = start else {
            let mut x0 = Point::from_elem(0.0, self.robot().dof());
            problem.propose_start(0, &self.bounds, rng, &mut x0);
            return x0;
        };
        Point::from_slice(start)
    }

    /// How far the target is out of reach, where it is beyond doubt.
    pub(super) fn beyond_reach(&self, target: &Target) -> Option<Beyond> {
        self.criterion.beyond_reach(target, self.robot(), &self.bounds)
    }
}

/// The position limits as a box. Velocities do not matter to a single configuration.
fn position_box(robot: &Robot, limits: Option<&Limits>) -> Result<Bounds> {
    let Some(limits) = limits else {
        return Ok(Bounds::from_ranges(robot.joints().iter().map(|joint| (joint.lower, joint.upper))));
    };
    let remedy = "a single configuration has no motion; leave it out";
    limits.require_for(robot)?;
    limits.require_none(&[Field::Acceleration, Field::Jerk], "solve", remedy)?;
    limits.position_box()
}
