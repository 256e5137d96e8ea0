//! The fastest motion of an arm from one state to another.

use super::arm_state::ArmState;
use super::synchronised::Synchronised;
use crate::error::{Error, Result};
use crate::limits::{Field, Limits, ROUNDING, StartSlack, TipField};
use crate::math::one_joint::{MotionState, Rates, Transfer};
use crate::trajectory::Trajectory;
use crate::wording::number;

const METHOD: &str = "state_to_state";

/// Returns the quickest motion from one state to another within constant `limits`, in which all joints arrive together.
///
/// A joint whose initial velocity or acceleration is outside its limits, or about to leave them, first returns inside
/// them as quickly as its jerk limit (or acceleration limit) allows. Without a jerk limit, accelerations may jump and
/// those given have no effect; without acceleration and jerk limits, nor have the velocities.
///
/// # Errors
/// [`Error::WrongLength`] and [`Error::NotFinite`] for the states, [`Error::UnsupportedLimit`] for limits that vary over
/// time, [`Error::OutOfRange`] for limits of zero, [`Error::NoPace`] for a joint without any,
/// [`Error::OutsideLimits`] for positions outside their limits, [`Error::Infeasible`] for a final state that cannot be
/// reached inside the limits or a motion that leaves the position limits, [`Error::InvalidTrajectory`] for states that
/// are the same.
pub fn state_to_state(from: &ArmState, to: &ArmState, limits: &Limits) -> Result<Trajectory> {
    state_to_state_from(from, to, limits, &StartSlack::default())
}

/// [`state_to_state`] from a start up to `slack` outside the position limits, which is led inside.
///
/// # Errors
/// As [`state_to_state`].
pub fn state_to_state_from(from: &ArmState, to: &ArmState, limits: &Limits, slack: &StartSlack) -> Result<Trajectory> {
    let joints = limits.joint_names();
    from.check("start", joints)?;
    to.check("end", joints)?;
    let rates = rates(limits)?;
    let from = &ArmState { q: limits.admit_start(None, "start_q", &from.q, slack)?.q, ..from.clone() };
    let to = &ArmState { q: limits.admit(None, "end_q", &to.q)?, ..to.clone() };
    for (j, rates) in rates.iter().enumerate() {
        require_reachable(&joints[j], &to.joint(j), rates)?;
    }
    let transfers = |(j, rates): (usize, &Rates)| Transfer::new(from.joint(j), to.joint(j), rates);
    let transfers: Vec<Transfer> = rates.iter().enumerate().map(transfers).collect();
    let Some(motion) = Synchronised::fastest(&transfers) else {
        return Err(Error::Infeasible { problem: "no motion within the limits connects the two states".into() });
    };
    if motion.duration() == 0.0 {
        let problem =
            "start_q and end_q, with their velocities and accelerations, are the same state: nothing moves".into();
        return Err(Error::InvalidTrajectory { problem });
    }
    require_room(limits, &from.q, &motion)?;
    motion.trajectory(joints.to_vec()).map_err(|_| too_long(&motion))
}

/// The error of a motion in whose duration rounding hides the shortest phases.
fn too_long(motion: &Synchronised) -> Error {
    let duration = number(motion.duration());
    let problem = format!(
        "the motion would take {duration} s, and times that long do not resolve its shortest phases: give limits of more \
         similar size"
    );
    Error::Infeasible { problem: problem.into() }
}

/// Returns a motion from one state to another that lasts `duration` (s); `None` if there is none within constant
/// `limits`.
pub(crate) fn meet(from: &ArmState, to: &ArmState, limits: &Limits, duration: f64) -> Option<Trajectory> {
    let joints = limits.joint_names();
    let rates = rates(limits).ok()?;
    let transfer = |(j, rates): (usize, &Rates)| {
        require_reachable(&joints[j], &to.joint(j), rates).ok()?;
        Some(Transfer::new(from.joint(j), to.joint(j), rates))
    };
    let transfers: Vec<Transfer> = rates.iter().enumerate().map(transfer).collect::<Option<_>>()?;
    let motion = Synchronised::lasting(&transfers, duration)?;
    require_room(limits, &from.q, &motion).ok()?;
    motion.trajectory(joints.to_vec()).ok()
}

