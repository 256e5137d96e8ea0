//! A curve, with an optional constant orientation.

use std::sync::Arc;

use nalgebra::Matrix3;

use super::orientation::check_rotation;
use super::{Curve, Reference};
use crate::error::Result;
use crate::interrupt::checkpoint_at;
use crate::math::ticks::ticks_of_path;
use crate::math::{Pose, pose};

/// A reference in space and time for the tip: a [`Curve`], and optionally an orientation. Cheap to clone.
///
/// As in [`Curve`], time `t` (s) is clamped to `[0, duration]`, and positions and rotations are in the frame of the
/// robot's base.
#[derive(Debug, Clone)]
pub struct Path {
    pub(super) curve: Arc<dyn Curve>,
    pub(super) orientation: Option<Matrix3<f64>>,
}

impl Path {
    /// The path along `curve`, with the curve's own orientation if it has one.
    pub fn new(curve: impl Curve + 'static) -> Self {
        Self { curve: Arc::new(curve), orientation: None }
    }

    /// The same path with this constant orientation, which replaces any other.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) or [`Error::NotRigid`](crate::Error::NotRigid) unless the matrix
    /// is a rotation to 1e-6.
    pub fn with_orientation(&self, rotation: Matrix3<f64>) -> Result<Self> {
        let orientation = Some(check_rotation("path orientation", &rotation)?);
        Ok(Self { curve: Arc::clone(&self.curve), orientation })
    }

    /// Duration of one pass (s).
    pub fn duration(&self) -> f64 {
        self.curve.duration()
    }

    /// Position (m).
    pub fn position(&self, t: f64) -> [f64; 3] {
        self.curve.position(t)
    }

    /// Velocity (m/s); at a corner, the velocity of the next segment.
    pub fn velocity(&self, t: f64) -> [f64; 3] {
        self.curve.velocity(t)
    }

    /// Times (s) at which the direction may jump.
    pub fn corners(&self) -> Vec<f64> {
        self.curve.corners()
    }

    /// Orientation, if the path has one.
    pub fn rotation(&self, t: f64) -> Option<Matrix3<f64>> {
        self.orientation.or_else(|| self.curve.rotation(t))
    }

    /// Position and orientation, if the path has an orientation.
    pub fn pose(&self, t: f64) -> Option<Pose> {
        self.rotation(t).map(|rotation| pose::from_parts(self.position(t), rotation))
    }

    /// Samples the path at the ticks i `dt` (s), from 0 to the first tick at or after its end.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for `dt` not positive, longer than the path, or so small that
    /// more than 10 million ticks would result.
    pub fn sample(&self, dt: f64) -> Result<Reference> {
        let times = (0..=ticks_of_path(self.duration(), dt)?).map(|i| i as f64 * dt);
        let position = |(i, t)| checkpoint_at(i).map(|()| self.position(t));
        let positions = times.clone().enumerate().map(position).collect::<Result<_>>()?;
        let rotations = times.map(|t| self.rotation(t)).collect();
        Reference::new(dt, positions, rotations)
    }

    /// Samples the path as [`sample`](Self::sample), with the velocities at the ticks.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn sample_with_velocities(&self, dt: f64) -> Result<Reference> {
        let reference = self.sample(dt)?;
        let velocities = (0..reference.len()).map(|i| self.velocity(reference.time(i))).collect();
        reference.with_velocities(velocities)
    }
}
