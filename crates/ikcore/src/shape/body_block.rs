//! Clearance test "nearer than m?" for four bodies in SIMD lanes: capsules of one robot, or one capsule at four
//! configurations.

use nalgebra::Vector3;

use super::checked_shape::{LARGEST, ROUNDING, Shape};
use super::geometry::Geometry;
use super::segment_lanes::{to_point, to_segment};
use super::solid_lanes::{BoxLanes, CylinderLanes, SolidLanes, segment_bound};
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vec3::Vec3;

/// Four capsules, one per lane (m).
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyBlock {
    /// Start of each capsule axis.
    pub start: [F64x4; 3],
    /// Vector from start to end of each axis.
    pub along: [F64x4; 3],
    /// Radius of each capsule.
    pub radius: F64x4,
    /// True if all four are spheres, with zero `along`.
    pub spheres: bool,
}

impl BodyBlock {
    /// Four points at the origin.
    pub const SPHERES: Self =
        Self { start: [F64x4::ZERO; 3], along: [F64x4::ZERO; 3], radius: F64x4::ZERO, spheres: true };

    /// Moves the capsules by `frame`.
    #[inline(always)]
    pub fn posed<A: Arithmetic>(&self, frame: &Frame) -> Self {
        let [x, y, z] = [0, 1, 2].map(|k| Vec3::<Four<A>>::splat(&frame.axes[k]));
        let (start, along) = (Vec3::of(&self.start), Vec3::of(&self.along));
        let start = x.mul_add(start.x, y.mul_add(start.y, z.mul_add(start.z, Vec3::splat(&frame.origin))));
        let along = if self.spheres { along } else { x.mul_add(along.x, y.mul_add(along.y, z * along.z)) };
        Self { start: start.stored(), along: along.stored(), radius: self.radius, spheres: self.spheres }
    }

    /// Broadcasts the body in lane `lane` to all lanes.
    #[inline(always)]
    pub fn repeated(&self, lane: usize) -> Self {
        let [[x, y, z], [u, v, w]] = [&self.start, &self.along];
        let start = [F64x4::splat(x.0[lane]), F64x4::splat(y.0[lane]), F64x4::splat(z.0[lane])];
        let along = [F64x4::splat(u.0[lane]), F64x4::splat(v.0[lane]), F64x4::splat(w.0[lane])];
        Self { start, along, radius: F64x4::splat(self.radius.0[lane]), spheres: self.spheres }
    }

    /// Whether two lanes hold the same capsule, which happens where a block is padded.
    fn is_same(&self, lane: usize, other: usize) -> bool {
        (0..3)
            .all(|k| self.start[k].0[lane] == self.start[k].0[other] && self.along[k].0[lane] == self.along[k].0[other])
            && self.radius.0[lane] == self.radius.0[other]
    }

    /// Returns the axis of the capsule in lane `lane`.
    fn segment(&self, lane: usize) -> [Vector3<f64>; 2] {
        let start = Vector3::from(self.start.map(|x| x.0[lane]));
        [start, start + Vector3::from(self.along.map(|x| x.0[lane]))]
    }
}

