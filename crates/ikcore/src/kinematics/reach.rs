//! How far the tip can be from the base at most.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::chain::{Chain, Motion};
use super::fixed_direction::Upright;
use crate::math::Frame;
use crate::math::arithmetic::Separate;
use crate::math::so3::norm;
use crate::robot::Robot;
use crate::wording::number;

/// What the tip cannot leave: a ball, or a disk where all joints turn about parallel axes. Not all of it can be reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// On the axis of the first joint (m); in the plane of the disk.
    pub center: [f64; 3],
    /// Infinite where a sliding joint has no limit (m).
    pub radius: f64,
    /// The unit vector that the disk is normal to; None: a ball.
    pub normal: Option<[f64; 3]>,
    /// The direction that the tip keeps, if it does.
    pub upright: Option<Upright>,
}

/// How far a target is out of reach.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Beyond {
    /// From where the tip can be, at least (m).
    pub distance: f64,
    /// From the plane that the tip of a planar arm moves in; 0 for any other (m).
    pub off_plane: f64,
    /// From any orientation that the tip can have, at least (rad).
    pub lean: f64,
}

impl fmt::Display for Beyond {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            (self.distance, "out of reach by at least ", " m"),
            (self.off_plane, "", " m off the plane that the tip moves in"),
            (self.lean, "", " rad off any orientation that the tip can have"),
        ];
        let told = parts.into_iter().filter(|(size, ..)| *size > 0.0);
        let told: Vec<_> = told.map(|(size, before, after)| format!("{before}{}{after}", number(size))).collect();
        f.write_str(&told.join(", "))
    }
}

impl Reach {
    /// How far a position, an orientation, or both are outside, where that is more than `tolerance`.
    pub fn beyond(
        &self,
        position: Option<&[f64; 3]>,
        orientation: Option<&Frame>,
        tolerance: [f64; 2],
    ) -> Option<Beyond> {
        let [metres, radians] = tolerance;
        let above = |size: f64, tolerance: f64| if size > tolerance { size } else { 0.0 };
        let beyond = Beyond {
            distance: position.map_or(0.0, |position| above(self.excess(position), metres)),
            off_plane: position.map_or(0.0, |position| above(self.off_plane(position).abs(), metres)),
            lean: orientation.zip(self.upright).map_or(0.0, |(frame, upright)| above(upright.lean(frame), radians)),
        };
        (beyond != Beyond::default()).then_some(beyond)
    }

    /// How far `position` is outside (m); zero or less inside.
    pub fn excess(&self, position: &[f64; 3]) -> f64 {
        let offset: [f64; 3] = std::array::from_fn(|k| position[k] - self.center[k]);
        let Some(normal) = self.normal else { return norm(&offset) - self.radius };
        let height = self.off_plane(position);
        let in_plane: [f64; 3] = std::array::from_fn(|k| offset[k] - height * normal[k]);
        let beyond = norm(&in_plane) - self.radius;
        if beyond > 0.0 { height.hypot(beyond) } else { height.abs() }
    }

    /// How far `position` is off the plane of the disk, along its normal (m); 0 for a ball.
    pub fn off_plane(&self, position: &[f64; 3]) -> f64 {
        let along = |normal: [f64; 3]| (0..3).map(|k| (position[k] - self.center[k]) * normal[k]).sum();
        self.normal.map_or(0.0, along)
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
    /// Of links alone, without what joints slide; `stages` and `motions` may end with some that move nothing.
    pub(crate) fn of_links(stages: &[Frame], motions: &[Motion], tip: &Frame) -> Self {
        let along = |from: &mut Frame, link: &Frame| {
            *from = from.then::<Separate>(link);
            Some(*from)
        };
        let at_zero: Vec<Frame> = stages.iter().chain([tip]).scan(Frame::IDENTITY, along).collect();
        let upright = Upright::of_chain(&at_zero, motions);
        let slides = motions.iter().any(|motion| motion.slide_scale != 0.0 || motion.slide_offset != 0.0);
        if let Some(Upright { base: normal, .. }) = upright.filter(|_| !slides) {
            return Self { upright, ..Self::of_planar_links(&at_zero, normal) };
        }
        // A first joint that turns keeps the height at which the second one begins, so that only the distance from its axis
        // counts; of every other link all its length does.
        let mut links = stages.iter().skip(1).chain([tip]).map(|frame| frame.origin);
        let [x, y, height] = links.next().unwrap_or_default();
        let (on_axis, first) = match motions[0].slide_scale {
            0.0 => (height, x.hypot(y)),
            _ => (0.0, norm(&[x, y, height])),
        };
        let center = stages.first().unwrap_or(&Frame::IDENTITY).place::<Separate>(&[0.0, 0.0, on_axis]);
        Self { center, radius: first + links.map(|link| norm(&link)).sum::<f64>(), normal: None, upright }
    }

    /// Of links between axes along `normal`, where they are at zero: along it the tip stays where it is.
    fn of_planar_links(at_zero: &[Frame], normal: [f64; 3]) -> Self {
        let (mut center, mut radius) = (at_zero[0].origin, 0.0);
        for ends in at_zero.windows(2) {
            let link: [f64; 3] = std::array::from_fn(|k| ends[1].origin[k] - ends[0].origin[k]);
            let along = (0..3).map(|k| link[k] * normal[k]).sum::<f64>();
            radius += norm(&std::array::from_fn(|k| link[k] - along * normal[k]));
            center = std::array::from_fn(|k| center[k] + along * normal[k]);
        }
        Self { center, radius, normal: Some(normal), upright: None }
    }
}

fn longest_slide(motion: &Motion, lower: &[f64], upper: &[f64]) -> f64 {
    if motion.slide_scale == 0.0 {
        return 0.0;
    }
    let at = |q: f64| (motion.slide_scale * q + motion.slide_offset).abs();
    at(lower[motion.joint]).max(at(upper[motion.joint]))
}
