//! Robot from the URDF joints between base and tip: adds the independent joints (entries of q, hence columns of the Jacobian)
//! in order, then the elements that they drive.

use std::collections::{HashMap, HashSet};

use super::document::{Document, UrdfKind};
use super::mimic::{self, Coupling, Couplings};
use super::off_chain::{self, MimicFollower};
use super::step;
use super::tree::{Tree, TreeStep};
use crate::error::{Error, Result};
use crate::robot::{ChainBuilder, Masses, Robot, require_supported};

/// Builds the robot whose chain leads from link `base` to the first of `tips`. All other links become branches; branches to
/// further tips keep their joints.
pub(super) fn build<'a>(document: &'a Document, tree: &Tree<'a>, base: &'a str, tips: &[&'a str]) -> Result<Robot> {
    let Some((tip, further)) = tips.split_first() else {
        return Err(Error::Urdf { line: None, problem: "no tip".into() });
    };
    let path = tree.path(base, tip)?;
    let joints = &document.joints;
    let mut moving = moving_on(document, &path);
    if moving.is_empty() {
        let problem = format!("no joint moves between base '{base}' and tip '{tip}'");
        return Err(Error::Urdf { line: None, problem: problem.into() });
    }
    for tip in further {
        let beside = moving_on(document, &tree.path(base, tip)?);
        moving.extend(beside.into_iter().filter(|joint| !moving.contains(joint)).collect::<Vec<_>>());
    }
    require_supported(&document.name, moving.len())?;
    let mut chain = ChainBuilder::new(&document.name, base);
    let mut couplings = Couplings::new(document);
    let index_in_q = add_joints(&mut chain, document, &mut couplings, &moving)?;
    let on_chain = narrow_joints(&mut chain, document, &mut couplings, (&index_in_q, &moving))?;
    for at in &path {
        let moved = match joints[at.joint].kind {
            UrdfKind::Fixed => None,
            _ => {
                let Coupling { master, drive } = couplings.of(at.joint)?;
                Some(step::DrivenJoint { joint: index_in_q[&master], kind: step::kind(document, at.joint)?, drive })
            }
        };
        step::elements(document, *at, moved)?.into_iter().for_each(|element| chain.push(element));
        chain.link(step::far_link(document, *at));
    }
    let robot = chain.build()?;
    let (off_chain, beside) = off_chain::of(document, tree, &robot, couplings, (&index_in_q, &moving))?;
    let robot = robot.with_branches(off_chain, further.iter().map(|tip| (*tip).to_owned()).collect())?;
    with_masses(document, robot, &on_chain, &beside)
}

/// The robot with the limits of its joints narrowed by their mimic joints beside the chain.
fn narrowed_by(beside: &[MimicFollower], robot: Robot) -> Result<Robot> {
    if beside.is_empty() {
        return Ok(robot);
    }
    let mut problem = None;
    let robot = robot.with_limits(|index, joint| {
        for follower in beside.iter().filter(|follower| follower.master == index) {
            if let Err(found) = mimic::narrow(joint, &follower.joint, follower.drive) {
                problem.get_or_insert(found);
            }
        }
    })?;
    match problem {
        None => Ok(robot),
        Some(problem) => Err(Error::Urdf { line: None, problem: problem.into() }),
    }
}

/// Adds masses. Mimic joints on the chain and beside it have added their friction.
fn with_masses(
    document: &Document,
    robot: Robot,
    on_chain: &[MimicFollower],
    beside: &[MimicFollower],
) -> Result<Robot> {
    let robot = narrowed_by(beside, robot)?;
    let links: HashSet<&str> = robot.all_link_names().collect();
    let inertias = document.inertias.iter().filter(|known| links.contains(known.link.as_str()));
    let mut faults = document.faults.clone();
    for MimicFollower { joint, master, drive } in on_chain.iter().chain(beside) {
        faults.extend(mimic::curved_load(joint, *drive, &robot.joints()[*master].name));
    }
    let masses = Masses { links: inertias.cloned().collect(), faults, ..Masses::default() };
    Ok(robot.with_masses(masses))
}

/// Returns the moving joints of a path.
fn moving_on(document: &Document, path: &[TreeStep]) -> Vec<usize> {
    path.iter().map(|step| step.joint).filter(|joint| document.joints[*joint].kind != UrdfKind::Fixed).collect()
}

/// Adds the independent joints in the order of the chains, and returns the index in q of each independent joint of the document. A
/// master outside the chain takes the position of its first mimic joint.
fn add_joints(
    chain: &mut ChainBuilder,
    document: &Document,
    couplings: &mut Couplings,
    moving: &[usize],
) -> Result<HashMap<usize, usize>> {
    let mut index_in_q = HashMap::new();
    for &joint in moving {
        let master = couplings.of(joint)?.master;
        step::require_limit(document, master)?;
        let stands_here = master == joint || !moving.contains(&master);
        if stands_here && !index_in_q.contains_key(&master) {
            index_in_q.insert(master, chain.add_joint(step::described(document, master)?));
        }
    }
    Ok(index_in_q)
}

/// Narrows the limits of the independent joints by their mimic joints among `moving`, which it returns.
fn narrow_joints(
    chain: &mut ChainBuilder,
    document: &Document,
    couplings: &mut Couplings,
    (index_in_q, moving): (&HashMap<usize, usize>, &[usize]),
) -> Result<Vec<MimicFollower>> {
    let mut followers = vec![];
    for &number in moving {
        let Coupling { master, drive } = couplings.of(number)?;
        if master != number {
            let follower =
                MimicFollower { joint: step::described(document, number)?, master: index_in_q[&master], drive };
            mimic::narrow(chain.joint_mut(follower.master), &follower.joint, drive)
                .map_err(|problem| document.error_at(number, problem))?;
            followers.push(follower);
        }
    }
    Ok(followers)
}
