//! Minimum signed distance along a segment.
//!
//! The signed distance of a convex shape along a segment is a convex function of one variable, which lies above all its
//! tangents and below all its chords.

use nalgebra::Vector3;

use super::tangent::Tangent;

/// Line segment between two points (m).
pub(crate) type LineSegment = [Vector3<f64>; 2];

/// Accuracy of the lower bound given by tangents (m).
const ACCURACY: f64 = 1e-9;
/// Step limit, far beyond the usual number of steps, for degenerate input.
const MOST_STEPS: usize = 60;

/// Minimum of the signed distance along a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SegmentDistance {
    /// Signed distance (m).
    pub distance: f64,
    /// Fraction of the segment's length.
    pub fraction: f64,
}

/// Tangent of the signed distance along the segment: value and slope at `fraction` of its length.
#[derive(Clone, Copy)]
struct Touch {
    fraction: f64,
    value: f64,
    slope: f64,
}

/// Returns the smallest signed distance between a segment and a convex set, given by its tangents. The result is a lower bound, at most [`ACCURACY`] below
/// the true distance unless it is at least `enough`.
pub(super) fn by_tangents(
    [a, b]: &LineSegment,
    tangent: impl Fn(&Vector3<f64>) -> Tangent,
    enough: f64,
) -> SegmentDistance {
    let along = b - a;
    let touch = |fraction: f64| {
        let tangent = tangent(&(a + fraction * along));
        Touch { fraction, value: tangent.value, slope: tangent.normal.dot(&along) }
    };
    let at = |touch: Touch| SegmentDistance { distance: touch.value, fraction: touch.fraction };
    let (mut left, mut right) = (touch(0.0), touch(1.0));
    if left.slope >= 0.0 {
        return at(left);
    }
    if right.slope <= 0.0 {
        return at(right);
    }
    let mut lowest_seen = left.value.min(right.value);
    for _ in 0..MOST_STEPS {
        // Intersection of the two tangents: a lower bound of the distance between them.
        let meeting = (right.value - left.value + left.slope * left.fraction - right.slope * right.fraction)
            / (left.slope - right.slope);
        let bound = left.value + left.slope * (meeting - left.fraction);
        if bound >= enough || lowest_seen - bound <= ACCURACY {
            return SegmentDistance { distance: bound, fraction: meeting.clamp(left.fraction, right.fraction) };
        }
        let inside = meeting > left.fraction && meeting < right.fraction;
        let next = touch(if inside { meeting } else { 0.5 * (left.fraction + right.fraction) });
        lowest_seen = lowest_seen.min(next.value);
        if next.slope < 0.0 {
            left = next;
        } else if next.slope > 0.0 {
            right = next;
        } else {
            return at(next);
        }
    }
    SegmentDistance { distance: left.value + left.slope * (right.fraction - left.fraction), fraction: left.fraction }
}
