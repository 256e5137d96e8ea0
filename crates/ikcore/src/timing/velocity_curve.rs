//! The maximum velocity curve: the path speed that the velocity limits allow.

use super::constant_limits::ConstantLimits;
use super::derivatives::PathDerivatives;
use super::grid::{Segment, UNLIMITED};
use super::joint_path::JointPath;
use super::tip_segments::TipSegments;
use crate::math::polynomial::quadratic_roots;

/// Largest factor by which the bound may grow between neighbouring grid points. If all joints reverse at once, dq/ds is
/// zero and the bound infinite, and a line from a finite to an infinite bound bounds nothing.
const LARGEST_GROWTH: f64 = 4.0;

/// Returns bounds on the squared path speed x = (ds/dt)^2 at the ends of all segments, such that a motion within them,
/// with x linear in s between them, keeps the velocity limits at every point: |dq/ds| sqrt(x) <= v,
/// and those of tips.
pub(super) fn maximum_velocity_curve(
    path: &JointPath,
    limits: &ConstantLimits,
    segments: &[Segment],
    tips: Option<&TipSegments<'_>>,
    derivatives: &mut PathDerivatives,
) -> Vec<f64> {
    let mut curve = at_grid_points(path, limits, segments, derivatives);
    if let Some(tips) = tips {
        for i in 0..segments.len() {
            let [left, right] = tips.at_ends(i);
            (curve[i], curve[i + 1]) = (curve[i].min(left), curve[i + 1].min(right));
        }
    }
    tame_poles(&mut curve);
    let mut factor_before = f64::INFINITY;
    let mut left = curve[0];
    for (i, segment) in segments.iter().enumerate() {
        derivatives.fill(path, segment);
        let right = curve[i + 1];
        let mut factor = chord_factor(derivatives, limits, left, right);
        if let Some(tips) = tips {
            factor = factor.min(1.0 / tips.excess(i, segment.length, [left, right]).max(1.0));
        }
        curve[i] = left * factor.min(factor_before);
        (left, factor_before) = (right, factor);
    }
    curve[segments.len()] = left * factor_before;
    curve
}

/// Returns bounds on x at the ends of all segments such that a motion within them, with x linear in between, is on average as fast as the
/// joints' velocity limits allow.
pub(super) fn average_velocity_curve(
    path: &JointPath,
    limits: &ConstantLimits,
    segments: &[Segment],
    derivatives: &mut PathDerivatives,
) -> Vec<f64> {
    let mut curve = at_grid_points(path, limits, segments, derivatives);
    tame_poles(&mut curve);
    let (mut factor_before, mut left) = (None, curve[0]);
    for (i, segment) in segments.iter().enumerate() {
        derivatives.fill(path, segment);
        let right = curve[i + 1];
        let [start, middle, end] = derivatives.first.each_ref();
        let slopes =
            || start.iter().zip(middle).zip(end).map(|((start, middle), end)| 0.25 * (start + 2.0 * middle + end));
        let bound = bound(path, limits, segment.piece, slopes());
        // The mean by Simpson's rule over that of the chord.
        let (sum, middle) = (left + right, bound.min(growth(left).min(growth(right))));
        let factor = if sum == 0.0 { 1.0 } else { (sum + 4.0 * middle) / (3.0 * sum) };
        curve[i] = left * 0.5 * (factor + factor_before.unwrap_or(factor));
        (left, factor_before) = (right, Some(factor));
    }
    curve[segments.len()] = left * factor_before.unwrap_or(1.0);
    curve
}

