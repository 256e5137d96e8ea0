//! Links that branch off the chain, and held joints.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};

use super::description::{Description, Element, moved};
use super::joint::Joint;
use crate::error::{Error, Result, require_finite};
use crate::kinematics::chain::{Chain, Transmission};
use crate::kinematics::link_tree::{LinkTree, LinkTreeFolder};
use crate::math::polynomial;

/// A link that is not on the chain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct OffChainLink {
    pub name: String,
    /// Number of the link that it is fixed to or moves on: those of the chain come first, then the branches in order.
    pub parent: usize,
    /// From the parent to this link. Joints from n on are the held ones.
    pub elements: Vec<Element>,
}

/// A joint beside the chain, with its constant value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldJoint {
    /// The joint with its limits.
    pub joint: Joint,
    /// Its value (rad or m).
    pub value: f64,
}

/// The links that branch off the chain, parents first, and the joints that are held among them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct OffChain {
    pub links: Vec<OffChainLink>,
    pub held: Vec<HeldJoint>,
}

impl OffChain {
    /// All links of the robot, in the form used by the kernels; `chain` is folded from `description`.
    pub fn folded(&self, description: &Description, chain: &Chain) -> LinkTree {
        let dof = description.joints.len();
        let mut tree = LinkTreeFolder::new(chain);
        for link in &self.links {
            tree.start_at(link.parent);
            for element in &link.elements {
                match self.settled(element, dof) {
                    Element::Fixed(transform) => tree.fixed(&transform),
                    // A rotation vector stands at the start of the chain alone.
                    Element::Link(_) | Element::RotationVector { .. } => {}
                    Element::Curved { axis, turns, joint, polynomial } => {
                        tree.curved(&axis, joint, turns, &description.joints[joint].curve(&polynomial));
                    }
                    Element::Moving { axis, turns, joint, scale, offset } => {
                        let motion = if turns { Transmission::turn } else { Transmission::slide };
                        tree.moving(&axis, motion(joint, scale, offset));
                    }
                }
            }
            tree.link();
        }
        tree.finish()
    }

    /// An element of a robot with `dof` independent joints; constant if its joint is held.
    pub fn settled(&self, element: &Element, dof: usize) -> Element {
        if let Element::Moving { axis, turns, joint, scale, offset } = element
            && let Some(held) = self.held.get(joint.wrapping_sub(dof))
        {
            return Element::Fixed(moved(axis, *turns, scale * held.value + offset));
        }
        if let Element::Curved { axis, turns, joint, polynomial } = element
            && let Some(held) = self.held.get(joint.wrapping_sub(dof))
        {
            return Element::Fixed(moved(axis, *turns, polynomial::value(polynomial, held.value)));
        }
        element.clone()
    }

    /// The independent joints, then the held ones.
    fn all_joints<'a>(&'a self, description: &'a Description) -> impl Iterator<Item = &'a Joint> {
        description.joints.iter().chain(self.held.iter().map(|held| &held.joint))
    }

    /// Checks all assumptions of [`folded`](Self::folded).
    pub fn validate(&self, description: &Description) -> Result<()> {
        let invalid =
            |problem: String| Error::InvalidRobot { robot: description.name.clone(), problem: problem.into() };
        let mut names: HashSet<&str> = description.link_names().collect();
        let on_chain = names.len();
        let joints: Vec<&str> = self.all_joints(description).map(|joint| joint.name.as_str()).collect();
        for (i, link) in self.links.iter().enumerate() {
            if !names.insert(&link.name) {
                return Err(invalid(format!("two links are named '{}'", link.name)));
            }
            if link.parent >= on_chain + i {
                return Err(invalid(format!("link '{}' comes before its parent", link.name)));
            }
            let elements = &mut link.elements.iter();
            elements.try_for_each(|element| {
                element.validate(&description.name, |joint| joints.get(joint).copied())?;
                element.require_bounded(&description.name, &description.joints)
            })?;
        }
        self.held.iter().try_for_each(|held| {
            require_finite("held joints", &[held.value], |_| format!("joint '{}'", held.joint.name))
        })
    }
}
