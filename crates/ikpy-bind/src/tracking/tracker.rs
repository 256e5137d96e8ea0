//! `Tracker`.

use std::sync::Mutex;

use ikcore::solver::Stopwatch;
use ikcore::solver::Unattended;
use ikcore::tracking::{Session, TickRule};
use pyo3::prelude::*;

use super::arguments::{TrackArguments, tick_rule};
use super::session::in_progress;
use super::step::PyStep;
use crate::convert::{point, vector};
use crate::error::raise;
use crate::ik::read_target;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched_with_interpreter;
use crate::robot::PyRobot;
use crate::traversal::traversed;

/// Tracks targets that arrive one at a time, one call per tick, otherwise like `track`.
///
/// A target may jump farther than one tick can reach. The model-based rule then moves all joints in proportion, with one at
/// its velocity limit, and brakes in time under acceleration limits.
///
/// Args:
///     robot: the arm.
///     start: (n,), configuration at t = 0.
///     dt: time step (s).
///     task: as in `track`.
///     solver: a solver or `WeightedPseudoInverse`, which runs in each step; None: the model-based rule.
///     limits: numbers and `Sinusoid`s; None: the robot's. Callables cannot be used: there is no end time up to which to
///         sample them.
///     goals: as in `track`.
///     position_tolerance: largest position error (m).
///     rotation_tolerance: largest rotation error (rad).
///     seed: seed of the random draws.
///     limit_at: as in `track`.
#[pyclass(name = "Tracker", module = "beetle_ik", frozen)]
pub struct PyTracker {
    session: Mutex<Session>,
    /// Whether a solver of any budget runs in each step; other rules take microseconds.
    runs_solver: bool,
    /// The robot.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PyTracker: robot, limits);

in_progress!(PyTracker, Session);

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
        #[pyo3(from_py_with = crate::convert::text)] limit_at: &str,
    ) -> PyResult<Self> {
        let (py, arm) = (robot.py(), &robot.get().core);
        limits.map_or(Ok(()), |limits| limits.require_no_functions("Tracker", "track"))?;
        let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
        let rule = tick_rule(solver)?;
        let runs_solver = matches!(rule, TickRule::Solver(_));
        let asked = TrackArguments { rule, task, goals, position_tolerance, rotation_tolerance, seed, limit_at };
        let options = asked.read(resolved)?;
        let session = Session::new(arm, &vector("start", start)?, dt, &options).map_err(raise)?;
        Ok(Self { session: Mutex::new(session), runs_solver, robot: robot.clone().unbind(), limits: in_force })
    }

    /// Moves by one tick towards `target`, a pose (4, 4) or a position (3,) (m), inside the limits.
    ///
    /// Args:
    ///     target: target of the tip at the end of the tick.
    ///     velocity: (3,) (m/s), velocity of the target at the end of the tick, which only `WeightedPseudoInverse` uses;
    ///         None: from the difference to the previous target.
    #[pyo3(signature = (target, *, velocity=None))]
    fn step(&self, py: Python<'_>, target: &Bound<'_, PyAny>, velocity: Option<&Bound<'_, PyAny>>) -> PyResult<PyStep> {
        let target = read_target("target", target)?;
        let velocity = velocity.map(|velocity| point("velocity", velocity)).transpose()?;
        let (watch, mut session) = (Stopwatch::start(), self.session());
        let core = if self.runs_solver {
            watched_with_interpreter(py, None, |watcher| {
                session.step_moving(&target, velocity, watcher).map_err(raise)
            })?
        } else {
            session.step_moving(&target, velocity, &mut Unattended).map_err(raise)?
        };
        let motion = [session.q().to_vec(), session.qd().to_vec()];
        Ok(PyStep::new(py, core, motion, self.limits.clone_ref(py), watch.elapsed()))
    }

    /// Resets to rest at q (n,) and t = 0.
    fn reset(&self, q: &Bound<'_, PyAny>) -> PyResult<()> {
        self.session().reset(&vector("q", q)?).map_err(raise)
    }

    fn __repr__(&self) -> String {
        let session = self.session();
        format!("<Tracker of '{}' at t = {} s, dt = {} s>", session.robot().name(), session.time(), session.dt())
    }
}
