//! Boxes and cylinders in SIMD lanes: nearest points, and lower bounds for segments.

use super::segment_lanes::excess;
use crate::math::real::Real;
use crate::math::vec3::Vec3;
use crate::math::{Frame, Pose};

/// Convex body with a frame of its own.
pub(super) trait SolidLanes<R: Real> {
    /// Transforms a point to the body's frame.
    fn to_local(&self, point: Vec3<R>) -> Vec3<R>;

    /// Rotates a vector to the body's frame.
    fn turned(&self, vector: Vec3<R>) -> Vec3<R>;

    /// Returns the vector from the body's nearest point to a point, both in its frame; zero inside.
    fn beyond(&self, point: Vec3<R>) -> Vec3<R>;

    /// Returns the squared distance (m^2) of a point in the body's frame; zero inside.
    #[inline(always)]
    fn squared_distance(&self, point: Vec3<R>) -> R {
        let beyond = self.beyond(point);
        beyond.dot(beyond)
    }
}

/// Axes and origin, the same in all lanes.
struct FrameLanes<R> {
    axes: [Vec3<R>; 3],
    origin: Vec3<R>,
}

impl<R: Real> FrameLanes<R> {
    #[inline(always)]
    fn of(frame: &Frame<R::Stored>) -> Self {
        let [x, y, z] = &frame.axes;
        Self { axes: [Vec3::of(x), Vec3::of(y), Vec3::of(z)], origin: Vec3::of(&frame.origin) }
    }

    #[inline(always)]
    fn new(pose: &Pose) -> Self {
        let (m, t) = (pose.rotation.matrix(), &pose.translation.vector);
        let axis = [[m.m11, m.m21, m.m31], [m.m12, m.m22, m.m32], [m.m13, m.m23, m.m33]];
        let axes = [Vec3::splat(&axis[0]), Vec3::splat(&axis[1]), Vec3::splat(&axis[2])];
        Self { axes, origin: Vec3::splat(&[t.x, t.y, t.z]) }
    }

    #[inline(always)]
    fn turned(&self, v: Vec3<R>) -> Vec3<R> {
        let [x, y, z] = self.axes;
        Vec3 { x: x.dot(v), y: y.dot(v), z: z.dot(v) }
    }
}

/// Box.
pub(super) struct BoxLanes<R> {
    frame: FrameLanes<R>,
    half: Vec3<R>,
}

impl<R: Real> BoxLanes<R> {
    #[inline(always)]
    pub fn new(pose: &Pose, size: &[f64; 3]) -> Self {
        let half = [0.5 * size[0], 0.5 * size[1], 0.5 * size[2]];
        Self { frame: FrameLanes::new(pose), half: Vec3::splat(&half) }
    }

    /// Creates a box at `frame` with these half edges.
    #[inline(always)]
    pub fn of(frame: &Frame<R::Stored>, half: &[R::Stored; 3]) -> Self {
        Self { frame: FrameLanes::of(frame), half: Vec3::of(half) }
    }
}

impl<R: Real> SolidLanes<R> for BoxLanes<R> {
    #[inline(always)]
    fn to_local(&self, point: Vec3<R>) -> Vec3<R> {
        self.frame.turned(point - self.frame.origin)
    }

    #[inline(always)]
    fn turned(&self, vector: Vec3<R>) -> Vec3<R> {
        self.frame.turned(vector)
    }

    #[inline(always)]
    fn beyond(&self, point: Vec3<R>) -> Vec3<R> {
        let h = self.half;
        Vec3 { x: excess(point.x, h.x), y: excess(point.y, h.y), z: excess(point.z, h.z) }
    }

    #[inline(always)]
    fn squared_distance(&self, p: Vec3<R>) -> R {
        let (h, zero) = (self.half, R::splat(0.0));
        let x = (p.x.larger(-p.x) - h.x).larger(zero);
        let y = (p.y.larger(-p.y) - h.y).larger(zero);
        let z = (p.z.larger(-p.z) - h.z).larger(zero);
        x * x + y * y + z * z
    }
}

/// Cylinder; the origin of its frame is the centre.
pub(super) struct CylinderLanes<R> {
    center: Vec3<R>,
    axis: Vec3<R>,
    radius: R,
    half_length: R,
}

