//! Cubic Hermite interpolation between values and slopes at both ends.

/// Cubic polynomial in a parameter that runs from 0 at one end to 1 at the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// Coefficients in ascending powers of the parameter.
    pub coefficients: [f64; 4],
}

impl Cubic {
    /// Returns the cubic between two values, with these slopes at the ends.
    #[inline]
    pub fn new([from, to]: [f64; 2], [left, right]: [f64; 2]) -> Self {
        let chord = to - from;
        Self { coefficients: [from, left, 3.0 * chord - 2.0 * left - right, left + right - 2.0 * chord] }
    }

    /// Returns the value at `fraction`.
    #[inline]
    pub fn at(&self, fraction: f64) -> f64 {
        let [a, b, c, d] = self.coefficients;
        a + fraction * (b + fraction * (c + fraction * d))
    }

    /// Returns the derivative at `fraction`.
    #[inline]
    pub fn slope(&self, fraction: f64) -> f64 {
        let [_, b, c, d] = self.coefficients;
        b + fraction * (2.0 * c + 3.0 * fraction * d)
    }

    /// Bounds the values between the ends by the smallest and the largest Bézier coefficient.
    #[inline]
    pub fn hull(&self) -> [f64; 2] {
        let [a, b, c, _] = self.coefficients;
        let points = [a, a + b / 3.0, a + (2.0 * b + c) / 3.0, self.at(1.0)];
        points
            .into_iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point), high.max(point)])
    }

    /// Returns the parameter of the smallest value.
    pub fn lowest(&self) -> f64 {
        let [_, b, c, d] = self.coefficients;
        let end = if self.at(1.0) < self.at(0.0) { 1.0 } else { 0.0 };
        // Root of b + 2 c s + 3 d s^2 with positive second derivative, in a form without cancellation if the cubic decreases
        // at first; NaN if there is none.
        let inside = -b / (c + (c * c - 3.0 * b * d).sqrt());
        if 0.0 < inside && inside < 1.0 && self.at(inside) < self.at(end) { inside } else { end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn both_ends_and_their_slopes_are_met(
            ends in prop::array::uniform2(-3.0..3.0), slopes in prop::array::uniform2(-9.0..9.0)
        ) {
            let cubic = Cubic::new(ends, slopes);
            for (fraction, end, slope) in [(0.0, ends[0], slopes[0]), (1.0, ends[1], slopes[1])] {
                prop_assert!((cubic.at(fraction) - end).abs() < 1e-14 && (cubic.slope(fraction) - slope).abs() < 1e-13);
            }
            let difference = (cubic.at(0.4 + 1e-5) - cubic.at(0.4 - 1e-5)) / 2e-5;
            prop_assert!((cubic.slope(0.4) - difference).abs() < 1e-8);
        }

        #[test]
        fn no_value_lies_outside_the_hull_or_below_the_lowest(
            ends in prop::array::uniform2(-3.0..3.0), slopes in prop::array::uniform2(-9.0..9.0)
        ) {
            let cubic = Cubic::new(ends, slopes);
            let ([low, high], least) = (cubic.hull(), cubic.at(cubic.lowest()));
            for value in (0..=100).map(|i| cubic.at(f64::from(i) / 100.0)) {
                prop_assert!(low - 1e-14 <= value && value <= high + 1e-14 && least <= value + 1e-14);
            }
        }
    }

    #[test]
    fn of_a_constant_and_of_a_line_the_lowest_is_an_end() {
        assert_eq!(Cubic::new([2.0, 2.0], [0.0, 0.0]).lowest(), 0.0);
        assert_eq!(Cubic::new([2.0, 1.0], [-1.0, -1.0]).lowest(), 1.0);
        assert_eq!(Cubic::new([1.0, 2.0], [1.0, 1.0]).lowest(), 0.0);
    }
}
