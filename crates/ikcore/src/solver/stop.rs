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

/// How a solve, one item of a batch or one step of a track ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[repr(u8)]
pub enum Status {
    /// Within the tolerances.
    Solved = 0,
    /// A step of a track: not yet within the tolerance, but nearer than the step before.
    Improved = 1,
    /// A step of a track: neither within the tolerance nor nearer than the step before; the best found is kept.
    Capped = 2,
    /// The solver's own rule gave up: nothing more to gain from here.
    Stalled = 3,
    /// The evaluation or iteration budget is spent.
    BudgetSpent = 4,
    /// The time limit is over.
    TimeUp = 5,
    /// The caller's monitor asked to stop.
    Interrupted = 6,
    /// A track that did not stay within its tolerance.
    Lost = 7,
    /// An item of a batch whose target or start is wrong: nothing was solved.
    Invalid = 8,
    /// The target is farther from the base than the arm is long.
    OutOfReach = 9,
    /// A plant that raised an error, or returned what is no position: the run ended with what was recorded.
    PlantFailed = 10,
    /// The solver's own threshold was met before the tolerances were.
    BelowThreshold = 11,
    /// The search arrived outside the limits, and whole turns do not bring it inside; the best inside is kept.
    OutsideLimits = 12,
    /// The region of the task keeps the tip from the target; the tip is in it, as near as it may come.
    HeldInRegion = 13,
}

impl Status {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 14] = [
        Self::Solved,
        Self::Improved,
        Self::Capped,
        Self::Stalled,
        Self::BudgetSpent,
        Self::TimeUp,
        Self::Interrupted,
        Self::Lost,
        Self::Invalid,
        Self::OutOfReach,
        Self::PlantFailed,
        Self::BelowThreshold,
        Self::OutsideLimits,
        Self::HeldInRegion,
    ];

    /// The name as Python shows it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solved => "SOLVED",
            Self::Improved => "IMPROVED",
            Self::Capped => "CAPPED",
            Self::Stalled => "STALLED",
            Self::BudgetSpent => "BUDGET_SPENT",
            Self::TimeUp => "TIME_UP",
            Self::Interrupted => "INTERRUPTED",
            Self::Lost => "LOST",
            Self::Invalid => "INVALID",
            Self::OutOfReach => "OUT_OF_REACH",
            Self::PlantFailed => "PLANT_FAILED",
            Self::BelowThreshold => "BELOW_THRESHOLD",
            Self::OutsideLimits => "OUTSIDE_LIMITS",
            Self::HeldInRegion => "HELD_IN_REGION",
        }
    }

    /// What to try, as the end of a sentence; empty for success.
    pub fn advice(self) -> &'static str {
        match self {
            Self::Solved | Self::Improved => "",
            Self::Capped => "allow more passes, a wider tolerance or a higher velocity limit",
            Self::Stalled => "try another start or seed, or MultiStart; the target may be out of reach",
            Self::BudgetSpent => "raise the budget in stop=Stop(...); the target may be out of reach",
            Self::TimeUp => "raise max_time",
            Self::Interrupted => "run again to finish",
            Self::Lost => {
                "slow the path down, raise the velocity limits, start elsewhere (another start or seed), or move the path into reach"
            }
            Self::OutOfReach => "move the target nearer to the base, or the base nearer to the target",
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
