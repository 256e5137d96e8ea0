//! Positions or poses at given times.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use serde::{Deserialize, Serialize};

use super::orientation::check_rotations;
use super::{Curve, Polyline};
use crate::error::{Error, Result};
use crate::math::Pose;

/// Positions, or poses, at given times. Between them the position moves along a straight line and the orientation about
/// a fixed axis, both at constant speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "(Polyline, Rotations)")]
pub struct Samples {
    positions: Polyline,
    rotations: Rotations,
}

/// One rotation per sample.
type Rotations = Option<Vec<UnitQuaternion<f64>>>;

/// Checks stored samples again.
impl TryFrom<(Polyline, Rotations)> for Samples {
    type Error = Error;

    fn try_from((positions, rotations): (Polyline, Rotations)) -> Result<Self> {
        if let Some(rotations) = &rotations {
            let count = positions.knots().times().len();
            if rotations.len() != count {
                let expected = format!("{count}, one per position");
                return Err(Error::WrongLength { what: "path rotations".into(), expected, got: rotations.len() });
            }
            check_rotations(rotations.iter().map(|rotation| rotation.to_rotation_matrix().into_inner()))?;
        }
        Ok(Self { positions, rotations })
    }
}

impl Samples {
    /// Positions (m) at times (s) that start at zero and increase.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] for fewer than 2 points, [`Error::WrongLength`], [`Error::NotFinite`],
    /// [`Error::OutOfRange`] if the first time is not zero, [`Error::NotIncreasing`].
    pub fn from_positions(times: Vec<f64>, positions: Vec<[f64; 3]>) -> Result<Self> {
        Ok(Self { positions: Polyline::through(times, positions)?, rotations: None })
    }

    /// Poses at times (s) that start at zero and increase.
    ///
    /// # Errors
    /// As [`from_positions`](Self::from_positions), and [`Error::NotRigid`].
    pub fn from_poses(times: Vec<f64>, poses: &[Pose]) -> Result<Self> {
        let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
        let positions = Polyline::through(times, positions)?;
        let rotations = check_rotations(poses.iter().map(|pose| pose.rotation.into_inner()))?;
        let quaternion = |rotation| UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        Ok(Self { positions, rotations: Some(rotations.into_iter().map(quaternion).collect()) })
    }
}

impl Curve for Samples {
    fn duration(&self) -> f64 {
        self.positions.duration()
    }

    fn position(&self, t: f64) -> [f64; 3] {
        self.positions.position(t)
    }

    fn velocity(&self, t: f64) -> [f64; 3] {
        self.positions.velocity(t)
    }

    fn corners(&self) -> Vec<f64> {
        self.positions.corners()
    }

    fn rotation(&self, t: f64) -> Option<Matrix3<f64>> {
        let rotations = self.rotations.as_ref()?;
        let knots = self.positions.knots();
        let (row, elapsed) = knots.locate(t);
        let (from, to) = (rotations[row], rotations[row + 1]);
        // The quaternion power is exact for the smallest angles too; the arc cosine of slerp is not.
        let reached = from.rotation_to(&to).powf(elapsed / knots.span(row)) * from;
        Some(reached.to_rotation_matrix().into_inner())
    }
}
