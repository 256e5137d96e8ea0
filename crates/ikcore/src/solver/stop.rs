//! When to stop, and why it stopped. The only file with a clock.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Limits on a run; whichever comes first. Counts repeat exactly, a time limit does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Objective evaluations (for a robot: forward kinematics), the start included.
    pub max_evaluations: usize,
    /// Iterations as the solver counts them.
    pub max_iterations: usize,
    /// Iterations that are made even from a start that is solved already.
    pub min_iterations: usize,
    /// Wall-clock time. Setting it gives up repeatability.
    pub max_time: Option<Duration>,
    /// Stop after a step whose best value is below this. The start itself is not held against it.
    pub value_below: Option<f64>,
}

impl Default for Stop {
    /// 30 000 evaluations: about 10 ms for a 7-joint arm.
    fn default() -> Self {
        Self {
            max_evaluations: 30_000,
            max_iterations: usize::MAX,
            min_iterations: 0,
            max_time: None,
            value_below: None,
        }
    }
}

impl Stop {
    /// Checks that at least the start may be evaluated and one step made.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a budget of zero.
    pub fn validate(&self) -> Result<()> {
        for (name, count) in [("max_evaluations", self.max_evaluations), ("max_iterations", self.max_iterations)] {
            if count == 0 {
                return Err(Error::out_of_range(name, "at least 1", 0.0));
            }
        }
        match self.value_below {
            Some(value) if value.is_nan() => Err(Error::out_of_range("value_below", "a number", value)),
            _ => Ok(()),
        }
    }
}

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

/// The caller's say in a long run: asked from the calling thread, every few microseconds of work.
pub trait Monitor {
    /// False ends the run with [`Status::Interrupted`].
    fn keep_going(&mut self) -> bool;

    /// Told of the steps of a track, or of the items of a batch, that are done, out of `total`.
    fn progress(&mut self, _done: usize, _total: usize) {}
}

/// A monitor that lets everything run to its end.
#[derive(Debug, Clone, Copy)]
pub struct Unattended;

impl Monitor for Unattended {
    fn keep_going(&mut self) -> bool {
        true
    }
}

/// Time since it was started.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(Instant);

impl Stopwatch {
    /// Starts now.
    #[allow(clippy::disallowed_methods)]
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }
}
