//! Estimate of all parameters: a correction of each transform, joint offsets and the landmark.

use nalgebra::{Rotation3, Translation3, Vector3};

use super::landmark::Landmark;
use super::parameters::{FitParameter, Place};
use crate::math::Pose;

/// Point in the space of the parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Estimate {
    /// Factor on the right of each corrected transform.
    pub corrections: Vec<Pose>,
    /// Zero of each joint (rad, m), added to its angle.
    pub offsets: Vec<f64>,
    pub landmark: Landmark,
}

impl Estimate {
    /// Moves by `step` (one entry per parameter).
    pub fn stepped(&self, parameters: &[FitParameter], step: &[f64]) -> Self {
        let mut next = self.clone();
        let mut twists = vec![[0.0; 6]; self.corrections.len()];
        for (parameter, change) in parameters.iter().zip(step) {
            match parameter.place {
                Place::Offset(joint) => next.offsets[joint] += change,
                Place::Correction { number, direction } => twists[number][direction] = *change,
                Place::Landmark(entry) => next.landmark = next.landmark.moved(entry, *change),
            }
        }
        for (correction, [x, y, z, rx, ry, rz]) in next.corrections.iter_mut().zip(twists) {
            // Translation in the axes of the frame, then rotation about its new origin.
            let rotation = Rotation3::new(Vector3::new(rx, ry, rz));
            *correction *= Pose::from_parts(Translation3::new(x, y, z), rotation);
            correction.rotation.renormalize();
        }
        next
    }

    /// Value of each parameter: translation and rotation vector of its correction, offset, displacement of the landmark.
    pub fn values(&self, parameters: &[FitParameter], start: &Landmark) -> Vec<f64> {
        let value = |parameter: &FitParameter| match parameter.place {
            Place::Offset(joint) => self.offsets[joint],
            Place::Correction { number, direction } if direction < 3 => {
                self.corrections[number].translation.vector[direction]
            }
            Place::Correction { number, direction } => self.corrections[number].rotation.scaled_axis()[direction - 3],
            Place::Landmark(entry) => self.landmark.displacement(start)[entry],
        };
        parameters.iter().map(value).collect()
    }
}
