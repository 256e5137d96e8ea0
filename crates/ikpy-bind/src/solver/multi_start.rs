//! `MultiStart`.

use ikcore::solver::{Algorithm, MultiStart};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyTuple};

use super::algorithm::{algorithm, not_a_solver, to_python};
use crate::convert::count;
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::NewArguments;

/// Restarts a solver from random starts when it stalls or makes too little progress.
///
/// Args:
///     solver: any other solver, for example `BAS` or `LevenbergMarquardt`.
///     max_starts: largest number of starts; None: as many as the evaluation budget allows.
#[pyclass(name = "MultiStart", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyMultiStart(pub MultiStart<Algorithm>);

#[pymethods]
impl PyMultiStart {
    #[new]
    #[pyo3(signature = (solver, *, max_starts=None))]
    fn new(solver: &Bound<'_, PyAny>, max_starts: Option<i128>) -> PyResult<Self> {
        if solver.is_instance_of::<Self>() {
            return Err(invalid("MultiStart takes a single solver, not another MultiStart".into()));
        }
        let mut multi_start = algorithm(solver).ok_or_else(|| not_a_solver(solver))?.into_multi_start();
        if let Some(starts) = max_starts {
            multi_start.rule.max_starts = count("max_starts", starts)?;
        }
        multi_start.validate().map_err(raise)?;
        Ok(Self(multi_start))
    }

    /// The solver that is restarted.
    #[getter]
    fn solver<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.0.solver)
    }

    /// Largest number of starts; None: as many as the evaluation budget allows.
    #[getter]
    fn max_starts(&self) -> Option<usize> {
        Some(self.0.rule.max_starts).filter(|starts| *starts != usize::MAX)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let starts = self.max_starts().map_or_else(String::new, |count| format!(", max_starts={count}"));
        Ok(format!("MultiStart({}{starts})", self.solver(py)?.repr()?))
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        Ok((PyTuple::new(py, [self.solver(py)?])?, [("max_starts", self.max_starts())].into_py_dict(py)?))
    }
}
