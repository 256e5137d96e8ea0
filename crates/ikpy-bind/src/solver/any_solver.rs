//! The list of solver classes, and reading of solver arguments.

use ikcore::solver::{Algorithm, AnySolver, DerivativeFree};
use pyo3::PyClass;
use pyo3::prelude::*;

use super::apps::PyApps;
use super::bas::PyBas;
use super::broyden_bas::PyBroydenBas;
use super::jacobian_transpose::PyJacobianTranspose;
use super::levenberg_marquardt::PyLevenbergMarquardt;
use super::multi_start::PyMultiStart;
use super::newton_raphson::PyNewtonRaphson;
use super::pso::PyPso;
use super::swarm::{PyBeeColony, PyBeetleSwarm, PyDifferentialEvolution, PyFirefly, PyGenetic, PyQpso};
use crate::convert::summary;
use crate::error::invalid;

/// The list of solver classes, by the names of the core's variants.
macro_rules! solvers {
    (derivative_free: $($simple:ident = $simple_class:ident),+; with_more: $($richer:ident = $richer_class:ident),+ $(;)?) => {
        /// Names of the derivative-free solvers, for messages.
        const DERIVATIVE_FREE: &[&str] = &[$(<$simple_class as PyClass>::NAME),+];
        /// Names of the others.
        const WITH_MORE: &[&str] = &[$(<$richer_class as PyClass>::NAME),+];

        pub(super) fn add_classes(module: &Bound<'_, PyModule>) -> PyResult<()> {
            $(module.add_class::<$simple_class>()?;)+
            $(module.add_class::<$richer_class>()?;)+
            Ok(())
        }

        /// Returns the algorithm in a Python value; None for anything else.
        fn algorithm(value: &Bound<'_, PyAny>) -> Option<Algorithm> {
            $(if let Ok(solver) = value.cast::<$simple_class>() {
                return Some(solver.get().0.clone().into());
            })+
            $(if let Ok(solver) = value.cast::<$richer_class>() {
                return Some(solver.get().0.clone().into());
            })+
            None
        }

        /// Returns an algorithm as a Python value.
        pub(super) fn to_python<'py>(py: Python<'py>, algorithm: &Algorithm) -> PyResult<Bound<'py, PyAny>> {
            Ok(match algorithm {
                $(Algorithm::DerivativeFree(DerivativeFree::$simple(solver)) => {
                    Bound::new(py, $simple_class(*solver))?.into_any()
                })+
                $(Algorithm::$richer(solver) => Bound::new(py, $richer_class(*solver))?.into_any(),)+
            })
        }
    };
}

solvers! {
    derivative_free: Bas = PyBas, BeeColony = PyBeeColony, BeetleSwarm = PyBeetleSwarm,
        DifferentialEvolution = PyDifferentialEvolution, Firefly = PyFirefly, Genetic = PyGenetic, Pso = PyPso, Qpso = PyQpso;
    with_more: Apps = PyApps, BroydenBas = PyBroydenBas, JacobianTranspose = PyJacobianTranspose,
        LevenbergMarquardt = PyLevenbergMarquardt, NewtonRaphson = PyNewtonRaphson;
}

/// Reads a `solver` argument.
pub fn any_solver(solver: &Bound<'_, PyAny>) -> PyResult<AnySolver> {
    known_solver(solver).ok_or_else(|| invalid(format!("solver must be {}, got {}", solver_names(), summary(solver))))
}

/// Returns the solver in a Python value; None for anything else.
pub fn known_solver(value: &Bound<'_, PyAny>) -> Option<AnySolver> {
    let multi_start = || value.cast::<PyMultiStart>().ok().map(|solver| AnySolver::MultiStart(solver.get().0.clone()));
    algorithm(value).map(AnySolver::Single).or_else(multi_start)
}

/// Names of all solvers, for messages.
pub fn solver_names() -> String {
    format!("{} or MultiStart of one of them", [DERIVATIVE_FREE, WITH_MORE].concat().join(", "))
}

/// Reads the `solver` argument of a method without derivatives.
pub fn derivative_free_solver(method: &str, solver: &Bound<'_, PyAny>) -> PyResult<AnySolver<DerivativeFree>> {
    any_solver(solver)?.into_derivative_free().ok_or_else(|| {
        let (names, got) = (DERIVATIVE_FREE.join(", "), summary(solver));
        invalid(format!("{method} knows no derivative: solver must be {names} or MultiStart of one of them, got {got}"))
    })
}
