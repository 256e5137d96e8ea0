//! Mimic joints: each is driven by an independent joint, whose limits are narrowed by its followers.

use std::collections::HashSet;

use super::document::{Document, UrdfKind};
use crate::error::{Error, Result, suggestion};
use crate::robot::{Drive, Joint, JointKind};
use crate::wording::listed;

/// Independent joint that drives a joint (usually the joint itself), and the drive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coupling {
    pub(super) master: usize,
    pub(super) drive: Drive,
}

/// Couplings of a document, with a cache.
pub(super) struct Couplings<'a> {
    document: &'a Document,
    found: Vec<Option<Coupling>>,
}

impl<'a> Couplings<'a> {
    pub(super) fn new(document: &'a Document) -> Self {
        Self { document, found: vec![None; document.joints.len()] }
    }

    /// Resolves a chain of `<mimic>` elements: value = multiplier * value of the mimicked joint + offset.
    pub(super) fn of(&mut self, joint: usize) -> Result<Coupling> {
        let mut followers = vec![];
        let coupling = self.master_above(joint, &mut followers)?;
        let joints = &self.document.joints;
        if joints[coupling.master].kind == UrdfKind::Fixed && coupling.master != joint {
            let (follower, master) = (&joints[joint].name, &joints[coupling.master].name);
            return Err(self.document.error_at(joint, format!("joint '{follower}' mimics '{master}', which is fixed")));
        }
        Ok(self.cached(coupling, &followers))
    }

    /// Resolves the coupling of a joint beside the chain, without errors: if the chain of `<mimic>` elements does not end in
    /// a movable joint, its last movable joint counts as independent.
    pub(super) fn of_off_chain(&mut self, joint: usize) -> Coupling {
        let mut followers = vec![];
        let movable = |joint: usize| self.document.joints[joint].kind.moves_one_way();
        match self.master_above(joint, &mut followers) {
            Ok(coupling) if movable(coupling.master) => self.cached(coupling, &followers),
            _ => {
                let last = followers.iter().rposition(|follower| movable(*follower)).unwrap_or(0);
                let alone = Coupling { master: followers.get(last).copied().unwrap_or(joint), drive: Drive::DIRECT };
                self.found[alone.master] = Some(alone);
                self.cached(alone, &followers[..last])
            }
        }
    }

    /// Returns the coupling of the first joint along the `<mimic>` elements that is independent or cached; `followers`
    /// collects the joints before it.
    fn master_above(&self, joint: usize, followers: &mut Vec<usize>) -> Result<Coupling> {
        let (document, mut at) = (self.document, joint);
        let mut passed = HashSet::new();
        loop {
            if let Some(coupling) = self.found[at] {
                return Ok(coupling);
            }
            passed.insert(at);
            let Some(mimic) = &document.joints[at].mimic else {
                return Ok(Coupling { master: at, drive: Drive::DIRECT });
            };
            followers.push(at);
            let next = document.joint_number(&mimic.joint);
            let next = next.ok_or_else(|| unknown_target(document, at, &mimic.joint))?;
            if passed.contains(&next) {
                let circle = followers.iter().chain([&next]).map(|index| document.joints[*index].name.as_str());
                let circle = circle.collect::<Vec<_>>().join(" -> ");
                return Err(document.error_at(at, format!("mimic joints follow in a circle: {circle}")));
            }
            at = next;
        }
    }

    /// Caches the couplings of `followers`, the last of which follows `coupling`, and returns the coupling of the first.
    fn cached(&mut self, mut coupling: Coupling, followers: &[usize]) -> Coupling {
        for &follower in followers.iter().rev() {
            if let Some(mimic) = &self.document.joints[follower].mimic {
                let Drive { scale, offset } = coupling.drive;
                let drive = Drive { scale: mimic.multiplier * scale, offset: mimic.multiplier * offset + mimic.offset };
                coupling.drive = drive;
            }
            self.found[follower] = Some(coupling);
        }
        coupling
    }
}

fn unknown_target(document: &Document, follower: usize, target: &str) -> Error {
    let names = || document.joints.iter().map(|joint| joint.name.as_str());
    let (hint, known) = (suggestion(target, names()), listed(names()));
    let follower_name = &document.joints[follower].name;
    let problem = format!("joint '{follower_name}' mimics '{target}', which does not exist{hint}; joints: {known}");
    document.error_at(follower, problem)
}

/// Narrows the limits of the master so that its mimic joint `follower` respects its own limits. The error explains an empty
/// range.
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
    reflect(master, follower, scale);
    for (own, rate) in [
        (&mut master.velocity, follower.velocity),
        (&mut master.rated_acceleration, follower.rated_acceleration),
        (&mut master.rated_jerk, follower.rated_jerk),
    ] {
        *own = own.min(rate / scale.abs());
    }
    Ok(())
}

/// Adds friction and rotor of a mimic joint, as its master feels them. The torque limit stays that of the master's motor.
pub(super) fn reflect(master: &mut Joint, follower: &Joint, scale: f64) {
    master.damping += scale * scale * follower.damping;
    master.armature += scale * scale * follower.armature;
    master.friction += scale.abs() * follower.friction;
}
