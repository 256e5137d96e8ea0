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
use crate::timing::{ConstantLimits, Violation};
use crate::trajectory::Trajectory;

/// Ratio of successive fractions of the accelerations and jerks with which an arm brakes or goes to the end, where limits forbid more.
const MILDER: f64 = 0.85;
/// Smallest of these fractions.
const MILDEST: f64 = 0.02;

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
    let limits = options.limits.clone().unwrap_or_else(|| Limits::of(search.robot)).of_joint_motion();
    let from = ArmState { q: q.clone(), qd: velocity.to_vec(), qdd: vec![0.0; q.len()] };
    let mut judge = Judge {
        limits: search.limits,
        sweep: space.map(|space| (ClearanceSweep::new(space.scene()), space.margin())),
        kept: (!options.keeps.is_empty()).then(|| KeepSweep::new(search.robot, &options.keeps)),
    };
    let pairs = search.pairs(PAIRS, monitor)?;
    if pairs.is_empty() {
        return Err(no_pair());
    }
    let rests = velocity.iter().all(|v| *v == 0.0);
    let stops = Stops::of(&from, &limits);
    let parts = if search.limits.limit_whole() && !rests { milder_parts() } else { vec![1.0] };
    for part in parts {
        if let Some((chosen, trajectory)) = direct(&from, &pairs, &limits.eased(part), &mut judge) {
            let clearance = judge.least_clearance(&trajectory)?;
            let plan = search.plan(trajectory, options.objective);
            return Ok(Beginning::Whole(Box::new(Plan { clearance, chosen_end: Some(chosen), ..plan })));
        }
        if let Some(braking) = stops.with(part).find(|braking| judge.admits(braking)) {
            return Ok(Beginning::Stop(braking));
        }
    }
    if rests {
        return Ok(Beginning::Rest);
    }
    let fastest = stop(&from, &limits)?;
    Err(judge.no_stop(fastest, &stops))
}

/// Stops of an arm in motion: each joint as quickly as it can, and all together on a straight line.
struct Stops<'a> {
    from: &'a ArmState,
    limits: [Limits; 2],
}

impl<'a> Stops<'a> {
    fn of(from: &'a ArmState, limits: &Limits) -> Self {
        Self { from, limits: [limits.clone(), limits.in_proportion(&from.qd)] }
    }

    /// The stops with this part of the accelerations and jerks; none for an arm at rest.
    fn with(&self, part: f64) -> impl Iterator<Item = Trajectory> {
        let stop_within = move |limits: &Limits| stop(self.from, &limits.eased(part)).ok();
        self.limits.iter().filter_map(stop_within)
    }
}

/// Parts of the accelerations and jerks with which an arm brakes or goes to the end, all of them first.
fn milder_parts() -> Vec<f64> {
    std::iter::successors(Some(1.0), |part| Some(MILDER * part)).take_while(|part| *part >= MILDEST).collect()
}

/// The quickest motion to one of these ends that the judge admits, and the index of the end.
fn direct(from: &ArmState, pairs: &[EndPair], limits: &Limits, judge: &mut Judge<'_>) -> Option<(usize, Trajectory)> {
    let motion = |end: &[f64]| state_to_state_from(from, &ArmState::at_rest(end), limits, &StartSlack::any()).ok();
    let to_end = |pair: &EndPair| Some((pair.chosen, motion(&pair.end)?));
    let mut motions: Vec<(usize, Trajectory)> = pairs.iter().filter_map(to_end).collect();
    motions.sort_by(|one, other| one.1.duration().total_cmp(&other.1.duration()));
    motions.into_iter().find(|(_, motion)| judge.admits(motion))
}

/// Judge of motions by what [`state_to_state_from`] does not know: limits of tips and torques, obstacles, and what is to be kept.
struct Judge<'a> {
    limits: &'a ConstantLimits,
    sweep: Option<(ClearanceSweep<'a>, f64)>,
    kept: Option<KeepSweep<'a>>,
}

impl Judge<'_> {
    fn admits(&mut self, motion: &Trajectory) -> bool {
        self.limits.keep_whole(motion)
            && self
                .kept
                .as_mut()
                .is_none_or(|kept| kept.check(&TimedMotion::new(motion), [0.0, motion.duration()]).is_ok())
            && self.sweep.as_mut().is_none_or(|(sweep, margin)| certify(sweep, motion, *margin).is_ok())
    }

    /// Smallest distance from obstacles, if there are any.
    fn least_clearance(&mut self, motion: &Trajectory) -> Result<Option<Clearance>> {
        let Some((sweep, margin)) = &mut self.sweep else { return Ok(None) };
        Ok(least_clearance(sweep, motion, Some(*margin))?.map(|(clearance, _)| clearance))
    }

    /// The error where none of these stops is admitted, not even the `fastest`.
    fn no_stop(&self, fastest: Trajectory, stops: &Stops<'_>) -> Error {
        let parts = if self.limits.limit_whole() { milder_parts() } else { vec![] };
        let milder = parts.into_iter().flat_map(|part| stops.with(part));
        let share = |found: &Violation| (found.value / found.bound).abs();
        let worst = |motion: Trajectory| {
            let found = self.limits.whole_violations(&motion);
            found.into_iter().max_by(|one, other| share(one).total_cmp(&share(other)))
        };
        // A stop within these limits is forbidden by what is around the arm.
        let found: Option<Vec<Violation>> = std::iter::once(fastest).chain(milder).map(worst).collect();
        let mildest = found.and_then(|all| all.into_iter().min_by(|one, other| share(one).total_cmp(&share(other))));
        let why = match mildest {
            Some(violation) => {
                format!(" the arm cannot stop within the limits of its tips or torques: in the easiest stop found, {violation}")
            }
            None if self.kept.is_none() => {
                " the arm cannot stop before it comes nearer to an obstacle than the margin".into()
            }
            None => " the arm cannot stop before it comes nearer to an obstacle than the margin, or breaks what is to be kept"
                .into(),
        };
        Error::Infeasible { problem: message!["at ", Setting::StartVelocity, why] }
    }
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
