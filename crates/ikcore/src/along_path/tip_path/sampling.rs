//! Timed paths as curves: the times at which they are sampled.

use nalgebra::Matrix3;

use super::tip_curve::{PAUSE, TipPath};
use crate::error::Result;
use crate::path::{Path, Waypoints};

/// Number of equal time intervals for sampling a [`Path`]; on a circle the error of their chords is 5e-6 of the radius.
const INTERVALS: usize = 1000;

/// Number of equal time intervals between the points that the published planner passes.
const POINTS: usize = 50;

impl TipPath {
    /// The curve of `path`, finely sampled.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled).
    pub fn along(path: &Path) -> Result<Self> {
        let times = Self::times(path.duration(), &path.corners());
        let positions = times.iter().map(|t| path.position(*t)).collect();
        let rotations = times.iter().map(|t| path.rotation(*t)).collect();
        Self::sampled(times, positions, rotations)
    }

    /// Times (s) at which a path of this `duration` is sampled, including its `corners`.
    pub fn times(duration: f64, corners: &[f64]) -> Vec<f64> {
        let even = (0..=INTERVALS).map(|i| duration * (i as f64 / INTERVALS as f64));
        let inside = corners.iter().copied().filter(|t| 0.0 < *t && *t < duration);
        let mut times: Vec<f64> = even.chain(inside).collect();
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier <= PAUSE * duration);
        times
    }

    /// The curve through `positions` (m) and rotations of a path at its [`times`](Self::times). Pauses are left out.
    ///
    /// # Errors
    /// [`Error::InvalidPath`](crate::Error::InvalidPath) for a path without extent; those of [`Waypoints::new`].
    pub fn sampled(times: Vec<f64>, positions: Vec<[f64; 3]>, rotations: Option<Vec<Matrix3<f64>>>) -> Result<Self> {
        let waypoints = Waypoints::new(positions, rotations)?;
        let last = times.len() - 1;
        let at = |i: usize| {
            let t = times[last] * (i as f64 / POINTS as f64);
            let after = times.partition_point(|time| *time < t).clamp(1, last);
            if t - times[after - 1] < times[after] - t { after - 1 } else { after }
        };
        let rows: Vec<usize> = (0..=POINTS).map(at).collect();
        Self::from_rows(&waypoints, &rows, Some(&times))
    }
}
