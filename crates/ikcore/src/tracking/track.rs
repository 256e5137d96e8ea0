//! Tracking of a whole path.

use super::path_approach::PathApproach;
use super::record::Record;
use super::session::Session;
use super::start_on_paths::start_on_paths;
use super::tip_paths::TipPaths;
use super::track_options::{TRACK, TrackOptions};
use crate::error::{Error, Result};
use crate::kinematics::ReachShortfall;
use crate::message::{Setting, message};
use crate::path::Reference;
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};

/// Follows `path` with the tip of `robot`, from `start` (n,) or from a configuration solved for its first point.
///
/// # Errors
/// Any [`Error`](crate::Error) for wrong input. A path that cannot be followed is a status, not an error. If the
/// monitor asks to stop, the record holds the finished ticks.
pub fn track(
    robot: &Robot,
    path: &Reference,
    start: Option<&[f64]>,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<Record> {
    robot.require_one_tip(TRACK)?;
    track_tips(robot, &TipPaths { tips: &[], paths: std::slice::from_ref(path) }, start, options, monitor)
}

/// Follows the paths of several tips at once, otherwise like [`track`]. Pairs of tips at their relative pose are held there
/// with priority: where one arm cannot follow, both lag.
///
/// # Errors
/// As [`track`]; [`Error::WrongLength`] for paths that are not sampled at the same times.
pub fn track_tips(
    robot: &Robot,
    asked: &TipPaths<'_>,
    start: Option<&[f64]>,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<Record> {
    let stopwatch = Stopwatch::start();
    let first = asked.first()?;
    if options.ease && robot.tip_count() > 1 {
        let does = " is for one tip: leave it out, or bring the arms to the paths first";
        return Err(Error::Contradiction { problem: message!["the approach of ", Setting::Ease, does] });
    }
    let limits = options.limits_for(robot, &TRACK.into())?;
    limits.validate(first.dt(), first.len() - 1)?;
    options.require_tips(robot)?;
    let only = options.only_task()?; // checked before a start is solved with other tolerances
    let start = match start {
        Some(q) => q.to_vec(),
        None => start_on_paths(robot, asked, &limits, options, monitor)?,
    };
    let mut session = Session::begun_by(&TRACK.into(), robot, &start, first.dt(), options)?;
    if options.ease && session.space().is_some() {
        let does = " is not kept clear of obstacles: leave one of the two out, or plan to the path first";
        return Err(Error::Contradiction { problem: message!["the approach of ", Setting::Ease, does] });
    }
    if options.ease && !session.keeps().is_empty() {
        let does = " does not keep constraints: leave one of the two out, or plan to the path first";
        return Err(Error::Contradiction { problem: message!["the approach of ", Setting::Ease, does] });
    }
    if options.ease && session.limits_torque() {
        let does = " does not keep torque limits: leave one of the two out, or plan to the path first";
        return Err(Error::Contradiction { problem: message!["the approach of ", Setting::Ease, does] });
    }
    let criterion = asked.tips.first().map_or(only.criterion, |task| task.tolerance.into());
    let limits = session.limits().clone();
    let mut record = Record::new(start.len(), first.len(), limits, options.limit_at, criterion, first.dt());
    record.start_outside = session.start_outside().to_vec();
    let beginning = session.begin(asked.arrival(0))?;
    asked.push(&session, &beginning, &mut record);
    if options.ease {
        match PathApproach::find(robot, asked, &start, options, monitor)? {
            Some(approach) => drive(&approach, asked, &mut session, &mut record)?,
            None => record.note_no_approach(),
        }
    }
    let finished = follow(asked, &mut session, &mut record, monitor)?;
    record.finish(!finished, stopwatch.elapsed());
    if finished && matches!(record.status, Status::Lost | Status::Capped | Status::Improved) {
        record.out_of_reach = farthest_out_of_reach(asked, record.joined().unwrap_or(0), &mut session)?;
    }
    Ok(record)
}

/// Returns the largest distance by which a path is provably out of reach from row `first` on, and its time (s).
fn farthest_out_of_reach(
    asked: &TipPaths<'_>,
    first: usize,
    session: &mut Session,
) -> Result<Option<(ReachShortfall, f64)>> {
    let mut farthest: Option<(ReachShortfall, f64)> = None;
    let Ok(bounds) = session.limits().position_box() else { return Ok(None) }; // limits vary over time
    for i in first..asked.len() {
        if let Some(shortfall) = session.reach_shortfall(asked.arrival(i), &bounds)?
            && farthest.is_none_or(|(most, _)| (shortfall.distance, shortfall.angle) > (most.distance, most.angle))
        {
            farthest = Some((shortfall, asked.time(i)));
        }
    }
    Ok(farthest)
}

/// Drives the arm along the approach.
fn drive(approach: &PathApproach, asked: &TipPaths<'_>, session: &mut Session, record: &mut Record) -> Result<()> {
    for i in 1..=approach.ticks {
        let step = session.drive(&approach.at(asked.time(i))?, asked.arrival(i))?;
        asked.push(session, &step, record);
    }
    record.note_approach(approach.ticks);
    Ok(())
}

/// Tracks to the end of the paths. Returns false if the monitor asked to stop before.
fn follow(asked: &TipPaths<'_>, session: &mut Session, record: &mut Record, monitor: &mut dyn Monitor) -> Result<bool> {
    let last = asked.len() - 1;
    for i in record.rows()..=last {
        // Polls here too, since most ticks end before the evaluator polls the monitor.
        if !monitor.keep_going() {
            return Ok(false);
        }
        let step = session.advance(Some(asked.arrival(i)), monitor)?;
        if step.interrupted {
            return Ok(false);
        }
        asked.push(session, &step, record);
        monitor.progress(i, last);
    }
    Ok(true)
}
