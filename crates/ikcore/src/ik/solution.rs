//! The result of one target.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::message::{Message, message};
use crate::objective::Point;
use crate::obstacle::{ClearSpace, NearestContact, Surroundings};
use crate::robot::Robot;
use crate::solver::Status;
use crate::task::TipError;
use crate::wording::number;

/// The best configuration found, and how the search ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solution {
    /// The configuration (n,) (rad, m), inside the limits.
    pub q: Point,
    /// Why the search ended.
    pub status: Status,
    /// Errors at `q`, by forward kinematics.
    pub error: TipError,
    /// Why the target was not reached, in words; empty if unknown or reached.
    pub obstruction: String,
    /// The nearest two bodies at `q`, if obstacles or the robot's own links were to be kept clear of; `None` too while they are left for
    /// later ([`SolveOptions::nearest_later`](super::SolveOptions)).
    pub nearest: Option<Box<Nearest>>,
    /// Iterations over all starts.
    pub iterations: usize,
    /// Starts beyond the first.
    pub restarts: usize,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

/// What is nearest to what at a configuration, where that was asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nearest {
    /// The two bodies; `None` if no two can touch.
    pub bodies: Option<NearestContact>,
    /// The first obstacle that is a mesh which is not closed: its inside is not known.
    pub open_mesh: Option<usize>,
}

impl Nearest {
    /// At `q` in `space`.
    pub(super) fn at(space: &ClearSpace<'_>, q: &[f64]) -> Self {
        Self { bodies: space.nearest(q), open_mesh: space.first_open_mesh() }
    }

    /// The smallest distance (m); infinite if nothing can touch.
    pub fn clearance(&self) -> f64 {
        self.bodies.as_ref().map_or(f64::INFINITY, |bodies| bodies.contact.distance)
    }
}

impl Solution {
    /// Finds the nearest two bodies where they were left for later.
    ///
    /// # Errors
    /// As [`Surroundings::clear_space`].
    pub fn find_nearest(&mut self, robot: &Robot, surroundings: &Surroundings) -> Result<()> {
        if self.nearest.is_none()
            && let Some(space) = surroundings.clear_space(robot)?
        {
            self.nearest = Some(Box::new(Nearest::at(&space, &self.q)));
        }
        Ok(())
    }

    /// The smallest distance at `q` (m), negative by the depth of an overlap; infinite if nothing can touch, NaN if nothing was
    /// checked.
    pub fn clearance(&self) -> f64 {
        self.nearest.as_ref().map_or(f64::NAN, |nearest| nearest.clearance())
    }

    /// Returns a sentence: what happened, and what to try.
    pub fn message(&self) -> Message {
        let Self { error, obstruction, status, .. } = self;
        if error.position.is_nan() && error.rotation.is_nan() {
            return message!["not solved: ", status.advice()];
        }
        let ended = match status {
            Status::Solved => return format!("solved to {error}{}", self.kept_clear()).into(),
            Status::InCollision => {
                return message![format!("reached to {error}, but {obstruction}: "), status.advice()];
            }
            Status::Improved => return format!("below the requested value, {error} away").into(),
            Status::OutOfReach => "as near as possible,",
            Status::BelowThreshold => "error_threshold met,",
            Status::HeldInRegion => "as near as its region allows,",
            Status::OutsideLimits => "reached only outside the limits; inside them",
            Status::Stalled => "no further progress,",
            Status::BudgetSpent => "budget spent,",
            Status::TimeUp => "time limit reached,",
            _ => "stopped,",
        };
        let why = if obstruction.is_empty() { String::new() } else { format!(" ({obstruction})") };
        message![format!("{ended} {error} away{why}: "), status.advice()]
    }

    /// The clearance, as the end of a sentence; empty if nothing was checked.
    fn kept_clear(&self) -> String {
        let Some(nearest) = &self.nearest else { return String::new() };
        let clear = match nearest.bodies {
            None => ", with nothing to touch".into(),
            Some(_) => format!(", {} m clear of everything", number(nearest.clearance())),
        };
        match nearest.open_mesh {
            None => clear,
            Some(i) => format!("{clear}; the mesh of obstacle {i} is open, so that its inside is unknown"),
        }
    }
}
