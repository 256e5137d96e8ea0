//! The description of a robot: independent joints, and the elements of its chain from base to tip.

use std::collections::HashSet;
use std::ops::Range;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::joint::{Joint, JointKind};
use crate::error::{Error, Result, require_finite};
use crate::kinematics::RotationVector;
use crate::kinematics::chain::{Chain, ChainFolder, Transmission};
use crate::math::{MAX_DOF, Pose, pose};

/// Squares of longer lengths (m) are not finite.
const LONGEST: f64 = 1e150;

/// One element between base and tip, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Element {
    /// A constant transform.
    Fixed(Pose),
    /// A motion by `scale * q[joint] + offset`.
    Moving {
        /// Axis of the motion, of unit length.
        axis: Vector3<f64>,
        /// True for a rotation (rad), false for a translation (m).
        turns: bool,
        /// The independent joint that drives it.
        joint: usize,
        /// Factor on q.
        scale: f64,
        /// Constant added (rad or m).
        offset: f64,
    },
    /// Names the frame reached so far.
    Link(String),
    /// A rotation by the vector (rad) whose entries are this independent joint and the two that follow it; one at most.
    RotationVector {
        /// The first of the three.
        joint: usize,
    },
    /// A motion by a polynomial of `q[joint]`, which needs position limits.
    Curved {
        /// Axis of the motion, of unit length.
        axis: Vector3<f64>,
        /// True for a rotation (rad), false for a translation (m).
        turns: bool,
        /// The independent joint that drives it.
        joint: usize,
        /// Coefficients of the polynomial (rad or m, by ascending powers of rad or m). From a little beyond the limits of the joint on it follows
        /// its tangents.
        polynomial: [f64; 5],
    },
}

/// Drive of a moving element by an independent joint at q: `scale * q + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Factor on q: a mimic joint's multiplier, or -1 for a joint passed from child to parent.
    pub scale: f64,
    /// Constant added (rad or m).
    pub offset: f64,
}

impl Drive {
    /// Follows the joint directly.
    pub const DIRECT: Self = Self { scale: 1.0, offset: 0.0 };
}

/// Name, independent joints in the order of q, and elements from base to tip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Description {
    pub name: String,
    pub joints: Vec<Joint>,
    pub elements: Vec<Element>,
}

/// Err for more moving joints than the kernels hold.
pub(crate) fn require_supported(robot: &str, moving: usize) -> Result<()> {
    if moving <= MAX_DOF {
        return Ok(());
    }
    let problem = format!("{moving} moving joints between base and tip; at most {MAX_DOF} are supported");
    Err(Error::InvalidRobot { robot: robot.into(), problem: problem.into() })
}

impl Description {
    /// Names of the links, base to tip.
    pub fn link_names(&self) -> impl Iterator<Item = &str> {
        self.elements.iter().filter_map(|element| match element {
            Element::Link(name) => Some(name.as_str()),
            Element::Fixed(_) | Element::Moving { .. } | Element::RotationVector { .. } | Element::Curved { .. } => {
                None
            }
        })
    }

    /// The chain between `base` and `tool`, in the form used by the kernels.
    pub fn folded(&self, base: &Pose, tool: &Pose) -> Chain {
        let mut chain = ChainFolder::new(base);
        for element in &self.elements {
            match element {
                Element::Fixed(transform) => chain.fixed(transform),
                Element::Link(_) => chain.link(),
                Element::RotationVector { joint } => chain.rotation_vector(*joint),
                Element::Curved { axis, turns, joint, polynomial } => {
                    chain.curved(axis, *joint, *turns, &self.joints[*joint].curve(polynomial));
                }
                // A follower whose factor is zero stands still.
                Element::Moving { axis, turns, scale: 0.0, offset, .. } => chain.fixed(&moved(axis, *turns, *offset)),
                Element::Moving { axis, turns, joint, scale, offset } => {
                    let motion = if *turns { Transmission::turn } else { Transmission::slide };
                    chain.moving(axis, motion(*joint, *scale, *offset));
                }
            }
        }
        chain.finish(tool)
    }

    /// Checks all assumptions of the kernels.
    pub fn validate(&self) -> Result<()> {
        let invalid = |problem: String| Error::InvalidRobot { robot: self.name.clone(), problem: problem.into() };
        let moving: usize = self.elements.iter().map(Element::stages).sum();
        if moving == 0 || self.joints.is_empty() {
            return Err(invalid("no joint moves between base and tip".into()));
        }
        require_supported(&self.name, moving.max(self.joints.len()))?;
        let length = self.elements.iter().map(Element::length).sum::<f64>();
        if !(length <= LONGEST) {
            return Err(invalid(format!("its links are {length:e} m long together, more than {LONGEST:e} m")));
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
            Element::Link(name) if !links.insert(name) => Err(invalid(format!("two links are named '{name}'"))),
            _ => {
                element.validate(&self.name, |joint| self.joints.get(joint).map(|driver| driver.name.as_str()))?;
                element.require_bounded(&self.name, &self.joints)
            }
        })
    }
}

