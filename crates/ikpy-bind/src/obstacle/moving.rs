//! `Moving`: an obstacle with a velocity.

use ikcore::obstacle::Obstacle;
use numpy::PyArray1;
use pyo3::prelude::*;

use super::body::{PyObstacle, not_made_here};
use super::from_core::wrapped;
use crate::convert::{copied, point};
use crate::error::invalid;
use crate::hash::content_hash;

/// A moving obstacle for a `Tracker`: its present shape and its velocity.
///
/// Assign `tracker.obstacles = [...]` at each new observation. Until then, an obstacle counts as everywhere that its
/// speed could have taken it, in any direction, and commands keep clear of this region. An obstacle faster than stated
/// can hit the arm, and so can any obstacle if the arm is cornered or too slow to give way.
///
/// Args:
///     shape: a shape of `bik.obstacles`, at its present position.
///     velocity: (3,) (m/s), in the frame of the robot's base.
#[pyclass(name = "Moving", module = "beetle_ik.obstacles", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyMoving {
    pub(super) obstacle: Obstacle,
    pub(super) velocity: [f64; 3],
}

#[pymethods]
impl PyMoving {
    #[new]
    #[pyo3(signature = (shape, velocity))]
    fn new(shape: &Bound<'_, PyAny>, velocity: &Bound<'_, PyAny>) -> PyResult<Self> {
        let obstacle = shape.cast::<PyObstacle>().map_err(|_| not_made_here("shape", shape))?;
        let velocity = point("velocity", velocity)?;
        if !velocity.iter().all(|entry| entry.is_finite()) {
            return Err(invalid(format!("velocity must be finite, got {velocity:?}")));
        }
        Ok(Self { obstacle: obstacle.get().core.clone(), velocity })
    }

    /// The shape, at its present position.
    #[getter]
    fn shape(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        wrapped(py, &self.obstacle)
    }

    /// Velocity (3,) (m/s), in the frame of the robot's base.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.velocity)
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs__(&self, py: Python<'_>) -> PyResult<(Py<PyAny>, [f64; 3])> {
        Ok((wrapped(py, &self.obstacle)?, self.velocity))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("obstacles.Moving({}, {:?})", wrapped(py, &self.obstacle)?.bind(py).repr()?, self.velocity))
    }
}
