//! `track` and `TrackResult`.

use ikcore::math::Pose;
use ikcore::path::Reference;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::{Target, TipError};
use ikcore::tracking::{Record, TipPaths, TrackOptions, track_tips};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arguments::{TrackArguments, tick_rule};
use super::record::{Columns, counts, record};
use crate::convert::{row, table};
use crate::error::{invalid, raise};
use crate::ik::read_target;
use crate::joint_order::{joint_numbers, joint_vector};
use crate::keep::read_keeps;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::read_surroundings;
use crate::outcome::outcome;
use crate::path::{PyPath, path_argument};
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::start_gate::{Outside, plain};
use crate::tips::{Asked, TaskArguments, TipErrors, ToleranceArgument, read_tolerance};
use crate::trajectory::PyTrajectory;
use crate::traversal::traversed;
use crate::units;
use crate::wording::said;

/// The record of a track, k = steps + 1 rows: row 0 is the start at t = 0, row i the tick that ends at t_i = i dt.
#[pyclass(name = "TrackResult", module = "beetle_ik", frozen)]
pub struct PyTrackResult {
    core: Record,
    columns: Columns,
    /// Errors by tip.
    tips: TipErrors,
    /// Smallest distances from obstacles and between links (k,) (m); NaN where nothing is checked.
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
    /// Positions of the tip (k, 3) (m); with several tips, of the first target: `positions` has all.
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
    /// Errors of each target, by the keys of the call or the name of the only tip: {tip: (position (k,) (m), rotation (k,) (rad))};
    /// `position_error` and `rotation_error` are the largest.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = self.core.position_error.iter().zip(&self.core.rotation_error);
        let only = rows.map(|(&position, &rotation)| TipError { position, rotation });
        self.tips.dict(py, only, |errors| {
            let (position, rotation) = errors.map(|error| (error.position, error.rotation)).unzip();
            (row::<f64>(py, position), row::<f64>(py, rotation))
        })
    }

    /// Positions of each target's tip, by the keys of the call or the name of the only tip: {tip: (k, 3) (m)}; for a
    /// pair, in the frame of its first tip.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.points(py, &self.core.position, &self.core.tips.positions)
    }

    /// Reference positions of each target, in the form of `positions`.
    #[getter]
    fn references<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.points(py, &self.core.reference, &self.core.tips.references)
    }

    /// Joints that began outside their position limits and were led inside, each (joint, value, limit) (rad, m).
    #[getter]
    fn start_outside(&self) -> Vec<Outside> {
        plain(&self.core.start_outside)
    }

    /// Smallest margin between a joint speed and its limit (rad/s, m/s); inf without limits.
    #[getter]
    fn limit_margin(&self) -> f64 {
        self.core.limit_margin
    }

    /// The joint trajectory. Without acceleration and jerk limits it is linear between the ticks, with the velocities
    /// `qd`. With them it is a cubic spline that keeps them at every instant; it passes each configuration at a
    /// distance of a sixth of its acceleration times dt^2 (rad, m).
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
        format!("<TrackResult {}: {} rows, {}>", self.core.status.name(), self.core.rows(), self.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("track", &self.core))?;
        let table = pickling::bytes(py, to_bytes("track of several tips", &self.core.tips))?;
        let (robot, limits) = (self.robot.clone_ref(py), self.limits.clone_ref(py));
        pickling::restored_from::<Self>(py, (core, robot, limits, self.tips.bytes(py)?, table))
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (bytes, robot, limits, tips=None, table=None))]
    fn _restore(
        py: Python<'_>,
        bytes: &[u8],
        robot: Py<PyRobot>,
        limits: Py<PyLimits>,
        tips: Option<&[u8]>,
        table: Option<&[u8]>,
    ) -> PyResult<Self> {
        let mut track: Record = from_bytes("track", bytes).map_err(raise)?;
        let tips =
            if tips.is_some() { TipErrors::restored(tips)? } else { TipErrors::of_one(robot.get().tips.clone()) };
        if let Some(table) = table {
            track.tips = from_bytes("track of several tips", table).map_err(raise)?;
        }
        Self::new(py, track, tips, robot, limits)
    }
}

impl PyTrackResult {
    fn new(py: Python<'_>, core: Record, tips: TipErrors, robot: Py<PyRobot>, limits: Py<PyLimits>) -> PyResult<Self> {
        Ok(Self {
            tips,
            columns: Columns::new(py, &core)?,
            velocity_limit: table(py, core.velocity_limit(), &[core.rows(), core.dof])?.unbind(),
            clearance: row(py, core.clearance.clone()).unbind(),
            step_iterations: counts(py, &core.step_iterations),
            robot,
            limits,
            core,
        })
    }

    /// Returns the points of each target (k, 3); for the only tip the points of `track`.
    fn points<'py>(&self, py: Python<'py>, track: &[[f64; 3]], several: &[[f64; 3]]) -> PyResult<Bound<'py, PyDict>> {
        let rows = track.len();
        let points = if several.is_empty() { track } else { several };
        let converted =
            |points: &mut dyn Iterator<Item = [f64; 3]>| table(py, points.flatten().collect(), &[rows, 3]).ok();
        self.tips.columns(py, points, converted)
    }
}

