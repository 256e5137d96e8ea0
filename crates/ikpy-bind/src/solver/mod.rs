//! Solvers, one family a file, budgets and statuses.

mod bas;
mod broyden_bas;
mod levenberg_marquardt;
mod multi_start;
mod stop;

use ikcore::solver::{Algorithm, AnySolver, DerivativeFree, MultiStart};
use pyo3::prelude::*;

use bas::PyBas;
pub use broyden_bas::PyBroydenBas;
use levenberg_marquardt::PyLevenbergMarquardt;
use multi_start::PyMultiStart;
pub use stop::{PyStop, status};

use crate::convert::summary;
use crate::error::invalid;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyBas>()?;
    module.add_class::<PyBroydenBas>()?;
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
    first_of!(solver; PyBas, PyBroydenBas, PyLevenbergMarquardt);
    if let Ok(multi_start) = solver.cast::<PyMultiStart>() {
        return Ok(AnySolver::MultiStart(multi_start.get().0.clone()));
    }
    Err(invalid(format!("solver must be BAS, BroydenBAS, LevenbergMarquardt or MultiStart, got {}", summary(solver))))
}

/// A solver argument for something of which only values are known.
pub fn derivative_free(solver: &Bound<'_, PyAny>) -> PyResult<AnySolver<DerivativeFree>> {
    match any_solver(solver)? {
        AnySolver::Single(Algorithm::DerivativeFree(algorithm)) => Ok(AnySolver::Single(algorithm)),
        AnySolver::MultiStart(MultiStart { solver: Algorithm::DerivativeFree(algorithm), rule }) => {
            Ok(AnySolver::MultiStart(MultiStart { solver: algorithm, rule }))
        }
        _ => Err(invalid(format!("solver must be one that needs values alone, such as BAS, got {}", summary(solver)))),
    }
}

/// The Python value of an algorithm.
fn to_python<'py>(py: Python<'py>, algorithm: &Algorithm) -> PyResult<Bound<'py, PyAny>> {
    match algorithm {
        Algorithm::DerivativeFree(DerivativeFree::Bas(bas)) => Ok(Bound::new(py, PyBas(*bas))?.into_any()),
        Algorithm::DerivativeFree(_) => Err(invalid("this solver has no Python class yet".into())),
        Algorithm::BroydenBas(solver) => Ok(Bound::new(py, PyBroydenBas(*solver))?.into_any()),
        Algorithm::LevenbergMarquardt(solver) => Ok(Bound::new(py, PyLevenbergMarquardt(*solver))?.into_any()),
    }
}