impl Shape {
    /// Returns 1 in each lane whose body stays at least `margin` >= 0 (m) away, else 0. Conservative: never 1 for a nearer
    /// body.
    #[inline(always)]
    pub(crate) fn clear_lanes<A: Arithmetic>(&self, block: &BodyBlock, margin: f64) -> F64x4 {
        let start = Vec3::<Four<A>>::of(&block.start);
        let along = Vec3::<Four<A>>::of(&block.along);
        let far = rounded::<A>(largest::<A>(start).larger(largest::<A>(start + along)));
        let rounding = Four::splat(self.rounding(0.0)).larger(far);
        let enough = Four::of(block.radius) + Four::splat(margin) + rounding;
        if self.is_huge() {
            return self.clear_one_by_one(block, &enough.stored());
        }
        let bounds = self.bounding_ball();
        if block.spheres {
            // Most bodies are clear of the bounding ball.
            let offset = start - Vec3::splat(&bounds.center);
            let clear = beyond_square(offset.dot(offset), enough + Four::splat(bounds.radius));
            if clear.0[0] + clear.0[1] + clear.0[2] + clear.0[3] == 4.0 {
                return clear;
            }
        }
        match self.geometry() {
            Geometry::Sphere { center, radius } => {
                let nearest = to_point(start, along, Vec3::splat(center));
                beyond_square(nearest.squared, enough + Four::splat(*radius))
            }
            Geometry::Capsule { a, b, radius } => {
                let axis = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
                let nearest = to_segment(start, along, Vec3::splat(a), Vec3::splat(&axis));
                beyond_square(nearest.squared, enough + Four::splat(*radius))
            }
            Geometry::HalfSpace { normal, offset } => {
                let normal = Vec3::splat(normal);
                let [first, last] = [start.dot(normal), (start + along).dot(normal)];
                at_least(first.smaller(last) - Four::splat(*offset), enough)
            }
            Geometry::Box { pose, size } => {
                solid_clear(&BoxLanes::new(pose, size), start, along, enough, block.spheres)
            }
            Geometry::Cylinder { center, axis, radius, length } => {
                let cylinder = CylinderLanes::new(center, axis, *radius, *length);
                solid_clear(&cylinder, start, along, enough, block.spheres)
            }
            _ => self.clear_one_by_one(block, &enough.stored()),
        }
    }

    /// Whether [`clear_lanes`](Self::clear_lanes) tests four bodies at once for this shape.
    pub(crate) fn has_lanes(&self) -> bool {
        use Geometry::{Box, Capsule, Cylinder, HalfSpace, Sphere};
        matches!(self.geometry(), Sphere { .. } | Capsule { .. } | HalfSpace { .. } | Box { .. } | Cylinder { .. })
    }

    /// Implements [`clear_lanes`](Self::clear_lanes) lane by lane, for shapes without a SIMD distance.
    #[inline(never)]
    fn clear_one_by_one(&self, block: &BodyBlock, enough: &F64x4) -> F64x4 {
        let mut clear = F64x4::ZERO;
        for lane in 0..4 {
            let repeats = (0..lane).find(|other| block.is_same(*other, lane));
            clear.0[lane] = match repeats {
                Some(other) => clear.0[other],
                None => {
                    let distance = self.distance_to_segment(&block.segment(lane), enough.0[lane]);
                    f64::from(u8::from(distance >= enough.0[lane]))
                }
            };
        }
        clear
    }
}

/// Returns 1 in each lane in which the bodies of both blocks stay at least `margin` >= 0 (m) apart, else 0.
#[inline(always)]
pub(crate) fn clear_of_each_other<A: Arithmetic>(one: &BodyBlock, other: &BodyBlock, margin: f64) -> F64x4 {
    let [p, q] = [Vec3::<Four<A>>::of(&one.start), Vec3::of(&other.start)];
    let [u, v] = [Vec3::<Four<A>>::of(&one.along), Vec3::of(&other.along)];
    let squared = if one.spheres && other.spheres { (p - q).dot(p - q) } else { to_segment(p, u, q, v).squared };
    let rounding = rounded::<A>(largest::<A>(p) + largest::<A>(q) + Four::splat(2.0));
    beyond_square(squared, Four::of(one.radius) + Four::of(other.radius) + Four::splat(margin) + rounding)
}

#[inline(always)]
fn solid_clear<A: Arithmetic, S: SolidLanes<Four<A>>>(
    solid: &S,
    start: Vec3<Four<A>>,
    along: Vec3<Four<A>>,
    enough: Four<A>,
    spheres: bool,
) -> F64x4 {
    let start = solid.to_local(start);
    if spheres {
        return beyond_square(solid.squared_distance(start), enough);
    }
    at_least(segment_bound(solid, start, solid.turned(along), enough), enough)
}

