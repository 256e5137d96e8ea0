//! `APPS`.

use ikcore::solver::{Apps, LearningRate};
use pyo3::prelude::*;

use super::rate::number_or_auto;
use crate::error::raise;
use crate::options::options;

/// Autonomous path planning solution (Yuan et al. 2016): gradient descent with a step limit for each joint. Needs no
/// Jacobian and no inverse.
///
/// The error is E of eq. (11): half the sum of squared differences between the matrices of target and tip (between the
/// positions, for a position). The search may leave the limits; whole turns bring revolute joints back, eq. (12). If they
/// cannot, the status is `OUTSIDE_LIMITS`, and the best configuration inside the limits is returned.
///
/// Args:
///     learning_rate: eta of eq. (13); "auto": from the curvature along the last step (Barzilai and Borwein 1988).
///     step_limit: largest change of a joint per iteration, eq. (20) (rad or m).
///     error_threshold: E_0; the search ends after the first update from an E of at most this value, even if the
///         tolerances of the call are not met. None: it ends when they are met.
#[pyclass(name = "APPS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyApps(pub Apps);

#[pymethods]
impl PyApps {
    #[new]
    #[pyo3(
        signature = (*, learning_rate=None, step_limit=Apps::default().step_limit, error_threshold=None),
        text_signature = "(*, learning_rate='auto', step_limit=0.2, error_threshold=None)"
    )]
    fn new(learning_rate: Option<&Bound<'_, PyAny>>, step_limit: f64, error_threshold: Option<f64>) -> PyResult<Self> {
        let rate = number_or_auto("learning_rate", learning_rate)?;
        let learning_rate = rate.map_or(LearningRate::Auto, LearningRate::Fixed);
        let solver = Apps { learning_rate, step_limit, error_threshold };
        solver.validate().map_err(raise)?;
        Ok(Self(solver))
    }

    /// Returns the paper's parameters, in the scale of its eq. (11): rate 0.2, step limit one degree, threshold 5e-10. The
    /// paper's budget is `Stop(max_iterations=1000)`.
    #[staticmethod]
    fn paper() -> Self {
        Self(Apps::paper())
    }
}

options! {
    PyApps, "APPS" {
        /// Learning rate eta of eq. (13), or "auto".
        learning_rate: LearningRate,
        /// Largest change of a joint per iteration (rad or m).
        step_limit: f64,
        /// Error threshold E_0, or None.
        error_threshold: Option<f64>,
    }
}