/// Follows a path with the tip of the robot, tick by tick, inside the limits.
///
/// In each tick the joints stay in a box: the position limits, and the range that the velocity limits allow from the
/// last accepted configuration. So neither limit can be violated (Cheng et al. 2020, Algorithm 1). Acceleration limits
/// reduce the box further, so that joints can still brake before their position limits; the arm starts at rest.
///
/// Args:
///     robot: the arm.
///     path: reference positions or poses over time. For a robot with several `tips`, a dict of paths of equal
///         duration, for example {"left_tool": path}; a constant pose (4, 4) or position (3,) counts as a path, and a
///         tip left out is free. The key ("left_tool", "right_tool") gives the second tip in the frame of the first.
///         This relative pose has priority, so that both arms lag where one cannot follow.
///     start_q: (n,), configuration at t = 0; None: a solution for the first point of the path, the best one for the goals
///         or, without goals, one far from singularities and limits.
///     dt: time step (s).
///     task: part of the path that counts, one of `tasks`, or a dict for several tips; None: all of it.
///     solver: a solver or `WeightedPseudoInverse`, which runs in each tick; None: the model-based rule, which needs one or
///         two evaluations per step.
///     limits: limits on the joint motion; None: the robot's. Each joint needs a velocity, acceleration or jerk limit;
///         `Limits(velocity=np.inf)` says that jumps are meant. Torque limits need acceleration limits, as in `Tracker`.
///     goals: one or several of `goals`; each tick moves down their gradient in the null space of the task, by weight times
///         dt. They need the model-based rule or `WeightedPseudoInverse`.
///     joint_weights: cost of moving each joint (n,), positive: each tick follows the path with the least sum of (weight * dq)^2, so
///         that a base of weight 100 stays where the arm can do it, and still moves where only it can. Only ratios count, up to
///         1e8. They need the model-based rule. None: all joints cost the same.
///     position_tolerance: error band of positions (m); for several tips also a dict.
///     rotation_tolerance: error band of orientations (rad); for several tips also a dict.
///     obstacles: obstacles of `bik.obstacles`, or a `Scene`, that the arm keeps clear of, between ticks too; an empty list for the
///         robot's own links alone. Each command is certified together with the stop that follows it: the arm slides along, waits
///         or stops. None: nothing is checked.
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where `obstacles` are given, and for a robot with
///         several tips all of whose collision shapes are known.
///     keep: a `Keep`, for example from `upright`, or several: constraints at every instant, between ticks too, and during the stop after
///         each. The arm goes as near to the path as that allows. None: nothing.
///     seed: seed of the random draws; the same seed gives the same bits.
///     limit_at: velocity limit that holds in a tick: the smallest over its "interval" or, as in the paper, the limit
///         at its "start".
///     start_slack: how far start_q may be outside the position limits (rad, m), a number or (n,); the arm then begins there and is led
///         inside within its limits, see `TrackResult.start_outside`. None: 5 degrees, 5 mm for joints that slide.
///     ease: under acceleration or jerk limits, begin with an approach: the quickest motion from rest within the limits
///         that meets the moving path, after which the arm is on it. The tip is off the path until then.
///     recover: whether an arm that comes no nearer to the path, at a joint limit or in a singular configuration, goes to a
///         configuration on it if one is known, as in `Tracker`.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `TrackResult`. If the path cannot be followed, its status says why; that is not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, a time step that is not positive, a joint that no limit slows down, or a start at which
///         something in keep does not hold.
///     LimitError: a start farther outside its limits than start_slack, or a negative limit.
///     UnsupportedLimit: acceleration or jerk limits, or position limits that vary in time, with a task that has a
///         region; position, acceleration or jerk limits that vary in time, among obstacles or with keep.
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> path = bik.paths.circle([0.5, 0.1, 0.4], 0.2, 5.0)
///     >>> track = bik.track(robot, path, dt=0.01)
///     >>> track.status
///     <Status.SOLVED: 0>
///     >>> track.q.shape
///     (501, 6)
#[pyfunction]
#[pyo3(signature = (robot, path, start_q=None, *, dt, task=None, solver=None, limits=None, goals=None, joint_weights=None,
                    position_tolerance=ToleranceArgument::All(1e-6), rotation_tolerance=ToleranceArgument::All(1e-6), obstacles=None,
                    margin=None, self_collision=None, keep=None, seed=0, limit_at="interval", ease=false, recover=true,
                    start_slack=None, progress=None),
       text_signature = "(robot, path, start_q=None, *, dt, task=None, solver=None, limits=None, goals=None, joint_weights=None, position_tolerance=1e-06, rotation_tolerance=1e-06, obstacles=None, margin=None, self_collision=None, keep=None, seed=0, limit_at='interval', ease=False, recover=True, start_slack=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub fn track(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    path: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    dt: f64,
    task: Option<&Bound<'_, PyAny>>,
    solver: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    goals: Option<&Bound<'_, PyAny>>,
    joint_weights: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = read_tolerance)] position_tolerance: ToleranceArgument<'_>,
    #[pyo3(from_py_with = read_tolerance)] rotation_tolerance: ToleranceArgument<'_>,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    keep: Option<&Bound<'_, PyAny>>,
    seed: i128,
    #[pyo3(from_py_with = crate::convert::text)] limit_at: &str,
    ease: bool,
    recover: bool,
    start_slack: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyTrackResult> {
    let arm = robot.get().core.clone();
    let rule = tick_rule(solver)?;
    let asked = Asked::read("path", robot.get(), path, read_path)?;
    let references = sampled(py, &asked, dt, rule.uses_velocities())?;
    for ((subject, _), reference) in asked.iter().zip(&references) {
        let rows = [0, reference.len() / 2, reference.len() - 1].into_iter();
        units::doubt(rows.filter_map(|row| units::of_point(&arm, "path", subject, &reference.position(row))).next())?;
    }
    let sampling = Sampling::of_ticks(dt, references[0].len() - 1);
    let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &sampling)?;
    let start = start_q.map(|q| joint_vector(&arm, "start_q", q)).transpose()?;
    let surroundings = read_surroundings(robot.get(), obstacles, margin, self_collision)?;
    let (position_tolerance, rotation_tolerance) = (&position_tolerance, &rotation_tolerance);
    let settings = TaskArguments { task, position_tolerance, rotation_tolerance }.read_for(robot.get(), &asked)?;
    let only = settings.of_only(robot.get());
    let keeps = read_keeps(robot.get(), keep)?;
    let joint_weights = joint_weights.map(|weights| joint_numbers(&arm, "joint_weights", weights)).transpose()?;
    let read =
        TrackArguments { rule, only, goals, joint_weights, surroundings, keeps, recover, seed, limit_at, start_slack };
    let options = TrackOptions { ease, ..read.read(resolved)? };
    let (start, tips) = (start.as_deref(), settings.tasks(&asked));
    let paths = TipPaths { tips: &tips, paths: &references };
    let record = watched(py, progress, |watcher| track_tips(&arm, &paths, start, &options, watcher))?;
    let tips = TipErrors { keys: asked.keys(robot.get()).clone(), errors: record.tips.errors.clone() };
    python_calls::log(py, "track", &said(&record.message()))?;
    PyTrackResult::new(py, record, tips, robot.clone().unbind(), in_force)
}

