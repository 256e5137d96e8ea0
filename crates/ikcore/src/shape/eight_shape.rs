//! Clearance test "nearer than m?" for one body at eight configurations in single precision, for searches whose results are
//! confirmed in double precision.

use nalgebra::Vector3;

use super::checked_shape::Shape;
use super::geometry::Geometry;
use super::segment_lanes::{to_point, to_segment};
use super::solid_lanes::{BoxLanes, CylinderLanes, SolidLanes, segment_bound};
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f32x8::F32x8;
use crate::math::real::{Eight, Real};
use crate::math::vec3::Vec3;

/// Largest coordinate (m) in single precision: products of four larger ones would overflow, so larger shapes are tested in
/// double precision.
pub(crate) const LARGEST_IN_SINGLE: f64 = 1e8;

/// Three-vector in eight lanes, equal or one per lane.
pub(crate) type Vectors = [F32x8; 3];

/// Shape broadcast to all lanes.
#[derive(Debug, Clone)]
pub(crate) struct EightShape {
    /// Bounding ball; infinite for a half-space.
    center: Vectors,
    radius: F32x8,
    form: Form,
}

#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "the innermost loop reads it")]
enum Form {
    Sphere,
    Capsule {
        start: Vectors,
        along: Vectors,
        radius: F32x8,
    },
    HalfSpace {
        normal: Vectors,
        offset: F32x8,
    },
    Box {
        frame: Frame<F32x8>,
        half: Vectors,
    },
    Cylinder {
        axis: Vectors,
        radius: F32x8,
        half_length: F32x8,
    },
    /// Shape tested lane by lane in double precision.
    Other(Shape),
}

/// Capsule at eight configurations, one per lane; a sphere if `along` is `None`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EightCapsules<A> {
    /// Start of each axis (m).
    pub start: Vec3<Eight<A>>,
    /// Vector from start to end of each axis.
    pub along: Option<Vec3<Eight<A>>>,
    /// Radius (m).
    pub radius: Eight<A>,
}

impl<A: Arithmetic> EightCapsules<A> {
    /// Returns the squared distance (m^2) between the axes.
    #[inline(always)]
    pub fn squared_distance(&self, other: &Self) -> Eight<A> {
        if self.along.is_none() && other.along.is_none() {
            return (self.start - other.start).dot(self.start - other.start);
        }
        let zero = Vec3 { x: Eight::splat(0.0), y: Eight::splat(0.0), z: Eight::splat(0.0) };
        let [one, other] = [self, other].map(|body| [body.start.stored(), body.along.unwrap_or(zero).stored()]);
        Eight::of(squared_distance(&one, &other))
    }
}

by_instructions! {
    /// Returns the squared distance (m^2) between segments, each given by its start and the vector to its end.
    fn squared_distance(one: &[Vectors; 2], other: &[Vectors; 2]) -> F32x8 {
        let ([a, u], [b, v]) = (one, other);
        to_segment::<Eight<A>>(Vec3::of(a), Vec3::of(u), Vec3::of(b), Vec3::of(v)).squared.stored()
    }
}

/// Broadcasts a vector to all lanes.
pub(crate) fn splat(vector: &[f64; 3]) -> Vectors {
    vector.map(|x| F32x8::splat(x as f32))
}

impl EightShape {
    /// Broadcasts a shape to all lanes.
    pub fn new(shape: &Shape) -> Self {
        let number = |x: f64| F32x8::splat(x as f32);
        let ball = shape.bounding_ball();
        let farthest = ball.center.iter().fold(ball.radius, |most, x| most.max(x.abs()));
        if farthest > LARGEST_IN_SINGLE && !matches!(shape.geometry(), Geometry::HalfSpace { .. }) {
            return Self { center: splat(&[0.0; 3]), radius: number(f64::INFINITY), form: Form::Other(shape.clone()) };
        }
        let form = match shape.geometry() {
            Geometry::Sphere { .. } => Form::Sphere,
            Geometry::Capsule { a, b, radius } => {
                let along = std::array::from_fn(|k| b[k] - a[k]);
                Form::Capsule { start: splat(a), along: splat(&along), radius: number(*radius) }
            }
            Geometry::HalfSpace { normal, offset } => {
                Form::HalfSpace { normal: splat(normal), offset: number(*offset) }
            }
            Geometry::Box { pose, size } => {
                let Frame { axes, origin } = Frame::from(pose);
                let frame = Frame { axes: axes.map(|axis| splat(&axis)), origin: splat(&origin) };
                Form::Box { frame, half: splat(&size.map(|x| 0.5 * x)) }
            }
            Geometry::Cylinder { axis, radius, length, .. } => {
                Form::Cylinder { axis: splat(axis), radius: number(*radius), half_length: number(0.5 * length) }
            }
            _ => Form::Other(shape.clone()),
        };
        Self { center: splat(&ball.center), radius: number(ball.radius), form }
    }

