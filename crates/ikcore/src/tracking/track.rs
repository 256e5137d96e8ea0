//! Tracking of a whole path.

use super::approach_motion::ApproachMotion;
use super::record::Record;
use super::session::Session;
use super::track_options::TrackOptions;
use crate::error::{Error, Result};
use crate::ik::{Prefer, SolveOptions, solve};
use crate::kinematics::ReachShortfall;
use crate::limits::{Field, Limits, Profile};
use crate::manipulability::Motion;
use crate::path::Reference;
use crate::robot::Robot;
use crate::solver::Stopwatch;
use crate::solver::{Monitor, Status, Stop};
use crate::task::{Goal, Target, Tolerance};

/// Follows `reference` with the tip of `robot`, from `start` (n,) or from a configuration solved for its first point.
///
/// # Errors
/// Any [`Error`](crate::Error) for wrong input. A path that cannot be followed is a status, not an error. If the
/// monitor asks to stop, the record holds the finished ticks.
pub fn track(
    robot: &Robot,
    reference: &Reference,
    start: Option<&[f64]>,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<Record> {
    robot.require_one_tip("track")?;
    let stopwatch = Stopwatch::start();
    let limits = options.limits_for(robot);
    limits.validate(reference.dt(), reference.len() - 1)?;
    options.criterion()?; // checked before a start is solved with other tolerances
    let start = match start {
        Some(q) => q.to_vec(),
        None => first_configuration(robot, reference, &limits, options, monitor)?,
    };
    let mut session = Session::new(robot, &start, reference.dt(), options)?;
    if options.ease && session.space().is_some() {
        let problem = "the approach of ease=True is not kept clear of obstacles: leave one of the two out, or plan to the path first";
        return Err(Error::Contradiction { problem: problem.into() });
    }
    let (limits, criterion) = (session.limits().clone(), *session.criterion());
    let mut record = Record::new(start.len(), reference.len(), limits, options.limit_at, criterion, reference.dt());
    let beginning = session.begin(&target(reference, 0), reference.velocity(0))?;
    record.push(&session.accepted(), reference.position(0), &beginning);
    if options.ease {
        let target = |i: usize| target(reference, i);
        match ApproachMotion::find(robot, reference, &start, options, target, monitor)? {
            Some(approach) => drive(&approach, reference, &mut session, &mut record)?,
            None => record.note_no_approach(),
        }
    }
    let finished = follow(reference, &mut session, &mut record, monitor)?;
    record.finish(!finished, stopwatch.elapsed());
    if finished && !matches!(record.status, Status::Solved | Status::HeldInRegion) {
        record.out_of_reach = farthest_out_of_reach(reference, record.joined().unwrap_or(0), &session)?;
    }
    Ok(record)
}

/// Returns the largest distance by which the path is provably out of reach from row `first` on, and its time (s).
fn farthest_out_of_reach(
    reference: &Reference,
    first: usize,
    session: &Session,
) -> Result<Option<(ReachShortfall, f64)>> {
    let mut farthest: Option<(ReachShortfall, f64)> = None;
    let Ok(bounds) = session.limits().position_box() else { return Ok(None) }; // limits vary over time
    for i in first..reference.len() {
        if let Some(shortfall) = session.reach_shortfall(&target(reference, i), &bounds)?
            && farthest.is_none_or(|(most, _)| (shortfall.distance, shortfall.angle) > (most.distance, most.angle))
        {
            farthest = Some((shortfall, reference.time(i)));
        }
    }
    Ok(farthest)
}

/// Drives the approach.
fn drive(approach: &ApproachMotion, reference: &Reference, session: &mut Session, record: &mut Record) -> Result<()> {
    for i in 1..=approach.ticks {
        let step = session.drive(&approach.at(reference.time(i))?, &target(reference, i), reference.velocity(i))?;
        record.push(&session.accepted(), reference.position(i), &step);
    }
    record.note_approach(approach.ticks);
    Ok(())
}

/// Steps to the end of `reference`; returns false if the monitor asked to stop before.
fn follow(
    reference: &Reference,
    session: &mut Session,
    record: &mut Record,
    monitor: &mut dyn Monitor,
) -> Result<bool> {
    let last = reference.len() - 1;
    for i in record.rows()..=last {
        // Polled here too, since most ticks end before the evaluator polls the monitor.
        if !monitor.keep_going() {
            return Ok(false);
        }
        let step = session.step_moving(&target(reference, i), reference.velocity(i), monitor)?;
        if step.interrupted {
            return Ok(false);
        }
        record.push(&session.accepted(), reference.position(i), &step);
        monitor.progress(i, last);
    }
    Ok(true)
}

/// Returns the target of row `i`: a pose if the reference has orientations, else a position.
pub(super) fn target(reference: &Reference, i: usize) -> Target {
    match reference.pose(i) {
        Some(pose) => Target::from(&pose),
        None => Target::Position(reference.position(i)),
    }
}

/// Evaluation budget of the first configuration: most of the time no worse than the best of all, in a sixth of the
/// time. If the target is still unsolved, the full budget of a solve is used.
const CHOOSING: usize = 1000;

/// Solves for a configuration on, or nearest to, the first point of the path: the best for the goals or, without goals,
/// one away from singularities and limits.
fn first_configuration(
    robot: &Robot,
    reference: &Reference,
    limits: &Limits,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<Vec<f64>> {
    let limits = limits_at_start(robot, limits)?;
    // Tighter than the band, so that the track does not start at its edge.
    let tolerance =
        Tolerance { position: 0.1 * options.tolerance.position, rotation: 0.1 * options.tolerance.rotation };
    let target = target(reference, 0);
    let goals = if options.goals.is_empty() { start_goals(&target) } else { options.goals.clone() };
    let TrackOptions { task, seed, .. } = *options;
    let surroundings = options.surroundings.clone();
    let (limits, prefer) = (Some(limits), Prefer::Best);
    let stop = Stop { max_evaluations: CHOOSING, ..Stop::default() };
    let options =
        SolveOptions { task, goals, prefer, tolerance, limits, surroundings, stop, seed, ..SolveOptions::default() };
    let chosen = solve(robot, &target, &options, monitor)?;
    if chosen.status != Status::BudgetSpent {
        return Ok(chosen.q.to_vec());
    }
    let options = SolveOptions { stop: Stop::default(), ..options };
    Ok(solve(robot, &target, &options, monitor)?.q.to_vec())
}

/// The position limits at t = 0.
pub(super) fn limits_at_start(robot: &Robot, limits: &Limits) -> Result<Limits> {
    let at_start = |field: Field| -> Vec<Profile> {
        let profiles = limits.field(field).unwrap_or_default().iter();
        profiles.map(|profile| Profile::Constant(profile.at(0.0))).collect()
    };
    Limits::of(robot).replace(Field::Lower, at_start(Field::Lower))?.replace(Field::Upper, at_start(Field::Upper))
}

/// Default goals of the start: away from singularities and limits.
fn start_goals(target: &Target) -> Vec<Goal> {
    let motion = if matches!(target, Target::Position(_)) { Motion::Position } else { Motion::Pose };
    vec![Goal::Manipulability { motion, tip: None, weight: 1.0 }, Goal::Centring { weight: 1.0 }]
}
