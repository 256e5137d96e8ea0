//! The call `time_optimal`: grid, speed profile, trajectory.

use super::compose::compose;
use super::constant_limits::ConstantLimits;
use super::grid::{check_gridpoints, cut};
use super::jerk_limited;
use super::joint_path::{JointPath, PathEnd};
use super::reachability::{Range, SpeedProfile};
use super::refine::refine;
use super::time_scaling::without_rounding;
use super::torque_segments::TorqueSegments;
use crate::error::{Error, Result};
use crate::trajectory::Trajectory;
use crate::wording::number;

/// Options of [`time_optimal`]. The default is from rest to rest on an adaptively refined grid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TimingOptions {
    /// Points at which the acceleration along the path may change, at least one per piece of the path. `None` refines
    /// the grid until it makes no difference.
    pub gridpoints: Option<usize>,
    /// Euclidean norm of the joint velocity at the start (rad/s, m/s).
    pub start_speed: f64,
    /// Euclidean norm of the joint velocity at the end (rad/s, m/s).
    pub end_speed: f64,
}

/// Number of segments before refinement.
const FIRST_SEGMENTS: usize = 100;

/// Fraction of the duration that the grid may lose, by estimate. What it loses, compared with a very fine grid, was up to five times as much.
const CONVERGED: f64 = 1e-4;

/// The same with torque limits, under which a segment takes three times as long to compute.
const CONVERGED_WITH_TORQUES: f64 = 1e-3;

/// Number of segments if jerk limits are to be kept: the profile then only says where the motion takes its time.
const SEGMENTS_FOR_JERK: usize = 100;

/// Returns the fastest motion along `path` within `limits`.
///
/// # Errors
/// [`Error::Infeasible`] for a path that leaves the position limits, a joint that must move but may not, or speeds at the
/// ends that are too high; [`Error::OutOfRange`] for the options; [`Error::InvalidPath`] for ways and limits whose times are beyond
/// floating-point numbers.
pub fn time_optimal(path: &JointPath, limits: &ConstantLimits, options: &TimingOptions) -> Result<Trajectory> {
    limits.require_for(path)?;
    time(path, limits, options).map_err(|error| beyond_numbers(error, path))
}

/// Names the joint with the longest way if the times of its motion are beyond floating-point numbers; any other error as it is.
fn beyond_numbers(error: Error, path: &JointPath) -> Error {
    let (Error::WrongLength { what, .. } | Error::NotFinite { what, .. }) = &error else { return error };
    if !what.to_string().starts_with(Trajectory::WHAT) {
        return error;
    }
    let way = |joint: usize| {
        let [lowest, highest] = path.range(joint);
        highest - lowest
    };
    let longest = (0..path.joints().len()).max_by(|one, other| way(*one).total_cmp(&way(*other))).unwrap_or(0);
    let (joint, way) = (&path.joints()[longest], way(longest));
    let moves = if way.is_finite() {
        format!("joint '{joint}' moves by {}, for which the limits leave a time", number(way))
    } else {
        format!("between its waypoints joint '{joint}' swings to positions")
    };
    let problem = format!("{moves} beyond floating-point numbers: check the units of waypoints, knots and limits");
    Error::InvalidPath { problem }
}

/// [`time_optimal`] without the check of position limits.
///
/// # Errors
/// As [`time_optimal`], except for position limits.
pub(crate) fn time(path: &JointPath, limits: &ConstantLimits, options: &TimingOptions) -> Result<Trajectory> {
    let ends =
        [end_range(path, options.start_speed, PathEnd::Start)?, end_range(path, options.end_speed, PathEnd::End)?];
    let is_refined = options.gridpoints.is_none() && !limits.limit_jerk();
    let mut torques = TorqueSegments::new(path, limits, is_refined);
    let mut fastest = |segments| SpeedProfile::fastest(path, limits, segments, ends, torques.as_mut());
    let profile = match options.gridpoints {
        Some(gridpoints) => {
            check_gridpoints(gridpoints)?;
            fastest(cut(path, gridpoints - 1))?
        }
        None if limits.limit_jerk() => fastest(cut(path, SEGMENTS_FOR_JERK))?,
        None => {
            let tolerance = if limits.torques.is_some() { CONVERGED_WITH_TORQUES } else { CONVERGED };
            let profile = fastest(cut(path, FIRST_SEGMENTS))?;
            let losses = losses(path, limits, &profile, ends, torques.as_ref());
            let fastest = |segments| SpeedProfile::fastest(path, limits, segments, ends, torques.as_mut());
            refine(profile, losses, tolerance, fastest)?
        }
    };
    if !limits.limit_jerk() {
        // The profile keeps torques for certain.
        return without_rounding(limits.slowed_for_tips(compose(path, &profile)?)?, limits);
    }
    if options.start_speed != 0.0 || options.end_speed != 0.0 {
        let problem = "with jerk limits a motion begins and ends at rest: leave out start_speed and end_speed".into();
        return Err(Error::Infeasible { problem });
    }
    jerk_limited::fastest(path, &profile, limits)
}

