//! Motions with an initial velocity: directly to the end, or to a stop from which a plan from rest continues.

use super::end_pair::EndPair;
use super::pair_search::PairSearch;
use super::straight_line_plan::{PAIRS, no_pair};
use crate::constraint::{KeepSweep, refuse_broken};
use crate::error::{Error, Result, require_finite};
use crate::limits::{Limits, ROUNDING, StartSlack};
use crate::message::{Setting, message};
use crate::motion::{ArmState, state_to_state_from, stop};
use crate::obstacle::{ClearSpace, Clearance, ClearanceSweep};
use crate::plan::{EndName, Endpoint, Plan, PointToPointOptions, TimedMotion, certify, joined, least_clearance};
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::trajectory::Trajectory;

/// Continuation of a motion with an initial velocity.
pub(super) enum Beginning {
    /// Directly to the end.
    Whole(Box<Plan>),
    /// A stop, because no direct motion was found to be free.
    Stop(Trajectory),
    /// A start from rest: the velocity is zero, and no direct motion was found to be free.
    Rest,
}

/// Plans the quickest motion from the given configuration and `velocity` directly to the end, or to a stop.
///
/// # Errors
/// [`Error::Contradiction`] without a configuration at the start, [`Error::WrongLength`], [`Error::NotFinite`];
/// [`Error::Infeasible`] if the joints cannot stop inside their limits or before an obstacle.
pub(super) fn begin(
    search: &mut PairSearch,
    velocity: &[f64],
    space: Option<&ClearSpace<'_>>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Beginning> {
    let Endpoint::Configuration(q) = search.start else {
        return Err(Error::Contradiction {
            problem: message![
                Setting::StartVelocity,
                " needs the configuration of the start: give ",
                Setting::StartConfiguration
            ],
        });
    };
    check(search, velocity)?;
    refuse_broken(&EndName::Start.of_configuration(), &options.keeps, search.robot, q)?;
    let taken = StartSlack::any();
    // Motions of state_to_state know nothing of tips and torques; those that keep their limits are taken.
    let limits = options.limits.clone().unwrap_or_else(|| Limits::of(search.robot)).of_joint_motion();
    let constant = search.limits;
    let from = ArmState { q: q.clone(), qd: velocity.to_vec(), qdd: vec![0.0; q.len()] };
    let mut sweep = space.map(|space| (ClearanceSweep::new(space.scene()), space.margin()));
    let mut kept = (!options.keeps.is_empty()).then(|| KeepSweep::new(search.robot, &options.keeps));
    let mut is_free = |motion: &Trajectory| {
        let whole = [0.0, motion.duration()];
        constant.keep_whole(motion)
            && kept.as_mut().is_none_or(|kept| kept.check(&TimedMotion::new(motion), whole).is_ok())
            && sweep.as_mut().is_none_or(|(sweep, margin)| certify(sweep, motion, *margin).is_ok())
    };
    let pairs = search.pairs(PAIRS, monitor)?;
    let last = pairs.first().ok_or_else(no_pair)?;
    let direct = |end: &[f64]| state_to_state_from(&from, &ArmState::at_rest(end), &limits, &taken).ok();
    let to_end = |pair: &EndPair| Some((pair.chosen, direct(&pair.end)?));
    let mut motions: Vec<(usize, Trajectory)> = pairs.iter().chain([last]).filter_map(to_end).collect();
    motions.sort_by(|one, other| one.1.duration().total_cmp(&other.1.duration()));
    if let Some((chosen, trajectory)) = motions.into_iter().find(|(_, motion)| is_free(motion)) {
        let least = match &mut sweep {
            Some((sweep, margin)) => least_clearance(sweep, &trajectory, Some(*margin))?,
            None => None,
        };
        return Ok(Beginning::Whole(Box::new(Plan {
            clearance: least.map(|(clearance, _)| clearance),
            chosen_end: Some(chosen),
            ..search.plan(trajectory, options.objective)
        })));
    }
    if velocity.iter().all(|v| *v == 0.0) {
        return Ok(Beginning::Rest);
    }
    let braking = stop(&from, &limits)?;
    if is_free(&braking) {
        return Ok(Beginning::Stop(braking));
    }
    if !constant.keep_whole(&braking) {
        let problem =
            message!["at ", Setting::StartVelocity, " the arm cannot stop within the limits of its tips or torques"];
        return Err(Error::Infeasible { problem });
    }
    let problem = message![
        "at ",
        Setting::StartVelocity,
        if options.keeps.is_empty() {
            " the arm cannot stop before it comes nearer to an obstacle than the margin"
        } else {
            " the arm cannot stop before it comes nearer to an obstacle than the margin, or breaks what is to be kept"
        }
    ];
    Err(Error::Infeasible { problem })
}

/// Checks that the velocity fits the arm and its limits, and that it cannot simply jump.
fn check(search: &PairSearch, velocity: &[f64]) -> Result<()> {
    let limits = search.limits;
    if velocity.len() != limits.dof() {
        let expected = format!("{} joints", limits.dof());
        return Err(Error::WrongLength { what: Setting::StartVelocity.into(), expected, got: velocity.len() });
    }
    require_finite(Setting::StartVelocity, velocity, |j| format!("joint '{}'", limits.joint_name(j)))?;
    let jumps = |j: &usize| limits.acceleration[*j].is_infinite() && limits.jerk[*j].is_infinite();
    if let Some(j) = (0..limits.dof()).find(jumps) {
        return Err(Error::Infeasible {
            problem: message![
                format!(
                    "without an acceleration or jerk limit the velocity of joint '{}' may jump, and ",
                    limits.joint_name(j)
                ),
                Setting::StartVelocity,
                " means nothing: give ",
                Setting::Limit("acceleration"),
            ],
        });
    }
    match (0..limits.dof()).find(|j| velocity[*j].abs() > limits.velocity[*j] * (1.0 + ROUNDING)) {
        None => Ok(()),
        Some(j) => {
            let what = message![Setting::StartVelocity, format!(" of joint '{}'", limits.joint_name(j))];
            Err(Error::out_of_range(what, format!("at most its velocity limit {}", limits.velocity[j]), velocity[j]))
        }
    }
}

/// A plan from rest, preceded by the stop that leads to it.
pub(super) fn followed_by(stop: Trajectory, rest: Plan, robot: &Robot, space: Option<&ClearSpace<'_>>) -> Result<Plan> {
    // The stop keeps the margin.
    let at_least =
        |(rest, space): (&Clearance, &ClearSpace<'_>)| Clearance::at_least(rest.distance.min(space.margin()));
    let clearance = rest.clearance.as_ref().zip(space).map(at_least);
    let plan = joined(robot, Some(&stop), rest, None)?;
    Ok(Plan { clearance, ..plan })
}
