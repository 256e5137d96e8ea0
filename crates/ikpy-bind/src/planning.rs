//! `plan_point_to_point`, `plan_along_path` and `Plan`.

use ikcore::math::Frame;
use ikcore::path::Reference;
use ikcore::planning::{self, AlongPathOptions, Elbow, End, Plan, PointToPointOptions, Violation};
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::Target;
use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::convert::{array, count, point, rigid_rows, shape_text, table, vector};
use crate::error::{invalid, raise};
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::Given;
use crate::outcome::outcome;
use crate::path::PyPath;
use crate::robot::PyRobot;
use crate::solver::{PyStop, derivative_free_solver};
use crate::stored::{self, Reduced};
use crate::trajectory::PyTrajectory;
use crate::upward;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyViolation>()?;
    module.add_class::<PyPlan>()?;
    module.add_function(wrap_pyfunction!(plan_point_to_point, module)?)?;
    module.add_function(wrap_pyfunction!(plan_along_path, module)?)
}

/// A bound that a planned trajectory breaks; `str` says it in words.
#[pyclass(name = "Violation", module = "beetle_ik", frozen, eq)]
#[derive(PartialEq)]
pub struct PyViolation(Violation);

#[pymethods]
impl PyViolation {
    /// What breaks it, such as "velocity of joint 'elbow'".
    #[getter]
    fn what(&self) -> &str {
        &self.0.what
    }

    /// How far the trajectory goes, in `unit`.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }

    /// How far it may go, in `unit`.
    #[getter]
    fn bound(&self) -> f64 {
        self.0.bound
    }

    /// "rad/s" and so on.
    #[getter]
    fn unit(&self) -> &str {
        &self.0.unit
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Violation: {}>", self.0)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::restored_from::<Self>(py, (stored::bytes(py, to_bytes("violation", &self.0))?,))
    }

    /// What pickle stored.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        from_bytes("violation", bytes).map(Self).map_err(raise)
    }
}

/// A planned motion, and what became of the search for it.
#[pyclass(name = "Plan", module = "beetle_ik", frozen)]
pub struct PyPlan {
    core: Plan,
    /// The motion: the best that keeps everything, else the least violating one.
    #[pyo3(get)]
    trajectory: Py<PyTrajectory>,
    /// How the search came to its best: rows (evaluations, lowest cost from then on), (h, 2); with penalties as long as
    /// the plan breaks something.
    #[pyo3(get)]
    history: Py<PyArrayDyn<f64>>,
    /// The absolute orientations that a planar arm was free to choose along the path (points, links, 3): value, lowest
    /// and highest possible (rad), from the tip's link down; without such a choice (0, 0, 3).
    #[pyo3(get)]
    redundancy: Py<PyArrayDyn<f64>>,
    /// Positions (k, 3) (m) that the tip was to follow; None for a plan from end to end.
    #[pyo3(get)]
    reference: Option<Py<PyArrayDyn<f64>>>,
    /// What the robot was not to touch, as given.
    #[pyo3(get)]
    obstacles: Py<PyTuple>,
    /// The robot that was planned for.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

outcome! {
    PyPlan = |result|
    /// Whether the trajectory keeps everything that was asked.
    success,
    /// SOLVED as `success`; else why the search ended.
    status: result.core.status,
    message: result.core.message(),
    /// Evaluations of the cost.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PyPlan {
    /// What was minimised: "time", "joint_travel" or "tip_travel".
    #[getter]
    fn objective(&self) -> String {
        self.core.objective.to_string()
    }

    /// Its value on the trajectory (s, rad or m).
    #[getter]
    fn cost(&self) -> f64 {
        self.core.cost
    }

    /// Smallest distance between robot and obstacles on the trajectory (m); NaN without obstacles.
    #[getter]
    fn clearance(&self) -> f64 {
        self.core.clearance.unwrap_or(f64::NAN)
    }

    /// Largest distance of the tip from the points of the path (m); NaN for a plan from end to end.
    #[getter]
    fn accuracy(&self) -> f64 {
        self.core.accuracy.unwrap_or(f64::NAN)
    }

    /// What the trajectory breaks, a list of `Violation`; empty for a plan that succeeded.
    #[getter]
    fn violations(&self) -> Vec<PyViolation> {
        self.core.violations.iter().cloned().map(PyViolation).collect()
    }

    /// A matplotlib figure: the arm along its way, the cost against evaluations, the joints' motion with their limits.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        upward::plot(slf.into_any(), "plan")
    }

