//! How far the tip can be from the base at most.

use super::Robot;
use super::chain::{Chain, Motion};
use crate::math::Frame;
use crate::math::arithmetic::Separate;
use crate::math::so3::norm;

/// A ball that the tip cannot leave. Not all of it can be reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// On the axis of the first joint (m).
    pub center: [f64; 3],
    /// Infinite where a sliding joint has no limit (m).
    pub radius: f64,
}

impl Reach {
    /// How far `position` is outside the ball (m); negative inside.
    pub fn excess(&self, position: &[f64; 3]) -> f64 {
        norm(&std::array::from_fn(|k| position[k] - self.center[k])) - self.radius
    }
}

impl Robot {
    /// The reach between these joint limits: the lengths of all links, stretched out, and what joints slide.
    pub fn reach(&self, lower: &[f64], upper: &[f64]) -> Reach {
        let Chain { stretched, motions, .. } = self.chain();
        let slides: f64 = motions.iter().map(|motion| longest_slide(motion, lower, upper)).sum();
        Reach { radius: stretched.radius + slides, ..*stretched }
    }
}

impl Reach {
    /// Of links alone, without what joints slide.
    ///
    /// A first joint that turns keeps the height at which the second one begins, so that only the distance from its axis
    /// counts; of every other link all its length does.
    pub(super) fn of_links(stages: &[Frame], motions: &[Motion], tip: &Frame) -> Self {
        let mut links = stages.iter().skip(1).chain([tip]).map(|frame| frame.origin);
        let [x, y, height] = links.next().unwrap_or_default();
        let (on_axis, first) = match motions[0].slide_scale {
            0.0 => (height, x.hypot(y)),
            _ => (0.0, norm(&[x, y, height])),
        };
        let center = stages.first().unwrap_or(&Frame::IDENTITY).place::<Separate>(&[0.0, 0.0, on_axis]);
        Self { center, radius: first + links.map(|link| norm(&link)).sum::<f64>() }
    }
}

fn longest_slide(motion: &Motion, lower: &[f64], upper: &[f64]) -> f64 {
    if motion.slide_scale == 0.0 {
        return 0.0;
    }
    let at = |q: f64| (motion.slide_scale * q + motion.slide_offset).abs();
    at(lower[motion.joint]).max(at(upper[motion.joint]))
}
