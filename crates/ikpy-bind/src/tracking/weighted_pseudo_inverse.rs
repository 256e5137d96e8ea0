//! `WeightedPseudoInverse`.

use std::sync::Arc;

use ikcore::tracking::{Integrator, TickRule, WeightedPseudoInverse};
use pyo3::prelude::*;

use crate::convert::{row, vector};
use crate::error::raise;
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, keywords};
use crate::trajectory::PyTrajectory;

/// Resolved motion rate control, a tick rule for `track` and `Tracker`: joint velocities follow from the velocity of the
/// target by the weighted pseudo-inverse of the Jacobian, inside the limits,
///
/// q' = Jw+ (x' + gain (x - f(q))) + (I - Jw+ J) q0',  Jw+ = W^-1 J' (J W^-1 J')^-1,
///
/// where q0' is the negative gradient of the goals plus a velocity towards `posture`. The other joints compensate for
/// joints at a limit.
///
/// Defaults: `WeightedPseudoInverse(gain=None, integrator='euler', weights=None, posture=None, posture_gain=20.0,
/// damping=0.0)`.
///
/// Args:
///     gain: feedback gain of the tip error (1/s), below 2 / dt. None: corrects half of the error in each tick.
///     integrator: "euler": the velocity at the start of a tick; "rk4": four evaluations per tick and far smaller errors.
///     weights: W (n,), weights of the squared joint velocities. None: 1 / (vU - vL)^2 from the velocity limits.
///     posture: a `Trajectory` that the joints follow in the null space.
///     posture_gain: feedback gain of the distance from `posture` (1/s).
///     damping: damping relative to the squared norm of the weighted Jacobian. 0 gives the pseudo-inverse itself, which
///         demands unbounded speed near singularities.
#[pyclass(name = "WeightedPseudoInverse", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyWeightedPseudoInverse(WeightedPseudoInverse);

#[pymethods]
impl PyWeightedPseudoInverse {
    #[new]
    #[pyo3(signature = (*, gain=None, integrator="euler", weights=None, posture=None,
                        posture_gain=WeightedPseudoInverse::default().posture_gain, damping=0.0))]
    fn new(
        gain: Option<f64>,
        #[pyo3(from_py_with = crate::convert::text)] integrator: &str,
        weights: Option<&Bound<'_, PyAny>>,
        posture: Option<&PyTrajectory>,
        posture_gain: f64,
        damping: f64,
    ) -> PyResult<Self> {
        let rule = WeightedPseudoInverse {
            gain,
            integrator: integrator.parse::<Integrator>().map_err(raise)?,
            weights: weights.map(|weights| vector("weights", weights)).transpose()?,
            posture: posture.map(|posture| Arc::new(posture.core().clone())),
            posture_gain,
            damping,
        };
        TickRule::WeightedPseudoInverse(rule.clone()).validate().map_err(raise)?;
        Ok(Self(rule))
    }

    /// Feedback gain of the tip error (1/s); None: half of the error in each tick.
    #[getter]
    fn gain(&self) -> Option<f64> {
        self.0.gain
    }

    /// Integration scheme: "euler" or "rk4".
    #[getter]
    fn integrator(&self) -> &'static str {
        self.0.integrator.name()
    }

    /// Weights of the squared joint velocities (n,); None: from the velocity limits.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        self.0.weights.as_ref().map(|weights| row(py, weights.clone()).into_any())
    }

    /// The trajectory that the joints follow in the null space.
    #[getter]
    fn posture(&self) -> Option<PyTrajectory> {
        self.0.posture.as_ref().map(|posture| PyTrajectory::from((**posture).clone()))
    }

    /// Feedback gain of the distance from `posture` (1/s).
    #[getter]
    fn posture_gain(&self) -> f64 {
        self.0.posture_gain
    }

    /// Damping relative to the squared norm of the weighted Jacobian.
    #[getter]
    fn damping(&self) -> f64 {
        self.0.damping
    }

    fn __repr__(&self) -> String {
        let WeightedPseudoInverse { gain, integrator, weights, posture, posture_gain, damping } = &self.0;
        let gain = gain.text();
        let weights = weights.as_ref().map_or("None".into(), |weights| format!("{weights:?}"));
        let posture =
            posture.as_ref().map_or("None".into(), |posture| format!("<Trajectory of {} s>", posture.duration()));
        format!(
            "WeightedPseudoInverse(gain={gain}, integrator='{}', weights={weights}, posture={posture}, \
             posture_gain={posture_gain:?}, damping={damping:?})",
            integrator.name()
        )
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["gain", "integrator", "weights", "posture", "posture_gain", "damping"])
    }
}

impl PyWeightedPseudoInverse {
    /// Returns the tick rule.
    pub fn rule(&self) -> TickRule {
        TickRule::WeightedPseudoInverse(self.0.clone())
    }
}
