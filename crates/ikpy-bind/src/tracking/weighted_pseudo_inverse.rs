//! `WeightedPseudoInverse`.

use std::sync::Arc;

use ikcore::tracking::{Integrator, TickRule, WeightedPseudoInverse};
use pyo3::prelude::*;

use crate::convert::{row, vector};
use crate::error::raise;
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, keywords};
use crate::trajectory::PyTrajectory;

/// Resolved motion rate, a tick rule for `track` and `Tracker`: joint velocities from the velocity of the target by the
/// weighted pseudo-inverse of the Jacobian, inside the limits,
///
/// q' = Jw+ (x' + gain (x - f(q))) + (I - Jw+ J) q0',  Jw+ = W^-1 J' (J W^-1 J')^-1,
///
/// with q0' down the gradient of the goals and towards `posture`. Joints at a limit leave their share to the others.
///
/// Defaults: `WeightedPseudoInverse(gain=None, integrator='euler', weights=None, posture=None, posture_gain=20.0,
/// damping=0.0)`.
///
/// Args:
///     gain: share of the error that is taken back per second (1/s); below 2 / dt. None: half of it in every tick.
///     integrator: "euler", the velocity at the beginning of a tick, or "rk4", four evaluations a tick and far smaller
///         errors.
///     weights: W (n,), the cost of each joint's squared velocity. None: 1 / (vU - vL)^2 from the velocity limits.
///     posture: a `Trajectory` for the joints to follow, as far as the target leaves them free.
///     posture_gain: share of the distance from it that is taken back per second (1/s).
///     damping: over the squared size of the weighted Jacobian; 0 is the pseudo-inverse itself, which near a singular
///         posture asks for all the speed that there is.
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
        integrator: &str,
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

    /// Share of the error that is taken back per second (1/s); None: half of it in every tick.
    #[getter]
    fn gain(&self) -> Option<f64> {
        self.0.gain
    }

    /// "euler" or "rk4".
    #[getter]
    fn integrator(&self) -> &'static str {
        self.0.integrator.name()
    }

    /// The cost of each joint's squared velocity (n,); None: from the velocity limits.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        self.0.weights.as_ref().map(|weights| row(py, weights.clone()).into_any())
    }

    /// What the joints follow, as far as the target leaves them free.
    #[getter]
    fn posture(&self) -> Option<PyTrajectory> {
        self.0.posture.as_ref().map(|posture| PyTrajectory::from((**posture).clone()))
    }

    /// Share of the distance from it that is taken back per second (1/s).
    #[getter]
    fn posture_gain(&self) -> f64 {
        self.0.posture_gain
    }

    /// Damping over the squared size of the weighted Jacobian.
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
    /// As a tick rule.
    pub fn rule(&self) -> TickRule {
        TickRule::WeightedPseudoInverse(self.0.clone())
    }
}
