//! Validated arguments shared by all targets of a call.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock, OnceLock};

use smallvec::SmallVec;

use super::checked_tasks::{asked_tasks, reduce};
use super::preference::Preference;
use super::ranked::given_up;
use super::solve_options::{Prefer, SolveOptions};
use crate::error::{Error, Result};
use crate::limits::{Field, Limits, TipField};
use crate::math::{JointWeights, sampling_range};
use crate::message::{Setting, message};
use crate::objective::Bounds;
use crate::obstacle::ClearSpace;
use crate::problem::Problem;
use crate::robot::Robot;
use crate::solver::{AnySolver, Status, Stopwatch};
use crate::task::{Aims, CheckedTask, First, Goal, Goals, SquaredError, Target, TargetRow};

/// Validated target and start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Query<'a> {
    /// Target of the only tip, or the targets of the tasks in their order, as returned by [`SolveContext::read`].
    pub targets: &'a [Target],
    /// Start of the search, if given.
    pub start: Option<&'a [f64]>,
    /// Random stream of the seed.
    pub stream: u64,
    /// Time since the solve began.
    pub stopwatch: Stopwatch,
}

/// Validated robot and options, ready to solve any number of targets.
#[derive(Debug)]
pub(crate) struct SolveContext<'a> {
    robot: &'a Robot,
    /// Robot with the tool of the task, if there is one; boxed to keep the context small.
    with_tool: Option<Box<Robot>>,
    options: &'a SolveOptions,
    /// Task of each target; one for a robot with one tip.
    tasks: SmallVec<[CheckedTask; 1]>,
    goals: Goals,
    bounds: Bounds,
    /// The same box with the weights of the joints, if they differ; boxed to keep the context small.
    weighted: Option<Box<Bounds>>,
    /// Preference of queries without a start, computed on first use.
    central: OnceLock<Preference>,
    /// Clear space of the solutions; boxed to keep the context small.
    space: Option<Box<ClearSpace<'a>>>,
}

impl<'a> SolveContext<'a> {
    /// Checks robot and options, except [`SolveOptions::start`], which each query carries.
    ///
    /// # Errors
    /// Any [`Error`] for wrong options.
    pub(crate) fn new(robot: &'a Robot, options: &'a SolveOptions) -> Result<Self> {
        options.solver.as_ref().map_or(Ok(()), |solver| solver.validate())?;
        options.stop.validate()?;
        let mut tasks = asked_tasks(robot, options)?;
        let space = options.surroundings.clear_space(robot)?.map(Box::new);
        options.goals.iter().try_for_each(|goal| goal.validate(robot, space.is_some()))?;
        if options.prefer == Prefer::Nearest && !options.goals.is_empty() {
            let problem =
                message![Setting::Prefer("nearest"), " takes no goals: the distance to the start is its goal"];
            return Err(Error::Contradiction { problem });
        }
        let weights = joint_weights(robot, options.joint_weights.as_deref())?;
        if options.joint_weights.is_some() && !options.goals.is_empty() {
            let problem = message![
                Setting::JointWeights,
                " take no goals: the weighted distance to the start is their goal; a Posture at the start, with a weight for \
                 each joint, may stand beside other goals"
            ];
            return Err(Error::Contradiction { problem });
        }
        if options.prefer == Prefer::Best && options.goals.is_empty() {
            let problem = message![Setting::Prefer("best"), " needs goals to compare solutions by"];
            return Err(Error::Contradiction { problem });
        }
        let bounds = position_box(robot, options.limits.as_ref())?;
        let with_tool = options.only_task(robot).map_or(Ok(None), |task| task.robot(robot))?.map(Box::new);
        if with_tool.is_some() {
            tasks[0].leave_tool();
        }
        // Tolerances by component are what a search aims at; those of a call only decide, unless the exact target is missed.
        for task in tasks.iter_mut().filter(|task| task.criterion.components.is_some() && task.criterion.has_band()) {
            task.criterion = task.criterion.beyond_tolerance();
        }
        let weighted = weights.map(|weights| Box::new(bounds.clone().weighted(Some(Arc::new(weights)))));
        let goals = Goals::new(&options.goals, with_tool.as_deref().unwrap_or(robot), &bounds);
        Ok(Self { robot, with_tool, options, tasks, goals, bounds, weighted, central: OnceLock::new(), space })
    }

