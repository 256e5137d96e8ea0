//! Poses of the bodies of an arm at one configuration.

use nalgebra::Vector3;

use super::carried_body::CarriedBody;
use crate::kinematics::link_tree::FrameBuffer;
use crate::shape::LineSegment;

/// Frames of the moving elements, and axes of the bodies, at one configuration.
#[derive(Debug, Clone)]
pub(crate) struct BodyPoses {
    pub frames: FrameBuffer,
    /// Axes of the enclosing capsules.
    pub segments: Vec<LineSegment>,
}

impl BodyPoses {
    /// Room for this many bodies of an arm with the moving elements at `frames`.
    pub fn with_room(frames: FrameBuffer, bodies: usize) -> Self {
        Self { frames, segments: vec![[Vector3::zeros(); 2]; bodies] }
    }

    /// Writes the axes of `bodies` with the moving elements where `frames` has them.
    pub fn update_axes(&mut self, bodies: &[CarriedBody]) {
        for (segment, body) in self.segments.iter_mut().zip(bodies) {
            *segment = body.axis_at(&self.frames[body.stages]);
        }
    }
}