impl<R: Real> CylinderLanes<R> {
    #[inline(always)]
    pub fn new(center: &[f64; 3], axis: &[f64; 3], radius: f64, length: f64) -> Self {
        let [center, axis] = [Vec3::splat(center), Vec3::splat(axis)];
        Self { center, axis, radius: R::splat(radius), half_length: R::splat(0.5 * length) }
    }

    /// Creates a cylinder about `center` along `axis`, with this radius and half this length.
    #[inline(always)]
    pub fn of(center: &[R::Stored; 3], axis: &[R::Stored; 3], [radius, half_length]: [R::Stored; 2]) -> Self {
        let [center, axis] = [Vec3::of(center), Vec3::of(axis)];
        Self { center, axis, radius: R::of(radius), half_length: R::of(half_length) }
    }
}

impl<R: Real> SolidLanes<R> for CylinderLanes<R> {
    #[inline(always)]
    fn to_local(&self, point: Vec3<R>) -> Vec3<R> {
        point - self.center
    }

    #[inline(always)]
    fn turned(&self, vector: Vec3<R>) -> Vec3<R> {
        vector
    }

    #[inline(always)]
    fn beyond(&self, point: Vec3<R>) -> Vec3<R> {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let along = self.axis.dot(point);
        let outward = self.axis.mul_add(-along, point);
        let from_axis = outward.dot(outward).sqrt();
        let safe = zero.choose_below(from_axis, from_axis, one);
        let fraction = (from_axis - self.radius).larger(zero) / safe;
        self.axis.mul_add(excess(along, self.half_length), outward * fraction)
    }
}

/// Number of steps that decides every segment, except very close to the threshold.
const STEPS: usize = 24;

/// Returns a lower bound on the distance of the segment from `start` along `along`, in the frame of `solid`, accurate enough
/// for a comparison with `enough`. The distance is convex along the segment, so the intersection of two tangents is a lower
/// bound between their points of contact.
#[inline(always)]
pub(super) fn segment_bound<R: Real, S: SolidLanes<R>>(solid: &S, start: Vec3<R>, along: Vec3<R>, enough: R) -> R {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let mut left = Touch::at(solid, start, along, zero);
    let mut right = Touch::at(solid, start, along, one);
    let mut seen = left.value.smaller(right.value);
    let mut bound = zero;
    for _ in 0..STEPS {
        let steepness = left.slope - right.slope;
        let safe = steepness.choose_below(zero, steepness, -one);
        let rest = right.value - left.value + left.slope * left.fraction - right.slope * right.fraction;
        let meeting = (rest / safe).larger(left.fraction).smaller(right.fraction);
        bound = left.value + left.slope * (meeting - left.fraction);
        // An end at which the distance rises inward is the nearest point.
        bound = left.slope.choose_below(zero, bound, left.value);
        bound = zero.choose_below(right.slope, bound, right.value.choose_below(left.value, right.value, bound));
        let open = bound.choose_below(enough, seen.choose_below(enough, zero, one), zero);
        let mut undecided = false;
        for lane in 0..R::LANES {
            undecided |= open.lane(lane) > 0.0;
        }
        if !undecided {
            break;
        }
        let next = Touch::at(solid, start, along, meeting);
        seen = seen.smaller(next.value);
        right = next.where_below(next.slope, zero, right, next);
        left = next.where_below(next.slope, zero, next, left);
    }
    bound
}

/// Distance and its slope at `fraction` of a segment.
#[derive(Clone, Copy)]
struct Touch<R> {
    fraction: R,
    value: R,
    slope: R,
}

impl<R: Real> Touch<R> {
    #[inline(always)]
    fn at<S: SolidLanes<R>>(solid: &S, start: Vec3<R>, along: Vec3<R>, fraction: R) -> Self {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let beyond = solid.beyond(along.mul_add(fraction, start));
        let value = beyond.dot(beyond).sqrt();
        let slope = beyond.dot(along) / zero.choose_below(value, value, one);
        Self { fraction, value, slope }
    }

    /// Selects `then` in lanes with value < limit, else `otherwise`.
    #[inline(always)]
    fn where_below(self, value: R, limit: R, then: Self, otherwise: Self) -> Self {
        Self {
            fraction: value.choose_below(limit, then.fraction, otherwise.fraction),
            value: value.choose_below(limit, then.value, otherwise.value),
            slope: value.choose_below(limit, then.slope, otherwise.slope),
        }
    }
}
