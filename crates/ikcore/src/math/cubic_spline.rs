//! Cubic splines over fixed knots with changing values.

/// Conditions at the two ends of a spline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SplineEnds {
    /// Zero second derivative.
    #[default]
    Natural,
    /// Third derivative continuous at the second and the second-last knot, so that the first two pieces are one cubic, and
    /// the last two.
    NotAKnot,
    /// Zero slope.
    Clamped,
}

/// Linear rule for the second derivative at an end, from the slope of the chord and the second derivatives at the two nearest
/// knots: q''_end = chord_fraction chord + near q''_1 + far q''_2.
#[derive(Debug, Clone, Copy, PartialEq)]
struct EndRule {
    chord_fraction: f64,
    near: f64,
    far: f64,
}

impl SplineEnds {
    /// Returns the rule of an end whose piece has length `h` and whose next piece has length `next`, with `pieces` in total.
    /// `sign` is 1 at the start and -1 at the end.
    fn rule(self, h: f64, next: f64, pieces: usize, sign: f64) -> EndRule {
        let rule = |chord_fraction, near, far| EndRule { chord_fraction, near, far };
        match self {
            Self::Clamped if pieces == 1 => rule(sign * 6.0 / h, 0.0, 0.0),
            Self::Clamped => rule(sign * 3.0 / h, -0.5, 0.0),
            // Three points: both end conditions together make the curve one parabola.
            Self::NotAKnot if pieces == 2 => rule(0.0, 1.0, 0.0),
            Self::NotAKnot if pieces > 2 => rule(0.0, 1.0 + h / next, -h / next),
            Self::NotAKnot | Self::Natural => rule(0.0, 0.0, 0.0),
        }
    }
}

/// Factored tridiagonal system of a spline: new values take one forward and one backward pass.
///
/// Slopes agree on both sides of each inner knot: h_(i-1) q''_(i-1) + 2 (h_(i-1) + h_i) q''_i + h_i q''_(i+1) = 6 (chord_i -
/// chord_(i-1)), with q'' at the ends by their rules.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicSpline {
    knots: Vec<f64>,
    rules: [EndRule; 2],
    /// Entries below and above the diagonal, and the inverse of the diagonal entry, by knot, after elimination.
    below: Vec<f64>,
    above: Vec<f64>,
    inverse: Vec<f64>,
}

/// Cubic piece: value + slope s + curvature/2 s^2 + third/6 s^3 in the time s since its knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Length in the parameter.
    pub span: f64,
    /// Value at the knot.
    pub value: f64,
    /// First derivative at the knot.
    pub slope: f64,
    /// Second derivative at the knot.
    pub curvature: f64,
    /// Third derivative.
    pub third: f64,
}

impl CubicSpline {
    /// Prepares splines over `knots`, at least two, which increase.
    pub fn over(knots: Vec<f64>, ends: SplineEnds) -> Self {
        let last = knots.len() - 1;
        let h = |i: usize| knots[i + 1] - knots[i];
        let [second, last_but_one] = [1.min(last - 1), last.saturating_sub(2)].map(h);
        let rules = [ends.rule(h(0), second, last, 1.0), ends.rule(h(last - 1), last_but_one, last, -1.0)];
        let [mut below, mut above, mut inverse] = [(); 3].map(|()| vec![0.0; knots.len()]);
        for i in 1..last {
            let (before, after) = (h(i - 1), h(i));
            let mut diagonal = 2.0 * (before + after);
            (below[i], above[i]) = (before, after);
            if i == 1 {
                diagonal += before * rules[0].near;
                above[i] += before * rules[0].far;
                below[i] = 0.0;
            }
            if i == last - 1 {
                diagonal += after * rules[1].near;
                below[i] += after * rules[1].far;
            }
            inverse[i] = 1.0 / (diagonal - below[i] * above[i - 1]);
            above[i] *= inverse[i];
        }
        Self { knots, rules, below, above, inverse }
    }

    /// Prepares splines with zero second derivative at their ends.
    pub fn natural(knots: Vec<f64>) -> Self {
        Self::over(knots, SplineEnds::Natural)
    }

    /// Returns the knots.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Writes the second derivatives of the spline through `values` at the knots into `curvatures`, which has the same
    /// length.
    pub fn curvatures(&self, values: &[f64], curvatures: &mut [f64]) {
        let last = self.knots.len() - 1;
        let h = |i: usize| self.knots[i + 1] - self.knots[i];
        let chord = |i: usize| (values[i + 1] - values[i]) / h(i);
        let [first_rule, last_rule] = &self.rules;
        curvatures[0] = 0.0;
        for i in 1..last {
            let (before, after) = (chord(i - 1), chord(i));
            let mut right = 6.0 * (after - before);
            if i == 1 {
                right -= h(0) * first_rule.chord_fraction * before;
            }
            if i == last - 1 {
                right -= h(i) * last_rule.chord_fraction * after;
            }
            curvatures[i] = (right - self.below[i] * curvatures[i - 1]) * self.inverse[i];
        }
        for i in (1..last - 1).rev() {
            curvatures[i] -= self.above[i] * curvatures[i + 1];
        }
        // Missing neighbours have a zero factor in the rule.
        let inner = |i: usize| if 0 < i && i < last { curvatures[i] } else { 0.0 };
        let ends = [
            first_rule.curvature(chord(0), inner(1), inner(2)),
            last_rule.curvature(chord(last - 1), inner(last - 1), inner(last.wrapping_sub(2))),
        ];
        [curvatures[0], curvatures[last]] = ends;
    }

