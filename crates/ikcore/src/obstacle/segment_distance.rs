//! Distance of a segment to a convex set, from below: along a segment the signed distance is a convex function of one
//! variable, which lies above all its tangents and below all its chords.

use nalgebra::Vector3;

use super::shape::Obstacle;
use super::tangent::nearest_on_segment;

/// A segment between two points (m).
pub(super) type Segment = [Vector3<f64>; 2];

/// How far below the true distance an answer may lie (m).
const ACCURACY: f64 = 1e-9;
/// Far more steps than the search for the minimum takes, but for degenerate numbers.
const MOST_STEPS: usize = 60;

/// One tangent of the signed distance along the segment: value and slope at `share` of its length.
#[derive(Clone, Copy)]
struct Touch {
    share: f64,
    value: f64,
    slope: f64,
}

/// Signed distance of the segment to the obstacle: negative by the depth of its deepest point. Never more than the
/// truth, and at most [`ACCURACY`] less unless it is at least `enough`.
pub(super) fn distance_to_obstacle(segment: &Segment, obstacle: &Obstacle, enough: f64) -> f64 {
    let [a, b] = segment;
    let center = Vector3::from(obstacle.bounding_center);
    let from_sphere = (nearest_on_segment(a, b, &center) - center).norm() - obstacle.bounding_radius;
    if from_sphere >= enough {
        return from_sphere;
    }
    let along = b - a;
    let touch = |share: f64| {
        let tangent = obstacle.tangent(&(a + share * along));
        Touch { share, value: tangent.value, slope: tangent.normal.dot(&along) }
    };
    let (mut left, mut right) = (touch(0.0), touch(1.0));
    if left.slope >= 0.0 {
        return left.value;
    }
    if right.slope <= 0.0 {
        return right.value;
    }
    let mut lowest_seen = left.value.min(right.value);
    for _ in 0..MOST_STEPS {
        // Where the two tangents meet is the lowest that the distance can be.
        let meeting = (right.value - left.value + left.slope * left.share - right.slope * right.share)
            / (left.slope - right.slope);
        let bound = left.value + left.slope * (meeting - left.share);
        if bound >= enough || lowest_seen - bound <= ACCURACY {
            return bound;
        }
        let inside = meeting > left.share && meeting < right.share;
        let next = touch(if inside { meeting } else { 0.5 * (left.share + right.share) });
        lowest_seen = lowest_seen.min(next.value);
        if next.slope < 0.0 {
            left = next;
        } else if next.slope > 0.0 {
            right = next;
        } else {
            return next.value;
        }
    }
    left.value + left.slope * (right.share - left.share)
}

/// Distance between two segments, exact.
pub(super) fn distance_between(one: &Segment, other: &Segment) -> f64 {
    let ([p, p_end], [q, q_end]) = (one, other);
    let (u, v, w) = (p_end - p, q_end - q, p - q);
    let (uu, uv, vv, uw, vw) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let share_of = |numerator: f64, denominator: f64| {
        if denominator > 0.0 { (numerator / denominator).clamp(0.0, 1.0) } else { 0.0 }
    };
    // The best point of one for the best point of the other, clamped; the second pass settles the clamps.
    let mut s = share_of(uv * vw - vv * uw, uu * vv - uv * uv);
    let mut t = share_of(uv * s + vw, vv);
    s = share_of(uv * t - uw, uu);
    t = share_of(uv * s + vw, vv);
    let crossing = (w + s * u - t * v).norm();
    // Nearly parallel segments are nearest at an end, where the division above says little.
    let ends = [
        (nearest_on_segment(q, q_end, p) - p).norm(),
        (nearest_on_segment(q, q_end, p_end) - p_end).norm(),
        (nearest_on_segment(p, p_end, q) - q).norm(),
        (nearest_on_segment(p, p_end, q_end) - q_end).norm(),
    ];
    ends.into_iter().fold(crossing, f64::min)
}
