//! Noise of a recorded path: rows that jitter to and fro, so that the motion exactly on them is slow.

use super::constant_limits::ConstantLimits;
use super::joint_path::JointPath;
use super::time_optimal::{coarse_duration, rough_duration};
use super::tube::Tube;
use crate::error::Result;
use crate::message::{Message, Setting, message};
use crate::trajectory::Trajectory;
use crate::wording::number;

/// Fewest rows of a recording; fewer are waypoints that somebody chose.
const FEWEST_ROWS: usize = 50;

/// Part of the rows that lie on the other side of their neighbours than the row before: of white noise 0.73, of a smooth path sampled
/// closely next to 0.
const REVERSED: f64 = 0.5;

/// Distance from the line between two neighbours that counts as rounding, relative to the range of the joint.
const ROUNDING: f64 = 1e-9;

/// Part of the rows that are nearer to the line between their neighbours than the jitter is said to be.
const MOST: f64 = 0.99;

/// Tolerance that smooths noise, as a multiple of the jitter.
const TOLERANCE: f64 = 2.0;
/// Largest such tolerance, as a fraction of the widest range of a joint: more is the shape of a motion.
const LARGEST: f64 = 0.02;

/// Part of the duration that is left without the noise below which the noise counts as setting it.
const WITHOUT: f64 = 0.8;

/// Segments of the timing without jerk limits of the smooth path.
const SEGMENTS: usize = 300;

/// Cost of the noise of a recording, in duration.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedNoise {
    /// Name of the joint that jitters most.
    pub joint: String,
    /// Distance of a row of it from the line between its neighbours (rad, m), which one row in 100 exceeds.
    pub jitter: f64,
    /// Tolerance that smooths the noise of all joints (rad, m).
    pub tolerance: f64,
    /// Duration of the motion, and of one within that tolerance (s).
    pub durations: [f64; 2],
}

impl RecordedNoise {
    /// A sentence that says what to do.
    pub fn message(&self) -> Message {
        let [with, without] = self.durations.map(number);
        message![
            format!(
                "joint '{}' jitters by {} from row to row, and this noise sets the duration: {with} s, without it about {without} s; \
                 give ",
                self.joint,
                number(self.jitter)
            ),
            Setting::Tolerance(self.tolerance.to_string()),
            ", which smooths it"
        ]
    }
}

/// Returns what the noise of the rows of `path` costs the fastest `motion` within `tolerance` (rad, m; per joint) of it; `None` where
/// they have none, or where it costs little.
///
/// # Errors
/// Interruptions alone.
pub fn recorded_noise(
    path: &JointPath,
    tolerance: &[f64],
    motion: &Trajectory,
    limits: &ConstantLimits,
) -> Result<Option<RecordedNoise>> {
    let joints = path.joints().len();
    if path.breaks().len() < FEWEST_ROWS {
        return Ok(None);
    }
    let range = |joint: usize| {
        let [lowest, highest] = path.range(joint);
        highest - lowest
    };
    let widest = (0..joints).map(range).fold(0.0, f64::max);
    let jitter_of = |joint: usize| jitter(path, joint, ROUNDING * widest).map(|jitter| (joint, jitter));
    let noisy = (0..joints).filter_map(jitter_of).filter(|(_, jitter)| TOLERANCE * jitter <= LARGEST * widest);
    let too_narrow = noisy.filter(|(joint, jitter)| tolerance[*joint] < TOLERANCE * jitter);
    let Some((joint, jitter)) = too_narrow.max_by(|one, other| one.1.total_cmp(&other.1)) else { return Ok(None) };
    let needed = two_digits(TOLERANCE * jitter);
    let Some((smooth, _)) = Tube::new(path, limits).smoothest(&vec![needed; joints], 1)? else { return Ok(None) };
    let without = if limits.limit_jerk() {
        rough_duration(&[smooth], limits)?
    } else {
        coarse_duration(&smooth, limits, SEGMENTS)?
    };
    let durations = [motion.duration(), without];
    let costs = without < WITHOUT * motion.duration();
    let joint = path.joints()[joint].clone();
    Ok(costs.then_some(RecordedNoise { joint, jitter, tolerance: needed, durations }))
}

/// Largest distance of the rows of a joint from the lines between their neighbours, but for one in 100, if they lie on alternating sides.
fn jitter(path: &JointPath, joint: usize, rounding: f64) -> Option<f64> {
    let rows = path.breaks().len();
    let at = |i: usize| {
        if i < path.pieces() {
            path.joint_at(i, 0.0, joint)[0]
        } else {
            path.joint_at(i - 1, path.length(i - 1), joint)[0]
        }
    };
    let off = |i: usize| {
        let [before, after] = [path.length(i - 1), path.length(i)];
        at(i) - (after * at(i - 1) + before * at(i + 1)) / (before + after)
    };
    let mut offs: Vec<f64> = (1..rows - 1).map(off).collect();
    let pairs = || offs.windows(2).filter(|pair| pair.iter().all(|off| off.abs() > rounding));
    let reversed = pairs().filter(|pair| pair[0] * pair[1] < 0.0).count();
    if reversed < FEWEST_ROWS / 2 || (reversed as f64) < REVERSED * pairs().count() as f64 {
        return None;
    }
    offs.iter_mut().for_each(|off| *off = off.abs());
    offs.sort_by(f64::total_cmp);
    Some(offs[((MOST * offs.len() as f64) as usize).min(offs.len() - 1)])
}

/// Rounds up to two digits, so that the number is quickly typed.
fn two_digits(value: f64) -> f64 {
    let unit = 10.0_f64.powf(value.log10().floor() - 1.0);
    let up = (value / unit).ceil() * unit;
    format!("{up:.1e}").parse().unwrap_or(up)
}
