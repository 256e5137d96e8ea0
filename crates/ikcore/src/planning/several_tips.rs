//! Point to point for robots with several tips: targets of the tips become configurations, between which the planner joins.

use super::point_to_point::{check_point_to_point, plan_point_to_point};
use crate::error::{Error, Result};
use crate::ik::{AllOptions, Solution, SolveOptions, checked_tasks, reduce, solve_all_tips, solve_tips};
use crate::obstacle::{Surroundings, kept_margin};
use crate::plan::{EndName, Endpoint, Plan, PointToPointOptions, RESERVE, can_collide, no_usable_end};
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::{Target, TipTask};
use crate::timing::MotionLimits;

/// The start of a motion of several tips, or one of its possible ends.
#[derive(Debug, Clone, PartialEq)]
pub enum TipsEndpoint {
    /// Targets of tips; the planner chooses the configuration.
    Targets(Vec<(TipTask, Target)>),
    /// A configuration (n,) (rad, m).
    Configuration(Vec<f64>),
}

/// What a motion begins or ends with: that of one tip, or of several.
pub trait MotionEnd: Sync + Sized {
    /// Checks the arguments of [`plan`](Self::plan), as far as no planner is needed.
    ///
    /// # Errors
    /// Any [`Error`] for wrong input.
    fn check(robot: &Robot, start: &Self, ends: &[Self], options: &PointToPointOptions) -> Result<()>;

    /// Plans the motion.
    ///
    /// # Errors
    /// As [`plan_point_to_point`].
    fn plan(
        robot: &Robot,
        start: &Self,
        ends: &[Self],
        options: &PointToPointOptions,
        monitor: &mut dyn Monitor,
    ) -> Result<Plan>;
}

impl MotionEnd for Endpoint {
    fn check(robot: &Robot, start: &Self, ends: &[Self], options: &PointToPointOptions) -> Result<()> {
        check_point_to_point(robot, start, ends, options)
    }

    fn plan(
        robot: &Robot,
        start: &Self,
        ends: &[Self],
        options: &PointToPointOptions,
        monitor: &mut dyn Monitor,
    ) -> Result<Plan> {
        plan_point_to_point(robot, start, ends, options, monitor)
    }
}

impl MotionEnd for TipsEndpoint {
    fn check(robot: &Robot, start: &Self, ends: &[Self], options: &PointToPointOptions) -> Result<()> {
        EndSearch::new(robot, options)?;
        let names = (0..ends.len()).map(|i| EndName::of(i, ends.len()));
        std::iter::once((EndName::Start, start)).chain(names.zip(ends)).try_for_each(|(name, end)| match end {
            Self::Configuration(q) => robot.check(&name.of_configuration(), q),
            Self::Targets(targets) => {
                let (tips, mut wanted): (Vec<TipTask>, Vec<Target>) = targets.iter().copied().unzip();
                wanted.iter().try_for_each(Target::validate)?;
                reduce(robot, &checked_tasks(robot, &tips)?, &mut wanted)
            }
        })
    }

    fn plan(
        robot: &Robot,
        start: &Self,
        ends: &[Self],
        options: &PointToPointOptions,
        monitor: &mut dyn Monitor,
    ) -> Result<Plan> {
        plan_point_to_point_tips(robot, start, ends, options, monitor)
    }
}

/// Configurations of an end that are tried, beside the one that a descent from the start leads to.
const TRIED: usize = 6;

/// [`plan_point_to_point`] for robots with several tips. Targets of the start are solved first; each end is taken at the solution that
/// a descent from the start leads to, and at a few others: the motion with the lowest cost is returned.
///
/// # Errors
/// As [`plan_point_to_point`]; [`Error::SeveralTips`] for what it does for one tip alone.
pub fn plan_point_to_point_tips(
    robot: &Robot,
    start: &TipsEndpoint,
    ends: &[TipsEndpoint],
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let mut search = EndSearch::new(robot, options)?;
    let start = search.start(start, monitor)?;
    let (mut found, mut origins, mut problems) = (vec![], vec![], vec![]);
    for (i, end) in ends.iter().enumerate() {
        match search.configurations(EndName::of(i, ends.len()), end, &start, monitor) {
            Ok(configurations) => {
                origins.extend(configurations.iter().map(|_| i));
                found.extend(configurations.into_iter().map(Endpoint::Configuration));
            }
            Err(problem @ Error::Unreachable { .. }) => problems.push(problem),
            Err(wrong) => return Err(wrong),
        }
    }
    if found.is_empty() && !problems.is_empty() {
        return Err(no_usable_end(ends.len(), problems));
    }
    let mut plan = plan_point_to_point(robot, &Endpoint::Configuration(start), &found, options, monitor)?;
    plan.chosen_end = plan.chosen_end.and_then(|chosen| origins.get(chosen).copied());
    plan.evaluations += search.evaluations;
    plan.elapsed = stopwatch.elapsed();
    Ok(plan)
}

