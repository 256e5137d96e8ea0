//! A joint that follows another one by a polynomial, as equality constraints of MuJoCo do.
//!
//! A chain represents it as two stages. The frame after the first one has a z axis of length p'(q) / b, with b the largest slope, so that
//! this axis times b is the velocity per unit rate of the joint, as for any other stage; links and later stages never use this frame.
//! The second stage, which no joint moves, has the axis of unit length again.

use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::polynomial;
use crate::math::so3::cross;

/// Share of a bound that exceeds the rounding of its computation.
const ROUNDING: f64 = 1e-9;

/// Position of a follower by that of its leader, q: c0 + c1 q + c2 q^2 + c3 q^3 + c4 q^4 between the ends of a range, and on along
/// the tangents beyond, so that slope and second derivative are bounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct JointCurve {
    /// Coefficients (rad or m, by powers of rad or m).
    pub coefficients: [f64; 5],
    /// Range of q within which the polynomial holds (rad, m).
    pub range: [f64; 2],
}

impl JointCurve {
    /// Returns value, slope and second derivative at `q`.
    pub fn at(&self, q: f64) -> [f64; 3] {
        let inside = q.clamp(self.range[0], self.range[1]);
        let [value, slope, bend] = polynomial::evaluate(&self.coefficients, inside);
        if inside == q { [value, slope, bend] } else { [value + slope * (q - inside), slope, 0.0] }
    }

    /// Returns the largest slope, and the largest second derivative; upper bounds of both.
    pub fn largest(&self) -> [f64; 2] {
        let [lower, upper] = self.range;
        let slope = polynomial::derivative(&self.coefficients);
        let bend = polynomial::derivative(&slope);
        // Rounding is relative to the terms, which may cancel.
        let size = |terms: &[f64]| polynomial::bound(terms, lower.abs().max(upper.abs()));
        let largest = |terms: &[f64]| polynomial::largest_magnitude(terms, lower, upper) + ROUNDING * size(terms);
        // Slopes are divided by the largest one, also that of a constant.
        [largest(&slope).max(f64::MIN_POSITIVE), largest(&bend)]
    }

    /// Returns the smallest and the largest value between `lower` and `upper`.
    pub fn values(&self, lower: f64, upper: f64) -> (f64, f64) {
        let [from, to] = self.range;
        let inside = polynomial::range(&self.coefficients, lower.clamp(from, to), upper.clamp(from, to));
        let ends = [lower, upper].map(|end| self.at(end)[0]);
        ends.iter().fold(inside, |(least, most), end| (least.min(*end), most.max(*end)))
    }

    /// Whether slope and second derivative are bounded, as they are between finite limits.
    pub fn is_bounded(&self) -> bool {
        let [lower, upper] = self.range;
        lower.is_finite() && upper.is_finite() && {
            let [slope, bend] = self.largest();
            slope.is_finite() && bend < f64::from(f32::MAX)
        }
    }
}

/// First stage of a [`JointCurve`] in a chain or tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CurvedStage {
    /// Number of the stage.
    pub stage: usize,
    pub curve: JointCurve,
    /// Whether it turns, or slides.
    pub turns: bool,
    /// The largest slope.
    pub steepest: f64,
}

impl CurvedStage {
    pub fn new(stage: usize, curve: JointCurve, turns: bool) -> Self {
        Self { stage, curve, turns, steepest: curve.largest()[0] }
    }

    /// Returns the largest distance (m) that it slides, with its joint between `lower` and `upper`.
    pub fn longest_slide(&self, lower: f64, upper: f64) -> f64 {
        let (least, most) = self.curve.values(lower, upper);
        if self.turns { 0.0 } else { (1.0 + ROUNDING) * least.abs().max(most.abs()) }
    }

    /// Returns the frame of the stage at `q`, of which `frame` is constant, relative to the stage before; its axis has unit length.
    pub fn placed(&self, frame: &Frame, q: f64) -> Frame {
        let [value, ..] = self.curve.at(q);
        if self.turns {
            let (sine, cosine) = value.sin_cos();
            return frame.turned::<NoFma>(sine, cosine);
        }
        Frame { origin: frame.transform::<NoFma>(&[0.0, 0.0, value]), ..*frame }
    }

    /// Returns `placed` with the axis as long as the slope at `q` requires.
    pub fn shown(&self, placed: &Frame, q: f64) -> Frame {
        let [_, slope, _] = self.curve.at(q);
        let [x, y, z] = placed.axes;
        Frame { axes: [x, y, z.map(|entry| entry * slope / self.steepest)], ..*placed }
    }
}

/// First stages of all curves of a chain or tree.
#[derive(Debug, Clone, Default)]
pub(crate) struct CurvedStages(Vec<CurvedStage>);

impl CurvedStages {
    /// Adds a stage that comes after the others.
    pub fn push(&mut self, curve: CurvedStage) {
        self.0.push(curve);
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn iter(&self) -> impl Iterator<Item = &CurvedStage> {
        self.0.iter()
    }

    /// Returns the curve of stage number `stage`, if it is the first one of a curve.
    #[inline]
    pub fn at(&self, stage: usize) -> Option<&CurvedStage> {
        let place = self.0.binary_search_by_key(&stage, |curve| curve.stage).ok()?;
        Some(&self.0[place])
    }
}

/// Returns the frame of the stage after one that [`CurvedStage::shown`] has written: the same with an axis of unit length.
pub(crate) fn restored(shown: &Frame) -> Frame {
    let [x, y, _] = shown.axes;
    Frame { axes: [x, y, cross(&x, &y)], ..*shown }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    #[test]
    fn no_slope_or_bend_is_larger_than_the_bounds() {
        let mut rng = rng::stream(3, 0);
        for round in 0..300 {
            let mut coefficients = std::array::from_fn(|_| rng.uniform_in(-1.0, 1.0));
            // Round numbers, double roots of the slope and no linear term.
            match round % 4 {
                0 => coefficients = coefficients.map(|c: f64| c.round()),
                1 => coefficients = [0.1, 1.0, -1.0, 1.0 / 3.0, 0.0],
                2 => coefficients[1] = 0.0,
                _ => {}
            }
            let ends = [rng.uniform_in(-3.0, 3.0), rng.uniform_in(-3.0, 3.0)];
            let curve = JointCurve { coefficients, range: [ends[0].min(ends[1]), ends[0].max(ends[1])] };
            let [steepest, sharpest] = curve.largest();
            let (least, most) = curve.values(-4.0, 4.0);
            let (mut slope_seen, mut before) = (0.0_f64, curve.at(-4.0));
            for i in 1..=4000 {
                let at = curve.at(-4.0 + 0.002 * f64::from(i));
                assert!(at[1].abs() <= steepest && at[2].abs() <= sharpest, "{curve:?}");
                assert!(least - 1e-12 <= at[0] && at[0] <= most + 1e-12, "{curve:?}");
                // Value and slope are continuous at the ends of the range.
                assert!((at[0] - before[0]).abs() <= 0.002 * steepest + 1e-9, "{curve:?}");
                assert!((at[1] - before[1]).abs() <= 0.002 * sharpest + 1e-9, "{curve:?}");
                (slope_seen, before) = (slope_seen.max(at[1].abs()), at);
            }
            // The largest slope of a constant is above zero.
            assert!(steepest <= 1.01 * slope_seen + 0.02 * sharpest + f64::MIN_POSITIVE, "{curve:?}");
        }
    }
}
