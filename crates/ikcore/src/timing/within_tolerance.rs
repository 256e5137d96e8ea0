//! The fastest motion that may leave its path by a tolerance.
//!
//! Smooth paths in tubes of the tolerance, and of narrower ones, compete with the path itself. All tolerances share the
//! widths of these tubes, so that a wider one takes no longer, but for what a timing misses of its optimum.

use super::constant_limits::ConstantLimits;
use super::joint_path::JointPath;
use super::time_optimal::{TimingOptions, coarse_duration, time, time_optimal};
use super::tube::Tube;
use crate::error::{Error, Result};
use crate::limits::ROUNDING;
use crate::trajectory::Trajectory;

/// Widths of tubes are powers of this number.
const WIDTH_RATIO: f64 = std::f64::consts::SQRT_2;
/// Number of widths tried, which ends at 1/1000 of the tolerance.
const WIDTHS: i32 = 21;

/// Segments of a rough timing without jerk limits, and the part of its duration below which no motion with them is looked for: the rough
/// timing of one recording was 3 % too long.
const SEGMENTS: usize = 300;
const LEAST_PART: f64 = 0.85;

/// Returns a fast motion within `limits` that stays within `tolerance` (rad, m; one number per joint) of `path`, at the
/// same path parameter, from its start to its end. Zero tolerances: the motion is on the path.
///
/// # Errors
/// [`Error::Infeasible`] as [`time_optimal`], if no path in the tube is feasible either; [`Error::WrongLength`],
/// [`Error::OutOfRange`] for `tolerance`.
pub fn time_optimal_within(
    path: &JointPath,
    tolerance: &[f64],
    limits: &ConstantLimits,
    options: &TimingOptions,
) -> Result<Trajectory> {
    check(path, tolerance)?;
    let mut fastest = Fastest { limits, options, best: None };
    if !tolerance.contains(&0.0) {
        fastest.try_tubes(path, tolerance)?;
    }
    match fastest.best {
        Some(best) if slower(path, limits, &best)? => Ok(best),
        Some(best) => Ok(time_optimal(path, limits, options)
            .ok()
            .filter(|exact| exact.duration() < best.duration())
            .unwrap_or(best)),
        None => time_optimal(path, limits, options),
    }
}

/// The fastest motion so far.
struct Fastest<'a> {
    limits: &'a ConstantLimits,
    options: &'a TimingOptions,
    best: Option<Trajectory>,
}

impl Fastest<'_> {
    /// Tries the smoothest paths in tubes of the tolerance, and of narrower ones.
    fn try_tubes(&mut self, path: &JointPath, tolerance: &[f64]) -> Result<()> {
        let tube = Tube::new(path, self.limits);
        let (widest, mut pieces) = (widest(path, tolerance), 1);
        for width in 0..WIDTHS {
            let tolerance: Vec<f64> = widest.iter().map(|widest| widest * WIDTH_RATIO.powi(-width)).collect();
            // Narrower tubes would need more pieces still.
            let Some((smooth, needed)) = tube.smoothest(&tolerance, pieces)? else { break };
            pieces = needed;
            // A tube wider than the motion leaves nothing of it.
            if !is_a_point(&smooth) {
                self.try_path(&smooth)?;
            }
        }
        Ok(())
    }

    fn try_path(&mut self, path: &JointPath) -> Result<()> {
        if self.limits.require_for(path).is_err() {
            return Ok(());
        }
        if let Some(best) = &self.best
            && slower(path, self.limits, best)?
        {
            return Ok(());
        }
        match time(path, self.limits, self.options) {
            Ok(motion) if self.best.as_ref().is_none_or(|best| motion.duration() < best.duration()) => {
                self.best = Some(motion);
            }
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            _ => {}
        }
        Ok(())
    }
}

/// The widest tubes to try: `tolerance`, or less where it exceeds the range of every joint.
fn widest(path: &JointPath, tolerance: &[f64]) -> Vec<f64> {
    let ranges = (0..tolerance.len()).map(|joint| path.range(joint)).map(|[lowest, highest]| highest - lowest);
    let excess = tolerance.iter().zip(ranges).map(|(tolerance, range)| tolerance / range).fold(f64::INFINITY, f64::min);
    let excess = if excess.is_finite() { excess.max(1.0) } else { 1.0 };
    tolerance.iter().map(|tolerance| WIDTH_RATIO.powf((tolerance / excess).log(WIDTH_RATIO).floor())).collect()
}

fn is_a_point(path: &JointPath) -> bool {
    (0..path.joints().len()).all(|joint| {
        let [lowest, highest] = path.range(joint);
        highest - lowest <= ROUNDING * lowest.abs().max(1.0)
    })
}

/// Whether a motion along a path would take longer than `best` without jerk limits, judged by a rough timing.
fn slower(path: &JointPath, limits: &ConstantLimits, best: &Trajectory) -> Result<bool> {
    Ok(limits.limit_jerk() && LEAST_PART * coarse_duration(path, limits, SEGMENTS)? > best.duration())
}

fn check(path: &JointPath, tolerance: &[f64]) -> Result<()> {
    let joints = path.joints();
    if tolerance.len() != joints.len() {
        let expected = format!("{} (one per joint)", joints.len());
        return Err(Error::WrongLength { what: "tolerance".into(), expected, got: tolerance.len() });
    }
    match tolerance.iter().position(|tolerance| !(*tolerance >= 0.0 && tolerance.is_finite())) {
        None => Ok(()),
        Some(joint) => {
            let what = format!("tolerance of joint '{}'", joints[joint]);
            Err(Error::out_of_range(what, "zero or more and finite", tolerance[joint]))
        }
    }
}
