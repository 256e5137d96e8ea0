//! "Nearer than m?" for one body at eight configurations, in single precision: for searches, whose results are confirmed in double
//! precision.

use nalgebra::Vector3;

use super::checked_shape::Shape;
use super::geometry::Geometry;
use super::segment_lanes::{to_point, to_segment};
use super::solid_lanes::{BoxLanes, CylinderLanes, SolidLanes, segment_bound};
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f32x8::F32x8;
use crate::math::real::{Eight, Real};
use crate::math::vec3::Vec3;

/// A vector, the same in all lanes or one per lane.
pub(crate) type Vectors = [F32x8; 3];

/// A shape in all lanes.
#[derive(Debug, Clone)]
pub(crate) struct EightShape {
    /// A ball around it; infinite for a half-space.
    center: Vectors,
    radius: F32x8,
    form: Form,
}

#[derive(Debug, Clone)]
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
    /// A shape whose distances are found one by one.
    Other(Shape),
}

/// A capsule at eight places, one per lane; a sphere if `along` is `None`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EightCapsules<A> {
    /// Start of each axis (m).
    pub start: Vec3<Eight<A>>,
    /// From the start of each axis to its end.
    pub along: Option<Vec3<Eight<A>>>,
    /// Radius (m).
    pub radius: Eight<A>,
}

impl<A: Arithmetic> EightCapsules<A> {
    /// Squared distance (m^2) between the axes.
    #[inline(always)]
    pub fn squared_distance(&self, other: &Self) -> Eight<A> {
        match (self.along, other.along) {
            (None, None) => (self.start - other.start).dot(self.start - other.start),
            (Some(along), None) => to_point(self.start, along, other.start).squared,
            (None, Some(along)) => to_point(other.start, along, self.start).squared,
            (Some(along), Some(others)) => to_segment(self.start, along, other.start, others).squared,
        }
    }
}

/// The same vector in all lanes.
pub(crate) fn splat(vector: &[f64; 3]) -> Vectors {
    vector.map(|x| F32x8::splat(x as f32))
}

impl EightShape {
    /// A shape in all lanes.
    pub fn new(shape: &Shape) -> Self {
        let number = |x: f64| F32x8::splat(x as f32);
        let ball = shape.bounding_ball();
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

    /// The lanes in which the capsule may be nearer than `margin` >= 0 (m), one bit each.
    #[inline(always)]
    pub fn near<A: Arithmetic>(&self, body: &EightCapsules<A>, margin: Eight<A>) -> u32 {
        let (start, enough) = (body.start, body.radius + margin);
        let zero = Eight::splat(0.0);
        let along = body.along.unwrap_or(Vec3 { x: zero, y: zero, z: zero });
        match &self.form {
            Form::Sphere => near_ball(self, body, enough),
            Form::Capsule { start: own, along: axis, radius } => {
                let nearest = match body.along {
                    None => to_point(Vec3::of(own), Vec3::of(axis), start),
                    Some(along) => to_segment(start, along, Vec3::of(own), Vec3::of(axis)),
                };
                below_square(nearest.squared, enough + Eight::of(*radius))
            }
            Form::HalfSpace { normal, offset } => {
                let normal = Vec3::of(normal);
                let [first, last] = [start.dot(normal), (start + along).dot(normal)];
                (first.smaller(last) - Eight::of(*offset)).not_at_least(enough)
            }
            Form::Box { frame, half } => near_solid(&BoxLanes::of(frame, half), body, enough),
            Form::Cylinder { axis, radius, half_length } => {
                near_solid(&CylinderLanes::of(&self.center, axis, [*radius, *half_length]), body, enough)
            }
            Form::Other(shape) => {
                let near = near_ball(self, body, enough);
                if near == 0 {
                    0
                } else {
                    near_one_by_one(shape, start.stored(), along.stored(), enough.stored(), near)
                }
            }
        }
    }
}

/// Of the ball around a shape.
#[inline(always)]
fn near_ball<A: Arithmetic>(shape: &EightShape, body: &EightCapsules<A>, enough: Eight<A>) -> u32 {
    let center = Vec3::of(&shape.center);
    let squared = match body.along {
        None => {
            let offset = body.start - center;
            offset.dot(offset)
        }
        Some(along) => to_point(body.start, along, center).squared,
    };
    below_square(squared, enough + Eight::of(shape.radius))
}

#[inline(always)]
fn near_solid<A: Arithmetic, S: SolidLanes<Eight<A>>>(solid: &S, body: &EightCapsules<A>, enough: Eight<A>) -> u32 {
    let start = solid.to_local(body.start);
    match body.along {
        None => below_square(solid.squared_distance(start), enough),
        Some(along) => segment_bound(solid, start, solid.turned(along), enough).not_at_least(enough),
    }
}

/// The lanes in which the square root of `squared` is not at least `enough`.
#[inline(always)]
pub(crate) fn below_square<A: Arithmetic>(squared: Eight<A>, enough: Eight<A>) -> u32 {
    squared.not_at_least(enough * enough)
}

/// Of these lanes those in which the segment is nearer than `enough`.
#[inline(never)]
fn near_one_by_one(shape: &Shape, start: Vectors, along: Vectors, enough: F32x8, lanes: u32) -> u32 {
    let near = |lane: usize| {
        let start = Vector3::from(start.map(|x| f64::from(x.0[lane])));
        let end = start + Vector3::from(along.map(|x| f64::from(x.0[lane])));
        let enough = f64::from(enough.0[lane]);
        // NaN counts as near.
        !(shape.distance_to_segment(&[start, end], enough) >= enough)
    };
    (0..8).filter(|lane| lanes & (1 << lane) != 0 && near(*lane)).fold(0, |found, lane| found | (1 << lane))
}
