//! Result of one target.

use std::ops::{Deref, DerefMut};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::message::{Message, message};
use crate::objective::Point;
use crate::obstacle::{ClearSpace, Clearance, Sensed, Surroundings, clear_in_words};
use crate::robot::Robot;
use crate::solver::Status;
use crate::task::TipError;
use crate::wording::number;

/// Best configuration found, with the report on its search, whose fields are read like those of the solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solution {
    /// Configuration (n,) (rad, m), inside the limits.
    pub q: Point,
    /// Report on the search.
    pub report: SolveReport,
}

/// Report on the search for one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolveReport {
    /// Reason for the end of the search.
    pub status: Status,
    /// Errors of the solution, by forward kinematics; NaN if nothing was solved.
    pub error: TipError,
    /// Reason for a miss, in words; empty if unknown or reached.
    pub obstruction: String,
    /// Kind of measurement that shows the robot itself, if that keeps the solution in collision.
    pub own_points: Option<Sensed>,
    /// Nearest two bodies, if obstacles or self-collision were checked; `None` while deferred by
    /// [`SolveOptions::nearest_later`](super::SolveOptions).
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

/// Clearance of a solution, if collisions were checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nearest {
    /// Smallest distance, and the nearest two bodies.
    pub clearance: Clearance,
    /// First obstacle with an open mesh, whose inside is unknown.
    pub open_mesh: Option<usize>,
}

impl Nearest {
    /// Nearest two bodies at `q` in `space`.
    pub(super) fn at(space: &ClearSpace<'_>, q: &[f64]) -> Self {
        Self { clearance: space.clearance(q), open_mesh: space.first_open_mesh() }
    }
}

impl Deref for Solution {
    type Target = SolveReport;

    fn deref(&self) -> &SolveReport {
        &self.report
    }
}

impl DerefMut for Solution {
    fn deref_mut(&mut self) -> &mut SolveReport {
        &mut self.report
    }
}

impl Solution {
    /// Computes the nearest two bodies if they were deferred.
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
}

impl SolveReport {
    /// Report on a target that was not solved.
    pub(crate) fn unsolved(status: Status) -> Self {
        Self {
            status,
            error: TipError { position: f64::NAN, rotation: f64::NAN },
            obstruction: String::new(),
            own_points: None,
            nearest: None,
            iterations: 0,
            restarts: 0,
            evaluations: 0,
            elapsed: Duration::ZERO,
        }
    }

    /// Smallest distance at the solution (m), negative by the depth of an overlap; infinite if nothing can touch, NaN if nothing was
    /// checked.
    pub fn clearance(&self) -> f64 {
        self.nearest.as_ref().map_or(f64::NAN, |nearest| nearest.clearance.distance)
    }

    /// Returns a sentence on the outcome, with advice.
    pub fn message(&self) -> Message {
        let Self { error, obstruction, status, .. } = self;
        if error.position.is_nan() && error.rotation.is_nan() {
            return message!["not solved: ", status.advice()];
        }
        let ended = match status {
            Status::RotationGivenUp | Status::PositionGivenUp => return self.given_up(),
            Status::LevelGivenUp => return message![format!("{obstruction}{}: ", self.kept_clear()), status.advice()],
            Status::Solved => return format!("solved to {error}{}", self.kept_clear()).into(),
            Status::InCollision => {
                return message![format!("reached to {error}, but {obstruction}: "), self.clear_advice()];
            }
            Status::Improved => return format!("below the requested value, {error} away").into(),
            Status::OutOfReach => "out of reach, the nearest found is",
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

    /// Sentence on a pose of which one part was met and the other given up.
    fn given_up(&self) -> Message {
        let Self { error, obstruction, status, .. } = self;
        let (position, rotation) = (number(error.position), number(error.rotation));
        let parts = match status {
            Status::PositionGivenUp => {
                format!("rotation met to {rotation} rad, position given up: the nearest found is {position} m away")
            }
            _ => format!("position met to {position} m, rotation given up: the nearest found is {rotation} rad away"),
        };
        let why = if obstruction.is_empty() { String::new() } else { format!(" ({obstruction})") };
        message![format!("{parts}{why}{}: ", self.kept_clear()), status.advice()]
    }

    /// Advice for a solution in collision.
    fn clear_advice(&self) -> Message {
        let nearest = self.nearest.as_ref().and_then(|nearest| nearest.clearance.nearest.as_ref());
        match (self.own_points, nearest.and_then(|nearest| nearest.contact.measured())) {
            (Some(measured), _) => measured.advice(),
            (None, Some(measured)) => message![
                measured.advice(),
                "; if there are none, choose another target, clear what is in the way, or lower the margin"
            ],
            (None, None) => self.status.advice(),
        }
    }

    /// Clearance as the end of a sentence; empty if nothing was checked.
    fn kept_clear(&self) -> String {
        let in_words = |nearest: &Nearest| clear_in_words(Some(&nearest.clearance), nearest.open_mesh);
        self.nearest.as_deref().map_or_else(String::new, in_words)
    }
}
