//! `track` and `TrackResult`.

use ikcore::obstacle::Surroundings;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::tracking::{self, Record, TrackOptions};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use super::arguments::{TrackArguments, tick_rule};
use super::record::{Columns, counts, record};
use crate::convert::{row, table, vector};
use crate::error::raise;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::Obstacles;
use crate::outcome::outcome;
use crate::path::path_argument;
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::trajectory::PyTrajectory;
use crate::traversal::traversed;

/// The record of a track, k = steps + 1 rows: row 0 is the start at t = 0, row i the tick that ends at t_i = i dt.
#[pyclass(name = "TrackResult", module = "beetle_ik", frozen)]
pub struct PyTrackResult {
    core: Record,
    columns: Columns,
    /// Smallest distances from obstacles and between links (k,) (m); NaN without `obstacles=` and `self_collision=True`.
    #[pyo3(get)]
    clearance: Py<PyArray1<f64>>,
    /// Velocity limits in force in each tick (k, n); NaN in row 0, inf for none.
    #[pyo3(get)]
    velocity_limit: Py<PyArrayDyn<f64>>,
    /// Iterations in each step (k,): passes of BAS, steps of Levenberg-Marquardt.
    #[pyo3(get)]
    step_iterations: Py<PyArray1<i64>>,
    /// The robot.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PyTrackResult: robot, limits);

record! {
    PyTrackResult = |result| result.core,
    /// Configurations (k, n) (rad, m).
    q,
    /// Positions of the tip (k, 3) (m).
    position,
    /// Evaluations of the forward kinematics in each step (k,).
    step_evaluations,
    /// Largest excess of a displacement over velocity limit times dt, or of a position over its limit (rad, m); 0 within
    /// rounding.
    max_violation,
}

outcome! {
    PyTrackResult = |result|
    /// Whether the tip reached the error band and stayed there.
    success,
    /// SOLVED on `success`; LOST if the tip left its band again; otherwise the status of the last step.
    status: result.core.status,
    message: result.core.message(),
    /// Total number of evaluations of the forward kinematics.
    evaluations: result.core.evaluations(),
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PyTrackResult {
    /// Smallest margin between a joint speed and its limit (rad/s, m/s); inf without limits.
    #[getter]
    fn limit_margin(&self) -> f64 {
        self.core.limit_margin
    }

    /// The joint trajectory. Without acceleration and jerk limits it is linear between the ticks: its velocities are exactly
    /// `qd`. With them it is a cubic spline that keeps them at every instant, and passes each configuration at a sixth of
    /// its acceleration times dt^2 (rad, m).
    #[getter]
    fn trajectory(&self) -> PyResult<PyTrajectory> {
        let names = self.robot.get().core.joints().iter().map(|joint| joint.name.clone()).collect();
        self.core.trajectory(names).map(PyTrajectory::from).map_err(raise)
    }

    /// Draws the path of the tip, the errors, joint positions, velocities with their limits, and evaluations; returns a
    /// matplotlib figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::plot(slf.into_any(), "track")
    }

    fn __repr__(&self) -> String {
        format!("<TrackResult {}: {} rows, {}>", self.core.status.name(), self.core.rows(), self.core.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("track", &self.core))?;
        pickling::restored_from::<Self>(py, (core, self.robot.clone_ref(py), self.limits.clone_ref(py)))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8], robot: Py<PyRobot>, limits: Py<PyLimits>) -> PyResult<Self> {
        Self::new(py, from_bytes("track", bytes).map_err(raise)?, robot, limits)
    }
}

impl PyTrackResult {
    fn new(py: Python<'_>, core: Record, robot: Py<PyRobot>, limits: Py<PyLimits>) -> PyResult<Self> {
        Ok(Self {
            columns: Columns::new(py, &core)?,
            velocity_limit: table(py, core.velocity_limit(), &[core.rows(), core.dof])?.unbind(),
            clearance: row(py, core.clearance.clone()).unbind(),
            step_iterations: counts(py, &core.step_iterations),
            robot,
            limits,
            core,
        })
    }
}

