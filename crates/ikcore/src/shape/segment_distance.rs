//! Distance of a segment from a shape.

use nalgebra::Vector3;

use super::along_segment::{LineSegment, SegmentDistance, by_tangents};
use super::checked_shape::{LARGEST, ROUNDING, Shape};
use super::geometry::Geometry;
use super::segment_lanes::{TOUCHING, to_box};
use super::tangent::{nearest_fraction, nearest_on_segment, point_between};
use crate::math::arithmetic::NoFma;
use crate::math::real::{One, Real};
use crate::math::vec3::Vec3;

impl Shape {
    /// Returns the signed distance (m) of the segment: negative by the depth of its deepest point, and always a lower bound.
    /// Where it is below `enough` it is exact to 1e-9 m, inside a closed mesh to 0.1 mm or 1 %; beyond [`LARGEST`] it is only
    /// a bound.
    pub(crate) fn distance_to_segment(&self, segment: &LineSegment, enough: f64) -> f64 {
        let [a, b] = segment;
        let bounds = self.bounding_ball();
        let center = Vector3::from(bounds.center);
        let reach = a.amax().max(b.amax());
        let rounding = self.rounding(reach);
        if self.is_huge() || !(reach <= LARGEST) {
            // Single coordinates do not overflow.
            let beyond = (0..3).map(|k| (a[k].min(b[k]) - center[k]).max(center[k] - a[k].max(b[k])));
            let distance = beyond.fold(f64::NEG_INFINITY, f64::max) - bounds.radius - rounding;
            return if distance > 0.0 && distance.is_finite() { distance } else { f64::NEG_INFINITY };
        }
        // Margin, so that a distance is still at least `enough` after rounding is subtracted.
        let enough = enough + 1.01 * rounding + 4.0 * f64::EPSILON * enough.abs();
        let from_ball = (nearest_on_segment(a, b, &center) - center).norm() - bounds.radius;
        if from_ball >= enough {
            return from_ball - rounding;
        }
        // NaN becomes the smallest distance.
        (self.geometry().approach(segment, enough).distance - rounding).max(f64::NEG_INFINITY)
    }
}

impl Geometry {
    /// Returns the minimum along a segment, exact only below `enough`.
    pub(super) fn approach(&self, segment: &LineSegment, enough: f64) -> SegmentDistance {
        let [a, b] = segment;
        match self {
            Self::Sphere { center, radius } => {
                let fraction = nearest_fraction(a, b, &Vector3::from(*center));
                SegmentDistance {
                    distance: (point_between(a, b, fraction) - Vector3::from(*center)).norm() - radius,
                    fraction,
                }
            }
            Self::Capsule { a: start, b: end, radius } => {
                let nearest = between(segment, &[(*start).into(), (*end).into()]);
                SegmentDistance { distance: nearest.distance - radius, ..nearest }
            }
            Self::HalfSpace { normal, offset } => {
                let [first, last] = [a, b].map(|end| Vector3::from(*normal).dot(end) - offset);
                if first <= last {
                    SegmentDistance { distance: first, fraction: 0.0 }
                } else {
                    SegmentDistance { distance: last, fraction: 1.0 }
                }
            }
            Self::Box { pose, size } => {
                let local = [a, b].map(|end| pose.inverse_transform_point(&(*end).into()).coords);
                let vector = |v: Vector3<f64>| Vec3::<One<NoFma>>::splat(&v.into());
                let nearest = to_box(vector(local[0]), vector(local[1] - local[0]), vector(0.5 * Vector3::from(*size)));
                match nearest.squared.stored() {
                    squared if squared <= TOUCHING => by_tangents(segment, |point| self.tangent(point), enough),
                    squared => SegmentDistance { distance: squared.sqrt(), fraction: nearest.fraction.stored() },
                }
            }
            Self::Mesh(mesh) => mesh.approach(segment, enough),
            Self::PointCloud(cloud) => cloud.approach(segment, enough),
            Self::Grid(grid) => grid.approach(segment, enough),
            Self::Cylinder { .. } | Self::Ellipsoid { .. } | Self::Ellipse { .. } | Self::ConvexMesh(_) => {
                by_tangents(segment, |point| self.tangent(point), enough)
            }
        }
    }
}

