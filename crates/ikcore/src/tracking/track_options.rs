//! Options of `track` and of a session.

use std::sync::Arc;

use super::rule::TickRule;
use super::target_filter::TargetFilter;
use crate::constraint::Keep;
use crate::error::{Error, Result};
use crate::ik::joint_weights;
use crate::limits::{LimitAt, Limits, StartSlack, TipField};
use crate::math::JointWeights;
use crate::message::{Message, Setting, message};
use crate::obstacle::Surroundings;
use crate::robot::Robot;
use crate::task::{CheckedTask, Goal, NamedTask, Task, Tolerance};

/// Name in messages of the call that follows a whole path.
pub(super) const TRACK: &str = "track";

/// Largest effect of one joint in a weighted step, relative to that of the tip.
const LARGEST_EFFECT: f64 = 10.0;
/// The same under acceleration or jerk limits, where light joints near a singularity have to slow down in time.
const LARGEST_EFFECT_UNDER_ACCELERATION: f64 = 4.0;

/// Options of [`track`](super::track()) and [`Session`](super::Session).
#[derive(Debug, Clone)]
pub struct TrackOptions {
    /// Rule that runs in every tick.
    pub rule: TickRule,
    /// Part of the path to follow. `None` means all of it.
    pub task: Option<Task>,
    /// Goals in the null space of the task.
    pub goals: Vec<Goal>,
    /// Cost of moving each joint (n,), positive: of the motions that follow the target, the one with the least sum of (weight *
    /// dq)^2. `None` means that all joints cost the same. It is for the library's own rule.
    pub joint_weights: Option<Vec<f64>>,
    /// The error band.
    pub tolerance: Tolerance,
    /// Limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Distance beyond a position limit in which a start is taken and led inside.
    pub start_slack: StartSlack,
    /// Time within a tick at which its velocity limit is evaluated.
    pub limit_at: LimitAt,
    /// Filter of the targets. `None` means none.
    pub target_filter: Option<TargetFilter>,
    /// Time without a new target after which the arm stops (s). `None` means never.
    pub timeout: Option<f64>,
    /// Whether [`track`](super::track()) begins with an approach that meets the moving path within acceleration and jerk
    /// limits. Sessions ignore it.
    pub ease: bool,
    /// Obstacles and self-collision to avoid; none by default.
    pub surroundings: Surroundings,
    /// Constraints at every instant, between ticks too, and in the stop after each; none by default.
    pub keeps: Vec<Keep>,
    /// Whether an arm that comes no nearer to its target, though a configuration on it is known, goes there by a motion of its
    /// joints; true by default. It is for the library's own rule, and tasks without a region.
    pub recover: bool,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

impl Default for TrackOptions {
    fn default() -> Self {
        Self {
            rule: TickRule::default(),
            task: None,
            goals: vec![],
            joint_weights: None,
            tolerance: Tolerance::default(),
            limits: None,
            limit_at: LimitAt::default(),
            target_filter: None,
            timeout: None,
            ease: false,
            surroundings: Surroundings::default(),
            keeps: vec![],
            recover: true,
            start_slack: StartSlack::default(),
            seed: 0,
        }
    }
}

impl TrackOptions {
    /// Task of the only tip, which decides whether a tick is in its band.
    pub(super) fn only_task(&self) -> Result<CheckedTask> {
        NamedTask::of_only(self.task, self.tolerance).validated()
    }

    /// Checks that rule and task support the robot's number of tips, and that it has those of the constraints.
    pub(super) fn require_tips(&self, robot: &Robot) -> Result<()> {
        self.rule.require_tips(robot)?;
        self.keeps.iter().try_for_each(|keep| keep.require_tips(robot))?;
        if self.task.is_some() { robot.require_one_tip(Setting::OneTask) } else { Ok(()) }
    }

    /// Checks that rule and robot support the goals.
    pub(super) fn check_goals(&self, robot: &Robot) -> Result<()> {
        if !self.goals.is_empty() && !self.rule.serves_goals() {
            let problem = "goals need the library's own rule, with solver left out, or WeightedPseudoInverse";
            return Err(Error::Contradiction { problem: problem.into() });
        }
        self.goals.iter().try_for_each(|goal| goal.validate(robot, false))
    }

    /// Weights of the joints of `robot`, if they differ; `under_acceleration` is true with acceleration or jerk limits.
    pub(super) fn weights_for(&self, robot: &Robot, under_acceleration: bool) -> Result<Option<Arc<JointWeights>>> {
        if self.joint_weights.is_some() && !self.rule.is_own() {
            let problem = message![
                Setting::JointWeights,
                " need the library's own rule, with solver left out; WeightedPseudoInverse has weights of its own"
            ];
            return Err(Error::Contradiction { problem });
        }
        let weights = joint_weights(robot, self.joint_weights.as_deref())?;
        let largest_effect = if under_acceleration { LARGEST_EFFECT_UNDER_ACCELERATION } else { LARGEST_EFFECT };
        Ok(weights.map(|weights| Arc::new(weights.fading_at(largest_effect))))
    }

    /// Limits in force for `robot` in the call `method`.
    ///
    /// # Errors
    /// [`Error::NoPace`] for a joint that nothing slows down, unless infinite velocity limits were given;
    /// [`Error::WrongLength`]; [`Error::UnsupportedLimit`] for accelerations of tips.
    pub(super) fn limits_for(&self, robot: &Robot, method: &Message) -> Result<Limits> {
        let limits = self.limits.clone().unwrap_or_else(|| Limits::of(robot));
        limits.require_for(robot)?;
        limits.require_pace_or_consent()?;
        limits.refuse_tips(&[TipField::Acceleration], method.clone(), "plan the motion, which keeps them")?;
        Ok(limits)
    }
}