/// Returns about what each segment of a first grid loses (s) because it keeps limits at every point. With torque limits that saves a grid of
/// halves; `None` without, or with limits of tips, whose means are not known.
fn losses(
    path: &JointPath,
    limits: &ConstantLimits,
    profile: &SpeedProfile,
    ends: [Range; 2],
    torques: Option<&TorqueSegments<'_>>,
) -> Option<Vec<f64>> {
    let torques = torques.filter(|_| limits.tips.is_none())?;
    let segments = profile.segments.clone();
    // Without an answer the grid is halved, which meets any lasting error again.
    let spans = SpeedProfile::spans_on_average(path, limits, segments, ends, torques).ok()?;
    Some(profile.spans().zip(spans).map(|(span, least)| (span - least).abs()).collect())
}

/// The fastest motion along `paths`, each from rest to rest, one after the other.
///
/// # Errors
/// As [`time`]; [`Error::InvalidPath`] without a path.
pub(crate) fn time_all(paths: &[JointPath], limits: &ConstantLimits) -> Result<Trajectory> {
    let none = || Error::InvalidPath { problem: "it has no points".into() };
    let rest_to_rest = TimingOptions::default();
    if !limits.limit_jerk() {
        return time(&JointPath::joined(paths.iter().cloned()).ok_or_else(none)?, limits, &rest_to_rest);
    }
    let mut motions = paths.iter().map(|path| time(path, limits, &rest_to_rest));
    let first = motions.next().ok_or_else(none)??;
    motions.try_fold(first, |all, next| all.then(&next?, 0.0))
}

/// Returns the duration (s) of a fast motion under jerk limits, without those of torques, along `paths`, each from rest to rest: one that
/// [`time_all`] improves little.
///
/// # Errors
/// As [`time_all`].
pub(crate) fn rough_duration(paths: &[JointPath], limits: &ConstantLimits) -> Result<f64> {
    let limits = &limits.without_torque();
    let of_path = |path: &JointPath| {
        let ends = [end_range(path, 0.0, PathEnd::Start)?, end_range(path, 0.0, PathEnd::End)?];
        let profile = SpeedProfile::fastest(path, limits, cut(path, SEGMENTS_FOR_JERK), ends, None)?;
        Ok(jerk_limited::rough(path, &profile, limits)?.duration())
    };
    paths.iter().map(of_path).sum()
}

/// Returns the duration (s) of the fastest motion from rest to rest on a grid of about `segments` segments: a quick
/// estimate to compare many paths, without torque limits. Position limits are left to the caller.
///
/// # Errors
/// None in practice: a motion from rest to rest always exists.
pub(crate) fn coarse_duration(path: &JointPath, limits: &ConstantLimits, segments: usize) -> Result<f64> {
    let ends = [end_range(path, 0.0, PathEnd::Start)?, end_range(path, 0.0, PathEnd::End)?];
    let profile = SpeedProfile::fastest(path, &limits.without_torque(), cut(path, segments), ends, None)?;
    Ok(profile.duration())
}

/// Returns the range of squared path speeds for a joint speed at an end. If dq/ds vanishes, the joints are at rest at
/// any path speed.
fn end_range(path: &JointPath, speed: f64, end: PathEnd) -> Result<Range> {
    let name = end.name();
    if !(speed >= 0.0 && speed.is_finite()) {
        return Err(Error::out_of_range(format!("{name}_speed"), "zero or more and finite", speed));
    }
    if !path.has_no_direction(end) {
        let squared = (speed / path.slope(end)).powi(2);
        return Ok([squared; 2]);
    }
    if speed == 0.0 {
        return Ok([0.0, f64::INFINITY]);
    }
    let problem =
        format!("{name}_speed is {speed}, but the path has no direction at its {name}: give the spline other ends");
    Err(Error::Infeasible { problem: problem.into() })
}
