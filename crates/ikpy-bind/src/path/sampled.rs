//! Sampling of paths for the core. Python functions are called here, before the core runs.

use ikcore::math::ticks::ticks_of_path;
use ikcore::nalgebra::Matrix3;
use ikcore::path::Reference;
use ikcore::planning::TipPath;
use pyo3::prelude::*;

use super::reference::{Curve, Orientation, PyPath};
use crate::error::raise;
use crate::monitor::long_call;
use crate::signals::check_signals_at;

/// Positions (m), and orientations if the path has them.
type Sampled = (Vec<[f64; 3]>, Option<Vec<Matrix3<f64>>>);

impl PyPath {
    /// Samples the path at all tick times.
    pub fn reference(&self, py: Python<'_>, dt: f64) -> PyResult<Reference> {
        if let (Curve::Core(path), Orientation::OfCurve) = (&self.curve, &self.orientation) {
            return long_call(py, || path.sample(dt));
        }
        let count = ticks_of_path(self.duration(), dt).map_err(raise)? + 1;
        let (positions, rotations) = self.at(py, (0..count).map(|i| (i as f64 * dt).min(self.duration())))?;
        Reference::new(dt, positions, rotations).map_err(raise)
    }

    /// Samples positions, orientations and velocities at all tick times.
    pub fn reference_with_velocities(&self, py: Python<'_>, dt: f64) -> PyResult<Reference> {
        let reference = self.reference(py, dt)?;
        let velocity = |i: usize| {
            check_signals_at(py, i)?;
            self.velocity_at(py, reference.time(i).min(self.duration()))
        };
        let velocities = (0..reference.len()).map(velocity).collect::<PyResult<_>>()?;
        reference.with_velocities(velocities).map_err(raise)
    }

    /// Samples the path for a planner.
    pub fn tip_path(&self, py: Python<'_>) -> PyResult<TipPath> {
        let corners = match &self.curve {
            Curve::Core(path) => path.corners(),
            Curve::Function { .. } => vec![],
        };
        let times = TipPath::times(self.duration(), &corners);
        let (positions, rotations) = self.at(py, times.iter().copied())?;
        TipPath::sampled(times, positions, rotations).map_err(raise)
    }

    /// Samples positions, and orientations if there are any, at these times.
    fn at(&self, py: Python<'_>, times: impl Iterator<Item = f64>) -> PyResult<Sampled> {
        let (mut positions, mut rotations) = (vec![], vec![]);
        for (i, t) in times.enumerate() {
            check_signals_at(py, i)?;
            positions.push(self.position_at(py, t)?);
            rotations.extend(self.rotation_at(py, t)?);
        }
        Ok((positions, (!rotations.is_empty()).then_some(rotations)))
    }
}
