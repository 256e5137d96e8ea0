//! Reading of obstacle arguments.

use ikcore::shape::Shape;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::body::PyObstacle;
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
        let wrong = |place: &str, got: &Bound<'_, PyAny>| {
            let got = summary(got);
            invalid(format!("{place} must be made by bik.obstacles, such as Sphere or Box, got {got}"))
        };
        let items: Vec<Bound<'_, PyAny>> = match value {
            None => vec![],
            Some(one) if one.cast::<PyObstacle>().is_ok() => {
                return Err(invalid(format!("obstacles must be a list, got a single one: [{}]", summary(one))));
            }
            Some(value) => value.try_iter().map_err(|_| wrong("obstacles", value))?.collect::<PyResult<_>>()?,
        };
        let core = items.iter().enumerate().map(|(i, item)| match item.cast::<PyObstacle>() {
            Ok(obstacle) => Ok(obstacle.get().core.clone()),
            Err(_) => Err(wrong(&format!("obstacle {i}"), item)),
        });
        Ok(Self { core: core.collect::<PyResult<_>>()?, tuple: PyTuple::new(py, items)?.unbind() })
    }
}
