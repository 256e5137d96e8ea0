//! Concatenation of motions.

use super::{Trajectory, polynomial};
use crate::error::{Error, Result};

/// Longest pause (s); after a longer one, times would lack the precision that the next motion needs.
const LONGEST_PAUSE: f64 = 1e6;

impl Trajectory {
    /// Returns this motion, followed by a pause of `pause` (s) and by `next`, which must start where this one ends.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a pause below zero or above a million seconds, [`Error::InvalidTrajectory`] if `next`
    /// has other joints or starts elsewhere.
    pub fn then(&self, next: &Self, pause: f64) -> Result<Self> {
        if !(0.0..=LONGEST_PAUSE).contains(&pause) {
            return Err(Error::out_of_range("pause", format!("from 0 to {LONGEST_PAUSE} s"), pause));
        }
        if self.joints() != next.joints() {
            let [these, those] = [self, next].map(|motion| motion.joints().join(", "));
            let problem = format!("the motion that follows moves other joints: {those} instead of {these}");
            return Err(Error::InvalidTrajectory { problem });
        }
        let (mut knots, mut coefficients) = (self.knots().to_vec(), self.coefficients().to_vec());
        if pause > 0.0 {
            knots.push(self.duration() + pause);
            coefficients.extend(next.coefficients()[..next.joints().len()].iter().map(|joint| polynomial([joint[0]])));
        }
        let begin = self.duration() + pause;
        knots.extend(next.knots()[1..].iter().map(|t| begin + t));
        coefficients.extend_from_slice(next.coefficients());
        Self::from_phases(self.joints().to_vec(), knots, coefficients)
    }
}