/// Follows a path with the tip of the robot, tick by tick, inside the limits.
///
/// In each tick the joints stay in a box: the position limits, and the range that the velocity limits allow from the last
/// accepted configuration. So neither limit can be violated (Cheng et al. 2020, Algorithm 1). Acceleration limits reduce the
/// box further, so that joints can still brake before their position limits; the arm starts at rest.
///
/// Args:
///     robot: the arm.
///     path: reference positions or poses over time.
///     start: (n,), configuration at t = 0; None: a solution for the first point of the path, the best one for the goals
///         or, without goals, one far from singularities and limits.
///     dt: time step (s).
///     task: which part of the path counts, one of `tasks`; None: all of it.
///     solver: a solver or `WeightedPseudoInverse`, which runs in each tick; None: the model-based rule, which needs one or
///         two evaluations per step.
///     limits: limits on the joint motion; None: the robot's.
///     goals: one or several of `goals`; each tick moves down their gradient in the null space of the task, by weight times
///         dt. They need the model-based rule or `WeightedPseudoInverse`.
///     position_tolerance: error band of positions (m).
///     rotation_tolerance: error band of orientations (rad).
///     obstacles: obstacles of `bik.obstacles`, or a `Scene`, that the arm keeps clear of, between ticks too; an empty list for the
///         robot's own links alone. Each command is certified together with the stop that follows it: the arm slides along, waits
///         or stops. None: nothing is checked.
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where `obstacles` are given.
///     seed: seed of the random draws; the same seed gives the same bits.
///     limit_at: which velocity limit holds in a tick: the smallest over its "interval", or, as in the paper, the one at its
///         "start".
///     ease: under acceleration or jerk limits, begin with an approach: the quickest motion from rest within the limits
///         that meets the moving path, after which the arm is on it. The tip is off the path until then.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `TrackResult`. If the path cannot be followed, its status says why; that is not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, or a time step that is not positive.
///     LimitError: a start outside its limits, or a negative limit.
///     UnsupportedLimit: jerk limits, which this tracker does not keep.
#[pyfunction]
#[pyo3(signature = (robot, path, start=None, *, dt, task=None, solver=None, limits=None, goals=None,
                    position_tolerance=1e-6, rotation_tolerance=1e-6, obstacles=None, margin=None, self_collision=None, seed=0,
                    limit_at="interval", ease=false, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn track(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    path: &Bound<'_, PyAny>,
    start: Option<&Bound<'_, PyAny>>,
    dt: f64,
    task: Option<&Bound<'_, PyAny>>,
    solver: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    goals: Option<&Bound<'_, PyAny>>,
    position_tolerance: f64,
    rotation_tolerance: f64,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    seed: i128,
    #[pyo3(from_py_with = crate::convert::text)] limit_at: &str,
    ease: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyTrackResult> {
    let arm = robot.get().core.clone();
    let path = path_argument(path)?.get();
    let rule = tick_rule(solver)?;
    let reference =
        if rule.uses_velocities() { path.reference_with_velocities(py, dt)? } else { path.reference(py, dt)? };
    let sampling = Sampling::of_ticks(dt, reference.len() - 1);
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &sampling)?;
    let start = start.map(|start| vector("start", start)).transpose()?;
    let obstacles = obstacles.map(|given| Obstacles::read_shapes(given)).transpose()?;
    let surroundings = Surroundings { obstacles, margin, self_collision };
    let asked =
        TrackArguments { rule, task, goals, position_tolerance, rotation_tolerance, surroundings, seed, limit_at };
    let options = TrackOptions { ease, ..asked.read(resolved)? };
    let record =
        watched(py, progress, |watcher| tracking::track(&arm, &reference, start.as_deref(), &options, watcher))?;
    python_calls::log(py, format!("track: {}", record.message()))?;
    PyTrackResult::new(py, record, robot.clone().unbind(), in_force)
}
