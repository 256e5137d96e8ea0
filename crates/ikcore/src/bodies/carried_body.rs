//! Bodies in the frames of the moving elements that carry them.

use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::vector::distance;
use crate::shape::{LineSegment, PosedBody, Shape};

/// A body in the frame of the moving element that carries it.
#[derive(Debug, Clone)]
pub(crate) struct CarriedBody {
    pub link: String,
    /// Number of the frame that carries it, 0 for the base.
    pub stages: usize,
    /// Ends of the axis of its enclosing capsule.
    pub ends: [[f64; 3]; 2],
    /// Radius of this capsule (m).
    pub radius: f64,
    /// Radius of its bounding ball (m).
    pub reach: f64,
    /// Shape and the frame in which it is given; `None` if it is the capsule.
    pub solid: Option<(Shape, Frame)>,
}

impl CarriedBody {
    /// A body of this shape, and its enclosing capsule from one to the other of `ends` with this `radius` (m), all given in a frame at
    /// `offset` from frame number `stages`. `solid` is `None` if it is the capsule.
    pub fn new(
        link: &str,
        (stages, offset): (usize, Frame),
        ends: [[f64; 3]; 2],
        radius: f64,
        solid: Option<&Shape>,
    ) -> Self {
        let ends = ends.map(|end| offset.transform::<NoFma>(&end));
        let reach = radius + 0.5 * distance(&ends[0], &ends[1]);
        Self { link: link.into(), stages, ends, radius, reach, solid: solid.map(|shape| (shape.clone(), offset)) }
    }

    /// The body where the axis of its capsule is `axis` and the element that carries it is at `frame`.
    #[inline]
    pub fn posed<'a>(&'a self, axis: &'a LineSegment, frame: &Frame) -> PosedBody<'a> {
        let solid = self.solid.as_ref().map(|(shape, offset)| (shape, frame.then::<NoFma>(offset)));
        PosedBody { axis, radius: self.radius, solid }
    }

    /// Axis of its capsule with the element that carries it at `frame`.
    pub fn axis_at(&self, frame: &Frame) -> LineSegment {
        self.ends.map(|end| frame.transform::<NoFma>(&end).into())
    }
}
