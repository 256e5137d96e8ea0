//! Where the bodies of a robot are at a configuration.

use nalgebra::Vector3;

use crate::robot::{Carried, FrameBuffer, Robot};
use crate::shape::LineSegment;

/// Where everything is at one configuration.
#[derive(Debug, Clone)]
pub(super) struct Placement {
    pub frames: FrameBuffer,
    /// Axes of the capsules around the bodies.
    pub segments: Vec<LineSegment>,
}

impl Placement {
    /// Of this many bodies of `robot`, not yet placed.
    pub fn of(robot: &Robot, bodies: usize) -> Self {
        Self { frames: robot.frame_buffer(), segments: vec![[Vector3::zeros(); 2]; bodies] }
    }

    /// Places `bodies` at the configuration `q`.
    pub fn update(&mut self, robot: &Robot, bodies: &[Carried], q: &[f64]) {
        robot.write_frames(q, &mut self.frames);
        for (segment, carried) in self.segments.iter_mut().zip(bodies) {
            *segment = carried.axis_at(&self.frames[carried.stages]);
        }
    }
}
