//! Mimic joints: each is driven by an independent joint, whose limits are narrowed by its followers.

use std::collections::HashSet;

use super::document::{Document, Mimic, UrdfKind};
use crate::error::{Error, Result, suggestion};
use crate::robot::{Drive, InertiaFault, Joint, JointKind};
use crate::wording::listed;

/// Independent joint that drives a joint (usually the joint itself), and the drive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coupling {
    pub(super) master: usize,
    pub(super) drive: MimicDrive,
}

/// Position of a joint by that of the joint that drives it.
#[derive(Debug, Clone, Copy)]
pub(super) enum MimicDrive {
    Linear(Drive),
    /// Coefficients by ascending powers.
    Polynomial([f64; 5]),
}

impl MimicDrive {
    pub(super) const DIRECT: Self = Self::Linear(Drive::DIRECT);

    /// The drive times `factor`, plus `constant`.
    pub(super) fn times(self, factor: f64, constant: f64) -> Self {
        match self {
            Self::Linear(Drive { scale, offset }) => {
                Self::Linear(Drive { scale: factor * scale, offset: factor * offset + constant })
            }
            Self::Polynomial(coefficients) => {
                let mut driven = coefficients.map(|c| factor * c);
                driven[0] += constant;
                Self::Polynomial(driven)
            }
        }
    }
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
        self.cached(coupling, &followers)
    }

    /// Resolves the coupling of a joint beside the chain: if the chain of `<mimic>` elements does not end in a movable joint, its last
    /// movable joint counts as independent.
    pub(super) fn of_off_chain(&mut self, joint: usize) -> Result<Coupling> {
        let mut followers = vec![];
        let movable = |joint: usize| self.document.joints[joint].kind.moves_one_way();
        match self.master_above(joint, &mut followers) {
            Ok(coupling) if movable(coupling.master) => self.cached(coupling, &followers),
            _ => {
                let last = followers.iter().rposition(|follower| movable(*follower)).unwrap_or(0);
                let master = followers.get(last).copied().unwrap_or(joint);
                let alone = Coupling { master, drive: MimicDrive::DIRECT };
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
                return Ok(Coupling { master: at, drive: MimicDrive::DIRECT });
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
    fn cached(&mut self, mut coupling: Coupling, followers: &[usize]) -> Result<Coupling> {
        for &follower in followers.iter().rev() {
            if let Some(mimic) = &self.document.joints[follower].mimic {
                if let Some(polynomial) = &mimic.polynomial {
                    coupling.drive = self.along(polynomial, follower, mimic, coupling)?;
                }
                coupling.drive = coupling.drive.times(mimic.multiplier, mimic.offset);
            }
            self.found[follower] = Some(coupling);
        }
        Ok(coupling)
    }

    /// Returns a polynomial of the joint that `coupling` drives as a function of its master.
    fn along(&self, polynomial: &[f64; 5], follower: usize, mimic: &Mimic, coupling: Coupling) -> Result<MimicDrive> {
        let joints = &self.document.joints;
        match coupling.drive {
            MimicDrive::Linear(drive) => Ok(MimicDrive::Polynomial(composed(polynomial, drive))),
            MimicDrive::Polynomial(_) => {
                let problem = format!(
                    "joint '{}' follows joint '{}' by a polynomial, which follows joint '{}' by a polynomial: at most one of both is \
                     followed",
                    joints[follower].name, mimic.joint, joints[coupling.master].name
                );
                Err(self.document.error_at(follower, problem))
            }
        }
    }
}

/// Returns the coefficients of p(scale q + offset) for those of p.
fn composed(coefficients: &[f64; 5], Drive { scale, offset }: Drive) -> [f64; 5] {
    coefficients.iter().rev().fold([0.0; 5], |sum, c| {
        let mut next = sum.map(|term| offset * term);
        (1..5).for_each(|power| next[power] += scale * sum[power - 1]);
        next[0] += c;
        next
    })
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
pub(super) fn narrow(master: &mut Joint, follower: &Joint, drive: MimicDrive) -> Result<(), String> {
    let Drive { scale, offset } = match drive {
        MimicDrive::Linear(drive) => drive,
        MimicDrive::Polynomial(polynomial) => return narrow_by_polynomial(master, follower, &polynomial),
    };
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

/// [`narrow`] for a follower by a polynomial, whose position limits its master has to keep already.
fn narrow_by_polynomial(master: &mut Joint, follower: &Joint, polynomial: &[f64; 5]) -> Result<(), String> {
    let curve = master.curve(polynomial);
    if !curve.is_bounded() {
        return Ok(()); // the robot is refused when it is complete
    }
    let (least, most) = curve.values(master.lower, master.upper);
    let rounding = 1e-9 * (1.0 + least.abs().max(most.abs()));
    if least < follower.lower - rounding || most > follower.upper + rounding {
        return Err(format!(
            "mimic joint '{}' moves from {least} to {most} while '{}', which it follows by a polynomial, is inside its limits, and \
             leaves its own, [{}, {}]: narrow the limits of '{}'",
            follower.name, master.name, follower.lower, follower.upper, master.name
        ));
    }
    if follower.rated_acceleration.is_finite() || follower.rated_jerk.is_finite() {
        return Err(format!(
            "mimic joint '{}' follows '{}' by a polynomial: limits of its acceleration and jerk are not followed",
            follower.name, master.name
        ));
    }
    let [steepest, _] = curve.largest();
    master.velocity = master.velocity.min(follower.velocity / steepest);
    Ok(())
}

/// Adds friction and rotor of a mimic joint, as its master feels them. The torque limit stays that of the master's motor.
fn reflect(master: &mut Joint, follower: &Joint, scale: f64) {
    master.damping += scale * scale * follower.damping;
    master.armature += scale * scale * follower.armature;
    master.friction += scale.abs() * follower.friction;
}

/// The reason why torques are not known: friction or rotor of a follower by a polynomial, whose reflection changes with its position.
pub(super) fn curved_load(follower: &Joint, drive: MimicDrive, master: &str) -> Option<InertiaFault> {
    let Joint { name, damping, friction, armature, .. } = follower;
    if matches!(drive, MimicDrive::Linear(_)) || [*damping, *friction, *armature] == [0.0; 3] {
        return None;
    }
    let problem = format!(
        "joint '{name}' follows '{master}' by a polynomial and has friction or a rotor of its own, which is not reflected: set damping, \
         friction and armature of '{name}' to zero"
    );
    Some(InertiaFault { owner: format!("joint '{name}'"), problem, point: None })
}
