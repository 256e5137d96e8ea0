//! Solver arguments: an algorithm, or `MultiStart` of one.

use ikcore::solver::{Algorithm, AnySolver, DerivativeFree, MultiStart};
use pyo3::prelude::*;

use super::algorithm::{DERIVATIVE_FREE, algorithm, not_a_solver, to_python};
use super::multi_start::PyMultiStart;
use crate::convert::summary;
use crate::error::invalid;

/// Reads a `solver` argument.
pub fn any_solver(solver: &Bound<'_, PyAny>) -> PyResult<AnySolver> {
    known_solver(solver).ok_or_else(|| not_a_solver(solver))
}

/// Returns the solver in a Python value; None if it is no solver.
pub fn known_solver(value: &Bound<'_, PyAny>) -> Option<AnySolver> {
    let multi_start = || value.cast::<PyMultiStart>().ok().map(|solver| AnySolver::MultiStart(solver.get().0.clone()));
    algorithm(value).map(AnySolver::Single).or_else(multi_start)
}

/// Reads the `solver` argument of a method without derivatives.
pub fn derivative_free_solver(method: &str, solver: &Bound<'_, PyAny>) -> PyResult<AnySolver<DerivativeFree>> {
    any_solver(solver)?.into_derivative_free().ok_or_else(|| {
        let (names, got) = (DERIVATIVE_FREE.join(", "), summary(solver));
        invalid(format!("{method} has no derivatives: solver must be {names} or MultiStart of one of them, got {got}"))
    })
}

/// Returns the Python value of a solver that needs values alone.
pub fn derivative_free_to_python<'py>(
    py: Python<'py>,
    solver: &AnySolver<DerivativeFree>,
) -> PyResult<Bound<'py, PyAny>> {
    match solver.clone() {
        AnySolver::Single(solver) => to_python(py, &Algorithm::DerivativeFree(solver)),
        AnySolver::MultiStart(MultiStart { solver, rule }) => {
            Ok(Bound::new(py, PyMultiStart(MultiStart { solver: Algorithm::DerivativeFree(solver), rule }))?.into_any())
        }
    }
}
