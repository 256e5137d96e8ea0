//! `ControlSession`, and controllers as arguments.

use std::sync::{Mutex, MutexGuard, PoisonError};

use ikcore::solver::stop::Stopwatch;
use ikcore::tracking::Controller;
use ikcore::tracking::controller::Session;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::convert::{count, point, row, summary, vector};
use crate::error::{invalid, raise};
use crate::limits::{PyLimits, Sampling, limits_without_robot};
use crate::solver::PyBroydenBas;
use crate::tracker::PyStep;
use crate::znnbas::PyZnnbas;

/// A controller in your own loop, with your own hardware.
///
///     session = bik.BroydenBAS(max_evaluations_per_step=1).session(q0, dt=0.01, limits=limits)
///     while session.time < path.duration:
///         q = session.command(path.position(session.time + session.dt))
///         session.observe(measure_tip_after(q))
///
/// The first command is the start itself: it only tells where the tip is, and time stands still. From then on a tick is over,
/// and time advances by dt, when the controller has no more to ask: after every measurement for `ZNNBAS`, for
/// `BroydenBAS` once it is in its band or has made max_evaluations_per_step.
#[pyclass(name = "ControlSession", module = "beetle_ik", frozen)]
pub struct PyControlSession {
    session: Mutex<Session>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

#[pymethods]
impl PyControlSession {
    /// Where to send the arm (n,) (rad, m), so that its tip comes to `target` (3,) (m) by the end of the tick. Within the
    /// limits, and within what the velocity limits let the configuration accepted last reach.
    fn command<'py>(&self, py: Python<'py>, target: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let target = point("target", target)?;
        Ok(row(py, self.session().command(target).map_err(raise)?.to_vec()))
    }

    /// The tip was at `position` (3,) (m) at the last command. Returns what became of the tick, a `Step`; None while it
    /// goes on.
    fn observe(&self, py: Python<'_>, position: &Bound<'_, PyAny>) -> PyResult<Option<PyStep>> {
        let position = point("position", position)?;
        let (watch, mut session) = (Stopwatch::start(), self.session());
        let step = session.observe(position).map_err(raise)?;
        Ok(step.map(|step| PyStep::new(py, step, (session.q(), session.qd()), &self.limits, watch)))
    }

    /// The configuration accepted last (n,) (rad, m).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.session().q().to_vec())
    }

    /// Time of that configuration (s).
    #[getter]
    fn time(&self) -> f64 {
        self.session().time()
    }

    /// Time step (s).
    #[getter]
    fn dt(&self) -> f64 {
        self.session().dt()
    }

    fn __repr__(&self) -> String {
        let session = self.session();
        format!("<ControlSession of {} joints at t = {} s, dt = {} s>", session.q().len(), session.time(), session.dt())
    }
}

impl PyControlSession {
    pub fn new(
        controller: &Controller,
        start: &Bound<'_, PyAny>,
        dt: f64,
        limits: Option<&PyLimits>,
        position_tolerance: f64,
        seed: i128,
    ) -> PyResult<Self> {
        let py = start.py();
        let start = vector("start", start)?;
        limits.map_or(Ok(()), |limits| limits.require_no_functions("session", "track_model_free"))?;
        let (in_force, limits) = limits_without_robot(py, limits, start.len(), &Sampling::once())?;
        let session = Session::new(controller, &start, dt, limits, position_tolerance, count("seed", seed)?);
        Ok(Self { session: Mutex::new(session.map_err(raise)?), limits: in_force })
    }

    /// A panic elsewhere cannot have left the session half-changed: it is written in one go at the end of a call.
    fn session(&self) -> MutexGuard<'_, Session> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A controller argument.
pub fn controller(controller: Option<&Bound<'_, PyAny>>) -> PyResult<Controller> {
    let Some(controller) = controller else { return Ok(Controller::default()) };
    if let Ok(broyden) = controller.cast::<PyBroydenBas>() {
        return Ok(Controller::BroydenBas(broyden.get().0));
    }
    if let Ok(znnbas) = controller.cast::<PyZnnbas>() {
        return Ok(znnbas.get().controller());
    }
    Err(invalid(format!("controller must be BroydenBAS or ZNNBAS, got {}", summary(controller))))
}