/// Returns the minimum over the joints of (v / q')^2, and of the squared path speeds asked for; zero at corners.
fn at_grid_points(
    path: &JointPath,
    limits: &ConstantLimits,
    segments: &[Segment],
    derivatives: &mut PathDerivatives,
) -> Vec<f64> {
    let mut curve = vec![UNLIMITED; segments.len() + 1];
    for (i, segment) in segments.iter().enumerate() {
        derivatives.fill(path, segment);
        curve[i] = bound(path, limits, segment.piece, derivatives.first[0].iter().copied()).min(curve[i]);
        curve[i + 1] = bound(path, limits, segment.piece, derivatives.first[2].iter().copied());
        if segment.from == 0.0 && segment.is_after_corner {
            curve[i] = 0.0;
        }
    }
    curve
}

/// Returns the bound on x where the joints have these slopes.
fn bound(path: &JointPath, limits: &ConstantLimits, piece: usize, slopes: impl Iterator<Item = f64>) -> f64 {
    let ratios =
        slopes.zip(&limits.velocity).map(|(slope, limit)| if slope == 0.0 { UNLIMITED } else { limit / slope });
    let asked = path.largest_speed(piece);
    ratios.chain([asked]).map(|speed| speed * speed).fold(UNLIMITED, f64::min)
}

fn tame_poles(curve: &mut [f64]) {
    for i in 1..curve.len() {
        curve[i] = curve[i].min(growth(curve[i - 1]));
    }
    for i in (1..curve.len()).rev() {
        curve[i - 1] = curve[i - 1].min(growth(curve[i]));
    }
}

/// Largest bound of a neighbour of this bound; the zero of a corner does not limit its neighbours.
fn growth(bound: f64) -> f64 {
    if bound == 0.0 { UNLIMITED } else { LARGEST_GROWTH * bound }
}

/// Returns the factor by which the chord x(s) from `left` to `right` must be lowered to keep the velocity limits
/// between grid points.
fn chord_factor(derivatives: &PathDerivatives, limits: &ConstantLimits, left: f64, right: f64) -> f64 {
    let m = (0.5 * (left + right)).sqrt();
    if m == 0.0 || m >= UNLIMITED.sqrt() {
        return 1.0;
    }
    let [g0, g1] = [left, right].map(|x| 0.5 * (x / m + m));
    let [d0, d1, d2] = &derivatives.first;
    let mut excess = 1.0_f64;
    for (j, limit) in limits.velocity.iter().enumerate() {
        // sqrt(x) lies below its tangent at any m^2, sqrt(x) <= (x / m + m) / 2, which is linear in s like x; so the
        // speed of a joint lies below a cubic, and the cubic below its Bernstein coefficients. Few joints come near
        // their limit, so the exact maximum is rarely needed.
        let inner = [(2.0 * d1[j] * g0 + d0[j] * g1) / 3.0, (d2[j] * g0 + 2.0 * d1[j] * g1) / 3.0];
        let bound = inner[0].abs().max(inner[1].abs()).max((d0[j] * g0).abs()).max((d2[j] * g1).abs());
        if bound * bound > excess * limit * limit {
            excess = excess.max(fastest([d0[j], d1[j], d2[j]], [left, right]) / (limit * limit));
        }
    }
    1.0 / excess
}

/// Returns the largest q'(s)^2 x(s) between the ends of a segment, for q' with these Bernstein coefficients and x
/// linear.
///
/// The derivative vanishes if q' = 0 or 2 q'' x + q' x' = 0, a quadratic.
fn fastest([d0, d1, d2]: [f64; 3], [left, right]: [f64; 2]) -> f64 {
    let (slope, curvature) = (2.0 * (d1 - d0), d0 - 2.0 * d1 + d2);
    let rise = right - left;
    let level = quadratic_roots(
        2.0 * slope * left + d0 * rise,
        2.0 * (slope * rise + 2.0 * curvature * left) + slope * rise,
        4.0 * curvature * rise + curvature * rise,
        0.0,
        1.0,
    );
    let squared = |s: f64| (d0 + s * (slope + s * curvature)).powi(2) * (left + s * rise);
    level.into_iter().map(squared).fold(squared(0.0).max(squared(1.0)), f64::max)
}
