//! Conversion of one URDF joint to elements of a robot, in either direction.

use nalgebra::Vector3;

use super::document::{Document, UrdfKind};
use super::inertial::JointLoad;
use super::mimic::MimicDrive;
use super::tree::TreeStep;
use crate::error::Result;
use crate::math::{Pose, pose};
use crate::robot::{Element, Joint, JointKind};

/// Motion of a joint: the robot joint that drives it, its kind and its drive.
pub(super) struct DrivenJoint {
    pub(super) joint: usize,
    pub(super) kind: JointKind,
    pub(super) drive: MimicDrive,
}

/// Returns the elements of one joint; `moved` is `None` for a joint that does not move. A reversed joint is the inverse: the
/// motion by -q first, then the inverse of its origin.
pub(super) fn elements(document: &Document, step: TreeStep, moved: Option<DrivenJoint>) -> Result<Vec<Element>> {
    let origin = origin(document, step.joint);
    let sign = if step.reversed { -1.0 } else { 1.0 };
    let motion = match moved {
        None => None,
        Some(DrivenJoint { joint, kind, drive }) => {
            let axis = axis(document, step.joint)?;
            Some(match drive.times(sign, 0.0) {
                MimicDrive::Linear(drive) => Element::moving(joint, kind, axis, drive),
                MimicDrive::Polynomial(polynomial) => {
                    Element::Curved { axis: axis.normalize(), turns: kind.turns(), joint, polynomial }
                }
            })
        }
    };
    Ok(match step.reversed {
        false => [Element::Fixed(origin)].into_iter().chain(motion).collect(),
        true => motion.into_iter().chain([Element::Fixed(origin.inverse())]).collect(),
    })
}

/// Returns a moving joint with its own limits.
pub(super) fn described(document: &Document, index: usize) -> Result<Joint> {
    let joint = &document.joints[index];
    let kind = kind(document, index)?;
    let [rated_acceleration, rated_jerk] = joint.rated;
    let JointLoad { effort, damping, friction, armature } = joint.load;
    let described = Joint {
        rated_acceleration,
        rated_jerk,
        rated_torque: effort,
        damping,
        friction,
        armature,
        ..Joint::new(&joint.name, kind).with_velocity(joint.velocity)
    };
    match kind {
        JointKind::Continuous => Ok(described),
        _ => Ok(described.with_range(joint.range.0, joint.range.1)),
    }
}

/// Checks that an independent revolute or prismatic joint has an element `limit`, as URDF requires. Followers have the limits of their
/// masters.
///
/// # Errors
/// [`Error::Urdf`](crate::Error::Urdf) with the line of the joint.
pub(super) fn require_limit(document: &Document, index: usize) -> Result<()> {
    let joint = &document.joints[index];
    let (kind, remedy) = match joint.kind {
        _ if joint.has_limit => return Ok(()),
        UrdfKind::Revolute => ("revolute", "give lower and upper, or write <joint type=\"continuous\">"),
        UrdfKind::Prismatic => ("prismatic", "give lower and upper, perhaps -inf and inf"),
        _ => return Ok(()),
    };
    let problem = format!("joint '{}' is {kind} and has no <limit>, which URDF requires: {remedy}", joint.name);
    Err(document.error_at(index, problem))
}

pub(super) fn kind(document: &Document, index: usize) -> Result<JointKind> {
    let joint = &document.joints[index];
    match joint.kind {
        UrdfKind::Revolute if joint.range == (f64::NEG_INFINITY, f64::INFINITY) => Ok(JointKind::Continuous),
        UrdfKind::Revolute => Ok(JointKind::Revolute),
        UrdfKind::Continuous => Ok(JointKind::Continuous),
        UrdfKind::Prismatic => Ok(JointKind::Prismatic),
        _ => {
            let (name, kind) = (&joint.name, format!("{:?}", joint.kind).to_lowercase());
            let problem = format!(
                "joint '{name}' is {kind}, and a chain takes only revolute, continuous, prismatic, fixed and mimic \
                 joints: take base and tip on one side of it, a base from '{}' on or a tip up to '{}'",
                joint.child, joint.parent
            );
            Err(document.error_at(index, problem))
        }
    }
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
    // Scaled to largest entry one: the axis may have any length, and squares of tiny or huge numbers must not vanish or
    // overflow.
    Ok(axis / largest)
}

/// Returns the link at the far end of a step.
pub(super) fn far_link(document: &Document, step: TreeStep) -> &str {
    let joint = &document.joints[step.joint];
    if step.reversed { &joint.parent } else { &joint.child }
}
