//! Reading of obstacle arguments.

use ikcore::shape::Shape;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::body::{PyObstacle, not_made_here};
use super::from_core::wrapped;
use super::moving::PyMoving;
use crate::convert::summary;
use crate::error::invalid;

/// The obstacles of a call.
pub struct Obstacles {
    /// For the core.
    pub core: Vec<Shape>,
    /// For results, which store them.
    pub tuple: Py<PyTuple>,
}

impl Obstacles {
    /// Reads any sequence of obstacles; None means no obstacles.
    pub fn read(py: Python<'_>, value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let items = value.map_or_else(|| Ok(vec![]), items)?;
        Ok(Self { core: shapes(&items)?, tuple: PyTuple::new(py, items)?.unbind() })
    }

    /// Reads the shapes of a sequence of obstacles.
    pub fn read_shapes(value: &Bound<'_, PyAny>) -> PyResult<Vec<Shape>> {
        shapes(&items(value)?)
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

fn items<'py>(value: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if value.cast::<PyObstacle>().is_ok() {
        return Err(invalid(format!("obstacles must be a list, got a single one: [{}]", summary(value))));
    }
    let wrong = |error: PyErr| match error.is_instance_of::<PyTypeError>(value.py()) {
        true => not_made_here("obstacles", value),
        false => error,
    };
    value.try_iter().map_err(wrong)?.collect()
}

fn shapes(items: &[Bound<'_, PyAny>]) -> PyResult<Vec<Shape>> {
    let shape = |(i, item): (usize, &Bound<'_, PyAny>)| match item.cast::<PyObstacle>() {
        Ok(obstacle) => Ok(obstacle.get().core.clone()),
        Err(_) if item.cast::<PyMoving>().is_ok() => {
            Err(invalid(format!("obstacle {i} is a Moving; only a Tracker takes obstacles that move: give its shape")))
        }
        Err(_) => Err(not_made_here(&format!("obstacle {i}"), item)),
    };
    items.iter().enumerate().map(shape).collect()
}
