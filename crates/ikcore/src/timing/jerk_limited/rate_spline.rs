//! Quadratic splines with continuous slope on any knots.

/// y(u) as a quadratic spline; three of its coefficients count on each interval.
#[derive(Debug, Clone)]
pub(super) struct RateSpline {
    knots: Vec<f64>,
    /// One more than knots: with coefficients that are all equal, y is that number.
    pub coefficients: Vec<f64>,
}

/// Weights of the three coefficients of an interval, in y, its first and its second derivative at a point.
pub(super) type Weights = [[f64; 3]; 3];

/// Points and weights of Gauss and Legendre on \[0, 1\], exact for polynomials of degree 9.
const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_094_54],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_23],
    [0.5, 0.284_444_444_444_444_44],
    [0.769_234_655_052_841_6, 0.239_314_335_249_683_23],
    [0.953_089_922_969_332, 0.118_463_442_528_094_54],
];

impl RateSpline {
    /// The spline that is 1 everywhere, on at least two increasing `knots`.
    pub(super) fn new(knots: Vec<f64>) -> Self {
        let coefficients = vec![1.0; knots.len() + 1];
        Self { knots, coefficients }
    }

    /// The same spline on finer knots: each interval cut in this number of equal parts.
    pub(super) fn refined(&self, parts: &[usize]) -> Self {
        let places = parts.iter().enumerate().flat_map(|(interval, parts)| {
            (0..*parts).map(move |part| (interval, [part, part + 1].map(|part| part as f64 / *parts as f64)))
        });
        let places: Vec<(usize, [f64; 2])> = places.collect();
        // The coefficient of a knot interval [p, q] is the blossom of y there, y((p + q) / 2) - y'' (q - p)^2 / 8.
        let coefficient = |interval: usize, [from, to]: [f64; 2]| {
            let [middle, .., curvature] = self.at(interval, 0.5 * (from + to));
            middle - 0.125 * curvature * ((to - from) * self.length(interval)).powi(2)
        };
        let [(first, [_, end]), (last, [begin, _])] = [places[0], places[places.len() - 1]];
        let before = coefficient(first, [-end, 0.0]);
        let after = coefficient(last, [1.0, 2.0 - begin]);
        let inner = places.iter().map(|(interval, ends)| coefficient(*interval, *ends));
        let coefficients = std::iter::once(before).chain(inner).chain([after]).collect();
        let mut knots: Vec<f64> = places.iter().map(|(interval, ends)| self.reading(*interval, ends[0])).collect();
        knots.extend(self.knots.last());
        Self { knots, coefficients }
    }

    /// Number of intervals between knots.
    pub(super) fn intervals(&self) -> usize {
        self.knots.len() - 1
    }

    /// The place in an interval, as a fraction of it.
    pub(super) fn reading(&self, interval: usize, fraction: f64) -> f64 {
        self.knots[interval] + fraction * self.length(interval)
    }

    /// Length of an interval.
    pub(super) fn length(&self, interval: usize) -> f64 {
        self.knots[interval + 1] - self.knots[interval]
    }

    /// Weights of the coefficients `interval`, `interval` + 1 and `interval` + 2 at a place in the interval.
    pub(super) fn weights(&self, interval: usize, fraction: f64) -> Weights {
        let h = self.length(interval);
        // Beyond the ends the first and the last interval repeat.
        let before = if interval == 0 { h } else { self.length(interval - 1) };
        let after = if interval + 1 == self.intervals() { h } else { self.length(interval + 1) };
        let [left, right] = [h * fraction, h * (1.0 - fraction)];
        let [first, last] = [1.0 / ((before + h) * h), 1.0 / ((h + after) * h)];
        let outer = [
            [right * right * first, -2.0 * right * first, 2.0 * first],
            [left * left * last, 2.0 * left * last, 2.0 * last],
        ];
        let sums = [1.0, 0.0, 0.0];
        std::array::from_fn(|order| {
            let [a, c] = [outer[0][order], outer[1][order]];
            [a, sums[order] - a - c, c]
        })
    }

    /// y and its first two derivatives at a place in an interval.
    pub(super) fn at(&self, interval: usize, fraction: f64) -> [f64; 3] {
        let of = &self.coefficients[interval..interval + 3];
        self.weights(interval, fraction).map(|weights| weights[0] * of[0] + weights[1] * of[1] + weights[2] * of[2])
    }

    /// The time that each interval takes, where y is the squared rate: the integral of 1 / sqrt(y).
    pub(super) fn durations(&self) -> Vec<f64> {
        let share = |interval: usize, [at, weight]: [f64; 2]| weight / self.at(interval, at)[0].sqrt();
        let of_interval = |interval| GAUSS.into_iter().map(|point| share(interval, point)).sum::<f64>();
        (0..self.intervals()).map(|interval| self.length(interval) * of_interval(interval)).collect()
    }

    /// Whether y is positive where the durations need it: rounding may spoil a refined rate between the places where limits are imposed.
    pub(super) fn is_finite(&self) -> bool {
        self.durations().iter().all(|duration| duration.is_finite())
    }
}