/// A turn about `axis` (rad), or a slide along it (m).
pub(super) fn moved(axis: &Vector3<f64>, turns: bool, value: f64) -> Pose {
    if turns { pose::rotation(*axis, value) } else { pose::translation(value * axis.x, value * axis.y, value * axis.z) }
}

impl Element {
    /// A motion about or along `axis` (any length but zero), driven by joint `joint`.
    pub(crate) fn moving(joint: usize, kind: JointKind, axis: Vector3<f64>, drive: Drive) -> Self {
        let Drive { scale, offset } = drive;
        Self::Moving { axis: axis.normalize(), turns: kind.turns(), joint, scale, offset }
    }

    /// The independent joints that drive it.
    pub(super) fn drivers(&self) -> Range<usize> {
        match self {
            Self::Fixed(_) | Self::Link(_) => 0..0,
            Self::Moving { joint, .. } | Self::Curved { joint, .. } => *joint..joint + 1,
            Self::RotationVector { joint } => *joint..joint + 3,
        }
    }

    /// Whether a joint moves it.
    pub(crate) fn moves(&self) -> bool {
        self.stages() > 0
    }

    /// The first joint that drives it.
    pub(crate) fn first_driver(&self) -> Option<usize> {
        self.drivers().next()
    }

    /// Largest displacement of the chain along an axis (m): finite where the square of the length is not.
    fn length(&self) -> f64 {
        if let Self::Fixed(transform) = self { transform.translation.vector.amax() } else { 0.0 }
    }

    /// Number of stages that it becomes.
    fn stages(&self) -> usize {
        match self {
            Self::Fixed(_) | Self::Link(_) | Self::Moving { scale: 0.0, .. } => 0,
            Self::Moving { .. } => 1,
            Self::RotationVector { .. } => RotationVector::STAGES,
            Self::Curved { .. } => 2,
        }
    }

    /// Copy of the element in a robot that has `shift` more joints before its own.
    pub(super) fn shifted(mut self, shift: usize) -> Self {
        if let Self::Moving { joint, .. } | Self::Curved { joint, .. } | Self::RotationVector { joint } = &mut self {
            *joint += shift;
        }
        self
    }

    /// Err for a polynomial whose slope is not bounded, where one of `joints` drives it.
    pub(super) fn require_bounded(&self, robot: &str, joints: &[Joint]) -> Result<()> {
        let Self::Curved { joint, polynomial, .. } = self else { return Ok(()) };
        let Some(leader) = joints.get(*joint).filter(|leader| !leader.curve(polynomial).is_bounded()) else {
            return Ok(());
        };
        let name = &leader.name;
        let problem = format!("a joint follows joint '{name}' by a polynomial: give '{name}' position limits");
        Err(Error::InvalidRobot { robot: robot.into(), problem: problem.into() })
    }

    /// Checks the assumptions of the kernels; `driver` names the joint of an index.
    pub(super) fn validate<'a>(&self, robot: &str, driver: impl Fn(usize) -> Option<&'a str>) -> Result<()> {
        let invalid = |problem: String| Error::InvalidRobot { robot: robot.into(), problem: problem.into() };
        let driven = |joint: usize, axis: &Vector3<f64>| {
            let Some(driver) = driver(joint) else {
                return Err(invalid(format!("a moving element is driven by joint {joint}, which does not exist")));
            };
            if !((axis.norm() - 1.0).abs() < 1e-9) {
                return Err(invalid(format!("joint '{driver}' has a zero or non-finite axis")));
            }
            Ok(driver)
        };
        match self {
            Self::Fixed(transform) => pose::checked("fixed transform", *transform).map(|_| ()),
            Self::Link(_) => Ok(()),
            Self::RotationVector { joint } => match driver(joint + 2) {
                Some(_) => Ok(()),
                None => Err(invalid(format!("joints {joint} to {} of a rotation vector do not exist", joint + 2))),
            },
            Self::Moving { axis, joint, scale, offset, .. } => {
                let driver = driven(*joint, axis)?;
                require_finite("scale and offset of a joint", &[*scale, *offset], |_| format!("joint '{driver}'"))
            }
            Self::Curved { axis, joint, polynomial, .. } => {
                let driver = driven(*joint, axis)?;
                require_finite("coefficients of a polynomial coupling", polynomial, |_| format!("joint '{driver}'"))
            }
        }
    }
}
