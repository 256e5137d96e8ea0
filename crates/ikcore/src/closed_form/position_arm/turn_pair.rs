//! Local optima of a rotation that two turns make, the second about an axis that the first turns.

use std::f64::consts::TAU;

use super::goal::{Trace, TurnRange};
use crate::closed_form::angle::Angle;
use crate::math::vector3::{Vector, cross, dot};

/// Values of the first turn at which the slope is taken. Two optima between neighbours would differ by less than 1e-3.
const VALUES: usize = 24;

/// Slope at which an optimum is found.
const FLAT: f64 = 1e-12;

/// Largest number of slopes taken for one optimum; a handful is usual.
const ROUNDS: usize = 40;

/// Trace of the rotation to the goal over both turns: each part of the trace over the second turn is a constant, and parts along
/// cosine and sine of the first.
#[derive(Debug, Clone, Copy)]
pub struct TurnPair {
    constant: [f64; 3],
    cosine: [f64; 3],
    sine: [f64; 3],
}

impl TurnPair {
    /// Trace of the `basis` of the tip, turned about its third vector and then about `axis`, with its images `wanted`.
    pub fn of(axis: &Vector, [x, y, z]: &[Vector; 3], [k1, k2, k3]: &[Vector; 3]) -> Self {
        let part = |k: &Vector, v: &Vector| {
            let along = dot(k, axis) * dot(axis, v);
            [along, dot(k, v) - along, dot(k, &cross(axis, v))]
        };
        let [a, b, c, d] = [part(k1, x), part(k2, y), part(k1, y), part(k2, x)];
        Self {
            constant: part(k3, z),
            cosine: std::array::from_fn(|k| a[k] + b[k]),
            sine: std::array::from_fn(|k| c[k] - d[k]),
        }
    }

    /// Trace over the second turn.
    #[inline]
    pub fn at(&self, first: Angle) -> Trace {
        let part = |[constant, cosine, sine]: &[f64; 3]| constant + cosine * first.cos + sine * first.sin;
        Trace { constant: part(&self.constant), cosine: part(&self.cosine), sine: part(&self.sine) }
    }

    /// Increase of the trace with the first turn, the second at its best in `last`: by the envelope theorem, that at a fixed second.
    #[inline]
    pub fn slope(&self, first: Angle, last: &TurnRange) -> f64 {
        let part = |[_, cosine, sine]: &[f64; 3]| sine * first.cos - cosine * first.sin;
        let best = self.at(first).best(last);
        part(&self.constant) + part(&self.cosine) * best.cos + part(&self.sine) * best.sin
    }

    /// First turn at which the trace is largest without a second.
    #[inline]
    pub fn best_alone(&self) -> Angle {
        Angle::towards(self.constant[1] + self.cosine[1], self.constant[2] + self.cosine[2])
    }

    /// Calls `keep` with each first turn at which the trace is locally largest, the second at its best in `last`.
    pub fn optima(&self, last: &TurnRange, mut keep: impl FnMut(Angle)) {
        let step = Angle::by(TAU / VALUES as f64);
        let mut first = Angle::NONE;
        let mut slope = self.slope(first, last);
        for _ in 0..VALUES {
            let next = first.and(step);
            let after = self.slope(next, last);
            if slope > 0.0 && after <= 0.0 {
                keep(self.between(first, [slope, after], last));
            }
            (first, slope) = (next, after);
        }
    }

    /// The optimum after `first`, where the slope is the first of `slopes`, and before the next value, where it is the second: by
    /// secants, an end that stays counting half (Illinois).
    fn between(&self, first: Angle, [mut rising, mut falling]: [f64; 2], last: &TurnRange) -> Angle {
        let (mut low, mut high) = (0.0, TAU / VALUES as f64);
        let mut found = first;
        let mut was_low = None;
        for _ in 0..ROUNDS {
            let at = (low * falling - high * rising) / (falling - rising);
            found = first.and(Angle::by(at));
            let slope = self.slope(found, last);
            if slope.abs() <= FLAT {
                break;
            }
            let is_low = slope > 0.0;
            let stays = was_low == Some(is_low);
            if is_low {
                (low, rising) = (at, slope);
                falling *= if stays { 0.5 } else { 1.0 };
            } else {
                (high, falling) = (at, slope);
                rising *= if stays { 0.5 } else { 1.0 };
            }
            was_low = Some(is_low);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector3::{across, unit};
    use crate::rng;

    #[test]
    fn the_optima_contain_the_best_of_many_values() {
        let mut rng = rng::stream(9, 0);
        for draw in 0..200 {
            let mut vector = || unit(&std::array::from_fn(|_| rng.uniform_in(-1.0, 1.0)));
            let (axis, basis, turn) = (vector(), across(&vector()), vector());
            let angle = rng.uniform_in(-3.0, 3.0);
            let pair = TurnPair::of(&axis, &basis, &basis.map(|v| Angle::by(angle).about(&turn, &v)));
            let last = TurnRange::of([[-4.0, 4.0], [-0.7, 1.1], [0.3, 0.3]][draw % 3]);
            let value = |first: Angle| pair.at(first).value(pair.at(first).best(&last));
            let mut least = f64::INFINITY;
            pair.optima(&last, |first| least = least.min(value(first)));
            let scanned =
                (0..2000).map(|k| value(Angle::by(TAU * f64::from(k) / 2000.0))).fold(f64::INFINITY, f64::min);
            assert!(least <= scanned + 1e-12, "{least} {scanned}");
            assert!(least >= scanned - 1e-4, "{least} {scanned}");
        }
    }
}
