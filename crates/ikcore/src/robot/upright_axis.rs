//! A vertical first axis: what the arm reaches it reaches at every azimuth, but for the limits of the first joint.

use super::model::Robot;
use crate::math::Frame;

/// Largest tilt of an axis that counts as vertical (rad): far below any tolerance over the length of an arm.
const TILT: f64 = 1e-12;

/// The vertical axis about which the first joint turns the whole arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UprightAxis {
    /// Intersection with the plane z = 0 of the robot's base (m).
    pub point: [f64; 2],
    /// The joint that turns the arm, as an entry of q.
    pub joint: usize,
    /// Joint motion while the arm turns by 1 rad about z.
    pub per_turn: f64,
}

impl UprightAxis {
    /// `pose` turned about the axis by `angle` (rad).
    pub(crate) fn turned(&self, pose: &Frame, angle: f64) -> Frame {
        let (sine, cosine) = angle.sin_cos();
        let turned = |v: [f64; 3]| [cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]];
        let [x, y] = self.point;
        let [east, north, up] = turned([pose.origin[0] - x, pose.origin[1] - y, pose.origin[2]]);
        Frame { axes: pose.axes.map(turned), origin: [x + east, y + north, up] }
    }
}

impl Robot {
    /// The vertical axis of the first joint; `None` if that slides, is tilted, or moves something else too.
    pub fn upright_axis(&self) -> Option<UprightAxis> {
        let (chain, first) = (self.chain(), *self.chain().motions.first()?);
        let driven = chain.motions[..chain.moving].iter().filter(|motion| motion.joint == first.joint).count();
        let frame = chain.stages.frame(0);
        let [x, y, z] = frame.axes[2];
        let turns = first.turn_scale != 0.0 && first.is_linear() && chain.vector.is_none();
        if self.tip_count() > 1 || driven != 1 || !turns || x.hypot(y) > TILT {
            return None;
        }
        let [px, py, _] = frame.origin;
        Some(UprightAxis { point: [px, py], joint: first.joint, per_turn: z.signum() / first.turn_scale })
    }
}
