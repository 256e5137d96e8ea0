//! The robot from the URDF joints between base and tip: adds the independent joints (entries of q, hence columns of the
//! Jacobian) in order, then the elements of the chain that they drive.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::document::{Document, UrdfKind};
use super::mimic::{self, Coupling};
use super::tree::TreeStep;
use crate::error::{Error, Result};
use crate::math::{Pose, pose};
use crate::robot::{Bodies, ChainBuilder, Drive, Joint, JointKind, Robot, require_supported};

/// Builds the robot whose chain starts at link `base` and passes these joints.
pub(super) fn build(document: &Document, base: &str, path: &[TreeStep]) -> Result<Robot> {
    let joints = &document.joints;
    let moving: Vec<usize> =
        path.iter().map(|step| step.joint).filter(|joint| joints[*joint].kind != UrdfKind::Fixed).collect();
    if moving.is_empty() {
        let tip = path.last().map_or(base, |step| far_link(document, *step));
        let problem = format!("no joint moves between base '{base}' and tip '{tip}'");
        return Err(Error::Urdf { line: None, problem });
    }
    require_supported(&document.name, moving.len())?;
    let mut chain = ChainBuilder::new(&document.name, base);
    let index_in_q = add_joints(&mut chain, document, &moving)?;
    for step in path {
        append(&mut chain, document, *step, &index_in_q)?;
        chain.link(far_link(document, *step));
    }
    let robot = chain.build()?;
    let bodies = bodies(document, robot.link_names());
    Ok(robot.with_bodies(bodies))
}

/// Collects the capsules of the links with these names.
fn bodies<'a>(document: &Document, names: impl Iterator<Item = &'a str>) -> Bodies {
    let mut bodies = Bodies::default();
    for link in names.filter_map(|name| document.capsules.get(name)) {
        bodies.capsules.extend(link.capsules.iter().cloned());
        bodies.unread.extend(link.unread.iter().cloned());
    }
    bodies
}

/// Adds the independent joints in chain order, with limits narrowed by their mimic joints, and returns the index in q
/// of each independent joint of the document. A master outside the chain takes the position of its first mimic joint.
fn add_joints(chain: &mut ChainBuilder, document: &Document, moving: &[usize]) -> Result<HashMap<usize, usize>> {
    let mut index_in_q = HashMap::new();
    for &joint in moving {
        let master = mimic::coupling(document, joint)?.master;
        let stands_here = master == joint || !moving.contains(&master);
        if stands_here && !index_in_q.contains_key(&master) {
            index_in_q.insert(master, chain.add_joint(described(document, master)?));
        }
    }
    for &joint in moving {
        let Coupling { master, drive } = mimic::coupling(document, joint)?;
        if master != joint {
            let follower = described(document, joint)?;
            mimic::narrow(chain.joint_mut(index_in_q[&master]), &follower, drive)
                .map_err(|problem| document.error_at(joint, problem))?;
        }
    }
    Ok(index_in_q)
}

/// A moving joint with its own limits.
fn described(document: &Document, index: usize) -> Result<Joint> {
    let joint = &document.joints[index];
    let kind = kind(document, index)?;
    let described = Joint::new(&joint.name, kind).with_velocity(joint.velocity);
    match kind {
        JointKind::Continuous => Ok(described),
        _ => Ok(described.with_range(joint.range.0, joint.range.1)),
    }
}

fn kind(document: &Document, index: usize) -> Result<JointKind> {
    let joint = &document.joints[index];
    match joint.kind {
        UrdfKind::Revolute => Ok(JointKind::Revolute),
        UrdfKind::Continuous => Ok(JointKind::Continuous),
        UrdfKind::Prismatic => Ok(JointKind::Prismatic),
        _ => {
            let (name, kind) = (&joint.name, format!("{:?}", joint.kind).to_lowercase());
            let problem = format!(
                "joint '{name}' is {kind}, and a chain takes only revolute, continuous, prismatic, fixed and mimic \
                 joints: take base and tip on one side of it, such as base '{}'",
                joint.child
            );
            Err(document.error_at(index, problem))
        }
    }
}

/// Appends one joint. A reversed joint is the inverse: the motion by -q first, then the inverse of its origin.
fn append(
    chain: &mut ChainBuilder,
    document: &Document,
    step: TreeStep,
    index_in_q: &HashMap<usize, usize>,
) -> Result<()> {
    let origin = origin(document, step.joint);
    let sign = if step.reversed { -1.0 } else { 1.0 };
    if !step.reversed {
        chain.fixed(origin);
    }
    if document.joints[step.joint].kind != UrdfKind::Fixed {
        let Coupling { master, drive } = mimic::coupling(document, step.joint)?;
        let drive = Drive { scale: sign * drive.scale, offset: sign * drive.offset };
        chain.moving(index_in_q[&master], kind(document, step.joint)?, axis(document, step.joint)?, drive);
    }
    if step.reversed {
        chain.fixed(origin.inverse());
    }
    Ok(())
}

fn origin(document: &Document, joint: usize) -> Pose {
    let joint = &document.joints[joint];
    pose::from_rpy(joint.rpy, joint.xyz)
}

fn axis(document: &Document, index: usize) -> Result<Vector3<f64>> {
    let joint = &document.joints[index];
    let axis = Vector3::from(joint.axis);
    let largest = axis.amax();
    if largest == 0.0 {
        return Err(
            document.error_at(index, format!("axis of joint '{}' is zero: it must have a direction", joint.name))
        );
    }
    // The axis may have any length; squares of tiny or huge numbers must not vanish or overflow.
    Ok(axis / largest)
}

/// The link that a step leads to.
fn far_link(document: &Document, step: TreeStep) -> &str {
    let joint = &document.joints[step.joint];
    if step.reversed { &joint.parent } else { &joint.child }
}