/// Returns the stop of each joint as quickly as constant `limits` allow. A joint that is outside its limits, or about to
/// leave them, first returns inside them.
///
/// # Errors
/// As [`state_to_state`]; [`Error::InvalidTrajectory`] for an arm at rest.
pub fn stop(from: &ArmState, limits: &Limits) -> Result<Trajectory> {
    let joints = limits.joint_names();
    from.check("start", joints)?;
    let rates = rates(limits)?;
    let states: Vec<_> = (0..joints.len()).map(|j| from.joint(j)).collect();
    let motion = Synchronised::stop(&states, &rates).filter(|motion| motion.duration() > 0.0);
    let at_rest = || Error::InvalidTrajectory { problem: "the arm is at rest: nothing has to stop".into() };
    let motion = motion.ok_or_else(at_rest)?;
    require_room(limits, &from.q, &motion)?;
    motion.trajectory(joints.to_vec())
}

/// The limits of each joint on velocity, acceleration and jerk.
fn rates(limits: &Limits) -> Result<Vec<Rates>> {
    limits.refuse_tips(&TipField::ALL, METHOD, "use plan_point_to_point, because here each joint has its own time")?;
    limits.refuse_torque(METHOD, "use plan_point_to_point, because here each joint has its own time")?;
    limits.validate(0.0, 0)?;
    let constants = |field: Field| -> Result<Vec<f64>> {
        let mut values = limits.constants(field, METHOD, "give numbers")?;
        values.resize(limits.dof(), f64::INFINITY);
        Ok(values)
    };
    let [velocity, acceleration, jerk] =
        [constants(Field::Velocity)?, constants(Field::Acceleration)?, constants(Field::Jerk)?];
    constants_of_position(limits)?;
    limits.require_unlocked()?;
    limits.require_pace()?;
    let of_joint = |j: usize| Rates { velocity: velocity[j], acceleration: acceleration[j], jerk: jerk[j] };
    Ok((0..limits.dof()).map(of_joint).collect())
}

/// Checks that the position limits do not vary over time.
fn constants_of_position(limits: &Limits) -> Result<()> {
    [Field::Lower, Field::Upper]
        .into_iter()
        .try_for_each(|field| limits.constants(field, METHOD, "give numbers").map(|_| ()))
}

/// Checks that a joint can get to its final state inside its limits.
fn require_reachable(joint: &str, to: &MotionState, rates: &Rates) -> Result<()> {
    let too_much = |value: f64, limit: f64| value.abs() > limit * (1.0 + ROUNDING);
    let refuse = |quantity: &str, value: f64, limit: f64| {
        let (value, limit) = (number(value), number(limit));
        let problem = format!("the final {quantity} of joint '{joint}' is {value}, its limit {limit}");
        Err(Error::Infeasible { problem: problem.into() })
    };
    if rates.acceleration.is_infinite() && rates.jerk.is_infinite() {
        return Ok(());
    }
    if too_much(to.v, rates.velocity) {
        return refuse("velocity (end_qd)", to.v, rates.velocity);
    }
    if rates.jerk.is_infinite() {
        return Ok(());
    }
    if too_much(to.a, rates.acceleration) {
        return refuse("acceleration (end_qdd)", to.a, rates.acceleration);
    }
    let before = to.v - 0.5 * to.a * to.a.abs() / rates.jerk;
    if too_much(before, rates.velocity) {
        let (before, limit) = (number(before), number(rates.velocity));
        let problem = format!(
            "to end with its velocity and acceleration (end_qd, end_qdd), joint '{joint}' would need a velocity of {before} \
             shortly before; its limit is {limit}"
        );
        return Err(Error::Infeasible { problem: problem.into() });
    }
    Ok(())
}

/// Checks that the motion stays inside the position limits. A joint whose `start` is outside goes no farther out.
fn require_room(limits: &Limits, start: &[f64], motion: &Synchronised) -> Result<()> {
    for (j, (lowest, highest)) in motion.ranges().enumerate() {
        let [lower, upper] = limits.position_range(j, 0.0, 0.0);
        let (lower, upper) = (lower.min(start[j]), upper.max(start[j]));
        let rounding = ROUNDING * lowest.abs().max(highest.abs()).max(1.0);
        let joint = limits.joint_name(j);
        for (position, limit, outside, side) in
            [(lowest, lower, lower - lowest, "lower"), (highest, upper, highest - upper, "upper")]
        {
            if outside > rounding {
                let (position, limit) = (number(position), number(limit));
                let problem = format!(
                    "joint '{joint}' would get to {position}, beyond its {side} limit {limit}: begin or end it slower, \
                     or farther from its limit"
                );
                return Err(Error::Infeasible { problem: problem.into() });
            }
        }
    }
    Ok(())
}