/// A path, or a constant target.
enum Followed<'py> {
    Path(Bound<'py, PyPath>),
    Constant(Target),
}

fn read_path<'py>(what: &str, value: &Bound<'py, PyAny>) -> PyResult<Followed<'py>> {
    match path_argument(value) {
        Ok(path) => Ok(Followed::Path(path.clone())),
        Err(_) if what != "path" => read_target(what, value).map(Followed::Constant).map_err(|error| {
            let problem = error.value(value.py());
            invalid(format!("{what}: expected a Path, or a constant pose or position: {problem}"))
        }),
        Err(error) => Err(error),
    }
}

/// Samples the paths at ticks of `dt` (s); all paths must have one duration.
fn sampled(py: Python<'_>, asked: &Asked<Followed<'_>>, dt: f64, velocities: bool) -> PyResult<Vec<Reference>> {
    let mut longest: Option<(f64, usize)> = None;
    let mut references = vec![];
    for followed in asked.values() {
        let Followed::Path(path) = followed else {
            references.push(None);
            continue;
        };
        let path = path.get();
        let reference = if velocities { path.reference_with_velocities(py, dt)? } else { path.reference(py, dt)? };
        let (duration, rows) = (path.duration(), reference.len());
        match longest {
            Some((other, count)) if count != rows => {
                return Err(invalid(format!(
                    "path: the paths have one time, got durations of {other} s and {duration} s"
                )));
            }
            _ => longest = Some((duration, rows)),
        }
        references.push(Some(reference));
    }
    let Some((_, rows)) = longest else {
        return Err(invalid("path: all targets are constant: give a Path for one tip at least".into()));
    };
    let constant = |followed: &Followed<'_>| match followed {
        Followed::Constant(target) => constant_reference(target, dt, rows),
        Followed::Path(_) => Err(invalid("path: no samples".into())),
    };
    let all = asked.values().iter().zip(references);
    all.map(|(followed, reference)| reference.map_or_else(|| constant(followed), Ok)).collect()
}

/// Returns a constant target as the samples of a path.
fn constant_reference(target: &Target, dt: f64, rows: usize) -> PyResult<Reference> {
    let rotations = match target {
        Target::Pose(frame) => Some(vec![*Pose::from(*frame).rotation.matrix(); rows]),
        _ => None,
    };
    Reference::new(dt, vec![target.position().unwrap_or_default(); rows], rotations).map_err(raise)
}
