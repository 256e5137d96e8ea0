//! Motions within constraints that leave straight lines no room, such as a tray that both hands hold.
//!
//! A line is then the way that it becomes when its points are moved to where the constraints hold, by halves. Along a whole path this
//! gives waypoints, dense enough that a spline through them stays within the tolerances between them too, which is certified.

use super::line_check::{LineCheck, PathConstraints};
use crate::error::Result;
use crate::math::cubic_spline::SplineEnds;
use crate::math::vector::{distance, point_between};
use crate::objective::Point;
use crate::obstacle::JointMotion;
use crate::plan::TimedMotion;
use crate::timing::{ConstantLimits, JointPath, TimingOptions, time_optimal};
use crate::trajectory::Trajectory;

/// Distance (rad, m) between configurations of a way that counts as a line.
const SHORT: f64 = 0.12;

/// Fraction of a line by which each of its halves, moved to the constraints, is shorter at least.
const LEAST_PROGRESS: f64 = 0.3;

/// Distances (rad, m) between waypoints, from the first that leads to a certified motion.
const SPACINGS: [f64; 4] = [0.04, 0.02, 0.01, 0.005];

impl LineCheck<'_> {
    /// Whether the way that a line becomes within narrow constraints is clear.
    pub(super) fn is_clear_way(&mut self, from: &[f64], to: &[f64]) -> bool {
        let length = distance(from, to);
        if length <= SHORT {
            return self.clear.is_clear(from, to);
        }
        let mut middle: Point = point_between(from, to, 0.5).collect();
        let most = (1.0 - LEAST_PROGRESS) * length;
        self.bring(&mut middle)
            && distance(from, &middle) <= most
            && distance(&middle, to) <= most
            && self.is_clear_way(from, &middle)
            && self.is_clear_way(&middle, to)
    }
}

impl PathConstraints<'_> {
    /// The fastest motion along the path of `motion`, moved to where narrow constraints hold; `None` if none was certified.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub(super) fn followed(&mut self, motion: &Trajectory, limits: &ConstantLimits) -> Result<Option<Trajectory>> {
        for spacing in SPACINGS {
            let Some(waypoints) = self.waypoints(motion, spacing) else { return Ok(None) };
            let knots = parameters(&waypoints);
            let path =
                JointPath::spline(motion.joints().to_vec(), &waypoints.concat(), Some(&knots), SplineEnds::NotAKnot)?;
            // A path that leaves the position limits between waypoints is none.
            let Ok(timed) = time_optimal(&path, limits, &TimingOptions::default()) else { continue };
            // Between waypoints at a position limit a spline may pass it by a little.
            let is_within = limits.violations(&timed).is_empty();
            if is_within && self.sweep.check(&TimedMotion::new(&timed), [0.0, timed.duration()]).is_ok() {
                return Ok(Some(timed));
            }
        }
        Ok(None)
    }

    /// Configurations along the path of `motion`, `spacing` apart before they were moved to where the constraints hold; `None` where
    /// that fails. Both ends stay.
    fn waypoints(&mut self, motion: &Trajectory, spacing: f64) -> Option<Vec<Vec<f64>>> {
        let (timed, n) = (TimedMotion::new(motion), motion.joints().len());
        let at = |fraction: f64| {
            let mut q = vec![0.0; n];
            timed.write(fraction * motion.duration(), &mut q);
            q
        };
        let fine: Vec<Vec<f64>> = (0..=FINE).map(|i| at(i as f64 / FINE as f64)).collect();
        let mut lengths = vec![0.0];
        for pair in fine.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + distance(&pair[0], &pair[1]));
        }
        let whole = lengths[FINE];
        let count = (whole / spacing).ceil().max(4.0) as usize;
        let mut waypoints = vec![fine[0].clone()];
        for i in 1..count {
            let wanted = whole * i as f64 / count as f64;
            let after = lengths.partition_point(|length| *length < wanted).clamp(1, FINE);
            let fraction = (wanted - lengths[after - 1]) / (lengths[after] - lengths[after - 1]).max(f64::MIN_POSITIVE);
            let mut q = at((after as f64 - 1.0 + fraction) / FINE as f64);
            if !self.onto.bring(&mut q) {
                return None;
            }
            waypoints.push(q);
        }
        waypoints.push(fine[FINE].clone());
        Some(waypoints)
    }
}

/// Samples of a motion from which its length is measured.
const FINE: usize = 2000;

/// Path parameters of waypoints: the lengths of the lines between them.
fn parameters(waypoints: &[Vec<f64>]) -> Vec<f64> {
    let lengths = waypoints.windows(2).scan(0.0, |length, pair| {
        *length += distance(&pair[0], &pair[1]);
        Some(*length)
    });
    std::iter::once(0.0).chain(lengths).collect()
}
