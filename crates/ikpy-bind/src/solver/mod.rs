//! Solvers, one family a file, budgets and statuses.

mod apps;
mod bas;
mod jacobian_transpose;
mod levenberg_marquardt;
mod multi_start;
mod newton_raphson;
mod rate;
mod stop;

use ikcore::solver::{Algorithm, AnySolver, DerivativeFree};
use pyo3::prelude::*;

use apps::PyApps;
use bas::PyBas;
use jacobian_transpose::PyJacobianTranspose;
use levenberg_marquardt::PyLevenbergMarquardt;
use multi_start::PyMultiStart;
use newton_raphson::PyNewtonRaphson;
pub use stop::{PyStop, status};

use crate::convert::summary;
use crate::error::invalid;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyApps>()?;
    module.add_class::<PyBas>()?;
    module.add_class::<PyJacobianTranspose>()?;
    module.add_class::<PyLevenbergMarquardt>()?;
    module.add_class::<PyMultiStart>()?;
    module.add_class::<PyNewtonRaphson>()?;
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
    first_of!(solver; PyApps, PyBas, PyJacobianTranspose, PyLevenbergMarquardt, PyNewtonRaphson);
    if let Ok(multi_start) = solver.cast::<PyMultiStart>() {
        return Ok(AnySolver::MultiStart(multi_start.get().0.clone()));
    }
    Err(invalid(format!(
        "solver must be APPS, BAS, JacobianTranspose, LevenbergMarquardt, NewtonRaphson or MultiStart, got {}",
        summary(solver)
    )))
}

/// The Python value of an algorithm.
fn to_python<'py>(py: Python<'py>, algorithm: &Algorithm) -> PyResult<Bound<'py, PyAny>> {
    match algorithm {
        Algorithm::DerivativeFree(DerivativeFree::Bas(bas)) => Ok(Bound::new(py, PyBas(*bas))?.into_any()),
        Algorithm::DerivativeFree(_) => Err(invalid("this solver has no Python class yet".into())),
        Algorithm::Apps(solver) => Ok(Bound::new(py, PyApps(*solver))?.into_any()),
        Algorithm::JacobianTranspose(solver) => Ok(Bound::new(py, PyJacobianTranspose(*solver))?.into_any()),
        Algorithm::NewtonRaphson(solver) => Ok(Bound::new(py, PyNewtonRaphson(*solver))?.into_any()),
        Algorithm::LevenbergMarquardt(solver) => Ok(Bound::new(py, PyLevenbergMarquardt(*solver))?.into_any()),
    }
}