    fn __repr__(&self) -> String {
        format!("<Plan {}: {}>", self.core.status.name(), self.core.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = stored::bytes(py, to_bytes("plan", &self.core))?;
        stored::restored_from::<Self>(py, (core, &self.reference, &self.robot, &self.limits, &self.obstacles))
    }

    /// What pickle stored.
    #[staticmethod]
    #[pyo3(signature = (bytes, reference, robot, limits, obstacles))]
    fn _restore(
        bytes: &[u8],
        reference: Option<&Bound<'_, PyAny>>,
        robot: &Bound<'_, PyRobot>,
        limits: Py<PyLimits>,
        obstacles: Py<PyTuple>,
    ) -> PyResult<Self> {
        let reference =
            reference.map(|rows| Ok::<_, PyErr>(array("reference", rows)?.as_slice()?.to_vec())).transpose()?;
        Self::new(from_bytes("plan", bytes).map_err(raise)?, reference, robot, limits, obstacles)
    }
}

impl PyPlan {
    fn new(
        core: Plan,
        reference: Option<Vec<f64>>,
        robot: &Bound<'_, PyRobot>,
        limits: Py<PyLimits>,
        obstacles: Py<PyTuple>,
    ) -> PyResult<Self> {
        let py = robot.py();
        let history: Vec<f64> = core.history.iter().flat_map(|step| [step.evaluations as f64, step.cost]).collect();
        let free = &core.redundancy;
        let orientations = free.iter().flatten().flat_map(|free| [free.value, free.lowest, free.highest]).collect();
        let shape = [free.len(), free.first().map_or(0, |links| links.len()), 3];
        let reference = reference.map(|positions| {
            let count = positions.len() / 3;
            table(py, positions, &[count, 3]).map(Bound::unbind)
        });
        Ok(Self {
            trajectory: Py::new(py, PyTrajectory::from(core.trajectory.clone()))?,
            history: table(py, history, &[core.history.len(), 2])?.unbind(),
            redundancy: table(py, orientations, &shape)?.unbind(),
            reference: reference.transpose()?,
            obstacles,
            robot: robot.clone().unbind(),
            limits,
            core,
        })
    }
}

/// Plans a motion from one end to another, at rest at both.
///
/// Args:
///     robot: the arm.
///     start, end: position (3,) (m) or pose (4, 4) of the tip; the configuration is the planner's choice.
///     start_q, end_q: instead of them, joint angles (n,).
///     obstacles: what the robot may not touch, from `bik.obstacles`; it may never touch itself if it has capsules.
///     margin: distance to keep from obstacles and between links (m); None: 1 mm.
///     limits: positions, velocities and accelerations to keep; None: the robot's.
///     method: "minmax": the ends' configurations that are nearest in time, joined at the limits' pace; "tpbso":
///         polynomials through a via point, searched by a beetle swarm (Wang et al. 2019).
///     objective: what to minimise: "time", "joint_travel" or "tip_travel".
///     elbows: for "tpbso" on planar arms, the sign of the second joint's angle at start and end, 1 or -1.
///     solver: what searches; None: the method's own.
///     stop: budgets; None: the method's own.
///     seed: of the random draws: the same seed, the same bits.
///     progress: True for a bar on the terminal, or a callable of (done, total).
///
/// Returns:
///     A `Plan`. That no plan keeps everything is a status beside the least violating trajectory, not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, an end that cannot be reached (which, and by how much).
///     LimitError: limits that contradict themselves or exclude an end.
///     UnsupportedLimit: jerk limits, or limits that vary in time.
#[pyfunction]
#[pyo3(signature = (robot, start=None, end=None, *, start_q=None, end_q=None, limits=None, method="minmax",
                    objective="time", obstacles=None, margin=None, elbows=[1, 1], solver=None, stop=None, seed=0,
                    progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn plan_point_to_point(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    start: Option<&Bound<'_, PyAny>>,
    end: Option<&Bound<'_, PyAny>>,
    start_q: Option<&Bound<'_, PyAny>>,
    end_q: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: &str,
    objective: &str,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    elbows: [i128; 2],
    solver: Option<&Bound<'_, PyAny>>,
    stop: Option<&PyStop>,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    let (start, end) = (read_end("start", start, start_q)?, read_end("end", end, end_q)?);
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let obstacles = Given::read(py, obstacles)?;
    let given = obstacles.tuple;
    let options = PointToPointOptions {
        method: method.parse().map_err(raise)?,
        objective: objective.parse().map_err(raise)?,
        obstacles: obstacles.core,
        margin,
        elbows: [read_elbow("elbows[0]", elbows[0])?, read_elbow("elbows[1]", elbows[1])?],
        limits: resolved,
        solver: solver.map(|solver| derivative_free_solver("plan_point_to_point", solver)).transpose()?,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_point_to_point(&arm, &start, &end, &options, watcher))?;
    PyPlan::new(plan, None, robot, in_force, given)
}

/// Plans a motion whose tip follows a path, in order.
///
/// Args:
///     robot: the arm.
///     path: a `Path`, whose times do not matter here, or points (k, 3) (m) or poses (k, 4, 4).
///     start_q: joint angles (n,) to start from; None: the planner's choice.
///     limits: positions, velocities and accelerations to keep; None: the robot's.
///     method: "timed": redundancy and the fastest timing found together; "tpbso": redundancy by a beetle swarm, uniform
///         time, splines through every second point (Wang et al. 2019).
///     objective: what to minimise: "time" or "joint_travel".
///     elbow: for "tpbso", the sign of the second joint's angle, 1 or -1, unless start_q says it.
///     accuracy: how far the tip may be from the points (m); None: what suits the method.
///     solver: what searches; None: the method's own.
///     stop: budgets; None: the method's own.
///     seed: of the random draws: the same seed, the same bits.
///     progress: True for a bar on the terminal, or a callable of (done, total).
///
/// Returns:
///     A `Plan`. That no plan keeps everything is a status beside the least violating trajectory, not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, fewer than two points, points out of reach.
///     LimitError: limits that contradict themselves.
///     UnsupportedLimit: jerk limits, or limits that vary in time.
#[pyfunction]
#[pyo3(signature = (robot, path, *, start_q=None, limits=None, method="timed", objective="time", elbow=1, accuracy=None,
                    solver=None, stop=None, seed=0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn plan_along_path(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    path: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    method: &str,
    objective: &str,
    elbow: i128,
    accuracy: Option<f64>,
    solver: Option<&Bound<'_, PyAny>>,
    stop: Option<&PyStop>,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyPlan> {
    let arm = robot.get().core.clone();
    let reference = read_path(py, path)?;
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
    let options = AlongPathOptions {
        method: method.parse().map_err(raise)?,
        objective: objective.parse().map_err(raise)?,
        start: start_q.map(|q| vector("start_q", q)).transpose()?,
        limits: resolved,
        elbow: read_elbow("elbow", elbow)?,
        accuracy,
        solver: solver.map(|solver| derivative_free_solver("plan_along_path", solver)).transpose()?,
        stop: stop.map(PyStop::core),
        seed: count("seed", seed)?,
    };
    let plan = watched(py, progress, |watcher| planning::plan_along_path(&arm, &reference, &options, watcher))?;
    let positions = (0..reference.len()).flat_map(|i| reference.position(i)).collect();
    PyPlan::new(plan, Some(positions), robot, in_force, PyTuple::empty(py).unbind())
}

/// Which way a planar arm bends.
fn read_elbow(name: &str, sign: i128) -> PyResult<Elbow> {
    match sign {
        1 => Ok(Elbow::Positive),
        -1 => Ok(Elbow::Negative),
        _ => Err(invalid(format!("{name} must be 1 or -1, the sign of the second joint's angle, got {sign}"))),
    }
}

/// An end given as a target or as joint angles.
fn read_end(name: &str, target: Option<&Bound<'_, PyAny>>, q: Option<&Bound<'_, PyAny>>) -> PyResult<End> {
    match (target, q) {
        (Some(target), None) => read_place(name, target).map(End::Target),
        (None, Some(q)) => vector(&format!("{name}_q"), q).map(End::Configuration),
        (None, None) => Err(invalid(format!("no {name} was given: give {name}= a position or pose, or {name}_q="))),
        (Some(_), Some(_)) => Err(invalid(format!("both {name} and {name}_q were given: give one of them"))),
    }
}

/// A pose (4, 4) or a position (3,).
fn read_place(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Target> {
    let numbers = array(name, value)?;
    match numbers.shape() {
        [3] => Ok(Target::Position(point(name, value)?)),
        [4, 4] => Ok(Target::Pose(Frame::from(&rigid_rows(name, numbers.as_slice()?)?))),
        shape => {
            let got = shape_text(shape);
            Err(invalid(format!("{name}: expected a pose (4, 4) or a position (3,), got shape {got}")))
        }
    }
}

/// Intervals that a `Path` is divided into: the published planner's.
const INTERVALS: f64 = 50.0;

/// A `Path`, or points (k, 3), or poses (k, 4, 4).
fn read_path(py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<Reference> {
    if let Ok(path) = path.cast::<PyPath>() {
        let path = path.get();
        return path.reference(py, path.duration() / INTERVALS);
    }
    let rows = array("path", path)?;
    let numbers = rows.as_slice()?;
    match rows.shape() {
        [_, 3] => Reference::new(1.0, numbers.as_chunks().0.to_vec(), None).map_err(raise),
        [_, 4, 4] => {
            let poses = numbers.chunks_exact(16).enumerate().map(|(i, rows)| rigid_rows(&format!("pose {i}"), rows));
            let poses = poses.collect::<PyResult<Vec<_>>>()?;
            let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
            let rotations = poses.iter().map(|pose| *pose.rotation.matrix()).collect();
            Reference::new(1.0, positions, Some(rotations)).map_err(raise)
        }
        shape => Err(invalid(format!(
            "path: expected a Path, points (k, 3) or poses (k, 4, 4), got shape {}",
            shape_text(shape)
        ))),
    }
}