/// Returns the distance between two segments, less an allowance for rounding.
pub(crate) fn distance_between(one: &LineSegment, other: &LineSegment) -> f64 {
    let reach = [one, other].into_iter().flatten().fold(1.0, |reach, end| f64::max(reach, end.amax()));
    if !(reach <= LARGEST) {
        return f64::NEG_INFINITY;
    }
    (between(one, other).distance - ROUNDING * reach).max(f64::NEG_INFINITY)
}

/// Finds the point of `one` that is nearest to `other`.
pub(super) fn between(one: &LineSegment, other: &LineSegment) -> SegmentDistance {
    let ([p, p_end], [q, q_end]) = (one, other);
    let (u, v, w) = (p_end - p, q_end - q, p - q);
    let (uu, uv, vv, uw, vw) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let fraction_of = |numerator: f64, denominator: f64| {
        if denominator > 0.0 { (numerator / denominator).clamp(0.0, 1.0) } else { 0.0 }
    };
    // Alternating projection: the best point of one for the best point of the other, clamped; the second pass settles the
    // clamps.
    let mut s = fraction_of(uv * vw - vv * uw, uu * vv - uv * uv);
    let mut t = fraction_of(uv * s + vw, vv);
    s = fraction_of(uv * t - uw, uu);
    t = fraction_of(uv * s + vw, vv);
    let crossing = SegmentDistance { distance: (w + s * u - t * v).norm(), fraction: s };
    // Nearly parallel segments are nearest at an end, where the division above is inaccurate.
    let to_one = |end: &Vector3<f64>| {
        let fraction = nearest_fraction(p, p_end, end);
        SegmentDistance { distance: (p + fraction * u - end).norm(), fraction }
    };
    let of_one = |end: &Vector3<f64>, fraction: f64| SegmentDistance {
        distance: (nearest_on_segment(q, q_end, end) - end).norm(),
        fraction,
    };
    let ends = [of_one(p, 0.0), of_one(p_end, 1.0), to_one(q), to_one(q_end)];
    ends.into_iter().fold(crossing, |best, next| if next.distance < best.distance { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{self, LazyRng};

    fn segment(rng: &mut LazyRng) -> LineSegment {
        [(); 2].map(|()| Vector3::from_fn(|_, _| rng.uniform_in(-1.0, 1.0)))
    }

    /// Returns the smallest distance between sampled points, `steps` + 1 on each segment.
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
            assert!(found <= nearest && nearest - found < 0.05, "case {case}: {found}, sampled {nearest}");
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
            let found = distance_between(&along_x, &other);
            assert!(found <= expected && expected - found < 1e-11, "{found} for {expected}");
        }
    }

    #[test]
    fn a_segment_is_as_far_from_an_obstacle_as_its_nearest_point() {
        let mut rng = rng::stream(2, 0);
        let turn = Some(*nalgebra::Rotation3::new(Vector3::new(0.4, -0.7, 0.2)).matrix());
        let egg = Shape::ellipsoid([0.1, -0.2, 0.3], [0.2, 0.5, 0.7], turn).unwrap();
        for _ in 0..100 {
            let [a, b] = segment(&mut rng);
            let found = egg.distance_to_segment(&[a, b], f64::INFINITY);
            let at = |i: usize| egg.geometry().tangent(&point_between(&a, &b, i as f64 / 2000.0)).value;
            let nearest = (0..=2000).map(at).fold(f64::INFINITY, f64::min);
            assert!(found <= nearest + 1e-9 && nearest - found < 2e-3, "{found}, sampled {nearest}");
            // Search with `enough` = 0.1 m: larger distances may be underestimated, but stay at least 0.1 m.
            let enough = egg.distance_to_segment(&[a, b], 0.1);
            assert!(enough <= found + 1e-9 && (enough >= 0.1) == (found >= 0.1), "{enough} for {found}");
        }
    }
}