    /// Returns a bit mask of the lanes in which the capsule may be nearer than `margin` >= 0 (m).
    #[inline(always)]
    pub fn near<A: Arithmetic>(&self, body: &EightCapsules<A>, margin: Eight<A>) -> u32 {
        let (center, enough) = (body.start, body.radius + margin);
        if let Some(along) = body.along {
            return near_capsule(self, &center.stored(), &along.stored(), enough.stored());
        }
        match &self.form {
            Form::Sphere => near_ball(self, center, enough),
            Form::Capsule { start, along, radius } => {
                let nearest = to_point(Vec3::of(start), Vec3::of(along), center);
                below_square(nearest.squared, enough + Eight::of(*radius))
            }
            Form::HalfSpace { normal, offset } => {
                (center.dot(Vec3::of(normal)) - Eight::of(*offset)).not_at_least(enough)
            }
            Form::Box { frame, half } => near_solid(&BoxLanes::of(frame, half), center, enough),
            Form::Cylinder { axis, radius, half_length } => {
                near_solid(&CylinderLanes::of(&self.center, axis, [*radius, *half_length]), center, enough)
            }
            Form::Other(shape) => {
                let near = near_ball(self, center, enough);
                let along = [F32x8::ZERO; 3];
                if near == 0 { 0 } else { near_one_by_one(shape, &center.stored(), &along, enough.stored(), near) }
            }
        }
    }
}

by_instructions! {
    /// Implements [`EightShape::near`] for capsules with an axis. A separate function: inlined into every kernel it takes
    /// minutes to compile.
    fn near_capsule(shape: &EightShape, start: &Vectors, along: &Vectors, enough: F32x8) -> u32 {
        let (a, u, enough) = (Vec3::<Eight<A>>::of(start), Vec3::<Eight<A>>::of(along), Eight::<A>::of(enough));
        match &shape.form {
            Form::Sphere => {
                let nearest = to_point(a, u, Vec3::of(&shape.center));
                below_square(nearest.squared, enough + Eight::of(shape.radius))
            }
            Form::Capsule { start, along, radius } => {
                let nearest = to_segment(a, u, Vec3::of(start), Vec3::of(along));
                below_square(nearest.squared, enough + Eight::of(*radius))
            }
            Form::HalfSpace { normal, offset } => {
                let normal = Vec3::of(normal);
                let [first, last] = [a.dot(normal), (a + u).dot(normal)];
                (first.smaller(last) - Eight::of(*offset)).not_at_least(enough)
            }
            Form::Box { frame, half } => {
                let solid = BoxLanes::of(frame, half);
                segment_bound(&solid, solid.to_local(a), solid.turned(u), enough).not_at_least(enough)
            }
            Form::Cylinder { axis, radius, half_length } => {
                let solid = CylinderLanes::of(&shape.center, axis, [*radius, *half_length]);
                segment_bound(&solid, solid.to_local(a), solid.turned(u), enough).not_at_least(enough)
            }
            Form::Other(other) => {
                let nearest = to_point(a, u, Vec3::of(&shape.center));
                let near = below_square(nearest.squared, enough + Eight::of(shape.radius));
                if near == 0 { 0 } else { near_one_by_one(other, start, along, enough.stored(), near) }
            }
        }
    }
}

/// Returns the lanes in which a point may be nearer than `enough` to the ball around a shape.
#[inline(always)]
fn near_ball<A: Arithmetic>(shape: &EightShape, point: Vec3<Eight<A>>, enough: Eight<A>) -> u32 {
    let offset = point - Vec3::of(&shape.center);
    below_square(offset.dot(offset), enough + Eight::of(shape.radius))
}

/// Returns the lanes in which a point may be nearer than `enough` to a solid.
#[inline(always)]
fn near_solid<A: Arithmetic, S: SolidLanes<Eight<A>>>(solid: &S, point: Vec3<Eight<A>>, enough: Eight<A>) -> u32 {
    below_square(solid.squared_distance(solid.to_local(point)), enough)
}

/// Returns the lanes in which the square root of `squared` is not at least `enough`.
#[inline(always)]
pub(crate) fn below_square<A: Arithmetic>(squared: Eight<A>, enough: Eight<A>) -> u32 {
    squared.not_at_least(enough * enough)
}

/// Returns those of `lanes` in which the segment is nearer than `enough`, tested in double precision.
#[inline(never)]
fn near_one_by_one(shape: &Shape, start: &Vectors, along: &Vectors, enough: F32x8, lanes: u32) -> u32 {
    let near = |lane: usize| {
        let start = Vector3::from(start.map(|x| f64::from(x.0[lane])));
        let end = start + Vector3::from(along.map(|x| f64::from(x.0[lane])));
        let enough = f64::from(enough.0[lane]);
        // NaN counts as near.
        !(shape.distance_to_segment(&[start, end], enough) >= enough)
    };
    (0..8).filter(|lane| lanes & (1 << lane) != 0 && near(*lane)).fold(0, |found, lane| found | (1 << lane))
}
