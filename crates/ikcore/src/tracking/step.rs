//! Result of one tick.

use serde::{Deserialize, Serialize};

use super::away::{Away, Way};
use super::idle::Idle;
use crate::limits::JointOutside;
use crate::message::{Message, message};
use crate::obstacle::{Contact, Sensed};
use crate::solver::Status;
use crate::task::TipError;

/// Result of one tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Status: [`Status::Solved`] in the band, [`Status::HeldInRegion`] if the region keeps the tip out of the band,
    /// [`Status::InCollision`] if an obstacle or another link is nearer than the margin, [`Status::HeldByObstacle`] if one
    /// holds the arm back, [`Status::HeldByConstraint`] if a constraint does, [`Status::HeldByTorque`] if a torque
    /// limit does or is exceeded by what the arm carries, [`Status::LevelGivenUp`] if the lowest level of
    /// several targets is met, not all, [`Status::RotationGivenUp`] or [`Status::PositionGivenUp`] if only the part of the pose that comes first
    /// is met, [`Status::Improved`] if the arm moves and is nearer than before, else [`Status::Capped`]. An arm that meets its last target
    /// is [`Status::Capped`] in a tick that ignored another one, for its stamp, which it does not meet.
    pub status: Status,
    /// Errors at the accepted configuration.
    pub error: TipError,
    /// Tip position at the accepted configuration (m).
    pub position: [f64; 3],
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Iterations of the rule; for beetle antennae search, passes.
    pub iterations: usize,
    /// Whether this tick can bring every joint back within its position limits and slow it down to its velocity limit.
    pub inside_limits: bool,
    /// Obstruction that keeps the arm away from its target, if it comes no nearer; `None` for rules other than the library's own.
    pub away: Option<Away>,
    /// Reason why no target leads the arm, if none does.
    pub idle: Option<Idle>,
    /// Whether the monitor asked to stop: no configuration was accepted, and time did not advance.
    pub interrupted: bool,
}

impl Step {
    /// Returns a sentence on the outcome, with advice. It numbers joints, the first being 1.
    pub fn message(&self) -> Message {
        self.message_with(self.status.advice(), &[], number)
    }

    /// Returns the advice where the nearest contact is known. An arm that is in collision with what a sensor measured is
    /// probably in it itself.
    pub fn advice_near(&self, nearest: &Contact) -> Message {
        let measured = nearest.measured().filter(|_| self.status == Status::InCollision);
        measured.map_or_else(|| self.status.advice(), Sensed::advice)
    }

    /// Returns [`message`](Self::message) with this `advice`, of an arm that began with the joints `outside` their limits.
    /// `joint` names each joint by its index.
    pub fn message_with(
        &self,
        advice: impl Into<Message>,
        outside: &[JointOutside],
        joint: impl Fn(usize) -> String,
    ) -> Message {
        let error = &self.error;
        let limits = match (outside, self.inside_limits) {
            ([], true) => String::new(),
            ([], false) => "; a joint is outside its limits and returns".into(),
            _ => JointOutside::in_words(outside, "began"),
        };
        if let (Some(idle), false) = (self.idle, self.is_obstructed()) {
            return idle.message(error, &limits);
        }
        if let (Status::Improved | Status::Capped, Some(away)) = (self.status, self.away) {
            return away.message(error, &limits, joint);
        }
        let how = match self.status {
            Status::Solved => return format!("within the tolerances, {error} away{limits}").into(),
            Status::Improved => return format!("nearer than in the tick before, {error} away{limits}").into(),
            Status::RotationGivenUp => "position met and rotation given up",
            Status::PositionGivenUp => "rotation met and position given up",
            Status::LevelGivenUp => "the lowest level met and a higher one given up",
            Status::HeldInRegion => "as near as its region allows",
            Status::InCollision => "nearer than the margin to an obstacle or another link",
            Status::HeldByObstacle => "held back by an obstacle or another link",
            Status::HeldByConstraint => "held back by what is to be kept",
            Status::HeldByTorque => "held back by a torque limit",
            _ => "no nearer than in the tick before",
        };
        let known = match self.away {
            Some(Away { way: Way::Blocked, .. }) if self.status != Status::HeldByConstraint => {
                format!("; {}", Away::NO_WAY)
            }
            _ => String::new(),
        };
        message![format!("{how}, {error} away{limits}{known}: "), advice]
    }

    /// Whether the status concerns the configuration of the arm, whatever its target.
    fn is_obstructed(&self) -> bool {
        matches!(self.status, Status::InCollision | Status::HeldByTorque)
    }
}

/// Number of joint `j`, the first being 1.
fn number(j: usize) -> String {
    (j + 1).to_string()
}
