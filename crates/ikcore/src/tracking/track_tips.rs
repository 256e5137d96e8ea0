//! Tracking of a path for each of several tips.

use serde::{Deserialize, Serialize};

use super::record::Record;
use super::session::Session;
use super::step::Step;
use super::target_stream::TipArrival;
use super::track::{limits_at_start, target};
use super::track_options::TrackOptions;
use crate::error::{Error, Result};
use crate::ik::{SolveOptions, solve_tips};
use crate::kinematics::ReachShortfall;
use crate::limits::Limits;
use crate::path::Reference;
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::{Goal, Target, TipError, TipTask, Tolerance};

/// The record of a track of several tips. Positions and references of `track` are those of the first target, its errors the largest.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct TipsRecord {
    /// Joints, status and message.
    pub track: Record,
    /// What became of each target.
    pub tips: TipTable,
}

/// What became of each target, row by row, the targets in the order of the call.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct TipTable {
    /// Positions (k, targets) (m), those of pairs as seen from the first tip.
    pub positions: Vec<[f64; 3]>,
    /// Reference positions (k, targets) (m).
    pub references: Vec<[f64; 3]>,
    /// Errors (k, targets).
    pub errors: Vec<TipError>,
}

/// Follows a path with each of several tips of `robot`, all at the same time, as [`track`](super::track()) does with one. Pairs of tips
/// that are where they are to be are held there before anything else: where one arm cannot follow, both lag.
///
/// # Errors
/// As [`track`](super::track()); [`Error::WrongLength`] for paths that are not sampled at the same times.
pub fn track_tips(
    robot: &Robot,
    paths: &[(TipTask, Reference)],
    start: Option<&[f64]>,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<TipsRecord> {
    let stopwatch = Stopwatch::start();
    let reference = same_times(paths)?;
    if options.ease {
        let problem = "the approach of ease=True is for one tip: leave it out, or bring the arms to the paths first";
        return Err(Error::Contradiction { problem: problem.into() });
    }
    let limits = options.limits_for(robot);
    limits.validate(reference.dt(), reference.len() - 1)?;
    options.require_tips(robot)?;
    let start = match start {
        Some(q) => q.to_vec(),
        None => first_configuration(robot, paths, &limits, options, monitor)?,
    };
    let mut session = Session::new(robot, &start, reference.dt(), options)?;
    let (limits, criterion) = (session.limits().clone(), paths[0].0.tolerance.into());
    let mut track = Record::new(start.len(), reference.len(), limits, options.limit_at, criterion, reference.dt());
    let mut tips = TipTable::default();
    let beginning = session.begin_tips(&targets(paths, 0))?;
    tips.push(paths, &session, beginning, &mut track);
    let finished = follow(paths, &mut session, (&mut track, &mut tips), monitor)?;
    track.finish(!finished, stopwatch.elapsed());
    if finished && track.status != Status::Solved {
        track.out_of_reach = farthest_out_of_reach(paths, track.joined().unwrap_or(0), &mut session)?;
    }
    Ok(TipsRecord { track, tips })
}

impl TipTable {
    /// Appends the result of a tick.
    fn push(&mut self, paths: &[(TipTask, Reference)], session: &Session, step: Step, track: &mut Record) {
        let row = track.rows();
        let first = self.positions.len();
        self.positions.extend(session.tip_positions());
        self.references.extend(paths.iter().map(|(_, path)| path.position(row)));
        self.errors.extend(session.tip_errors());
        let position = self.positions.get(first).copied().unwrap_or([f64::NAN; 3]);
        track.push(&session.accepted(), paths[0].1.position(row), &Step { position, ..step });
    }
}

/// The first path, of which there is one at least; all are sampled at the same times.
fn same_times(paths: &[(TipTask, Reference)]) -> Result<&Reference> {
    let Some((_, first)) = paths.first() else {
        return Err(Error::WrongLength { what: "paths".into(), expected: "one at least".into(), got: 0 });
    };
    match paths.iter().find(|(_, path)| path.len() != first.len() || path.dt() != first.dt()) {
        None => Ok(first),
        Some((_, other)) => {
            let expected = format!("{} samples of {} s, as the first path has", first.len(), first.dt());
            Err(Error::WrongLength { what: "a path of several".into(), expected, got: other.len() })
        }
    }
}

/// Tasks and targets of row `i`.
fn targets(paths: &[(TipTask, Reference)], i: usize) -> Vec<(TipTask, Target)> {
    paths.iter().map(|(task, path)| (*task, target(path, i))).collect()
}

/// Steps to the end of the paths; returns false if the monitor asked to stop before.
fn follow(
    paths: &[(TipTask, Reference)],
    session: &mut Session,
    (track, tips): (&mut Record, &mut TipTable),
    monitor: &mut dyn Monitor,
) -> Result<bool> {
    let last = paths[0].1.len() - 1;
    for i in 1..=last {
        if !monitor.keep_going() {
            return Ok(false);
        }
        let arrival = TipArrival { targets: targets(paths, i), stamp: None };
        let step = session.advance_tips(Some(arrival), monitor)?;
        if step.interrupted {
            return Ok(false);
        }
        tips.push(paths, session, step, track);
        monitor.progress(i, last);
    }
    Ok(true)
}

/// The largest distance by which a path is provably out of reach from row `first` on, and its time (s).
fn farthest_out_of_reach(
    paths: &[(TipTask, Reference)],
    first: usize,
    session: &mut Session,
) -> Result<Option<(ReachShortfall, f64)>> {
    let mut farthest: Option<(ReachShortfall, f64)> = None;
    let Ok(bounds) = session.limits().position_box() else { return Ok(None) }; // limits vary over time
    for i in first..paths[0].1.len() {
        if let Some(shortfall) = session.reach_shortfall_of_tips(&targets(paths, i), &bounds)?
            && farthest.is_none_or(|(most, _)| (shortfall.distance, shortfall.angle) > (most.distance, most.angle))
        {
            farthest = Some((shortfall, paths[0].1.time(i)));
        }
    }
    Ok(farthest)
}

/// Solves for a configuration on the first points of the paths: the best near it for the goals or, without goals, one away from limits.
fn first_configuration(
    robot: &Robot,
    paths: &[(TipTask, Reference)],
    limits: &Limits,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<Vec<f64>> {
    // Tighter than the band, so that the track does not start at its edge.
    let tight =
        |Tolerance { position, rotation }: Tolerance| Tolerance { position: 0.1 * position, rotation: 0.1 * rotation };
    let tightened = |(task, target): (TipTask, Target)| (TipTask { tolerance: tight(task.tolerance), ..task }, target);
    let (tips, wanted): (Vec<TipTask>, Vec<Target>) = targets(paths, 0).into_iter().map(tightened).unzip();
    let goals = if options.goals.is_empty() { vec![Goal::Centring { weight: 1.0 }] } else { options.goals.clone() };
    let limits = Some(limits_at_start(robot, limits)?);
    let surroundings = options.surroundings.clone();
    let options = SolveOptions { tips, goals, limits, surroundings, seed: options.seed, ..SolveOptions::default() };
    Ok(solve_tips(robot, &wanted, &options, monitor)?.q.to_vec())
}