/// Solves for configurations of the ends.
struct EndSearch<'a> {
    robot: &'a Robot,
    options: SolveOptions,
    evaluations: usize,
}

impl<'a> EndSearch<'a> {
    fn new(robot: &'a Robot, options: &PointToPointOptions) -> Result<Self> {
        let limits = MotionLimits::new(robot, options.limits.as_ref(), "plan_point_to_point")?;
        let margin = Some(kept_margin(options.margin)? + RESERVE);
        let surroundings = match can_collide(robot, options) {
            true => Surroundings { margin, ..options.surroundings() },
            false => Surroundings::default(),
        };
        let options = SolveOptions {
            limits: Some(limits.position_limits(robot)?),
            surroundings,
            seed: options.seed,
            ..SolveOptions::default()
        };
        Ok(Self { robot, options, evaluations: 0 })
    }

    /// The configuration of the start.
    fn start(&mut self, start: &TipsEndpoint, monitor: &mut dyn Monitor) -> Result<Vec<f64>> {
        match start {
            TipsEndpoint::Configuration(q) => {
                self.robot.check(&EndName::Start.of_configuration(), q)?;
                Ok(q.clone())
            }
            TipsEndpoint::Targets(targets) => {
                let solution = self.solve(targets, None, monitor)?;
                reached(EndName::Start, &solution).map(|()| solution.q.to_vec())
            }
        }
    }

    /// Configurations of an end: the one that a descent from `start` leads to, then others.
    fn configurations(
        &mut self,
        name: EndName,
        end: &TipsEndpoint,
        start: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Vec<f64>>> {
        let targets = match end {
            TipsEndpoint::Configuration(q) => return Ok(vec![q.clone()]),
            TipsEndpoint::Targets(targets) => targets,
        };
        let inside =
            self.options.limits.as_ref().is_none_or(|limits| limits.require_inside("start", 0.0, start).is_ok());
        let first = self.solve(targets, inside.then_some(start), monitor)?;
        reached(name, &first)?;
        let (tips, wanted): (Vec<TipTask>, Vec<Target>) = targets.iter().copied().unzip();
        let each = SolveOptions { tips, ..self.options.clone() };
        let all = AllOptions { each, limit: Some(TRIED), ..AllOptions::default() };
        let others = solve_all_tips(self.robot, &wanted, &all, monitor)?;
        self.evaluations += others.evaluations;
        Ok(std::iter::once(first.q.to_vec()).chain(others.solutions.iter().map(|other| other.q.to_vec())).collect())
    }

    fn solve(
        &mut self,
        targets: &[(TipTask, Target)],
        start: Option<&[f64]>,
        monitor: &mut dyn Monitor,
    ) -> Result<Solution> {
        let (tips, wanted): (Vec<TipTask>, Vec<Target>) = targets.iter().copied().unzip();
        let options = SolveOptions { tips, start: start.map(<[f64]>::to_vec), ..self.options.clone() };
        let solution = solve_tips(self.robot, &wanted, &options, monitor)?;
        self.evaluations += solution.evaluations;
        Ok(solution)
    }
}

/// Err unless the targets of an end were reached.
fn reached(name: EndName, solution: &Solution) -> Result<()> {
    match solution.status {
        Status::Solved => Ok(()),
        Status::Interrupted => Err(Error::Interrupted),
        _ => Err(Error::Unreachable { what: name.of_target(), problem: solution.message() }),
    }
}
