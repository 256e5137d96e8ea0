//! Polynomials of low degree, stored as coefficients in ascending powers: p(x) = c\[0\] + c\[1\] x + c\[2\] x^2 + ...

use smallvec::SmallVec;

/// Coefficients or roots of a polynomial up to degree 6, on the stack.
pub type Short = SmallVec<[f64; 7]>;

/// Returns the value at `x`.
pub fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |value, c| value * x + c)
}

/// Returns value, first and second derivative at `x`, in one Horner pass.
pub fn evaluate(coefficients: &[f64], x: f64) -> [f64; 3] {
    let (mut value, mut slope, mut half_bend) = (0.0, 0.0, 0.0);
    for &c in coefficients.iter().rev() {
        half_bend = half_bend * x + slope;
        slope = slope * x + value;
        value = value * x + c;
    }
    [value, slope, 2.0 * half_bend]
}

/// Returns the coefficients of the derivative; none for a constant.
pub fn derivative(coefficients: &[f64]) -> Short {
    coefficients.iter().enumerate().skip(1).map(|(power, c)| power as f64 * c).collect()
}

/// Returns all distinct real roots in `[lower, upper]`, ascending; the two ends for the zero polynomial.
///
/// A polynomial is monotone between the roots of its derivative, so each such interval contains at most one root, bracketed
/// by its ends. Two roots count as one if rounding hides the sign between them.
pub fn roots(coefficients: &[f64], lower: f64, upper: f64) -> Short {
    let mut found = Short::new();
    let mut left = (lower, value_or_zero(coefficients, lower));
    for x in stationary_points(coefficients, lower, upper).into_iter().chain([upper]) {
        let right = (x, value_or_zero(coefficients, x));
        if left.1 == 0.0 {
            found.push(left.0);
        } else if right.1 != 0.0 && (left.1 < 0.0) != (right.1 < 0.0) {
            found.push(bracketed_root(coefficients, left.0, right.0));
        }
        left = right;
    }
    if left.1 == 0.0 {
        found.push(left.0);
    }
    found
}

/// Returns the real roots of a + b x + c x^2 strictly inside `(lower, upper)`, ascending, in closed form.
pub fn quadratic_roots(a: f64, b: f64, c: f64, lower: f64, upper: f64) -> SmallVec<[f64; 2]> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return SmallVec::new();
    }
    // Both roots from the half-sum without cancellation; for c = 0 only -a/b remains, since the other is infinite.
    let half_sum = -0.5 * (b + discriminant.sqrt().copysign(b));
    let [first, second] = [half_sum / c, a / half_sum];
    let ordered = if second < first { [second, first] } else { [first, second] };
    ordered.into_iter().filter(|x| lower < *x && *x < upper).collect()
}

/// Returns the largest magnitude on `[lower, upper]`: at an end, or where the derivative vanishes.
pub fn largest_magnitude(coefficients: &[f64], lower: f64, upper: f64) -> f64 {
    let candidates = stationary_points(coefficients, lower, upper).into_iter().chain([lower, upper]);
    candidates.map(|x| evaluate(coefficients, x)[0].abs()).fold(0.0, f64::max)
}

/// Returns an upper bound of the magnitude on `[0, upper]`, without a search for the largest one.
pub fn bound(coefficients: &[f64], upper: f64) -> f64 {
    const ROUNDING: f64 = 1.0 + 64.0 * f64::EPSILON;
    ROUNDING * coefficients.iter().rev().fold(0.0, |sum, c| sum * upper + c.abs())
}

/// Returns the smallest and the largest value on `[lower, upper]`.
pub fn range(coefficients: &[f64], lower: f64, upper: f64) -> (f64, f64) {
    let candidates = stationary_points(coefficients, lower, upper).into_iter().chain([lower, upper]);
    candidates
        .map(|x| evaluate(coefficients, x)[0])
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Returns the points where the derivative vanishes, strictly inside `(lower, upper)`.
fn stationary_points(coefficients: &[f64], lower: f64, upper: f64) -> Short {
    if coefficients.len() < 2 {
        return Short::new();
    }
    let slope = derivative(coefficients);
    if lower == 0.0 && has_one_sign(&slope, upper) {
        return Short::new();
    }
    let mut points = roots(&slope, lower, upper);
    points.retain(|x| lower < *x && *x < upper);
    points
}

/// Returns whether the Bernstein coefficients on `[0, upper]` have one sign, beyond rounding: then so does the polynomial. Most pieces of
/// a motion rise or fall throughout, which needs no search for roots.
fn has_one_sign(coefficients: &[f64], upper: f64) -> bool {
    const ROUNDING: f64 = 64.0 * f64::EPSILON;
    let degree = coefficients.len().saturating_sub(1);
    let mut control = Short::from_slice(coefficients);
    let (mut power, mut choices, mut terms) = (1.0, 1.0, 0.0);
    for (k, c) in control.iter_mut().enumerate() {
        *c *= power;
        terms += c.abs();
        *c /= choices;
        power *= upper;
        choices *= (degree - k) as f64 / (k + 1) as f64;
    }
    for first in 1..=degree {
        for i in (first..=degree).rev() {
            control[i] += control[i - 1];
        }
    }
    let least = ROUNDING * terms;
    control.iter().all(|c| *c > least) || control.iter().all(|c| *c < -least)
}

/// Returns the value at `x`, or zero if the value is within the rounding error of its terms.
fn value_or_zero(coefficients: &[f64], x: f64) -> f64 {
    let value = evaluate(coefficients, x)[0];
    let terms = coefficients.iter().rev().fold(0.0, |sum, c| sum * x.abs() + c.abs());
    if value.abs() <= 4.0 * f64::EPSILON * terms { 0.0 } else { value }
}

/// Finds the root between two points with different signs, to the last bits.
///
/// Newton's method, replaced by bisection where a step leaves the bracket or is longer than half the previous step.
fn bracketed_root(coefficients: &[f64], mut lower: f64, mut upper: f64) -> f64 {
    let rising = evaluate(coefficients, lower)[0] < 0.0;
    let mut last_step = upper - lower;
    let mut x = lower + 0.5 * last_step;
    loop {
        let [value, slope, _] = evaluate(coefficients, x);
        if value == 0.0 {
            return x;
        }
        if (value < 0.0) == rising {
            lower = x;
        } else {
            upper = x;
        }
        let newton = x - value / slope;
        let converges = lower < newton && newton < upper && (newton - x).abs() < 0.5 * last_step;
        let next = if converges { newton } else { lower + 0.5 * (upper - lower) };
        last_step = (next - x).abs();
        if last_step <= f64::EPSILON * x.abs() || next == lower || next == upper {
            return next;
        }
        x = next;
    }
}
