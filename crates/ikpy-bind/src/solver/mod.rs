//! Solvers, one family per file; budgets and statuses.

mod algorithm;
mod any_solver;
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

use pyo3::prelude::*;

use algorithm::add_classes;
pub use algorithm::solver_names;
pub use any_solver::{any_solver, derivative_free_solver, derivative_free_to_python, known_solver};
pub use broyden_bas::PyBroydenBas;
use multi_start::PyMultiStart;
pub use stop::{PyStop, status};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    add_classes(module)?;
    module.add_class::<PyMultiStart>()?;
    module.add_class::<PyStop>()?;
    module.add("Status", stop::status_class(module.py())?)
}
