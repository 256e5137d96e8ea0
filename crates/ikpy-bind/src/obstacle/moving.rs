//! `Moving`: an obstacle with a velocity.

use ikcore::shape::Shape;
use numpy::PyArray1;
use pyo3::prelude::*;

use super::argument::{Obstacles, items, not_made_here};
use super::body::PyObstacle;
use super::from_core::wrapped;
use crate::convert::{copied, point};
use crate::error::invalid;
use crate::hash::content_hash;

/// An obstacle that moves, for a `Tracker`: where it is now, and its velocity.
///
/// Give the obstacles anew, `tracker.obstacles = [...]`, as often as they are seen. In between each counts as anywhere that its speed
/// could have taken it, in any direction: its clearance is guaranteed as long as it is no faster.
///
/// Args:
///     shape: a shape of `bik.obstacles`, where it is now.
///     velocity: (3,) (m/s), in the frame of the robot's base.
#[pyclass(name = "Moving", module = "beetle_ik.obstacles", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyMoving {
    shape: Shape,
    velocity: [f64; 3],
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
        Ok(Self { shape: obstacle.get().core.clone(), velocity })
    }

    /// The shape, where it is now.
    #[getter]
    fn shape(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        wrapped(py, &self.shape)
    }

    /// Its velocity (3,) (m/s).
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.velocity)
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs__(&self, py: Python<'_>) -> PyResult<(Py<PyAny>, [f64; 3])> {
        Ok((wrapped(py, &self.shape)?, self.velocity))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("obstacles.Moving({}, {:?})", wrapped(py, &self.shape)?.bind(py).repr()?, self.velocity))
    }
}

/// Obstacles of which some may move: shapes, and the velocity of each; no velocities if all are at rest.
#[derive(Default)]
pub struct MovingObstacles {
    pub shapes: Vec<Shape>,
    pub velocities: Vec<[f64; 3]>,
}

impl MovingObstacles {
    /// Reads any sequence of obstacles.
    pub fn read(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let given = items(value)?;
        if given.iter().all(|item| item.cast::<PyMoving>().is_err()) {
            return Ok(Self { shapes: Obstacles::read_shapes(value)?, velocities: vec![] });
        }
        let mut all = Self::default();
        for (i, item) in given.iter().enumerate() {
            let (shape, velocity) = match (item.cast::<PyMoving>(), item.cast::<PyObstacle>()) {
                (Ok(moving), _) => (moving.get().shape.clone(), moving.get().velocity),
                (_, Ok(obstacle)) => (obstacle.get().core.clone(), [0.0; 3]),
                _ => return Err(not_made_here(&format!("obstacle {i}"), item)),
            };
            all.shapes.push(shape);
            all.velocities.push(velocity);
        }
        Ok(all)
    }

    /// The obstacles as Python objects: those that move are `Moving`.
    pub fn objects(py: Python<'_>, shapes: &[Shape], velocities: &[[f64; 3]]) -> PyResult<Vec<Py<PyAny>>> {
        let object = |(i, shape): (usize, &Shape)| match velocities.get(i) {
            Some(velocity) if *velocity != [0.0; 3] => {
                Ok(Py::new(py, PyMoving { shape: shape.clone(), velocity: *velocity })?.into_any())
            }
            _ => wrapped(py, shape),
        };
        shapes.iter().enumerate().map(object).collect()
    }
}
