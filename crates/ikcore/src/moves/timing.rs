//! The fastest motion along the path of each step.

use crate::error::{Error, Result};
use crate::objective::Point;
use crate::timing::{ConstantLimits, JointPath, TimingOptions, time};
use crate::trajectory::Trajectory;

/// Tolerated excess over the requested speed, relative to it.
const FASTER: f64 = 1e-6;
/// Tolerated shortfall of the requested speed, relative to it.
const SLOWER: f64 = 3e-4;

/// Fraction of the requested speed above which a shortfall is due to the timing; below it, to limits.
const NEARLY: f64 = 0.99;

/// Minimum number of grid points of a timing. Refining the grid would gain a thousandth of the duration.
const GRIDPOINTS: usize = 240;
/// Minimum number of grid points per piece of the path.
const FOR_EACH_PIECE: usize = 2;

/// Samples in each segment of a trajectory.
const SAMPLES: usize = 2;
/// Samples in each segment with jerk limits, under which the speed may be highest at a quarter of a segment.
const JERKY_SAMPLES: usize = 4;
/// Tolerated relative excess over the requested speed at the quarters: the whole motion is not slowed for an instant.
const FOR_AN_INSTANT: f64 = 1e-3;

/// Newton steps onto the path at each sample.
const STEPS: usize = 2;

/// A motion along a joint path at a time.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathTime {
    /// Time (s).
    pub t: f64,
    /// Path parameter, and its rate.
    pub s: f64,
    pub rate: f64,
}

/// The fastest motion along `path` that keeps the largest path speeds of its pieces.
///
/// With jerk limits the whole motion ends up slightly slowed, and its speeds with it; higher ones are then requested once.
///
/// # Errors
/// Those of `time_optimal`.
pub(super) fn timed(path: &JointPath, limits: &ConstantLimits) -> Result<Trajectory> {
    let asked: Vec<f64> = (0..path.pieces()).map(|piece| path.largest_speed(piece)).collect();
    let gridpoints = Some(GRIDPOINTS.max(FOR_EACH_PIECE * path.pieces()));
    let options = TimingOptions { gridpoints, ..TimingOptions::default() };
    let motion = time(path, limits, &options)?;
    if !limits.limit_jerk() || asked.iter().all(|speed| speed.is_infinite()) {
        return Ok(motion);
    }
    let (motion, reached) = at_most_asked((path, limits), &asked, motion)?;
    if !(NEARLY..1.0 - SLOWER).contains(&reached) {
        return Ok(motion);
    }
    let speeds = asked.iter().map(|speed| speed / reached).collect();
    let again = match time(&path.clone().with_speeds(speeds), limits, &options) {
        Err(error @ Error::Interrupted) => return Err(error),
        // The first motion is right, and a little slower.
        Err(_) => return Ok(motion),
        Ok(again) => again,
    };
    let (again, _) = at_most_asked((path, limits), &asked, again)?;
    Ok(if again.duration() < motion.duration() { again } else { motion })
}

/// Slows the whole motion if it exceeds the requested speeds. Returns it, and the largest fraction of them that it reached before.
fn at_most_asked(
    (path, limits): (&JointPath, &ConstantLimits),
    asked: &[f64],
    motion: Trajectory,
) -> Result<(Trajectory, f64)> {
    let reached = largest_ratio(path, &path_times(path, &motion, limits)?, asked);
    Ok((if reached > 1.0 + FASTER { motion.slowed(reached)? } else { motion }, reached))
}

/// Largest path speed at these times, four to a segment, relative to the one asked for.
fn largest_ratio(path: &JointPath, times: &[PathTime], asked: &[f64]) -> f64 {
    let ratio = |(i, at): (usize, &PathTime)| {
        let excused = if i % 2 == 1 { 1.0 + FOR_AN_INSTANT } else { 1.0 };
        at.rate / (excused * asked[path.locate(at.s).0])
    };
    times.iter().enumerate().map(ratio).fold(0.0, f64::max)
}

/// Path parameters of a motion along a path from rest to rest, at the knots of the motion and between them.
///
/// # Errors
/// None in practice: the joints are the same.
pub(super) fn path_times(path: &JointPath, motion: &Trajectory, limits: &ConstantLimits) -> Result<Vec<PathTime>> {
    let n = path.joints().len();
    let samples = if limits.limit_jerk() { JERKY_SAMPLES } else { SAMPLES };
    let [mut q, mut qd, mut qdd, mut position, mut slope] = [(); 5].map(|()| Point::from_elem(0.0, n));
    let [first, last] = [path.breaks()[0], path.breaks()[path.pieces()]];
    let mut times = vec![PathTime { t: 0.0, s: first, rate: 0.0 }];
    for ends in motion.knots().windows(2) {
        for k in 1..=samples {
            let t = ends[0] + (ends[1] - ends[0]) * k as f64 / samples as f64;
            let before = times[times.len() - 1];
            motion.at(t, &mut q, &mut qd, &mut qdd)?;
            let (mut s, mut rate) = (before.s + before.rate * (t - before.t), before.rate);
            for _ in 0..STEPS {
                path.position_and_slope(s, &mut position, &mut slope);
                let squared: f64 = slope.iter().map(|slope| slope * slope).sum();
                if squared == 0.0 {
                    break;
                }
                let ahead: f64 = q.iter().zip(&position).zip(&slope).map(|((q, p), slope)| (q - p) * slope).sum();
                rate = qd.iter().zip(&slope).map(|(qd, slope)| qd * slope).sum::<f64>() / squared;
                s = (s + ahead / squared).clamp(before.s, last);
            }
            times.push(PathTime { t, s, rate });
        }
    }
    Ok(times)
}

/// Time at which a motion passes the path parameter `s`, between samples.
pub(super) fn time_at(times: &[PathTime], s: f64) -> f64 {
    let after = times.partition_point(|at| at.s < s).min(times.len() - 1);
    let (from, to) = (times[after.saturating_sub(1)], times[after]);
    if to.s > from.s { from.t + (to.t - from.t) * ((s - from.s) / (to.s - from.s)).clamp(0.0, 1.0) } else { to.t }
}

/// The samples between two path parameters, and both of these.
pub(super) fn times_between(times: &[PathTime], [from, to]: [f64; 2]) -> Vec<PathTime> {
    let at = |s: f64| {
        let t = time_at(times, s);
        let after = times.partition_point(|at| at.t < t).min(times.len() - 1);
        PathTime { t, s, rate: times[after].rate }
    };
    let between = times.iter().filter(|at| from < at.s && at.s < to).copied();
    std::iter::once(at(from)).chain(between).chain([at(to)]).collect()
}