    pub(crate) fn robot(&self) -> &Robot {
        self.with_tool.as_deref().unwrap_or(self.robot)
    }

    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Box of the steps near a start or a solution, by the weights of the joints.
    pub(super) fn weighted_bounds(&self) -> &Bounds {
        self.weighted.as_deref().unwrap_or(&self.bounds)
    }

    /// Weights of the joints; `None` where all cost the same.
    pub(super) fn weights(&self) -> Option<&JointWeights> {
        self.weighted.as_ref().and_then(|bounds| bounds.weights()).map(|weights| &**weights)
    }

    /// Goals of the call.
    pub(super) fn goals(&self) -> &Goals {
        &self.goals
    }

    /// Goals that a solution is moved by: those of the call or, with weights of the joints, the distance to the start. `None`
    /// without either.
    pub(super) fn goals_from(&self, start: Option<&[f64]>) -> Option<Goals> {
        match start {
            Some(start) if self.weights().is_some() => Some(self.distance_from(start)),
            _ => Some(&self.goals).filter(|goals| !goals.is_empty()).cloned(),
        }
    }

    /// Squared distance from `start`, by the weights of the joints, as a goal.
    pub(super) fn distance_from(&self, start: &[f64]) -> Goals {
        let posture = start.to_vec();
        let goal = match self.weights() {
            None => Goal::Posture { posture, weight: 1.0 },
            Some(weights) => Goal::WeightedPosture { posture, weights: weights.as_slice().to_vec() },
        };
        Goals::new(&[goal], self.robot(), &self.bounds)
    }

