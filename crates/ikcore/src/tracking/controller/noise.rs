//! Noise level of a sensor, estimated from repeated measurements.

use crate::math::vector::median;
use crate::tracking::tip_pose::TipPose;

/// Multiple of the noise level up to which distances may be noise alone.
const EXPLAINED: f64 = 3.0;

/// Ratio, for Gaussian noise, of the root mean square distance of two measurements to the mean distance of the closest two of
/// three.
const TWO_OVER_NEAREST_OF_THREE: f64 = 1.62;

/// Noise level of a sensor (m): the median of the last three distances between measurements of one command, so that one outlier
/// has no effect.
#[derive(Debug, Default)]
pub(super) struct Noise {
    repeats: [f64; 3],
    noted: usize,
    level: f64,
}

impl Noise {
    /// Adds the distance between two measurements of one command (m).
    pub(super) fn note(&mut self, repeat: f64) {
        self.repeats[self.noted % 3] = repeat;
        self.noted += 1;
        let [a, b, c] = self.repeats;
        self.level = median(a, b, c) * std::f64::consts::FRAC_1_SQRT_2;
    }

    /// Adds three measurements of one command. One of them may be an outlier, so the closest two count.
    pub(super) fn note_three(&mut self, [a, b, c]: &[TipPose; 3]) {
        let nearest = a.distance(b).min(b.distance(c)).min(a.distance(c));
        (0..2).for_each(|_| self.note(TWO_OVER_NEAREST_OF_THREE * nearest));
    }

    /// Root mean square noise of one measurement (m); zero before the first estimate.
    pub(super) fn level(&self) -> f64 {
        self.level
    }

    /// Whether a motion or an error of this size (m) may be noise alone.
    pub(super) fn explains(&self, size: f64) -> bool {
        size < EXPLAINED * self.level
    }

    /// Fraction of the update to apply after a prediction missed by `miss` (m): the part above the noise level. The
    /// whole update would carry the noise of every measurement into the Jacobian until the steps go astray.
    pub(super) fn fraction(&self, miss: f64) -> f64 {
        (1.0 - (EXPLAINED * self.level / miss).powi(2)).max(0.0)
    }
}
