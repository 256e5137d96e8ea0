//! Numbers given once for all joints or once per joint.

use pyo3::prelude::*;

use crate::convert::{row, scalar_or_vector};
use crate::error::invalid;
use crate::options::{Shown, list_text};

/// A number, or one per joint.
#[derive(Debug, Clone, PartialEq)]
pub struct PerJoint {
    pub values: Vec<f64>,
    pub single: bool,
}

impl PerJoint {
    pub fn read(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (values, single) = scalar_or_vector(what, value)?;
        if values.is_empty() {
            return Err(invalid(format!("{what}: expected a number or one per joint, got none")));
        }
        Ok(Self { values, single })
    }

    /// Returns the number of a joint.
    pub fn at(&self, joint: usize) -> f64 {
        self.values[if self.values.len() == 1 { 0 } else { joint }]
    }

    pub fn show<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if self.single {
            return Ok(self.values[0].into_pyobject(py)?.into_any());
        }
        Ok(row(py, self.values.clone()).into_any())
    }

    pub fn repr(&self) -> String {
        if self.single { self.values[0].text() } else { list_text(&self.values) }
    }
}
