//! Bodies seen from the moving elements that carry them.

use super::model::Robot;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::vector::distance;
use crate::shape::{LineSegment, PlacedBody, Shape};

/// A body of the robot, seen from the moving element that carries it.
#[derive(Debug, Clone)]
pub(crate) struct Carried {
    pub link: String,
    /// Number of the frame that carries it, 0 for the base.
    pub stages: usize,
    /// Ends of the axis of the capsule around it.
    pub ends: [[f64; 3]; 2],
    /// Radius of this capsule (m).
    pub radius: f64,
    /// Radius of the ball around it (m).
    pub reach: f64,
    /// Its shape and the frame in which it is given; `None` if it is the capsule.
    pub solid: Option<(Shape, Frame)>,
}

impl Robot {
    /// The bodies, each seen from the moving element that carries it.
    pub(crate) fn carried_bodies(&self) -> Vec<Carried> {
        let numbers = self.link_numbers();
        let bodies = self.capsules().iter().zip(self.bodies()).filter_map(|(capsule, body)| {
            let link = *numbers.get(capsule.link.as_str())?;
            let (stages, offset) = self.place_of_link_number(link);
            let ends = [capsule.a, capsule.b].map(|end| offset.place::<NoFma>(&end));
            let solid = (!body.is_capsule()).then(|| (body.shape.clone(), offset));
            let reach = capsule.radius + 0.5 * distance(&ends[0], &ends[1]);
            Some(Carried { link: capsule.link.clone(), stages, ends, radius: capsule.radius, reach, solid })
        });
        bodies.collect()
    }
}

impl Carried {
    /// The body where the axis of its capsule is `axis` and the element that carries it is at `frame`.
    #[inline]
    pub fn placed<'a>(&'a self, axis: &'a LineSegment, frame: &Frame) -> PlacedBody<'a> {
        let solid = self.solid.as_ref().map(|(shape, offset)| (shape, frame.then::<NoFma>(offset)));
        PlacedBody { axis, radius: self.radius, solid }
    }

    /// Axis of its capsule with the element that carries it at `frame`.
    pub fn axis_at(&self, frame: &Frame) -> LineSegment {
        self.ends.map(|end| frame.place::<NoFma>(&end).into())
    }
}