    /// Clear space of the solutions, if collisions are checked.
    pub(crate) fn space(&self) -> Option<&ClearSpace<'a>> {
        self.space.as_deref()
    }

    /// Whether the target fixes the pose of the tip.
    pub(super) fn fixes_pose(&self, target: &Target) -> bool {
        self.tasks[0].criterion.fixes_pose(target)
    }

    pub(super) fn options(&self) -> &SolveOptions {
        self.options
    }

    /// Solver of searches.
    pub(super) fn solver(&self) -> &AnySolver {
        static DEFAULT: LazyLock<AnySolver> = LazyLock::new(AnySolver::default);
        self.options.solver.as_ref().unwrap_or(&DEFAULT)
    }

    /// Whether only pose and limits define a solution, goals aside, and no solver is named.
    pub(crate) fn asks_for_pose(&self, target: &Target) -> bool {
        self.fixes_pose(target) && self.options.solver.is_none()
    }

    /// Whether only pose and limits define a solution, without goals, and no solver is named.
    pub(super) fn asks_for_pose_alone(&self, target: &Target) -> bool {
        self.goals.is_empty() && self.asks_for_pose(target)
    }

    /// Part of a pose that comes first where the whole cannot be met; `None` where both are balanced, or a solver is named.
    pub(super) fn comes_first(&self, target: &Target) -> Option<First> {
        let [task] = &self.tasks[..] else { return None };
        if self.options.whole_only {
            return None;
        }
        let dof = if self.options.solver.is_none() { self.robot.dof() } else { usize::MAX };
        if self.robot.tip_count() == 1 { task.comes_first(target, dof) } else { None }
    }

    /// Whether the tasks of several tips have levels, of which the lower ones come first where not all targets can be met.
    pub(super) fn has_levels(&self) -> bool {
        !self.options.whole_only && Aims { tasks: &self.tasks, targets: &[] }.has_levels(self.robot)
    }

    /// Checks that the tasks have one level: solutions that meet all targets leave nothing to put first.
    ///
    /// # Errors
    /// [`Error::Contradiction`].
    pub(super) fn require_one_level(&self) -> Result<()> {
        if let Some(first) = self.tasks.iter().find_map(|task| task.first).filter(|_| !self.options.whole_only) {
            let problem = message![
                Setting::First(first.name()),
                " has no effect where all solutions are asked for, which meet the whole pose: solve for one configuration"
            ];
            return Err(Error::Contradiction { problem });
        }
        let level = |task: &CheckedTask| task.level;
        let (lowest, highest) = (self.tasks.iter().map(level).min(), self.tasks.iter().map(level).max());
        if lowest == highest {
            return Ok(());
        }
        let problem = format!(
            "all solutions meet all targets, so levels from {} to {} have no effect: give all tasks one level, or solve for one \
             configuration, which meets them in their order",
            lowest.unwrap_or_default(),
            highest.unwrap_or_default()
        );
        Err(Error::Contradiction { problem: problem.into() })
    }

    /// Status at an error beyond the tolerances, if the part that comes first is met.
    pub(super) fn given_up(&self, target: &Target, error: &SquaredError) -> Option<Status> {
        given_up(&self.tasks[0], target, self.robot.dof(), error)
    }

    /// Preference among several solutions.
    pub(super) fn preference(&self, start: Option<&[f64]>) -> Cow<'_, Preference> {
        match start {
            Some(_) => Cow::Owned(Preference::new(self.robot(), self.weighted_bounds(), start)),
            None => Cow::Borrowed(self.central()),
        }
    }

    /// Finite ranges inside the limits for drawing configurations: lower ends and upper ends.
    pub(super) fn sampling_ranges(&self) -> [&[f64]; 2] {
        self.central().ranges()
    }

    fn central(&self) -> &Preference {
        self.central.get_or_init(|| Preference::new(self.robot(), &self.bounds, None))
    }

    /// Problem of reaching the targets of a query.
    pub(super) fn problem<'p>(&'p self, targets: &'p [Target]) -> Problem<'p> {
        let penalty = if self.solver().needs_values_alone() { self.space() } else { None };
        Problem::of_configuration(self.robot(), Aims { tasks: &self.tasks, targets }, penalty)
    }

    /// Tasks whose errors count beyond their tolerances, if any of them has a tolerance that is not aimed at already.
    pub(super) fn tasks_beyond_tolerance(&self) -> Option<SmallVec<[CheckedTask; 1]>> {
        let is_new = |task: &CheckedTask| task.criterion.has_band() && !task.criterion.beyond;
        let aimed = |task: &CheckedTask| {
            let mut task = task.clone();
            task.criterion = if is_new(&task) { task.criterion.beyond_tolerance() } else { task.criterion };
            task
        };
        self.tasks.iter().any(is_new).then(|| self.tasks.iter().map(aimed).collect())
    }

    /// Whether the only target is a pose whose components have tolerances and equal weights, and no solver is named.
    pub(super) fn asks_for_band_of_pose(&self, target: &Target) -> bool {
        let criterion = &self.tasks[0].criterion;
        let plain =
            criterion.components.is_some_and(|components| components.weights.iter().all(|weight| *weight == 1.0));
        matches!(target, Target::Pose(_))
            && criterion.beyond
            && plain
            && criterion.region.is_none()
            && self.options.solver.is_none()
    }

    /// Validates the targets `wanted`, and returns the parts that their tasks use.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; errors of [`reduce`](Self::reduce).
    pub(crate) fn read(&self, wanted: &[Target]) -> Result<TargetRow> {
        wanted.iter().try_for_each(Target::validate)?;
        let mut targets = TargetRow::from_slice(wanted);
        self.reduce(&mut targets)?;
        Ok(targets)
    }

    /// Reduces targets to the parts that their tasks use.
    ///
    /// # Errors
    /// [`Error::WrongTarget`], or [`Error::Contradiction`] for targets of tips that contradict each other.
    #[inline]
    pub(crate) fn reduce(&self, targets: &mut [Target]) -> Result<()> {
        reduce(self.robot, &self.tasks, targets)
    }

    /// Takes a start, which is a hint: outside the limits, each joint is brought inside by whole turns or, where none does, to its
    /// nearest limit.
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub(crate) fn hint<'q>(&self, q: &'q [f64]) -> Result<Cow<'q, [f64]>> {
        self.check_hint(q)?;
        let [lower, upper] = self.bounds.ends();
        let is_inside = (0..q.len()).all(|j| lower[j] <= q[j] && q[j] <= upper[j]);
        Ok(if is_inside { Cow::Borrowed(q) } else { Cow::Owned(self.brought_inside(q)) })
    }

    /// Checks a start.
    ///
    /// # Errors
    /// As [`hint`](Self::hint).
    pub(crate) fn check_hint(&self, q: &[f64]) -> Result<()> {
        self.robot().check("start_q", q)
    }

    #[cold]
    fn brought_inside(&self, q: &[f64]) -> Vec<f64> {
        let [lower, upper] = self.bounds.ends();
        let joint = |(j, value): (usize, &f64)| {
            let limits = [lower[j], upper[j]];
            let is_inside = lower[j] <= *value && *value <= upper[j];
            let turned = if is_inside { None } else { self.robot().turned_inside(j, *value, None, limits) };
            turned.unwrap_or(*value).clamp(lower[j], upper[j])
        };
        q.iter().enumerate().map(joint).collect()
    }

    /// Checks that the preference for the nearest solution, and weights of joints, come with a start.
    ///
    /// # Errors
    /// [`Error::Contradiction`].
    pub(crate) fn require_reference(&self, start: Option<&[f64]>) -> Result<()> {
        match (self.options.prefer, start) {
            (Prefer::Nearest, None) => Err(Error::Contradiction {
                problem: message![Setting::Prefer("nearest"), " needs a start to measure distances from"],
            }),
            (_, None) if self.options.joint_weights.is_some() => Err(Error::Contradiction {
                problem: message![Setting::JointWeights, " need a start to measure motions from"],
            }),
            _ => Ok(()),
        }
    }
}

