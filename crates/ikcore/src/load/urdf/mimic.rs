//! Mimic joints: each is driven by an independent joint, whose limits are narrowed by its followers.

use std::collections::HashSet;

use super::document::{Document, UrdfKind};
use crate::error::{Error, Result, suggestion};
use crate::robot::{Drive, InertiaFault, Joint, JointCurve, JointKind};
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
    Polynomial(JointCurve),
}

impl MimicDrive {
    pub(super) const DIRECT: Self = Self::Linear(Drive::DIRECT);

    /// The drive times `factor`, plus `constant`.
    pub(super) fn times(self, factor: f64, constant: f64) -> Self {
        match self {
            Self::Linear(Drive { scale, offset }) => {
                Self::Linear(Drive { scale: factor * scale, offset: factor * offset + constant })
            }
            Self::Polynomial(curve) => Self::Polynomial(curve.driven(factor, constant)),
        }
    }
}

/// How far beyond the limits of its leader a polynomial holds: a start a little outside is led inside.
const SLACK: [f64; 2] = [0.2, 0.02];

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
        self.require_one_polynomial(joint)?;
        Ok(self.cached(coupling, &followers))
    }

    /// Err for a joint that follows another one by a polynomial, which follows a third one by a polynomial.
    pub(super) fn require_one_polynomial(&self, joint: usize) -> Result<()> {
        let (document, mut at, mut curved) = (self.document, joint, None);
        // Joints beside the chain may follow in a circle.
        for _ in 0..document.joints.len() {
            let Some(mimic) = &document.joints[at].mimic else { return Ok(()) };
            let Some(next) = document.joint_number(&mimic.joint) else { return Ok(()) };
            if mimic.polynomial.is_some()
                && let Some(first) = curved.replace(at)
            {
                let [outer, inner]: [&str; 2] = [first, at].map(|number: usize| document.joints[number].name.as_str());
                let problem = format!(
                    "joint '{outer}' follows joint '{inner}' by a polynomial, which follows another one by a polynomial: at most one of both is followed"
                );
                return Err(document.error_at(joint, problem));
            }
            at = next;
        }
        Ok(())
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

    /// Returns the polynomial of the joint that `coupling` drives, as a function of its master. A polynomial of another one stays as
    /// that one is: on the chain, [`require_one_polynomial`](Self::require_one_polynomial) has refused it.
    fn along(&self, coefficients: [f64; 5], Coupling { master, drive }: Coupling) -> MimicDrive {
        let joint = &self.document.joints[master];
        let slack = SLACK[usize::from(joint.kind == UrdfKind::Prismatic)];
        let range = [joint.range.0 - slack, joint.range.1 + slack];
        match drive {
            MimicDrive::Linear(drive) => {
                MimicDrive::Polynomial(JointCurve { coefficients: composed(&coefficients, drive), range })
            }
            MimicDrive::Polynomial(_) => drive,
        }
    }

    /// Caches the couplings of `followers`, the last of which follows `coupling`, and returns the coupling of the first.
    fn cached(&mut self, mut coupling: Coupling, followers: &[usize]) -> Coupling {
        for &follower in followers.iter().rev() {
            if let Some(mimic) = &self.document.joints[follower].mimic {
                if let Some(coefficients) = mimic.polynomial {
                    coupling.drive = self.along(coefficients, coupling);
                }
                coupling.drive = coupling.drive.times(mimic.multiplier, mimic.offset);
            }
            self.found[follower] = Some(coupling);
        }
        coupling
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
        MimicDrive::Polynomial(curve) => return narrow_by_curve(master, follower, &curve),
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
fn narrow_by_curve(master: &mut Joint, follower: &Joint, curve: &JointCurve) -> Result<(), String> {
    if curve.range.iter().any(|end| end.is_infinite()) {
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
    if steepest > 0.0 {
        master.velocity = master.velocity.min(follower.velocity / steepest);
    }
    Ok(())
}

/// Adds friction and rotor of a mimic joint, as its master feels them. The torque limit stays that of the master's motor.
pub(super) fn reflect(master: &mut Joint, follower: &Joint, scale: f64) {
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
