//! Construction of a robot element by element, from base to tip.

use nalgebra::Vector3;

use super::description::{Description, Drive, Element};
use super::joint::{Joint, JointKind};
use super::model::Robot;
use crate::error::Result;
use crate::math::Pose;

/// A robot under construction: independent joints in order, and the elements from base to tip.
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
#[derive(Debug, Clone, PartialEq)]
pub struct ChainBuilder {
    description: Description,
}

impl ChainBuilder {
    /// An empty chain that starts in the frame of link `base_link`.
    pub fn new(name: impl Into<String>, base_link: impl Into<String>) -> Self {
        let elements = vec![Element::Link(base_link.into())];
        Self { description: Description { name: name.into(), joints: Vec::new(), elements } }
    }

    /// Adds an independent joint and returns its index in q. It moves nothing until [`moving`](Self::moving) uses it.
    pub fn add_joint(&mut self, joint: Joint) -> usize {
        self.description.joints.push(joint);
        self.description.joints.len() - 1
    }

    /// Name of the robot.
    pub(crate) fn name(&self) -> &str {
        &self.description.name
    }

    /// The independent joint of this index, mutable so that its limits can be narrowed.
    pub(crate) fn joint_mut(&mut self, index: usize) -> &mut Joint {
        &mut self.description.joints[index]
    }

    /// Appends a constant transform.
    pub fn fixed(&mut self, transform: Pose) {
        self.push(Element::Fixed(transform));
    }

    /// Appends a motion about or along `axis` (any length but zero), driven by independent joint `joint`.
    pub fn moving(&mut self, joint: usize, kind: JointKind, axis: Vector3<f64>, drive: Drive) {
        self.push(Element::moving(joint, kind, axis, drive));
    }

    /// Appends an element.
    pub(crate) fn push(&mut self, element: Element) {
        self.description.elements.push(element);
    }

    /// Names the frame reached so far. The last frame named is the tip.
    pub fn link(&mut self, name: impl Into<String>) {
        self.push(Element::Link(name.into()));
    }

    /// Checks the description and builds the robot.
    ///
    /// # Errors
    /// [`Error::InvalidRobot`](crate::Error::InvalidRobot) for no joints, too many, or a joint or link named twice;
    /// [`Error::EmptyRange`](crate::Error::EmptyRange), [`Error::NegativeLimit`](crate::Error::NegativeLimit) or
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for impossible limits;
    /// [`Error::NotFinite`](crate::Error::NotFinite) for transforms.
    pub fn build(self) -> Result<Robot> {
        Robot::new(self.description)
    }
}
