//! `ControlSession`, and reading of controller arguments.

use std::sync::{Mutex, OnceLock};

use ikcore::solver::Stopwatch;
use ikcore::task::Tolerance;
use ikcore::tracking::ControlSession;
use ikcore::tracking::{Controller, TipPose};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::session::in_progress;
use super::step::{PyStep, Remarks};
use super::znnbas::PyZnnbas;
use crate::convert::{array, copied, count, counted, own, rigid_rows, shape_text, summary, vector};
use crate::error::{invalid, raise};
use crate::limits::{PyLimits, Sampling, limits_without_robot};
use crate::pickling;
use crate::solver::PyBroydenBas;
use crate::tips::TipErrors;
use crate::traversal::traversed;

/// A model-free controller for your own loop and hardware.
///
///     session = bik.BroydenBAS(max_evaluations_per_step=1).session(start_q, dt=0.01, limits=limits)
///     while session.time < path.duration:
///         q = session.command(path.position(session.time + session.dt))
///         session.observe(measure_tip_after(q))
///
/// The first command is the start itself: it measures where the tip is and does not advance the time. After that, a tick
/// ends, and the time advances by dt, when the controller needs no further measurement: for `ZNNBAS` after each one, for
/// `BroydenBAS` when the error is in its band or max_evaluations_per_step are made.
#[pyclass(name = "ControlSession", module = "beetle_ik", frozen)]
pub struct PyControlSession {
    session: Mutex<ControlSession>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PyControlSession: limits);

in_progress!(PyControlSession, ControlSession);

#[pymethods]
impl PyControlSession {
    /// Returns the next command (n,) (rad, m), which moves the tip towards `target` for the end of the tick: a position
    /// (3,) (m), or a pose (4, 4) if the first target was one. The command is inside the limits, and within the
    /// velocity limits from the last accepted configuration.
    fn command<'py>(&self, py: Python<'py>, target: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let target = tip_pose("target", target)?;
        Ok(own(copied(py, self.session().command(&target).map_err(raise)?)))
    }

    /// Takes the `position` (3,) (m) or the pose (4, 4) of the tip, measured at the last command; it must be a pose if the
    /// targets are poses. Returns a `Step` if the tick has ended, else None.
    fn observe(&self, py: Python<'_>, position: &Bound<'_, PyAny>) -> PyResult<Option<PyStep>> {
        let position = tip_pose("position", position)?;
        let (watch, mut session) = (Stopwatch::start(), self.session());
        let step = session.observe(&position).map_err(raise)?;
        Ok(step.map(|core| PyStep {
            core,
            q: copied(py, session.q()).unbind(),
            qd: copied(py, &session.qd()).unbind(),
            limits: self.limits.clone_ref(py),
            elapsed: watch.elapsed(),
            tips: TipErrors::unnamed(),
            remarks: Remarks::default(),
            among: None,
            around: OnceLock::new(),
        }))
    }

    /// Names the way to another session.
    fn __reduce__(&self) -> PyResult<()> {
        Err(pickling::in_progress("ControlSession", "begin another one at the q of this one"))
    }

    fn __repr__(&self) -> String {
        let session = self.session();
        let joints = counted(session.q().len(), "joint");
        format!("<ControlSession of {joints} at t = {} s, dt = {} s>", session.time(), session.dt())
    }
}

impl PyControlSession {
    fn new(
        controller: &Controller,
        start: &Bound<'_, PyAny>,
        dt: f64,
        limits: Option<&PyLimits>,
        tolerance: Tolerance,
        seed: i128,
    ) -> PyResult<Self> {
        let py = start.py();
        let start = vector("start_q", start)?;
        limits.map_or(Ok(()), |limits| limits.require_no_functions("session", "track_model_free"))?;
        let (in_force, limits) = limits_without_robot(py, limits, start.len(), &Sampling::once())?;
        let session = ControlSession::new(controller, &start, dt, limits, tolerance, count("seed", seed)?);
        Ok(Self { session: Mutex::new(session.map_err(raise)?), limits: in_force })
    }
}

/// Reads a position or a pose.
pub fn tip_pose(what: &str, value: &Bound<'_, PyAny>) -> PyResult<TipPose> {
    let numbers = array(what, value)?;
    match (numbers.shape(), numbers.as_slice()?) {
        ([3], &[x, y, z]) => Ok([x, y, z].into()),
        ([4, 4], rows) => Ok(TipPose::from(&rigid_rows(what, rows)?)),
        (shape, _) => {
            let got = shape_text(shape);
            Err(invalid(format!("{what}: expected a position (3,) or a pose (4, 4), got shape {got}")))
        }
    }
}

/// Reads a `controller` argument.
pub fn controller(controller: Option<&Bound<'_, PyAny>>) -> PyResult<Controller> {
    let Some(controller) = controller else { return Ok(Controller::default()) };
    if let Ok(broyden) = controller.cast::<PyBroydenBas>() {
        return Ok(broyden.get().controller());
    }
    if let Ok(znnbas) = controller.cast::<PyZnnbas>() {
        return Ok(znnbas.get().controller());
    }
    Err(invalid(format!("controller must be BroydenBAS or ZNNBAS, got {}", summary(controller))))
}

/// Defines the method `session` of a controller's class.
macro_rules! session {
    ($class:ty) => {
        #[pymethods]
        impl $class {
            /// Starts a `ControlSession` at `start_q` (n,) and t = 0, for your own loop.
            #[pyo3(signature = (start_q, *, dt, limits=None, position_tolerance=1e-9, rotation_tolerance=1e-9, seed=0))]
            fn session(
                &self,
                start_q: &Bound<'_, PyAny>,
                dt: f64,
                limits: Option<&PyLimits>,
                position_tolerance: f64,
                rotation_tolerance: f64,
                seed: i128,
            ) -> PyResult<PyControlSession> {
                let tolerance = Tolerance { position: position_tolerance, rotation: rotation_tolerance };
                PyControlSession::new(&self.controller(), start_q, dt, limits, tolerance, seed)
            }
        }
    };
}

session!(PyBroydenBas);
session!(PyZnnbas);
