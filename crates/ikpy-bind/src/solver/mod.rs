//! Solvers, one family a file, budgets and statuses.

mod bas;
mod levenberg_marquardt;
mod multi_start;
mod stop;

use ikcore::solver::{Algorithm, AnySolver, DerivativeFree};
use pyo3::prelude::*;

use bas::PyBas;
use levenberg_marquardt::PyLevenbergMarquardt;
use multi_start::PyMultiStart;
pub use stop::{PyStop, status};

use crate::convert::summary;
use crate::error::invalid;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyBas>()?;
    module.add_class::<PyLevenbergMarquardt>()?;
    module.add_class::<PyMultiStart>()?;
    module.add_class::<PyStop>()?;
    module.add("Status", stop::status_class(module.py())?)
}

/// Tries the classes one after another.
macro_rules! first_of {
    ($value:expr; $($class:ty),*) => {$(
        if let Ok(solver) = $value.cast::<$class>() {
            return Ok(AnySolver::Single(solver.get().0.clone().into()));
        }
    )*};
}

/// A solver argument.
pub fn any_solver(solver: &Bound<'_, PyAny>) -> PyResult<AnySolver> {
    first_of!(solver; PyBas, PyLevenbergMarquardt);
    if let Ok(multi_start) = solver.cast::<PyMultiStart>() {
        return Ok(AnySolver::MultiStart(multi_start.get().0.clone()));
    }
    Err(invalid(format!("solver must be BAS, LevenbergMarquardt or MultiStart, got {}", summary(solver))))
}

/// The Python value of an algorithm.
fn to_python<'py>(py: Python<'py>, algorithm: &Algorithm) -> PyResult<Bound<'py, PyAny>> {
    match algorithm {
        Algorithm::DerivativeFree(DerivativeFree::Bas(bas)) => Ok(Bound::new(py, PyBas(*bas))?.into_any()),
        Algorithm::LevenbergMarquardt(solver) => Ok(Bound::new(py, PyLevenbergMarquardt(*solver))?.into_any()),
    }
}
