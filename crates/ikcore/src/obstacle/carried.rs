//! The bodies that a robot carries, and where they are at a configuration.

use nalgebra::Vector3;

use crate::math::arithmetic::NoFma;
use crate::robot::{FrameBuffer, Robot};
use crate::shape::LineSegment;

/// A capsule of the robot, seen from the moving element that carries it.
#[derive(Debug, Clone)]
pub(super) struct Carried {
    pub link: String,
    /// Number of the frame that carries it, 0 for the base.
    pub stages: usize,
    pub ends: [[f64; 3]; 2],
    pub radius: f64,
}

/// Where everything is at one configuration.
#[derive(Debug, Clone)]
pub(super) struct Placement {
    pub frames: FrameBuffer,
    pub segments: Vec<LineSegment>,
}

/// The bodies of `robot`.
pub(super) fn carried(robot: &Robot) -> Vec<Carried> {
    let bodies = robot.capsules().iter().filter_map(|capsule| {
        let (stages, offset) = robot.place_of_link(&capsule.link)?;
        let ends = [capsule.a, capsule.b].map(|end| offset.place::<NoFma>(&end));
        Some(Carried { link: capsule.link.clone(), stages, ends, radius: capsule.radius })
    });
    bodies.collect()
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
            let frame = &self.frames[carried.stages];
            *segment = carried.ends.map(|end| frame.place::<NoFma>(&end).into());
        }
    }
}
