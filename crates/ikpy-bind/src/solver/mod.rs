//! Solvers, one family a file, budgets and statuses.

mod apps;
mod bas;
mod broyden_bas;
mod jacobian_transpose;
mod levenberg_marquardt;
mod multi_start;
mod newton_raphson;
mod pso;
mod rate;
mod schedule;
mod stop;
mod swarm;

use ikcore::solver::{Algorithm, AnySolver, DerivativeFree};
use pyo3::prelude::*;

use apps::PyApps;
use bas::PyBas;
pub use broyden_bas::PyBroydenBas;
use jacobian_transpose::PyJacobianTranspose;
use levenberg_marquardt::PyLevenbergMarquardt;
use multi_start::PyMultiStart;
use newton_raphson::PyNewtonRaphson;
use pso::PyPso;
pub use stop::{PyStop, status};
use swarm::{PyBeeColony, PyBeetleSwarm, PyDifferentialEvolution, PyFirefly, PyGenetic, PyQpso};

use crate::convert::summary;
use crate::error::invalid;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyApps>()?;
    module.add_class::<PyBas>()?;
    module.add_class::<PyBroydenBas>()?;
    module.add_class::<PyBeeColony>()?;
    module.add_class::<PyBeetleSwarm>()?;
    module.add_class::<PyDifferentialEvolution>()?;
    module.add_class::<PyFirefly>()?;
    module.add_class::<PyGenetic>()?;
    module.add_class::<PyJacobianTranspose>()?;
    module.add_class::<PyLevenbergMarquardt>()?;
    module.add_class::<PyMultiStart>()?;
    module.add_class::<PyNewtonRaphson>()?;
    module.add_class::<PyPso>()?;
    module.add_class::<PyQpso>()?;
    module.add_class::<PyStop>()?;
    module.add("Status", stop::status_class(module.py())?)
}

/// The names of those that need values alone, for messages.
const DERIVATIVE_FREE: &str = "BAS, BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, PSO, QPSO";
/// The names of those that need more.
const WITH_MORE: &str = "APPS, BroydenBAS, JacobianTranspose, LevenbergMarquardt, NewtonRaphson";

/// Returns from the function with the solver if it is of one of these classes.
macro_rules! return_if_one_of {
    ($value:expr; $($class:ty),*) => {$(
        if let Ok(solver) = $value.cast::<$class>() {
            return Ok(AnySolver::Single(solver.get().0.clone().into()));
        }
    )*};
}

/// A solver argument.
pub fn any_solver(solver: &Bound<'_, PyAny>) -> PyResult<AnySolver> {
    any_solver_or("", solver)
}

/// A solver argument where something else, named in `other`, could have been given too.
pub fn any_solver_or(other: &str, solver: &Bound<'_, PyAny>) -> PyResult<AnySolver> {
    return_if_one_of!(solver; PyBas, PyBeeColony, PyBeetleSwarm, PyDifferentialEvolution, PyFirefly, PyGenetic);
    return_if_one_of!(solver; PyPso, PyQpso, PyApps, PyBroydenBas, PyJacobianTranspose, PyLevenbergMarquardt);
    return_if_one_of!(solver; PyNewtonRaphson);
    if let Ok(multi_start) = solver.cast::<PyMultiStart>() {
        return Ok(AnySolver::MultiStart(multi_start.get().0.clone()));
    }
    let (or, got) = (if other.is_empty() { "" } else { " or " }, summary(solver));
    Err(invalid(format!(
        "solver must be {DERIVATIVE_FREE}, {WITH_MORE} or MultiStart of one of them{or}{other}, got {got}"
    )))
}

/// A solver argument of a method that knows values alone.
pub fn derivative_free_solver(method: &str, solver: &Bound<'_, PyAny>) -> PyResult<AnySolver<DerivativeFree>> {
    any_solver(solver)?.into_derivative_free().ok_or_else(|| {
        let got = summary(solver);
        invalid(format!(
            "{method} knows no derivative: solver must be {DERIVATIVE_FREE} or MultiStart of one of them, got {got}"
        ))
    })
}

/// The Python value of an algorithm.
fn to_python<'py>(py: Python<'py>, algorithm: &Algorithm) -> PyResult<Bound<'py, PyAny>> {
    Ok(match algorithm {
        Algorithm::DerivativeFree(solver) => match solver {
            DerivativeFree::Bas(solver) => Bound::new(py, PyBas(*solver))?.into_any(),
            DerivativeFree::BeeColony(solver) => Bound::new(py, PyBeeColony(*solver))?.into_any(),
            DerivativeFree::BeetleSwarm(solver) => Bound::new(py, PyBeetleSwarm(*solver))?.into_any(),
            DerivativeFree::DifferentialEvolution(solver) => {
                Bound::new(py, PyDifferentialEvolution(*solver))?.into_any()
            }
            DerivativeFree::Firefly(solver) => Bound::new(py, PyFirefly(*solver))?.into_any(),
            DerivativeFree::Genetic(solver) => Bound::new(py, PyGenetic(*solver))?.into_any(),
            DerivativeFree::Pso(solver) => Bound::new(py, PyPso(*solver))?.into_any(),
            DerivativeFree::Qpso(solver) => Bound::new(py, PyQpso(*solver))?.into_any(),
        },
        Algorithm::BroydenBas(solver) => Bound::new(py, PyBroydenBas(*solver))?.into_any(),
        Algorithm::Apps(solver) => Bound::new(py, PyApps(*solver))?.into_any(),
        Algorithm::JacobianTranspose(solver) => Bound::new(py, PyJacobianTranspose(*solver))?.into_any(),
        Algorithm::NewtonRaphson(solver) => Bound::new(py, PyNewtonRaphson(*solver))?.into_any(),
        Algorithm::LevenbergMarquardt(solver) => Bound::new(py, PyLevenbergMarquardt(*solver))?.into_any(),
    })
}
