//! Natural cubic splines over knots that stay the same while the values change.

/// The knots' part of the equations, solved beforehand: a spline through new values costs a pass there and one back.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalSpline {
    knots: Vec<f64>,
    /// What elimination leaves above the diagonal, and the inverse of what it leaves on it, knot by knot.
    above: Vec<f64>,
    inverse: Vec<f64>,
}

/// A cubic piece: value + slope s + bend/2 s^2 + rate/6 s^3 in the time s since its knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Length in the parameter.
    pub span: f64,
    /// Value at its knot.
    pub value: f64,
    /// First derivative there.
    pub slope: f64,
    /// Second derivative there.
    pub bend: f64,
    /// Third derivative.
    pub rate: f64,
}

impl NaturalSpline {
    /// Splines over `knots`, at least two, which increase.
    pub fn over(knots: Vec<f64>) -> Self {
        let (mut above, mut inverse) = (vec![0.0; knots.len()], vec![0.0; knots.len()]);
        for i in 1..knots.len() - 1 {
            let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            inverse[i] = 1.0 / (2.0 * (before + after) - before * above[i - 1]);
            above[i] = after * inverse[i];
        }
        Self { knots, above, inverse }
    }

    /// The knots.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Writes the second derivatives at the knots of the spline through `values`; `bends` is as long.
    ///
    /// Slopes agree on both sides of each inner knot: h_(i-1) q''_(i-1) + 2 (h_(i-1) + h_i) q''_i + h_i q''_(i+1) =
    /// 6 (secant_i - secant_(i-1)); at the ends q'' = 0.
    pub fn bends(&self, values: &[f64], bends: &mut [f64]) {
        let last = self.knots.len() - 1;
        (bends[0], bends[last]) = (0.0, 0.0);
        for i in 1..last {
            let (before, after) = (self.knots[i] - self.knots[i - 1], self.knots[i + 1] - self.knots[i]);
            let kink = (values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before;
            bends[i] = (6.0 * kink - before * bends[i - 1]) * self.inverse[i];
        }
        for i in (1..last).rev() {
            bends[i] -= self.above[i] * bends[i + 1];
        }
    }

    /// The piece that begins at knot `i`, of the spline with these values and second derivatives.
    pub fn piece(&self, i: usize, values: &[f64], bends: &[f64]) -> Piece {
        let span = self.knots[i + 1] - self.knots[i];
        Piece {
            span,
            value: values[i],
            slope: (values[i + 1] - values[i]) / span - span * (2.0 * bends[i] + bends[i + 1]) / 6.0,
            bend: bends[i],
            rate: (bends[i + 1] - bends[i]) / span,
        }
    }

    /// Its value at `u`, inside the knots.
    pub fn at(&self, u: f64, values: &[f64], bends: &[f64]) -> f64 {
        let i = self.knots.partition_point(|knot| *knot <= u).clamp(1, self.knots.len() - 1) - 1;
        self.piece(i, values, bends).at(u - self.knots[i])
    }
}

impl Piece {
    /// Its value `s` after its knot.
    pub fn at(&self, s: f64) -> f64 {
        self.value + s * (self.slope + s * (self.bend / 2.0 + s * self.rate / 6.0))
    }

    /// The largest slope, in magnitude: at an end or where the bend vanishes.
    pub fn steepest(&self) -> f64 {
        let slope_at = |s: f64| (self.slope + s * (self.bend + 0.5 * s * self.rate)).abs();
        let level = -self.bend / self.rate;
        let inside = if 0.0 < level && level < self.span { slope_at(level) } else { 0.0 };
        inside.max(slope_at(0.0)).max(slope_at(self.span))
    }

    /// Where it turns round, at most twice; ascending.
    pub fn turning_points(&self) -> smallvec::SmallVec<[f64; 2]> {
        super::polynomial::quadratic_roots(self.slope, self.bend, 0.5 * self.rate, 0.0, self.span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meets_its_values_with_one_slope_and_no_bend_at_the_ends() {
        let spline = NaturalSpline::over(vec![0.0, 0.3, 0.5, 1.1, 1.2]);
        let values = [0.4, -0.2, 1.5, 0.7, 0.9];
        let mut bends = [f64::NAN; 5];
        spline.bends(&values, &mut bends);
        assert_eq!([bends[0], bends[4]], [0.0, 0.0]);
        for i in 0..4 {
            let piece = spline.piece(i, &values, &bends);
            assert!((piece.at(piece.span) - values[i + 1]).abs() < 1e-15);
            if i < 3 {
                let next = spline.piece(i + 1, &values, &bends);
                let slope = piece.slope + piece.span * (piece.bend + 0.5 * piece.span * piece.rate);
                assert!((slope - next.slope).abs() < 1e-13, "{i}: {slope} and {}", next.slope);
            }
        }
    }

    #[test]
    fn extremes_are_those_of_samples() {
        let piece = Piece { span: 2.0, value: 0.3, slope: 1.0, bend: -2.5, rate: 2.0 };
        let samples = (0..=20_000).map(|i| 2.0 * f64::from(i) / 20_000.0);
        let slope = |s: f64| 1.0 - 2.5 * s + s * s;
        let steepest = samples.map(|s| slope(s).abs()).fold(0.0, f64::max);
        assert!((piece.steepest() - steepest).abs() < 1e-7);
        let turning = piece.turning_points();
        assert_eq!(turning.len(), 1);
        assert!(slope(turning[0]).abs() < 1e-15);
    }
}
