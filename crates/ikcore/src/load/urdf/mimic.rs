//! Mimic joints: the independent joint that drives each, narrowed by the limits of its followers.

use super::document::{Document, UrdfKind};
use crate::error::{Error, Result, suggestion};
use crate::robot::{Drive, Joint, JointKind};
use crate::wording::listed;

/// The independent joint that drives a joint (usually the joint itself), and its drive.
pub(super) struct Coupling {
    pub(super) master: usize,
    pub(super) drive: Drive,
}

/// Follows `<mimic>` from joint to joint: value = multiplier * value of the mimicked joint + offset.
pub(super) fn coupling(document: &Document, joint: usize) -> Result<Coupling> {
    let joints = &document.joints;
    let mut coupling = Coupling { master: joint, drive: Drive::DIRECT };
    let mut passed = vec![joint];
    while let Some(mimic) = &joints[coupling.master].mimic {
        let follower = coupling.master;
        let master = joints.iter().position(|other| other.name == mimic.joint);
        let master = master.ok_or_else(|| unknown_target(document, follower, &mimic.joint))?;
        if passed.contains(&master) {
            let names: Vec<_> = passed.iter().chain([&master]).map(|index| joints[*index].name.as_str()).collect();
            return Err(document.error_at(follower, format!("mimic joints follow in a circle: {}", names.join(" -> "))));
        }
        passed.push(master);
        let (multiplier, offset) = (mimic.multiplier, mimic.offset);
        let Drive { scale, offset: constant } = coupling.drive;
        coupling = Coupling { master, drive: Drive { scale: scale * multiplier, offset: scale * offset + constant } };
    }
    if joints[coupling.master].kind == UrdfKind::Fixed {
        let (follower, master) = (&joints[joint].name, &joints[coupling.master].name);
        return Err(document.error_at(joint, format!("joint '{follower}' mimics '{master}', which is fixed")));
    }
    Ok(coupling)
}

fn unknown_target(document: &Document, follower: usize, target: &str) -> Error {
    let names = || document.joints.iter().map(|joint| joint.name.as_str());
    let (hint, known) = (suggestion(target, names()), listed(names()));
    let follower_name = &document.joints[follower].name;
    let problem = format!("joint '{follower_name}' mimics '{target}', which does not exist{hint}; joints: {known}");
    document.error_at(follower, problem)
}

/// Narrows the limits of the master so that its mimic joint `follower` keeps its own limits. The error explains an
/// empty range.
pub(super) fn narrow(master: &mut Joint, follower: &Joint, drive: Drive) -> Result<(), String> {
    let Drive { scale, offset } = drive;
    if scale == 0.0 {
        return Ok(());
    }
    let ends = [(follower.lower - offset) / scale, (follower.upper - offset) / scale];
    let [lower, upper] = if scale > 0.0 { ends } else { [ends[1], ends[0]] };
    if lower > master.upper || upper < master.lower {
        return Err(format!(
            "mimic joint '{}' allows its master '{}' only [{lower}, {upper}], which is outside [{}, {}]",
            follower.name, master.name, master.lower, master.upper
        ));
    }
    if master.kind == JointKind::Continuous && (lower.is_finite() || upper.is_finite()) {
        master.kind = JointKind::Revolute;
    }
    master.lower = master.lower.max(lower);
    master.upper = master.upper.min(upper);
    master.velocity = master.velocity.min(follower.velocity / scale.abs());
    Ok(())
}
