//! Links beside the chain: moved by chain joints through mimics, or attached by held joints.

use std::collections::HashMap;

use super::document::Document;
use super::mimic::{Couplings, MimicDrive};
use super::step::{self, DrivenJoint};
use super::tree::{Tree, TreeStep};
use crate::error::Result;
use crate::robot::{HeldJoint, Joint, OffChain, OffChainLink, Robot};

/// Mimic joint that follows an independent joint.
pub(super) struct MimicFollower {
    pub(super) joint: Joint,
    /// Index of its master in q.
    pub(super) master: usize,
    pub(super) drive: MimicDrive,
}

/// Returns the links that branch off the chain of `robot`, whose joints are `index_in_q`; joints in `moving` lead to a
/// further tip; and the mimic joints beside the chain that move. Other joints are held at zero, or at the limit nearest to zero; joints without a single axis stay in their
/// origin.
pub(super) fn of(
    document: &Document,
    tree: &Tree,
    robot: &Robot,
    mut couplings: Couplings,
    (index_in_q, moving): (&HashMap<usize, usize>, &[usize]),
) -> Result<(OffChain, Vec<MimicFollower>)> {
    let chain: Vec<&str> = robot.link_names().collect();
    let mut off_chain = OffChain::default();
    let mut drivers = index_in_q.clone();
    let mut followers = vec![];
    for (parent, at) in tree.off_chain(&chain) {
        let moved = match moving.contains(&at.joint) || moves(document, at) {
            false => None,
            true => {
                let coupling = couplings.of_off_chain(at.joint)?;
                let joint = match drivers.get(&coupling.master) {
                    Some(known) => *known,
                    None => {
                        let number = robot.dof() + off_chain.held.len();
                        drivers.insert(coupling.master, number);
                        off_chain.held.push(held(step::described(document, coupling.master)?));
                        number
                    }
                };
                if joint < robot.dof() && at.joint != coupling.master && !moving.contains(&at.joint) {
                    let described = step::described(document, at.joint)?;
                    followers.push(MimicFollower { joint: described, master: joint, drive: coupling.drive });
                }
                Some(DrivenJoint { joint, kind: step::kind(document, at.joint)?, drive: coupling.drive })
            }
        };
        let elements = step::elements(document, at, moved)?;
        off_chain.links.push(OffChainLink { name: step::far_link(document, at).into(), parent, elements });
    }
    Ok((off_chain, followers))
}

/// Whether a joint has exactly one axis.
fn moves(document: &Document, at: TreeStep) -> bool {
    let joint = &document.joints[at.joint];
    joint.kind.moves_one_way() && joint.axis != [0.0; 3]
}

/// Holds a joint at zero, or at the limit nearest to zero.
fn held(joint: Joint) -> HeldJoint {
    // Limits of a joint that never moves may be contradictory.
    let value = if joint.lower <= joint.upper { 0.0_f64.clamp(joint.lower, joint.upper) } else { 0.0 };
    HeldJoint { value, joint }
}
