//! Choice of tick rule, and the running rule.

use super::any_solver;
use super::goal_pursuit::GoalPursuit;
use super::joint_move::JointMove;
use super::mid_step::{self, MidStepState};
use super::tick::{Tick, TickResult};
use super::tip_step::TipStep;
use super::weighted_pseudo_inverse::{self, WeightedPseudoInverse};
use crate::error::Result;
use crate::robot::Robot;
use crate::solver::AnySolver;
use crate::tracking::safety_filter::SafetyFilter;

/// Rule that runs in every tick.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TickRule {
    /// Model steps: one evaluation of kinematics and Jacobian suffices for most ticks.
    #[default]
    MidStep,
    /// Solver started at the accepted configuration in every tick.
    Solver(AnySolver),
    /// Joint velocities by the weighted pseudo-inverse of the Jacobian.
    WeightedPseudoInverse(WeightedPseudoInverse),
}

/// Running rule with its state between ticks.
#[derive(Debug)]
pub(in crate::tracking) enum RunningRule {
    MidStep(MidStepState),
    /// Variant of `MidStep` under acceleration or jerk limits.
    GoalPursuit(Box<GoalPursuit>),
    /// Variant of `MidStep` for several tips.
    TipStep(TipStep),
    /// Joint motion back to a configuration on the target; in place of `MidStep` and `TipStep`.
    JointMove(JointMove),
    Solver(AnySolver),
    WeightedPseudoInverse(WeightedPseudoInverse, weighted_pseudo_inverse::Scratch),
}

impl TickRule {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::MidStep => Ok(()),
            Self::Solver(solver) => solver.validate(),
            Self::WeightedPseudoInverse(rule) => rule.validate(),
        }
    }

    /// Checks the options for `robot` and ticks of `dt` (s).
    pub(in crate::tracking) fn validate_for(&self, robot: &Robot, dt: f64) -> Result<()> {
        match self {
            Self::MidStep | Self::Solver(_) => Ok(()),
            Self::WeightedPseudoInverse(rule) => rule.validate_for(robot, dt),
        }
    }

    /// Whether the rule is the library's own, which a way back can follow.
    pub(in crate::tracking) fn is_own(&self) -> bool {
        *self == Self::MidStep
    }

    /// Whether the rule supports goals.
    pub(in crate::tracking) fn serves_goals(&self) -> bool {
        !matches!(self, Self::Solver(_))
    }

    /// Whether the rule uses the velocity of the target.
    pub fn uses_velocities(&self) -> bool {
        matches!(self, Self::WeightedPseudoInverse(_))
    }

    /// Checks that the rule supports the robot's number of tips.
    ///
    /// # Errors
    /// [`Error::SeveralTips`].
    pub(in crate::tracking) fn require_tips(&self, robot: &Robot) -> Result<()> {
        match self {
            Self::MidStep => Ok(()),
            Self::Solver(_) => robot.require_one_tip("a given solver"),
            Self::WeightedPseudoInverse(_) => robot.require_one_tip("WeightedPseudoInverse"),
        }
    }

    /// Whether the rule extrapolates targets, and so uses their stamps; `under_acceleration` is true with acceleration or jerk
    /// limits.
    pub(in crate::tracking) fn extrapolates(&self, under_acceleration: bool) -> bool {
        *self == Self::MidStep && under_acceleration
    }

    /// Starts the rule; `under_acceleration` is true with acceleration or jerk limits.
    pub(in crate::tracking) fn start(&self, under_acceleration: bool, several_tips: bool) -> RunningRule {
        match self {
            Self::MidStep if under_acceleration => RunningRule::GoalPursuit(Box::default()),
            Self::MidStep if several_tips => RunningRule::TipStep(TipStep::default()),
            Self::MidStep => RunningRule::MidStep(MidStepState::default()),
            Self::Solver(solver) => RunningRule::Solver(solver.clone()),
            Self::WeightedPseudoInverse(rule) => {
                RunningRule::WeightedPseudoInverse(rule.clone(), weighted_pseudo_inverse::Scratch::default())
            }
        }
    }
}

impl RunningRule {
    /// Drops the state of the last tick, because the arm has left the rule's configuration.
    pub(crate) fn forget(&mut self) {
        match self {
            Self::MidStep(memory) => memory.forget(),
            Self::GoalPursuit(pursuit) => pursuit.forget(),
            Self::TipStep(_) | Self::JointMove(_) | Self::Solver(_) | Self::WeightedPseudoInverse(..) => {}
        }
    }

    /// Makes `q`, a configuration on the target, the goal of the joints.
    pub(crate) fn head_for(&mut self, q: &[f64]) {
        match self {
            Self::GoalPursuit(pursuit) => pursuit.head_for(q),
            other => *other = Self::JointMove(JointMove::to(q)),
        }
    }

    /// Goal of the joints, if they pursue one.
    pub(crate) fn goal(&self) -> Option<&[f64]> {
        match self {
            Self::GoalPursuit(pursuit) => pursuit.goal(),
            Self::JointMove(motion) => Some(motion.goal()),
            Self::MidStep(_) | Self::TipStep(_) | Self::Solver(_) | Self::WeightedPseudoInverse(..) => None,
        }
    }

    /// Whether the arm follows the motion of its last targets on, because no new one has come.
    pub(crate) fn has_outlived_targets(&self) -> bool {
        matches!(self, Self::GoalPursuit(pursuit) if pursuit.has_outlived_targets())
    }

    /// Runs one tick. `safety` moves samples of a goal away from obstacles.
    pub(crate) fn advance(&mut self, mut tick: Tick<'_>, safety: Option<&mut SafetyFilter>) -> TickResult {
        match self {
            Self::MidStep(memory) => mid_step::advance(memory, tick),
            Self::GoalPursuit(pursuit) => {
                let found = pursuit.find_sample(&mut tick);
                if let (Some(safety), Some(_)) = (safety, tick.sampled_ago) {
                    let (from, sample) = pursuit.sample_to_clear(tick.context.q);
                    let held = safety.clear_goal(&tick.context, from, sample);
                    pursuit.note_held(held);
                }
                pursuit.pursue(found, &tick)
            }
            Self::TipStep(step) => step.advance(tick),
            Self::JointMove(motion) => motion.advance(&tick),
            Self::Solver(solver) => any_solver::advance(solver, tick),
            Self::WeightedPseudoInverse(rule, scratch) => weighted_pseudo_inverse::advance(rule, scratch, tick),
        }
    }
}