/// Returns the weights of the joints of `robot`, if they differ.
///
/// # Errors
/// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::OutOfRange`].
pub(crate) fn joint_weights(robot: &Robot, weights: Option<&[f64]>) -> Result<Option<JointWeights>> {
    let Some(weights) = weights else { return Ok(None) };
    robot.check("joint_weights", weights)?;
    JointWeights::new(weights)
}

/// Position limits as a box. Velocity limits do not matter for a single configuration.
fn position_box(robot: &Robot, limits: Option<&Limits>) -> Result<Bounds> {
    let Some(limits) = limits else {
        return Ok(open_box(robot.joints().iter().map(|joint| (joint.lower, joint.upper))));
    };
    let remedy = "a single configuration has no motion; leave it out";
    limits.require_for(robot)?;
    limits.require_none(&[Field::Acceleration, Field::Jerk], "solve", remedy)?;
    limits.refuse_tips(&TipField::ALL, "solve", "plan a motion, because a single configuration has none")?;
    limits.refuse_torque("solve", "plan a motion, because a single configuration has none")?;
    let given = limits.position_box()?;
    Ok(open_box(given.lower().iter().copied().zip(given.upper().iter().copied())))
}

/// Box of these (lower, upper) (rad, m), unbounded where a limit counts as infinite.
fn open_box(ranges: impl Iterator<Item = (f64, f64)>) -> Bounds {
    Bounds::from_ranges(ranges.map(|(lower, upper)| sampling_range::opened(lower, upper)))
}
