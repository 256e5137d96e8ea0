//! Samples of a path at the ticks of a tracker.

use nalgebra::Matrix3;

use super::waypoints::Waypoints;
use crate::error::{Error, Result, require_finite, require_positive};
use crate::math::Pose;

/// Positions, and optionally rotations, at the ticks t_i = i dt. Row 0 is the start; row i is the target at the end of
/// tick i.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    dt: f64,
    points: Waypoints,
    velocities: Option<Vec<[f64; 3]>>,
}

#[expect(clippy::len_without_is_empty, reason = "there are always at least two rows")]
impl Reference {
    /// The reference with these positions (m) and rotations at ticks of `dt` (s).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for `dt` not positive, [`Error::InvalidPath`] for fewer than 2 rows,
    /// [`Error::WrongLength`] if there are not as many rotations as positions, [`Error::NotFinite`],
    /// [`Error::NotRigid`].
    pub fn new(dt: f64, positions: Vec<[f64; 3]>, rotations: Option<Vec<Matrix3<f64>>>) -> Result<Self> {
        require_positive("dt", dt)?;
        Ok(Self { dt, points: Waypoints::new(positions, rotations)?, velocities: None })
    }

    /// The same reference with the velocities (m/s) of its positions, for rules that work with velocities.
    ///
    /// # Errors
    /// [`Error::WrongLength`] unless there is one per position, [`Error::NotFinite`].
    pub fn with_velocities(self, velocities: Vec<[f64; 3]>) -> Result<Self> {
        if velocities.len() != self.points.len() {
            let expected = format!("{}, one a position", self.points.len());
            return Err(Error::WrongLength { what: "path velocities".into(), expected, got: velocities.len() });
        }
        require_finite("path velocities", velocities.as_flattened(), |i| {
            format!("{} of row {}", ["x", "y", "z"][i % 3], i / 3)
        })?;
        Ok(Self { velocities: Some(velocities), ..self })
    }

    /// Time between two rows (s).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Number of rows, one more than the number of ticks.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Time of row `i` (s).
    pub fn time(&self, i: usize) -> f64 {
        i as f64 * self.dt
    }

    /// Position of row `i` (m).
    pub fn position(&self, i: usize) -> [f64; 3] {
        self.points.position(i)
    }

    /// Velocity at row `i` (m/s), if known; at a corner, the velocity of the next segment.
    pub fn velocity(&self, i: usize) -> Option<[f64; 3]> {
        self.velocities.as_ref().map(|velocities| velocities[i])
    }

    /// Rotation of row `i`, if there are rotations.
    pub fn rotation(&self, i: usize) -> Option<Matrix3<f64>> {
        self.points.rotation(i)
    }

    /// Position and rotation of row `i`, if there are rotations.
    pub fn pose(&self, i: usize) -> Option<Pose> {
        self.points.pose(i)
    }
}
