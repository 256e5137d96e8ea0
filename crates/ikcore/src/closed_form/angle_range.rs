//! Joint limits tested on cosine and sine, before any arctangent is taken.

use std::f64::consts::PI;

use super::angle::Angle;

/// Largest change of an angle by polishing (rad); candidates at double roots are kept within it, see
/// [`super::subproblem::CLAMP`].
pub(crate) const MOVED_BY_POLISHING: f64 = 0.03;

/// Range of angles modulo 2 pi, slightly wider than the joint limits.
#[derive(Debug, Clone, Copy)]
pub struct AngleRange {
    middle: Angle,
    /// Half the width (rad), at most pi.
    half: f64,
    /// Smallest cosine of the angle to the middle.
    least: f64,
}

impl AngleRange {
    /// Full circle.
    pub const ANY: Self = Self { middle: Angle::NONE, half: PI, least: -2.0 };

    /// Returns the range of these limits (rad).
    pub fn of([lower, upper]: [f64; 2]) -> Self {
        let half = 0.5 * (upper - lower);
        if half < PI {
            Self { middle: Angle::by(lower + half), half, least: half.cos() - MOVED_BY_POLISHING }
        } else {
            Self::ANY
        }
    }

    /// Returns the angles q and r with q + `sense` r = `sum` that lie deepest inside this range and `other`, relative to
    /// their widths; if these lie outside, every such pair does.
    pub fn deepest_pair(&self, other: &Self, sum: Angle, sense: f64) -> [Angle; 2] {
        let excess = sum.and(self.middle.back()).and(other.middle.signed(sense).back()).angle();
        let halves = self.half + other.half;
        let fraction = if halves > 0.0 { self.half / halves } else { 0.5 };
        let [of_this, of_other] = [fraction * excess, sense * (1.0 - fraction) * excess].map(Angle::by);
        [self.middle.and(of_this), other.middle.and(of_other)]
    }

    /// Returns false only if no branch within the limits lies near `angle`.
    #[inline(always)]
    pub fn may_hold(&self, angle: &Angle) -> bool {
        self.middle.cos * angle.cos + self.middle.sin * angle.sin >= self.least
    }
}

/// Whether each angle may lie within its limits.
#[inline(always)]
pub fn may_hold(ranges: &[AngleRange], angles: &[Angle]) -> bool {
    ranges.iter().zip(angles).all(|(range, angle)| range.may_hold(angle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_what_lies_between_the_limits_and_little_else() {
        for limits in [[-2.9, 2.9], [-3.07, -0.07], [-0.02, 3.75], [2.0, 2.0], [5.0, 7.0]] {
            let range = AngleRange::of(limits);
            for k in -700..700 {
                let q = 0.01 * f64::from(k);
                let near = |by: f64| {
                    [-2.0, -1.0, 0.0, 1.0, 2.0].iter().any(|turn| {
                        let q = q + turn * 2.0 * PI;
                        limits[0] - by <= q && q <= limits[1] + by
                    })
                };
                let held = range.may_hold(&Angle::by(q));
                assert!(held || !near(0.0), "{limits:?} {q}");
                assert!(!held || near(0.3), "{limits:?} {q}");
            }
        }
        assert!(AngleRange::of([-4.0, 4.0]).may_hold(&Angle::by(3.0)));
        assert!(AngleRange::of([f64::NEG_INFINITY, f64::INFINITY]).may_hold(&Angle::by(3.0)));
    }
}
