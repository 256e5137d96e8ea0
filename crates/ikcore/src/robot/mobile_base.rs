//! Robots on a base that moves: wheels, or nothing at all.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;

use super::description::{Drive, Element};
use super::joint::{Joint, JointKind};
use super::model::Robot;
use super::off_chain::OffChain;
use super::parts::Parts;
use crate::error::{Error, Result};
use crate::math::Pose;
use crate::wording::words;

/// Mobility of a base.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MobileBase {
    /// Motion on a plane: `base_x`, `base_y` (m) and `base_yaw` (rad).
    Planar,
    /// Free motion: `base_x`, `base_y`, `base_z` (m), and the rotation vector `base_rx`, `base_ry`, `base_rz` (rad).
    Floating,
}

words!("kind of mobile base": MobileBase { Planar => "planar", Floating => "floating" });

/// Limits of the joints of a base, one entry for each.
#[derive(Debug, Clone, PartialEq)]
pub struct BaseLimits {
    /// Position limits (m, rad).
    pub lower: Vec<f64>,
    /// Position limits (m, rad).
    pub upper: Vec<f64>,
    /// Velocity limits (m/s, rad/s); infinity where unknown.
    pub velocity: Vec<f64>,
    /// Acceleration limits (m/s^2, rad/s^2); infinity where unknown.
    pub acceleration: Vec<f64>,
}

/// Rotation vectors have to be shorter (rad): at a full turn the rotation no longer follows all of their entries.
const LONGEST_VECTOR: f64 = 0.95 * TAU;

impl MobileBase {
    /// Names of its joints, in the order of q.
    pub fn joint_names(self) -> &'static [&'static str] {
        match self {
            Self::Planar => &["base_x", "base_y", "base_yaw"],
            Self::Floating => &["base_x", "base_y", "base_z", "base_rx", "base_ry", "base_rz"],
        }
    }

    /// The number of its joints that slide; they come first.
    fn slides(self) -> usize {
        match self {
            Self::Planar => 2,
            Self::Floating => 3,
        }
    }

    fn elements(self) -> Vec<Element> {
        let axis = |k: usize| Vector3::from_fn(|row, _| f64::from(u8::from(row == k)));
        let slide = |k: usize| Element::moving(k, JointKind::Prismatic, axis(k), Drive::DIRECT);
        let turns = match self {
            Self::Planar => Element::moving(2, JointKind::Continuous, Vector3::z(), Drive::DIRECT),
            Self::Floating => Element::RotationVector { joint: 3 },
        };
        (0..self.slides()).map(slide).chain([turns]).collect()
    }

    /// The joints between `limits`.
    fn joints(self, limits: &BaseLimits) -> Result<Vec<Joint>> {
        let BaseLimits { lower, upper, velocity, acceleration } = limits;
        let joint = |(k, name): (usize, &&str)| {
            let (lower, upper) = (lower[k], upper[k]);
            let is_open = lower == f64::NEG_INFINITY && upper == f64::INFINITY;
            let kind = match (k < self.slides(), self) {
                (true, _) => JointKind::Prismatic,
                (false, Self::Planar) if is_open => JointKind::Continuous,
                (false, _) => JointKind::Revolute,
            };
            if kind != JointKind::Continuous {
                for (side, value) in [("lower", lower), ("upper", upper)] {
                    if !value.is_finite() {
                        let name = format!("{side} limit of joint '{name}'");
                        return Err(Error::out_of_range(
                            name,
                            "finite: configurations are drawn from the range",
                            value,
                        ));
                    }
                }
            }
            let joint = Joint::new(*name, kind).with_range(lower, upper).with_velocity(velocity[k]);
            Ok(Joint { rated_acceleration: acceleration[k], ..joint })
        };
        self.joint_names().iter().enumerate().map(joint).collect()
    }
}

