//! `Break`.

use ikcore::planning::Break;
use pyo3::prelude::*;

use crate::pickling::stored_value;

/// A place where the tool leaves its path, and goes on with another posture of the arm or farther along.
#[pyclass(name = "Break", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyBreak(pub Break);

#[pymethods]
impl PyBreak {
    /// Where the tool leaves the path: the index of a point, with the part of the way to the next one (12.5 is halfway between points
    /// 12 and 13); for a `Path` its time (s).
    #[getter]
    fn at(&self) -> f64 {
        self.0.at
    }

    /// Where it goes on, counted alike: at the same place, where nothing is left out; at the end of the path, where it does not come back.
    #[getter]
    fn until(&self) -> f64 {
        self.0.until
    }

    /// Why the arm cannot go on along the path: a joint at its limit, a singularity, two bodies, or a point out of reach.
    #[getter]
    fn reason(&self) -> &str {
        &self.0.reason
    }

    /// When the tool leaves the path (s).
    #[getter]
    fn start(&self) -> f64 {
        self.0.start
    }

    /// When it is back (s).
    #[getter]
    fn end(&self) -> f64 {
        self.0.end
    }

    fn __repr__(&self) -> String {
        let Break { at, until, reason, start, end } = &self.0;
        let place = if at == until { format!("at {at:.3}") } else { format!("from {at:.3} to {until:.3}") };
        format!("<Break {place}, {start:.3} to {end:.3} s: {reason}>")
    }
}

stored_value!(PyBreak, "break of a path");
