//! Status of a finished run, shared by solves, batches and tracks.
//!
//! A [`Stop`](super::Stop) holds the budgets of a run; a [`Status`] reports how the run ended. Inside a run a status is also
//! the signal that ends it: evaluator and solver return it as an error, and `?` passes it up to the driver.

use serde::{Deserialize, Serialize};

use crate::message::{Message, Setting, message};

/// Defines the statuses: variant and number, name, meaning.
macro_rules! statuses {
    ($($variant:ident = $number:literal, $name:literal: $meaning:literal;)+) => {
        /// Status of a solve, an item of a batch or a step of a track at its end.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[repr(u8)]
        pub enum Status {
            $(#[doc = $meaning] $variant = $number,)+
        }

        impl Status {
    /// Whether what comes first is met, and another part of the pose, or another level of tips, was given up for it.
    pub(crate) fn is_given_up(self) -> bool {
        matches!(self, Self::RotationGivenUp | Self::PositionGivenUp | Self::LevelGivenUp)
    }

            /// All statuses in the order of their numbers.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// Name of the status.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }

            /// Meaning in one sentence.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$variant => $meaning,)+
                }
            }
        }
    };
}

statuses! {
    Solved = 0, "SOLVED": "Within the tolerances.";
    Improved = 1, "IMPROVED":
        "A step of a track that came nearer than the step before, not yet within the tolerance; or a search that reached the value asked for.";
    Capped = 2, "CAPPED":
        "A step of a track that is neither within the tolerance nor nearer than the step before; the best configuration found is kept.";
    Stalled = 3, "STALLED": "The solver's own rule ended the search: no further progress from here.";
    BudgetSpent = 4, "BUDGET_SPENT": "The evaluation or iteration budget is spent.";
    TimeUp = 5, "TIME_UP": "The time limit is reached.";
    Interrupted = 6, "INTERRUPTED": "Stopped on request before the end.";
    Lost = 7, "LOST": "A track that did not stay within its tolerance.";
    Invalid = 8, "INVALID": "An item of a batch with an invalid target or start; it was not solved.";
    OutOfReach = 9, "OUT_OF_REACH":
        "Provably out of reach: the target is farther away than the arm is long, off its plane, or without a solution in closed form.";
    PlantFailed = 10, "PLANT_FAILED":
        "The plant raised an error or returned something other than a position; the run ended with what was recorded.";
    BelowThreshold = 11, "BELOW_THRESHOLD": "The solver's own threshold was met before the tolerances were.";
    OutsideLimits = 12, "OUTSIDE_LIMITS":
        "The search converged outside the limits, and whole turns do not bring it inside; the best configuration inside is kept.";
    HeldInRegion = 13, "HELD_IN_REGION":
        "The region of the task keeps the tip from the target; the tip is in the region, as near as possible.";
    InCollision = 14, "IN_COLLISION":
        "Nearer than the margin to an obstacle, or with two links nearer to each other; the target may be reached.";
    HeldByObstacle = 15, "HELD_BY_OBSTACLE":
        "A step of a track in which obstacles, or the robot's own links, keep the tip from the target; the arm keeps its margin.";
    RotationGivenUp = 16, "ROTATION_GIVEN_UP":
        "The position is within its tolerance, and the rotation as near as the search found; a configuration that meets both was not found.";
    PositionGivenUp = 17, "POSITION_GIVEN_UP":
        "The rotation is within its tolerance, and the position as near as the search found; a configuration that meets both was not found.";
    HeldByConstraint = 18, "HELD_BY_CONSTRAINT":
        "A step of a track in which what is to be kept holds the tip away from the target; the arm keeps it at every instant.";
    LevelGivenUp = 19, "LEVEL_GIVEN_UP":
        "The tasks of the lowest level are within their tolerances, those of a higher level as near as the search found; a configuration that meets all was not found.";
    HeldByTorque = 20, "HELD_BY_TORQUE":
        "A step of a track in which a torque limit holds the tip away from the target: a joint could not move or hold the arm farther on, or carries more than it can.";
}

impl Status {
    /// Advice on the next attempt, as the end of a sentence; empty for success.
    pub fn advice(self) -> Message {
        Message::from(match self {
            Self::Solved | Self::Improved => "",
            Self::Capped => {
                "allow more ticks, wider limits, a wider tolerance or more solver passes, or move the target into reach"
            }
            Self::Stalled => "try another start or seed, or MultiStart; the target may be out of reach",
            Self::BudgetSpent => return message!["raise the ", Setting::Budget, "; the target may be out of reach"],
            Self::TimeUp => "raise max_time",
            Self::Interrupted => "run again to finish",
            Self::Lost => {
                "slow the path down, widen the limits, start elsewhere (another start or seed), or move the path into reach"
            }
            Self::OutOfReach => "move or turn the target into reach, or move the base",
            Self::Invalid => return message![Setting::RaiseInvalid, " to see what is wrong"],
            Self::PlantFailed => "fix the plant and run again",
            Self::BelowThreshold => "lower error_threshold, or leave it out and let the tolerances decide",
            Self::InCollision => "move the target or what is in the way, or lower the margin",
            Self::HeldByObstacle => "move the target or what is in the way, lower the margin, or plan a way round",
            Self::HeldByConstraint => {
                "move the target to where everything can be kept, or widen a tolerance of what is kept"
            }
            Self::HeldByTorque => {
                "move the target to where the joints can hold the arm, lighten the payload, or raise the torque limit"
            }
            Self::RotationGivenUp => {
                "turn the target, give the rotation a tolerance, or take a task that leaves it free, such as Position or Pointing"
            }
            Self::PositionGivenUp => {
                "move the target, give the position a tolerance, or take a task that leaves it free, such as Orientation"
            }
            Self::LevelGivenUp => {
                "move the targets of the higher levels, or give them a tolerance, a lower level or a task that leaves more free"
            }
            Self::HeldInRegion => "move the target into the region, or widen the region",
            Self::OutsideLimits => {
                "try another start or seed, MultiStart, or a solver that searches inside the limits, such as LevenbergMarquardt"
            }
        })
    }
}