/// Returns 1 where the square root of `squared` is at least `enough`, else 0.
#[inline(always)]
fn beyond_square<A: Arithmetic>(squared: Four<A>, enough: Four<A>) -> F64x4 {
    at_least(squared, enough * enough)
}

#[inline(always)]
fn at_least<A: Arithmetic>(value: Four<A>, enough: Four<A>) -> F64x4 {
    let clear = value.choose_below(enough, Four::splat(0.0), Four::splat(1.0));
    // Non-finite values count as too near.
    value.choose_below(Four::splat(f64::INFINITY), clear, Four::splat(0.0)).stored()
}

/// Returns the rounding error of distances for coordinates up to `largest`; infinite if their products would overflow.
#[inline(always)]
fn rounded<A: Arithmetic>(largest: Four<A>) -> Four<A> {
    let infinite = Four::splat(f64::INFINITY);
    largest.choose_below(Four::splat(LARGEST), largest * Four::splat(ROUNDING), infinite)
}

/// Returns the largest absolute coordinate.
#[inline(always)]
fn largest<A: Arithmetic>(v: Vec3<Four<A>>) -> Four<A> {
    v.x.larger(-v.x).larger(v.y.larger(-v.y)).larger(v.z.larger(-v.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::arithmetic::by_instructions;
    use crate::rng::{self, LazyRng};

    by_instructions! {
        fn clear(shape: &Shape, block: &BodyBlock, margin: f64) -> F64x4 {
            shape.clear_lanes::<A>(block, margin)
        }
    }

    fn shapes(rng: &mut LazyRng) -> Vec<Shape> {
        let mut point = |reach: f64| -> [f64; 3] { std::array::from_fn(|_| rng.uniform_in(-reach, reach)) };
        let turn = Some(*nalgebra::Rotation3::new(Vector3::from(point(2.0))).matrix());
        let cloud: Vec<[f64; 3]> = (0..50).map(|_| point(0.5)).collect();
        let size = point(0.3).map(|x| 0.02 + x.abs());
        let shapes = [
            Shape::sphere(point(0.5), size[0]),
            Shape::capsule(point(0.5), point(0.5), size[0]),
            Shape::cuboid(point(0.5), size, turn),
            Shape::cylinder(point(0.5), point(1.0), size[0], size[1]),
            Shape::half_space(point(1.0), point(1.0)[0]),
            Shape::ellipsoid(point(0.5), size, turn),
            Shape::point_cloud(cloud, 0.01),
        ];
        shapes.into_iter().map(Result::unwrap).collect()
    }

    #[test]
    fn four_bodies_at_once_are_near_when_each_is() {
        let mut rng = rng::stream(1, 0);
        let (mut near, mut far) = (0, 0);
        for case in 0..2000 {
            let spheres = case % 2 == 0;
            let mut lanes = |reach: f64| F64x4(std::array::from_fn(|_| rng.uniform_in(-reach, reach)));
            let block = BodyBlock {
                start: [lanes(1.0), lanes(1.0), lanes(1.0)],
                along: if spheres { [F64x4::ZERO; 3] } else { [lanes(0.4), lanes(0.4), lanes(0.4)] },
                radius: F64x4(lanes(0.1).0.map(f64::abs)),
                spheres,
            };
            let margin = lanes(0.1).0[0].abs();
            for shape in shapes(&mut rng) {
                let clear = clear(&shape, &block, margin).0;
                for lane in 0..4 {
                    let radius = block.radius.0[lane];
                    let gap = shape.distance_to_segment(&block.segment(lane), f64::INFINITY) - radius - margin;
                    // Either answer is right within rounding of the threshold.
                    assert!(gap.abs() < 3e-9 || (gap > 0.0) == (clear[lane] == 1.0), "{}: {gap}", shape.name());
                    *(if gap > 0.0 { &mut far } else { &mut near }) += 1;
                }
            }
        }
        assert!(near > 5000 && far > 5000, "{near} {far}");
    }
}
