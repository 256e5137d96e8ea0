//! Bounds on the tip position, from the lengths of the links.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::chain::{Chain, Transmission};
use super::fixed_direction::FixedDirection;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::vector3::{add_scaled, dot, norm, sub};
use crate::wording::number;

/// Rounding error of positions, relative to the reach, and of angles (rad): a target outside by less may be reachable.
const ROUNDING: f64 = 1e-12;

/// Ball that contains every tip position, or a disk if all joints rotate about parallel axes. Parts of it may be unreachable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Centre on the axis of the first joint (m), in the plane of the disk.
    pub center: [f64; 3],
    /// Radius (m); infinite if a prismatic joint has no limit.
    pub radius: f64,
    /// Unit normal of the disk; `None` for a ball.
    pub normal: Option<[f64; 3]>,
    /// Direction that the tip keeps, if there is one.
    pub fixed_direction: Option<FixedDirection>,
}

/// Lower bounds on the distance of a target from the reachable poses.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ReachShortfall {
    /// Distance to the nearest reachable point (m).
    pub distance: f64,
    /// Distance to the plane of a planar arm (m); 0 for other arms.
    pub off_plane: f64,
    /// Angle to the nearest orientation that the tip can have (rad).
    pub angle: f64,
}

impl fmt::Display for ReachShortfall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [
            (self.distance, "out of reach by at least ", " m"),
            (self.off_plane, "", " m off the plane that the tip moves in"),
            (self.angle, "", " rad off any orientation that the tip can have"),
        ];
        let given = parts.into_iter().filter(|(size, ..)| *size > 0.0);
        let given: Vec<_> = given.map(|(size, before, after)| format!("{before}{}{after}", number(size))).collect();
        f.write_str(&given.join(", "))
    }
}

impl Reach {
    /// Returns how far a position, an orientation, or both are out of reach; `None` if within `tolerance` (m, rad).
    pub fn shortfall(
        &self,
        position: Option<&[f64; 3]>,
        orientation: Option<&Frame>,
        tolerance: [f64; 2],
    ) -> Option<ReachShortfall> {
        let [metres, radians] = [tolerance[0] + ROUNDING * (1.0 + self.radius), tolerance[1] + ROUNDING];
        let above = |size: f64, tolerance: f64| if size > tolerance { size } else { 0.0 };
        let shortfall = ReachShortfall {
            distance: position.map_or(0.0, |position| above(self.excess(position), metres)),
            off_plane: position.map_or(0.0, |position| above(self.off_plane(position).abs(), metres)),
            angle: orientation
                .zip(self.fixed_direction)
                .map_or(0.0, |(frame, fixed)| above(fixed.angle_to(frame), radians)),
        };
        (shortfall != ReachShortfall::default()).then_some(shortfall)
    }

    /// Returns the distance of `position` from the reach (m); zero or negative inside.
    pub fn excess(&self, position: &[f64; 3]) -> f64 {
        let offset = sub(position, &self.center);
        let Some(normal) = self.normal else { return norm(&offset) - self.radius };
        let height = self.off_plane(position);
        let beyond = norm(&add_scaled(&offset, &normal, -height)) - self.radius;
        if beyond > 0.0 { height.hypot(beyond) } else { height.abs() }
    }

    /// Returns the distance of `position` from the plane of the disk, along its normal (m); 0 for a ball.
    pub fn off_plane(&self, position: &[f64; 3]) -> f64 {
        self.normal.map_or(0.0, |normal| dot(&sub(position, &self.center), &normal))
    }
}

impl Reach {
    /// Returns the reach of the stretched links, without prismatic motion.
    pub(crate) fn of_links(chain: &Chain) -> Self {
        let at_zero: Vec<Frame> = chain
            .moving_frames()
            .chain([chain.tip])
            .scan(Frame::IDENTITY, |from, link| {
                *from = from.then::<NoFma>(&link);
                Some(*from)
            })
            .collect();
        let motions = &chain.motions;
        let fixed_direction = FixedDirection::of_chain(&at_zero, motions);
        let slides = motions.iter().any(|motion| motion.slide_scale != 0.0 || motion.slide_offset != 0.0);
        if let Some(FixedDirection { base: normal, .. }) = fixed_direction.filter(|_| !slides) {
            return Self { fixed_direction, ..Self::of_planar_links(&at_zero, normal) };
        }
        // A revolute first joint keeps the height of the second joint, so only the distance of the latter from the first axis
        // counts; every other link counts with its full length.
        let mut links = chain.moving_frames().skip(1).chain([chain.tip]).map(|frame| frame.origin);
        let [x, y, height] = links.next().unwrap_or_default();
        let (on_axis, first) = match motions[0].slide_scale {
            0.0 => (height, x.hypot(y)),
            _ => (0.0, norm(&[x, y, height])),
        };
        let center = chain.stages.frame(0).transform::<NoFma>(&[0.0, 0.0, on_axis]);
        Self { center, radius: first + links.map(|link| norm(&link)).sum::<f64>(), normal: None, fixed_direction }
    }

    /// Extends this reach of the links of `chain` by the prismatic motion between these limits.
    pub(crate) fn with_slides(self, chain: &Chain, lower: &[f64], upper: &[f64]) -> Self {
        let slide = |(stage, motion): (usize, &Transmission)| {
            let Some(curve) = chain.curves.at(stage) else { return longest_slide(motion, lower, upper) };
            curve.longest_slide(lower[motion.joint], upper[motion.joint])
        };
        let slides: f64 = chain.motions.iter().enumerate().map(slide).sum();
        Self { radius: self.radius + slides, ..self }
    }

    /// Returns the disk of links between axes along `normal`. `at_zero` holds the frames of the stages and the tip at zero.
    fn of_planar_links(at_zero: &[Frame], normal: [f64; 3]) -> Self {
        let (mut center, mut radius) = (at_zero[0].origin, 0.0);
        for ends in at_zero.windows(2) {
            let link = sub(&ends[1].origin, &ends[0].origin);
            let along = dot(&link, &normal);
            radius += norm(&add_scaled(&link, &normal, -along));
            center = add_scaled(&center, &normal, along);
        }
        Self { center, radius, normal: Some(normal), fixed_direction: None }
    }
}

fn longest_slide(motion: &Transmission, lower: &[f64], upper: &[f64]) -> f64 {
    if motion.slide_scale == 0.0 {
        return 0.0;
    }
    let at = |q: f64| (motion.slide_scale * q + motion.slide_offset).abs();
    at(lower[motion.joint]).max(at(upper[motion.joint]))
}
