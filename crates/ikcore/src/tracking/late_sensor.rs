//! Detection of a sensor delay from the first commands of a run and their measurements.
//!
//! Near the start, the motion of the tip is linear in the commands: dy_k = J du_{k-d}, with d the delay in measurements.
//! J is fitted by least squares for each delay from 0 to 8. With the true delay the residual is far smaller than with the
//! delay the controller assumes. Noise, and a servo that lags behind its commands, leave residuals of similar size for
//! all delays. Differences are compared instead of positions, because slow motions correlate at all delays.

use nalgebra::DMatrix;

use super::tip_pose::TipPose;

/// Longest delay considered (measurements).
const LONGEST: usize = 8;

/// Largest ratio of the squared residuals with the detected and with the assumed delay. In trials without delay (noise,
/// outliers, slow servos) the smallest ratio of another delay was 0.4.
const CLEARLY_SMALLER: f64 = 0.25;

/// Measurements to fit per joint, beyond those needed for the delays. The short window stays near the start, where the motion
/// is linear; the long one suppresses noise.
const PER_JOINT: [usize; 2] = [4, 8];

/// Relative tolerance for zero singular values: directions that no command took.
const NEGLIGIBLE: f64 = 1e-9;

/// The first commands of a run and the positions measured.
#[derive(Debug)]
pub(super) struct FirstMeasurements {
    joints: usize,
    commands: Vec<f64>,
    positions: Vec<[f64; 3]>,
    most: usize,
}

impl FirstMeasurements {
    /// An empty buffer for an arm with `joints` joints.
    pub(super) fn new(joints: usize) -> Self {
        let most = window(PER_JOINT[1], joints);
        Self { joints, commands: Vec::with_capacity(most * joints), positions: Vec::with_capacity(most), most }
    }

    /// Records a command (n,) and its measurement until the buffer is full.
    #[inline]
    pub(super) fn note(&mut self, command: &[f64], tip: &TipPose) {
        if self.positions.len() < self.most {
            self.commands.extend_from_slice(command);
            self.positions.push(*tip.position());
        }
    }

    /// Returns the delay of the sensor (measurements) if it clearly differs from the `assumed` one.
    pub(super) fn delay_other_than(&self, assumed: usize) -> Option<usize> {
        PER_JOINT.iter().find_map(|per_joint| {
            let residuals = self.residuals(window(*per_joint, self.joints))?;
            let best = (0..=LONGEST).min_by(|a, b| residuals[*a].total_cmp(&residuals[*b]))?;
            let with_assumed = residuals[assumed.min(LONGEST)];
            (best != assumed && residuals[best] <= CLEARLY_SMALLER * with_assumed).then_some(best)
        })
    }

    /// Squared residuals of the fits with delays 0 to [`LONGEST`] over the first `count` measurements; `None` with fewer
    /// measurements, or if the tip did not move.
    fn residuals(&self, count: usize) -> Option<Vec<f64>> {
        let (n, rows) = (self.joints, count - 1 - LONGEST);
        if self.positions.len() < count {
            return None;
        }
        let step = |k: usize, j: usize| self.commands[(k + 1) * n + j] - self.commands[k * n + j];
        let moved = DMatrix::from_fn(rows, 3, |row, k| {
            let at = row + LONGEST;
            self.positions[at + 1][k] - self.positions[at][k]
        });
        if !(moved.norm_squared() > 0.0) {
            return None;
        }
        let of_delay = |delay: usize| {
            let sent = DMatrix::from_fn(rows, n, |row, j| step(row + LONGEST - delay, j));
            unexplained(sent, &moved)
        };
        (0..=LONGEST).map(of_delay).collect()
    }
}

/// Number of measurements for a fit.
fn window(per_joint: usize, joints: usize) -> usize {
    2 * LONGEST + per_joint * joints
}

/// Squared norm of the part of `moved` outside the column space of `sent`.
fn unexplained(sent: DMatrix<f64>, moved: &DMatrix<f64>) -> Option<f64> {
    let decomposed = sent.try_svd(true, false, f64::EPSILON, 1000)?;
    let (directions, sizes) = (decomposed.u?, decomposed.singular_values);
    let mut rest = moved.clone();
    for (direction, _) in directions.column_iter().zip(&sizes).filter(|(_, size)| **size > NEGLIGIBLE * sizes.max()) {
        rest -= direction * (direction.transpose() * moved);
    }
    Some(rest.norm_squared())
}