impl Robot {
    /// Copy of the robot on a mobile base, whose joints come first in q, between `limits`. The first link moves; the pose of the base
    /// before is how it is mounted. Poses are in the frame of a new first link, "world". In named configurations the base is at zero,
    /// or as near to it as its limits allow.
    ///
    /// The orientation of a floating base is a rotation vector: nothing is singular below the length 2 pi. The limits of velocity and
    /// acceleration are those of its entries; the angular velocity is at most the length of their rates.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for limits of another number of joints; [`Error::OutOfRange`] for limits that are not finite (the yaw may
    /// be unlimited on both sides), and for rotation vectors that may be 0.95 turns long or longer; [`Error::InvalidRobot`] for a name that is taken,
    /// a robot that floats, and more joints than are supported; impossible limits as [`Joint`] has them.
    pub fn with_mobile_base(&self, base: MobileBase, limits: &BaseLimits) -> Result<Self> {
        let count = base.joint_names().len();
        let BaseLimits { lower, upper, velocity, acceleration } = limits;
        for (field, values) in
            [("lower", lower), ("upper", upper), ("velocity", velocity), ("acceleration", acceleration)]
        {
            if values.len() != count {
                let what = format!("{field} of a {base} base");
                let expected = format!("{count} joints: {}", base.joint_names().join(", "));
                return Err(Error::WrongLength { what: what.into(), expected, got: values.len() });
            }
        }
        let joints = base.joints(limits)?;
        if base == MobileBase::Floating {
            require_short(limits)?;
            if self.is_floating() {
                let problem = "its base floats already".into();
                return Err(Error::InvalidRobot { robot: self.name().into(), problem });
            }
        }
        Self::assembled(on_base(self.parts().clone(), base, joints, self.free_link_name()))
    }

    /// Whether its base turns by a rotation vector.
    pub(crate) fn is_floating(&self) -> bool {
        self.chain().vector.is_some()
    }

    /// The first of "world", "world_2" and so on that no link has.
    fn free_link_name(&self) -> String {
        let numbered = (2..).map(|i| format!("world_{i}"));
        let mut names = std::iter::once("world".to_owned()).chain(numbered);
        names.find(|name| self.link_number(name).is_err()).unwrap_or_default()
    }
}

/// Checks that the rotation vector stays short.
fn require_short(BaseLimits { lower, upper, .. }: &BaseLimits) -> Result<()> {
    let farthest = |k: usize| lower[k].abs().max(upper[k].abs());
    let length = (3..6).map(farthest).fold(0.0, f64::hypot);
    if length < LONGEST_VECTOR {
        return Ok(());
    }
    let name = "length of the rotation vector at the limits of base_rx, base_ry and base_rz";
    Err(Error::out_of_range(name, "below 5.97 rad, 0.95 of a turn; limits of -pi and pi are", length))
}

/// `parts` with the joints and elements of `base` before their own, which begin at a new link `world`.
fn on_base(mut parts: Parts, base: MobileBase, joints: Vec<Joint>, world: String) -> Parts {
    let shift = joints.len();
    let at_rest = joints.iter().map(|joint| 0.0_f64.clamp(joint.lower, joint.upper.max(joint.lower)));
    for stance in &mut parts.stances {
        stance.q.splice(0..0, at_rest.clone());
    }
    let mount = std::mem::replace(&mut parts.base, Pose::identity());
    let own = std::mem::take(&mut parts.description.elements).into_iter().map(|element| element.shifted(shift));
    let before = std::iter::once(Element::Link(world)).chain(base.elements()).chain([Element::Fixed(mount)]);
    parts.description.elements = before.chain(own).collect();
    parts.description.joints.splice(0..0, joints);
    let off_chain = Arc::make_mut(&mut parts.off_chain);
    let OffChain { links, .. } = off_chain;
    for link in links {
        // One link more comes before.
        link.parent += 1;
        link.elements = std::mem::take(&mut link.elements).into_iter().map(|element| element.shifted(shift)).collect();
    }
    parts
}
