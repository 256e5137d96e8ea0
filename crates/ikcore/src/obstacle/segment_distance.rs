//! Lower bound on the distance of a segment from a convex set: along a segment the signed distance is a convex function
//! of one variable, which lies above all its tangents and below all its chords.

use nalgebra::Vector3;

use super::shape::Obstacle;
use super::tangent::nearest_on_segment;

/// A segment between two points (m).
pub(super) type LineSegment = [Vector3<f64>; 2];

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
pub(super) fn distance_to_obstacle(segment: &LineSegment, obstacle: &Obstacle, enough: f64) -> f64 {
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
pub(super) fn distance_between(one: &LineSegment, other: &LineSegment) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{self, LazyRng};

    fn segment(rng: &mut LazyRng) -> LineSegment {
        [(); 2].map(|()| Vector3::from_fn(|_, _| rng.uniform_in(-1.0, 1.0)))
    }

    /// The smallest distance between points at `steps` + 1 points of each segment.
    fn sampled([a, b]: &LineSegment, [c, d]: &LineSegment, steps: usize) -> f64 {
        let places = || (0..=steps).map(|i| i as f64 / steps as f64);
        let distance = |(s, t): (f64, f64)| (a + s * (b - a) - c - t * (d - c)).norm();
        places().flat_map(|s| places().map(move |t| (s, t))).map(distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn segments_are_as_far_apart_as_their_nearest_samples() {
        let mut rng = rng::stream(1, 0);
        for case in 0..300 {
            let (one, mut other) = (segment(&mut rng), segment(&mut rng));
            match case % 3 {
                0 => other[1] = other[0] + 0.7 * (one[1] - one[0]), // parallel
                1 => other[1] = other[0],                           // a point
                _ => {}
            }
            let (found, nearest) = (distance_between(&one, &other), sampled(&one, &other, 60));
            assert!(found <= nearest + 1e-12 && nearest - found < 0.05, "case {case}: {found}, sampled {nearest}");
            assert!((distance_between(&other, &one) - found).abs() < 1e-12, "case {case}");
        }
    }

    #[test]
    fn crossing_and_parallel_segments_have_known_distances() {
        let line = |a: [f64; 3], b: [f64; 3]| [Vector3::from(a), Vector3::from(b)];
        let along_x = line([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let cases = [
            (line([0.0, -1.0, 0.3], [0.0, 1.0, 0.3]), 0.3), // they pass over each other
            (line([0.5, 0.2, 0.0], [3.0, 0.2, 0.0]), 0.2),  // parallel, they overlap
            (line([4.0, 4.0, 0.0], [9.0, 4.0, 0.0]), 5.0),  // parallel, end to end
            (line([-1.0, 0.0, 0.0], [0.0, 2.0, 0.0]), 0.0), // a common end
        ];
        for (other, expected) in cases {
            assert!((distance_between(&along_x, &other) - expected).abs() < 1e-12, "{expected}");
        }
    }

    #[test]
    fn a_segment_is_as_far_from_an_obstacle_as_its_nearest_point() {
        let mut rng = rng::stream(2, 0);
        let turn = Some(*nalgebra::Rotation3::new(Vector3::new(0.4, -0.7, 0.2)).matrix());
        let egg = Obstacle::ellipsoid([0.1, -0.2, 0.3], [0.2, 0.5, 0.7], turn).unwrap();
        for _ in 0..100 {
            let [a, b] = segment(&mut rng);
            let found = distance_to_obstacle(&[a, b], &egg, f64::INFINITY);
            let at = |i: usize| egg.tangent(&(a + i as f64 / 2000.0 * (b - a))).value;
            let nearest = (0..=2000).map(at).fold(f64::INFINITY, f64::min);
            assert!(found <= nearest + 1e-9 && nearest - found < 2e-3, "{found}, sampled {nearest}");
            // A caller to whom 0.1 m is enough may get less than the distance, but never less than 0.1 m for more.
            let enough = distance_to_obstacle(&[a, b], &egg, 0.1);
            assert!(enough <= found + 1e-9 && (enough >= 0.1) == (found >= 0.1), "{enough} for {found}");
        }
    }
}
