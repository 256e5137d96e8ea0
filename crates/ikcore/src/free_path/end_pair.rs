//! A pair of end configurations of a motion.

use crate::error::{Error, Result};
use crate::math::vector::largest_difference;
use crate::objective::Point;
use crate::timing::JointPolyline;

/// Configurations of both ends, and the duration of a quintic between them (s).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct EndPair {
    pub start: Point,
    pub end: Point,
    /// Index of the end, of those given.
    pub chosen: usize,
    pub duration: f64,
}

/// Pairs that differ by less count as the same (rad, m).
const SAME: f64 = 1e-3;

impl EndPair {
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let near = |a: &Point, b: &Point| largest_difference(a, b) < SAME;
        self.chosen == other.chosen && near(&self.start, &other.start) && near(&self.end, &other.end)
    }

    /// The straight line from one to the other.
    pub(super) fn line(&self) -> JointPolyline {
        JointPolyline(vec![self.start.to_vec(), self.end.to_vec()])
    }

    /// Checks that the ends differ.
    pub(super) fn require_motion(&self) -> Result<()> {
        let largest = largest_difference(&self.start, &self.end);
        if largest > 0.0 {
            return Ok(());
        }
        let problem =
            "start and end are the same configuration: the arm is there already, nothing is to be planned".into();
        Err(Error::InvalidTrajectory { problem })
    }
}