    /// Returns the piece after knot `i` of the spline with these values and second derivatives.
    pub fn piece(&self, i: usize, values: &[f64], curvatures: &[f64]) -> Piece {
        let span = self.knots[i + 1] - self.knots[i];
        Piece {
            span,
            value: values[i],
            slope: (values[i + 1] - values[i]) / span - span * (2.0 * curvatures[i] + curvatures[i + 1]) / 6.0,
            curvature: curvatures[i],
            third: (curvatures[i + 1] - curvatures[i]) / span,
        }
    }

    /// Returns the value at `u`, inside the knots.
    pub fn at(&self, u: f64, values: &[f64], curvatures: &[f64]) -> f64 {
        let i = self.knots.partition_point(|knot| *knot <= u).clamp(1, self.knots.len() - 1) - 1;
        self.piece(i, values, curvatures).at(u - self.knots[i])
    }
}

impl EndRule {
    fn curvature(&self, chord: f64, near: f64, far: f64) -> f64 {
        self.chord_fraction * chord + self.near * near + self.far * far
    }
}

impl Piece {
    /// Returns the coefficients of 1, s, s^2 and s^3.
    pub fn coefficients(&self) -> [f64; 4] {
        [self.value, self.slope, 0.5 * self.curvature, self.third / 6.0]
    }

    /// Returns the value at `s` after the knot.
    pub fn at(&self, s: f64) -> f64 {
        self.value + s * (self.slope + s * (self.curvature / 2.0 + s * self.third / 6.0))
    }

    /// Returns the largest slope magnitude: at an end or where the second derivative vanishes.
    pub fn steepest(&self) -> f64 {
        let slope_at = |s: f64| (self.slope + s * (self.curvature + 0.5 * s * self.third)).abs();
        let level = -self.curvature / self.third;
        let inside = if 0.0 < level && level < self.span { slope_at(level) } else { 0.0 };
        inside.max(slope_at(0.0)).max(slope_at(self.span))
    }

    /// Returns the parameters of zero slope, at most two, ascending.
    pub fn turning_points(&self) -> smallvec::SmallVec<[f64; 2]> {
        super::polynomial::quadratic_roots(self.slope, self.curvature, 0.5 * self.third, 0.0, self.span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meets_its_values_with_one_slope_and_no_bend_at_the_ends() {
        let spline = CubicSpline::natural(vec![0.0, 0.3, 0.5, 1.1, 1.2]);
        let values = [0.4, -0.2, 1.5, 0.7, 0.9];
        let mut curvatures = [f64::NAN; 5];
        spline.curvatures(&values, &mut curvatures);
        assert_eq!([curvatures[0], curvatures[4]], [0.0, 0.0]);
        for i in 0..4 {
            let piece = spline.piece(i, &values, &curvatures);
            assert!((piece.at(piece.span) - values[i + 1]).abs() < 1e-15);
            if i < 3 {
                let next = spline.piece(i + 1, &values, &curvatures);
                let slope = piece.slope + piece.span * (piece.curvature + 0.5 * piece.span * piece.third);
                assert!((slope - next.slope).abs() < 1e-13, "{i}: {slope} and {}", next.slope);
            }
        }
    }

    #[test]
    fn not_a_knot_splines_reproduce_cubic_polynomials() {
        let cubic = |u: f64| 0.3 + u * (-2.0 + u * (1.5 - 4.0 * u));
        let parabola = |u: f64| 0.3 + u * (-2.0 + 1.5 * u);
        let line = |u: f64| 0.3 - 2.0 * u;
        let all = [0.0, 0.3, 0.5, 1.1, 1.2];
        for (count, polynomial) in [(5, cubic as fn(f64) -> f64), (4, cubic), (3, parabola), (2, line)] {
            let knots = &all[..count];
            let values: Vec<f64> = knots.iter().map(|u| polynomial(*u)).collect();
            let mut curvatures = vec![f64::NAN; count];
            let spline = CubicSpline::over(knots.to_vec(), SplineEnds::NotAKnot);
            spline.curvatures(&values, &mut curvatures);
            for u in [0.05, 0.2, 0.29] {
                assert!((spline.at(u, &values, &curvatures) - polynomial(u)).abs() < 1e-14, "{count} knots, u = {u}");
            }
        }
    }

    #[test]
    fn clamped_ends_are_level() {
        let (all, values) = ([0.0, 0.3, 0.5, 1.1, 1.2], [0.4, -0.2, 1.5, 0.7, 0.9]);
        for count in 2..=5 {
            let (knots, values) = (&all[..count], &values[..count]);
            let mut curvatures = vec![f64::NAN; count];
            let spline = CubicSpline::over(knots.to_vec(), SplineEnds::Clamped);
            spline.curvatures(values, &mut curvatures);
            let last = spline.piece(count - 2, values, &curvatures);
            let at_end = last.slope + last.span * (last.curvature + 0.5 * last.span * last.third);
            assert!(spline.piece(0, values, &curvatures).slope.abs() < 1e-13, "{count} knots");
            assert!(at_end.abs() < 1e-12, "{count} knots: {at_end}");
        }
    }

    #[test]
    fn extremes_are_those_of_samples() {
        let piece = Piece { span: 2.0, value: 0.3, slope: 1.0, curvature: -2.5, third: 2.0 };
        let samples = (0..=20_000).map(|i| 2.0 * f64::from(i) / 20_000.0);
        let slope = |s: f64| 1.0 - 2.5 * s + s * s;
        let steepest = samples.map(|s| slope(s).abs()).fold(0.0, f64::max);
        assert!((piece.steepest() - steepest).abs() < 1e-7);
        let turning = piece.turning_points();
        assert_eq!(turning.len(), 1);
        assert!(slope(turning[0]).abs() < 1e-15);
    }
}
