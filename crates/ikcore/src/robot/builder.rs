//! Describes a serial chain from base to tip, element by element; [`ChainBuilder::build`] checks it and makes a [`Robot`].

use std::collections::HashSet;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::joint::{Joint, JointKind};
use super::model::Robot;
use crate::error::{Error, Result, require_finite};
use crate::math::{MAX_DOF, Pose, pose};

/// One element between base and tip, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Element {
    /// A constant transform.
    Fixed(Pose),
    /// A motion by `scale * q[joint] + offset`.
    Moving {
        /// About or along this axis, of unit length.
        axis: Vector3<f64>,
        /// Whether it turns (rad) rather than slides (m).
        turns: bool,
        /// The independent joint that drives it.
        joint: usize,
        /// Factor on q.
        scale: f64,
        /// Constant added (rad or m).
        offset: f64,
    },
    /// The frame reached here is that of a link.
    Link(String),
}

/// How far a moving element goes for a value q of the independent joint that drives it: `scale * q + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Factor on q; -1 for a joint passed from its child to its parent, a mimic joint's multiplier.
    pub scale: f64,
    /// Constant added (rad or m).
    pub offset: f64,
}

impl Drive {
    /// The joint's own value.
    pub const DIRECT: Self = Self { scale: 1.0, offset: 0.0 };
}

/// The description of a robot: independent joints in order, and the elements from base to tip.
///
/// ```
/// use ikcore::nalgebra::Vector3;
/// use ikcore::math::pose;
/// use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind};
///
/// let mut arm = ChainBuilder::new("pendulum", "base");
/// let swing = arm.add_joint(Joint::new("swing", JointKind::Continuous));
/// arm.moving(swing, JointKind::Continuous, Vector3::y(), Drive::DIRECT);
/// arm.fixed(pose::translation(0.0, 0.0, -1.0));
/// arm.link("bob");
/// let robot = arm.build()?;
/// assert_eq!(robot.dof(), 1);
/// # Ok::<(), ikcore::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChainBuilder {
    pub(crate) name: String,
    pub(crate) joints: Vec<Joint>,
    pub(crate) elements: Vec<Element>,
}

impl ChainBuilder {
    /// An empty chain that starts in the frame of link `base_link`.
    pub fn new(name: impl Into<String>, base_link: impl Into<String>) -> Self {
        Self { name: name.into(), joints: Vec::new(), elements: vec![Element::Link(base_link.into())] }
    }

    /// Adds an independent joint and returns its index in q. It moves nothing until [`moving`](Self::moving) uses it.
    pub fn add_joint(&mut self, joint: Joint) -> usize {
        self.joints.push(joint);
        self.joints.len() - 1
    }

    /// The independent joint of this index, to narrow its limits.
    pub(crate) fn joint_mut(&mut self, index: usize) -> &mut Joint {
        &mut self.joints[index]
    }

    /// Appends a constant transform.
    pub fn fixed(&mut self, transform: Pose) {
        self.elements.push(Element::Fixed(transform));
    }

    /// Appends a motion about or along `axis` (any length but zero), driven by independent joint `joint`.
    pub fn moving(&mut self, joint: usize, kind: JointKind, axis: Vector3<f64>, drive: Drive) {
        let Drive { scale, offset } = drive;
        self.elements.push(Element::Moving { axis: axis.normalize(), turns: kind.turns(), joint, scale, offset });
    }

    /// Names the frame reached so far. The last frame named is the tip.
    pub fn link(&mut self, name: impl Into<String>) {
        self.elements.push(Element::Link(name.into()));
    }

    /// Checks the description and makes the robot.
    ///
    /// # Errors
    /// [`Error::InvalidRobot`] for no joints, too many, or a joint or link named twice;
    /// [`Error::EmptyRange`], [`Error::NegativeLimit`] or
    /// [`Error::OutOfRange`] for impossible limits;
    /// [`Error::NotFinite`] for transforms.
    pub fn build(self) -> Result<Robot> {
        Robot::new(self)
    }

    /// Everything that the kernels rely on.
    pub(crate) fn validate(&self) -> Result<()> {
        let invalid = |problem: String| Error::InvalidRobot { robot: self.name.clone(), problem };
        let moving = self.elements.iter().filter(|e| matches!(e, Element::Moving { .. })).count();
        if moving == 0 || self.joints.is_empty() {
            return Err(invalid("no joint moves between base and tip".into()));
        }
        if moving > MAX_DOF || self.joints.len() > MAX_DOF {
            return Err(invalid(format!(
                "{moving} moving joints between base and tip; at most {MAX_DOF} are supported"
            )));
        }
        let mut names = HashSet::new();
        for joint in &self.joints {
            if !names.insert(&joint.name) {
                return Err(invalid(format!("two joints are named '{}'", joint.name)));
            }
            joint.validate()?;
        }
        let mut links = HashSet::new();
        self.elements.iter().try_for_each(|element| match element {
            Element::Fixed(transform) => pose::checked("fixed transform", *transform).map(|_| ()),
            Element::Link(name) if !links.insert(name) => Err(invalid(format!("two links are named '{name}'"))),
            Element::Link(_) => Ok(()),
            Element::Moving { axis, joint, scale, offset, .. } => {
                let Some(driver) = self.joints.get(*joint) else {
                    return Err(invalid(format!("a moving element is driven by joint {joint}, which does not exist")));
                };
                if !((axis.norm() - 1.0).abs() < 1e-9) {
                    return Err(invalid(format!("joint '{}' has a zero or non-finite axis", driver.name)));
                }
                require_finite("scale and offset of a joint", &[*scale, *offset], |_| {
                    format!("joint '{}'", driver.name)
                })
            }
        })
    }
}
