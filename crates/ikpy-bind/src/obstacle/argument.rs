//! Reading of obstacle arguments.

use ikcore::shape::Shape;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::body::PyObstacle;
use super::moving::PyMoving;
use crate::convert::{optional_texts, summary};
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

/// Names of links that may touch something, as passed from Python.
pub type Touch = Option<Vec<String>>;

/// Reads names of links that may touch something.
pub fn read_touch(value: &Bound<'_, PyAny>) -> PyResult<Touch> {
    let wrong = || invalid(format!("touch must be a list of link names, got {}", summary(value)));
    let named = |error: PyErr| if error.is_instance_of::<PyTypeError>(value.py()) { wrong() } else { error };
    optional_texts(value).map_err(named)
}

pub(super) fn items<'py>(value: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
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

pub(super) fn not_made_here(place: &str, got: &Bound<'_, PyAny>) -> PyErr {
    let got = summary(got);
    invalid(format!("{place} must be made by bik.obstacles, such as Sphere or Box, got {got}"))
}
