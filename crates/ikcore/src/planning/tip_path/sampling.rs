//! A path in time as a curve: the times at which it is sampled.

use nalgebra::Matrix3;

use super::TipPath;
use super::tip_curve::PAUSE;
use crate::error::Result;
use crate::path::{Path, Waypoints};

/// Intervals of equal time in which a [`Path`] is sampled: on a circle their chords err by 5e-6 of the radius.
const INTERVALS: usize = 1000;

/// Intervals of equal time between the points that the published planner passes.
const POINTS: usize = 50;

impl TipPath {
    /// Along `path`, finely sampled.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled).
    pub fn along(path: &Path) -> Result<Self> {
        let times = Self::times(path.duration(), &path.corners());
        let positions = times.iter().map(|t| path.position(*t)).collect();
        let rotations = times.iter().map(|t| path.rotation(*t)).collect();
        Self::sampled(times, positions, rotations)
    }

    /// The times (s) at which a path of this `duration` is sampled, those of its `corners` among them.
    pub fn times(duration: f64, corners: &[f64]) -> Vec<f64> {
        let even = (0..=INTERVALS).map(|i| duration * (i as f64 / INTERVALS as f64));
        let inside = corners.iter().copied().filter(|t| 0.0 < *t && *t < duration);
        let mut times: Vec<f64> = even.chain(inside).collect();
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier <= PAUSE * duration);
        times
    }

    /// Through a path's `positions` (m) and rotations at its [`times`](Self::times). Pauses are left out.
    ///
    /// # Errors
    /// [`Error::InvalidPath`](crate::Error::InvalidPath) for a path that stays in one place; those of [`Waypoints::new`].
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
