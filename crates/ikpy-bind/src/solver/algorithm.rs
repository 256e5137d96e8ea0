//! The list of solver classes.

use ikcore::solver::{Algorithm, DerivativeFree};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::PyString;

use super::apps::PyApps;
use super::bas::PyBas;
use super::broyden_bas::PyBroydenBas;
use super::jacobian_transpose::PyJacobianTranspose;
use super::levenberg_marquardt::PyLevenbergMarquardt;
use super::newton_raphson::PyNewtonRaphson;
use super::pso::PyPso;
use super::swarm::{PyBeeColony, PyBeetleSwarm, PyDifferentialEvolution, PyFirefly, PyGenetic, PyQpso};
use crate::convert::summary;
use crate::error::invalid;

/// The list of solver classes, by the names of the core's variants.
macro_rules! solvers {
    (derivative_free: $($simple:ident = $simple_class:ident),+; with_more: $($richer:ident = $richer_class:ident),+ $(;)?) => {
        /// Names of the derivative-free solvers, for messages.
        pub(super) const DERIVATIVE_FREE: &[&str] = &[$(<$simple_class as PyClass>::NAME),+];
        /// Names of the solvers that need more than values, for messages.
        const WITH_MORE: &[&str] = &[$(<$richer_class as PyClass>::NAME),+];

        pub(super) fn add_classes(module: &Bound<'_, PyModule>) -> PyResult<()> {
            $(module.add_class::<$simple_class>()?;)+
            $(module.add_class::<$richer_class>()?;)+
            Ok(())
        }

        /// Returns the algorithm in a Python value; None if it is no solver.
        pub(super) fn algorithm(value: &Bound<'_, PyAny>) -> Option<Algorithm> {
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

/// Names of all solvers, for messages.
pub fn solver_names() -> String {
    format!("{} or MultiStart of one of them", [DERIVATIVE_FREE, WITH_MORE].concat().join(", "))
}

/// Returns the error for a `solver` argument that is no solver.
pub(super) fn not_a_solver(value: &Bound<'_, PyAny>) -> PyErr {
    let object =
        if value.is_instance_of::<PyString>() { ": give an object, such as bik.LevenbergMarquardt()" } else { "" };
    invalid(format!("solver must be {}, got {}{object}", solver_names(), summary(value)))
}
