//! The common part of tracking records, with a model and without.

use ikcore::tracking::Record;
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::convert::{row, table};

/// The arrays of a record, converted once.
pub struct Columns {
    pub time: Py<PyArray1<f64>>,
    pub q: Py<PyArrayDyn<f64>>,
    pub qd: Py<PyArrayDyn<f64>>,
    pub position: Py<PyArrayDyn<f64>>,
    pub reference: Py<PyArrayDyn<f64>>,
    pub position_error: Py<PyArray1<f64>>,
    pub rotation_error: Py<PyArray1<f64>>,
    pub step_status: Py<PyArray1<u8>>,
    pub step_evaluations: Py<PyArray1<i64>>,
}

impl Columns {
    pub fn new(py: Python<'_>, record: &Record) -> PyResult<Self> {
        let (k, n) = (record.rows(), record.dof);
        Ok(Self {
            time: row(py, record.time()).unbind(),
            q: table(py, record.q.clone(), &[k, n])?.unbind(),
            qd: table(py, record.qd(), &[k, n])?.unbind(),
            position: table(py, record.position.as_flattened().to_vec(), &[k, 3])?.unbind(),
            reference: table(py, record.reference.as_flattened().to_vec(), &[k, 3])?.unbind(),
            position_error: row(py, record.position_error.clone()).unbind(),
            rotation_error: row(py, record.rotation_error.clone()).unbind(),
            step_status: row(py, record.step_status.iter().map(|status| *status as u8).collect()).unbind(),
            step_evaluations: counts(py, &record.step_evaluations),
        })
    }
}

/// Converts counts (k,) to a numpy array.
pub fn counts(py: Python<'_>, counts: &[usize]) -> Py<PyArray1<i64>> {
    row(py, counts.iter().map(|count| *count as i64).collect()).unbind()
}

/// Defines the getters of a class with `columns`. Four of them differ in meaning without a model, and take their
/// docstrings as arguments.
macro_rules! record {
    (
        $class:ident = |$result:ident| $record:expr,
        $(#[$q_note:meta])* q,
        $(#[$position_note:meta])* position,
        $(#[$evaluations_note:meta])* step_evaluations,
        $(#[$violation_note:meta])* max_violation $(,)?
    ) => {
        #[pymethods]
        impl $class {
            /// Times (k,) (s).
            #[getter]
            fn time<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArray1<f64>> {
                self.columns.time.bind(py)
            }

            $(#[$q_note])*
            #[getter]
            fn q<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArrayDyn<f64>> {
                self.columns.q.bind(py)
            }

            /// Velocities (k, n) (rad/s, m/s): (q_i - q_{i-1}) / dt, zero in row 0.
            #[getter]
            fn qd<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArrayDyn<f64>> {
                self.columns.qd.bind(py)
            }

            $(#[$position_note])*
            #[getter]
            fn position<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArrayDyn<f64>> {
                self.columns.position.bind(py)
            }

            /// Reference positions (k, 3) (m).
            #[getter]
            fn reference<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArrayDyn<f64>> {
                self.columns.reference.bind(py)
            }

            /// Distances between tip and reference (k,) (m).
            #[getter]
            fn position_error<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArray1<f64>> {
                self.columns.position_error.bind(py)
            }

            /// Angles to the reference orientations (k,) (rad); NaN if the orientation is left free.
            #[getter]
            fn rotation_error<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArray1<f64>> {
                self.columns.rotation_error.bind(py)
            }

            /// The error band (m).
            #[getter]
            fn position_tolerance(&self) -> f64 {
                let $result = self;
                $record.criterion.tolerance.position
            }

            /// The error band of orientations (rad).
            #[getter]
            fn rotation_tolerance(&self) -> f64 {
                let $result = self;
                $record.criterion.tolerance.rotation
            }

            /// Status of each step (k,), values of `Status`: SOLVED inside the band, IMPROVED nearer than in the previous step,
            /// otherwise CAPPED.
            #[getter]
            fn step_status<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArray1<u8>> {
                self.columns.step_status.bind(py)
            }

            $(#[$evaluations_note])*
            #[getter]
            fn step_evaluations<'py>(&self, py: Python<'py>) -> &Bound<'py, PyArray1<i64>> {
                self.columns.step_evaluations.bind(py)
            }

            $(#[$violation_note])*
            #[getter]
            fn max_violation(&self) -> f64 {
                let $result = self;
                $record.max_violation
            }

            fn __len__(&self) -> usize {
                let $result = self;
                $record.rows()
            }
        }
    };
}

pub(super) use record;
