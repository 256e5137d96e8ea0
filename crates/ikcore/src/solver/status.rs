//! How a run ended: one vocabulary for solves, batches and tracks.
//!
//! A [`Stop`](super::Stop) holds the budgets that a caller asks for; a [`Status`] says how the run ended. Inside a run a
//! status is also the signal that ends it: evaluator and solver return it as an error, `?` passes it up to the driver.

use serde::{Deserialize, Serialize};

/// The list of statuses: variant and number, the name that Python shows, and what it means.
macro_rules! statuses {
    ($($variant:ident = $number:literal, $name:literal: $meaning:literal;)+) => {
        /// How a solve, one item of a batch or one step of a track ended.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[repr(u8)]
        pub enum Status {
            $(#[doc = $meaning] $variant = $number,)+
        }

        impl Status {
            /// All of them, in the order of their numbers.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// The name as Python shows it.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }

            /// What it says, in words.
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
        "A step of a track: nearer than the step before, not yet within the tolerance. Or a search ended by `value_below`.";
    Capped = 2, "CAPPED":
        "A step of a track: neither within the tolerance nor nearer than the step before; the best found is kept.";
    Stalled = 3, "STALLED": "The solver's own rule gave up: nothing more to gain from here.";
    BudgetSpent = 4, "BUDGET_SPENT": "The evaluation or iteration budget is spent.";
    TimeUp = 5, "TIME_UP": "The time limit is over.";
    Interrupted = 6, "INTERRUPTED": "It was asked to stop before its end.";
    Lost = 7, "LOST": "A track that did not stay within its tolerance.";
    Invalid = 8, "INVALID": "An item of a batch whose target or start is wrong: nothing was solved.";
    OutOfReach = 9, "OUT_OF_REACH":
        "Beyond doubt, no configuration reaches so far: the target is farther than the arm is long, or off its plane.";
    PlantFailed = 10, "PLANT_FAILED":
        "A plant that raised an error, or returned what is no position: the run ended with what was recorded.";
    BelowThreshold = 11, "BELOW_THRESHOLD": "The solver's own threshold was met before the tolerances were.";
    OutsideLimits = 12, "OUTSIDE_LIMITS":
        "The search arrived outside the limits, and whole turns do not bring it inside; the best inside is kept.";
    HeldInRegion = 13, "HELD_IN_REGION":
        "The region of the task keeps the tip from the target; the tip is in it, as near as it may come.";
}

impl Status {
    /// What to try, as the end of a sentence; empty for success.
    pub fn advice(self) -> &'static str {
        match self {
            Self::Solved | Self::Improved => "",
            Self::Capped => {
                "give it more ticks, wider limits, a wider tolerance, its solver more passes, or a target within reach"
            }
            Self::Stalled => "try another start or seed, or MultiStart; the target may be out of reach",
            Self::BudgetSpent => "raise the budget in stop=Stop(...); the target may be out of reach",
            Self::TimeUp => "raise max_time",
            Self::Interrupted => "run again to finish",
            Self::Lost => {
                "slow the path down, widen the limits, start elsewhere (another start or seed), or move the path into reach"
            }
            Self::OutOfReach => "move or turn the target into reach, or move the base",
            Self::Invalid => "on_invalid=\"raise\" says what is wrong",
            Self::PlantFailed => "mend the plant and run again",
            Self::BelowThreshold => "lower error_threshold, or leave it out and let the tolerances decide",
            Self::HeldInRegion => "move the target into the region, or widen the region",
            Self::OutsideLimits => {
                "try another start or seed, MultiStart, or a solver that searches inside the limits, such as LevenbergMarquardt"
            }
        }
    }
}
