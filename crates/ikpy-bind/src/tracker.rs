//! `Tracker` and `Step`.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use ikcore::limits::LimitAt;
use ikcore::solver::stop::Stopwatch;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Tolerance;
use ikcore::tracking::{self, Session, TrackOptions};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::convert::{count, point, row, vector};
use crate::error::raise;
use crate::goal::read_goals;
use crate::ik::read_target;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::robot::PyRobot;
use crate::solver::status;
use crate::task::read_task;
use crate::tracking::tick_rule;

/// What became of one step of a `Tracker` or a `ControlSession`.
#[pyclass(name = "Step", module = "beetle_ik", frozen)]
pub struct PyStep {
    core: tracking::Step,
    /// The configuration to command (n,) (rad, m).
    #[pyo3(get)]
    q: Py<PyArray1<f64>>,
    /// The velocity that leads there (n,) (rad/s, m/s).
    #[pyo3(get)]
    qd: Py<PyArray1<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    elapsed: Duration,
}

impl PyStep {
    pub fn new(
        py: Python<'_>,
        core: tracking::Step,
        (q, qd): (&[f64], &[f64]),
        limits: &Py<PyLimits>,
        watch: Stopwatch,
    ) -> Self {
        let elapsed = watch.elapsed();
        let [q, qd] = [q, qd].map(|values| row(py, values.to_vec()).unbind());
        Self { core, q, qd, limits: limits.clone_ref(py), elapsed }
    }
}

#[pymethods]
impl PyStep {
    /// Whether the tip is within the tolerances.
    #[getter]
    fn success(&self) -> bool {
        self.core.status == Status::Solved
    }

    /// SOLVED within the tolerances, IMPROVED nearer than the step before, CAPPED neither.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        status(py, self.core.status)
    }

    /// What happened, and what to try.
    #[getter]
    fn message(&self) -> String {
        self.core.message()
    }

    /// Distance of the tip from the target (m).
    #[getter]
    fn position_error(&self) -> f64 {
        self.core.error.position
    }

    /// Geodesic angle to the target's orientation (rad); NaN where none was asked for.
    #[getter]
    fn rotation_error(&self) -> f64 {
        self.core.error.rotation
    }

    /// Evaluations of the forward kinematics.
    #[getter]
    fn evaluations(&self) -> usize {
        self.core.evaluations
    }

    /// Time that the step took to compute (s).
    #[getter]
    fn elapsed(&self) -> f64 {
        self.elapsed.as_secs_f64()
    }

    /// False where a joint cannot be brought within its position limits in this step.
    #[getter]
    fn inside_limits(&self) -> bool {
        self.core.inside_limits
    }

    fn __repr__(&self) -> String {
        format!("<Step {}: {}>", self.core.status.name(), self.core.message())
    }
}

/// One control loop, one call a tick: the same as `track`, for targets that come one at a time.
///
/// Args:
///     robot: the arm.
///     start: (n,), configuration at t = 0.
///     dt: time step (s).
///     task, goals: as in `track`.
///     solver: what runs in every step: a solver, `WeightedPseudoInverse`, or None: the library's model-based rule.
///     limits: None: the robot's. Numbers and `Sinusoid`s; a callable has no end to be sampled to.
///     position_tolerance: m.
///     rotation_tolerance: rad.
///     seed: of the random draws.
///     limit_at: as in `track`.
#[pyclass(name = "Tracker", module = "beetle_ik", frozen)]
pub struct PyTracker {
    session: Mutex<Session>,
    /// The robot that is moved.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

#[pymethods]
impl PyTracker {
    #[new]
    #[pyo3(signature = (robot, start, *, dt, task=None, solver=None, limits=None, goals=None,
                        position_tolerance=1e-6, rotation_tolerance=1e-6, seed=0, limit_at="interval"))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        robot: &Bound<'_, PyRobot>,
        start: &Bound<'_, PyAny>,
        dt: f64,
        task: Option<&Bound<'_, PyAny>>,
        solver: Option<&Bound<'_, PyAny>>,
        limits: Option<&PyLimits>,
        goals: Option<&Bound<'_, PyAny>>,
        position_tolerance: f64,
        rotation_tolerance: f64,
        seed: i128,
        limit_at: &str,
    ) -> PyResult<Self> {
        let (py, arm) = (robot.py(), &robot.get().core);
        limits.map_or(Ok(()), |limits| limits.require_no_functions("Tracker", "track"))?;
        let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
        let options = TrackOptions {
            rule: tick_rule(solver)?,
            task: read_task(task)?,
            goals: read_goals(goals)?,
            tolerance: Tolerance { position: position_tolerance, rotation: rotation_tolerance },
            limits: resolved,
            limit_at: limit_at.parse::<LimitAt>().map_err(raise)?,
            seed: count("seed", seed)?,
        };
        let session = Session::new(arm, &vector("start", start)?, dt, &options).map_err(raise)?;
        Ok(Self { session: Mutex::new(session), robot: robot.clone().unbind(), limits: in_force })
    }

    /// Moves by one tick towards `target`, a pose (4, 4) or a position (3,) (m), inside the limits.
    ///
    /// Args:
    ///     target: where the tip is to be at the end of the tick.
    ///     velocity: (3,) (m/s), that of the target then, for `WeightedPseudoInverse`; None: the way from where it was.
    ///         Other rules need none.
    #[pyo3(signature = (target, *, velocity=None))]
    fn step(&self, py: Python<'_>, target: &Bound<'_, PyAny>, velocity: Option<&Bound<'_, PyAny>>) -> PyResult<PyStep> {
        let target = read_target(target)?;
        let velocity = velocity.map(|velocity| point("velocity", velocity)).transpose()?;
        let (watch, mut session) = (Stopwatch::start(), self.session());
        let core = session.step_moving(&target, velocity, &mut Unattended).map_err(raise)?;
        Ok(PyStep::new(py, core, (session.q(), session.qd()), &self.limits, watch))
    }

    /// The configuration reached (n,) (rad, m).
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

    /// Back to rest in q (n,), at t = 0.
    fn reset(&self, q: &Bound<'_, PyAny>) -> PyResult<()> {
        self.session().reset(&vector("q", q)?).map_err(raise)
    }

    fn __repr__(&self) -> String {
        let session = self.session();
        format!("<Tracker of '{}' at t = {} s, dt = {} s>", session.robot().name(), session.time(), session.dt())
    }
}

impl PyTracker {
    /// A panic elsewhere cannot have left the session half-changed: it is written in one go at the end of a step.
    fn session(&self) -> MutexGuard<'_, Session> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
