//! `solve` and `Solution`.

use std::sync::{Arc, OnceLock};

use ikcore::ik::{self, SolveOptions};
use ikcore::math::{Frame, Pose};
use ikcore::obstacle::Surroundings;
use ikcore::robot::Robot;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::{Target, TargetRow, TipError};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{array, copied, point, rigid_rows, shape_text};
use crate::error::{invalid, raise};
use crate::joint_order::joint_vector;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::obstacle::PyNearest;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;
use crate::solve_arguments::SolveArguments;
use crate::solver::PyStop;
use crate::tips::{Asked, TipErrors, ToleranceArgument, read_tolerance, tip_errors};
use crate::traversal::traversed;
use crate::units;

/// The best configuration found, and the outcome of the search.
#[pyclass(name = "Solution", module = "beetle_ik", frozen)]
pub struct PySolution {
    /// Solution as found; its nearest bodies may be missing.
    core: ik::Solution,
    around: Option<Box<Around>>,
    /// Errors by tip.
    tips: TipErrors,
    /// The configuration (n,) (rad, m), inside the limits.
    #[pyo3(get)]
    q: Py<PyArray1<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

/// Robot and surroundings, from which the nearest bodies are computed at the first access.
struct Around {
    robot: Arc<Robot>,
    surroundings: Surroundings,
    whole: OnceLock<ik::Solution>,
}

traversed!(PySolution: limits);

outcome! {
    PySolution = |result|
    /// Whether the target was reached within the tolerances.
    success,
    /// Reason why the search ended, a `Status`.
    status: result.core.status,
    message: result.whole().message(),
    /// Evaluations of the forward kinematics.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PySolution {
    /// Errors of each target, by the keys of the call or the name of the only tip: {tip: (position (m), rotation (rad))}, as
    /// `position_error` and `rotation_error`.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.tips.dict(py, std::iter::once(self.core.error), |errors| {
            errors.next().map(|TipError { position, rotation }| (position, rotation))
        })
    }

    /// Distance of the tip from the target (m), by forward kinematics of `q`; the largest of several tips.
    #[getter]
    fn position_error(&self) -> f64 {
        self.core.error.position
    }

    /// Geodesic angle to the target's orientation (rad), the largest of several tips; NaN if the task leaves the orientation free.
    #[getter]
    fn rotation_error(&self) -> f64 {
        self.core.error.rotation
    }

    /// Smallest distance (m) between the robot and obstacles, or between two of its links; a negative value is the depth of the
    /// deepest overlap. NaN where nothing is checked; inf if nothing can touch.
    #[getter]
    fn clearance(&self) -> f64 {
        self.whole().clearance()
    }

    /// The nearest two bodies, a `Nearest`; None where nothing is checked, or if nothing can touch.
    #[getter]
    fn nearest(&self) -> Option<PyNearest> {
        self.whole().nearest.as_ref()?.clearance.nearest.clone().map(PyNearest::from)
    }

    /// Iterations over all starts.
    #[getter]
    fn iterations(&self) -> usize {
        self.core.iterations
    }

    /// Restarts after the first start.
    #[getter]
    fn restarts(&self) -> usize {
        self.core.restarts
    }

    fn __repr__(&self) -> String {
        format!("<Solution {}: {}>", self.core.status.name(), self.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("solution", self.whole()))?;
        pickling::restored_from::<Self>(py, (core, &self.limits, self.tips.bytes(py)?))
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (bytes, limits, tips=None))]
    fn _restore(py: Python<'_>, bytes: &[u8], limits: Py<PyLimits>, tips: Option<&[u8]>) -> PyResult<Self> {
        Ok(Self::new(py, from_bytes("solution", bytes).map_err(raise)?, limits, TipErrors::restored(tips)?))
    }
}

impl PySolution {
    pub fn new(py: Python<'_>, core: ik::Solution, limits: Py<PyLimits>, tips: TipErrors) -> Self {
        Self { q: copied(py, &core.q).unbind(), limits, tips, core, around: None }
    }

    /// Returns the solution with its nearest bodies.
    fn whole(&self) -> &ik::Solution {
        let Some(around) = &self.around else { return &self.core };
        let Around { robot, surroundings, whole } = &**around;
        whole.get_or_init(|| {
            let mut solution = self.core.clone();
            let found = solution.find_nearest(robot, surroundings);
            found.expect("the arm was solved in these surroundings");
            solution
        })
    }
}

/// Finds a configuration that brings the tip of `robot` to `target`, inside the limits.
///
/// Args:
///     robot: the arm.
///     target: pose (4, 4), or position (3,) (m) with the orientation left free. For a robot with several `tips`, a
///         dict from tips to targets, for example {"left_tool": T}; a tip left out is free. The key ("left_tool",
///         "right_tool") gives the pose of the second tip in the frame of the first; "center_of_mass" the position (3,) (m)
///         of the centre of all masses.
///     task: part of the target that counts, one of `tasks`, or a dict for several tips, whose `level` says which come first where
///         not all can be met; None: all of it.
///     start_q: configuration (n,), a hint: one outside the limits is first brought inside, by whole turns or to the nearest limit.
///         For an arm with up to 6 joints, the closed form returns the solution nearest to it; a
///         search, or the descent of a redundant arm, begins there. None: the closed form returns the most central
///         solution inside the limits, and a search begins at stored configurations of the robot with the tip near the
///         target.
///     solver: the solver of a search; None: the closed form of the arm for poses, where it has one (`Robot.closed_form`), and
///         Levenberg-Marquardt from many starts for everything else.
///     position_tolerance: largest position error (m); for several tips also a dict.
///     rotation_tolerance: largest rotation error, a geodesic angle (rad); for several tips also a dict.
///     goals: one or several of `goals`; the solution is moved along its self-motion to a local optimum of the goals.
///     prefer: solution to return.
///         "any": the first solution found.
///         "nearest": of the solutions found, the one with the smallest |q - start_q| (rad, m). Each is moved along its
///         self-motion and by whole turns towards the start; the search ends when 24 in a row are no nearer.
///         "best": of the solutions found, the best one for the goals. Each is optimised along its self-motion; the
///         search
///         ends when 40 in a row are no better. For an arm with one redundant degree of freedom, each solution curve is
///         traced once instead, including the parts beyond joint limits.
///     joint_weights: cost of moving each joint away from `start_q` (n,), positive; of the solutions, the one with the least sum of
///         (weight * (q - start_q))^2 is wanted: a base of weight 100 stays where the arm can do it, and still moves where only
///         it can. Of the branches of a closed form, the nearest by this measure is returned; a redundant arm is moved along
///         its self-motion to the nearest solution nearby, and prefer="nearest" compares many. Only ratios count, up to
///         1e8. It needs start_q, and takes no goals. None: all joints cost the same.
///     limits: position limits; None: the robot's.
///     obstacles: obstacles of `bik.obstacles`, or a `Scene`, that a solution keeps clear of; an empty list for the robot's own
///         links alone. None: nothing is checked.
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where `obstacles` are given, and for a robot with
///         several tips all of whose collision shapes are known.
///     stop: budgets; None: a count of evaluations that keeps a 7-joint arm under about 10 ms.
///     seed: seed of the random draws; the same seed gives the same bits.
///
/// Returns:
///     A `Solution`. If the target is not reached, `status` says why, and `q` is the best configuration found. With
///     obstacles, a solution counts as solved only if it is clear by the margin. If none is found, the status is
///     IN_COLLISION, and `message` names the two bodies and says whether the hand itself is in the way.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, a target that is not a rigid transform, or obstacles and a robot without bodies.
///     LimitError: limits that contradict each other.
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> solution = bik.solve(robot, bik.pose([0.4, 0.1, 0.3], rpy=[3.14, 0, 0]))
///     >>> solution.status
///     <Status.SOLVED: 0>
///     >>> solution.q.shape
///     (6,)
#[pyfunction]
#[pyo3(signature = (robot, target, *, task=None, start_q=None, solver=None, position_tolerance=ToleranceArgument::All(1e-6),
                    rotation_tolerance=ToleranceArgument::All(1e-6), goals=None, prefer="any", joint_weights=None, limits=None, obstacles=None, margin=None,
                    self_collision=None, stop=None, seed=0),
       text_signature = "(robot, target, *, task=None, start_q=None, solver=None, position_tolerance=1e-06, rotation_tolerance=1e-06, goals=None, prefer='any', joint_weights=None, limits=None, obstacles=None, margin=None, self_collision=None, stop=None, seed=0)")]
#[allow(clippy::too_many_arguments)]
pub fn solve(
    py: Python<'_>,
    robot: &PyRobot,
    target: &Bound<'_, PyAny>,
    task: Option<&Bound<'_, PyAny>>,
    start_q: Option<&Bound<'_, PyAny>>,
    solver: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = read_tolerance)] position_tolerance: ToleranceArgument<'_>,
    #[pyo3(from_py_with = read_tolerance)] rotation_tolerance: ToleranceArgument<'_>,
    goals: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = crate::convert::text)] prefer: &str,
    joint_weights: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    stop: Option<&PyStop>,
    seed: i128,
) -> PyResult<PySolution> {
    let asked = read_targets("target", robot, target)?;
    let (in_force, resolved) = limits_of_call(py, limits, robot, &Sampling::once())?;
    let arguments = SolveArguments {
        task,
        solver,
        position_tolerance: &position_tolerance,
        rotation_tolerance: &rotation_tolerance,
        goals,
        prefer,
        joint_weights,
        obstacles,
        margin,
        self_collision,
        stop,
        seed,
    };
    let start = start_q.map(|q| joint_vector(&robot.core, "start_q", q)).transpose()?;
    let options = SolveOptions { nearest_later: true, ..arguments.read(robot, &asked, start, resolved)? };
    let core = watched(py, None, |watcher| ik::solve_tips(&robot.core, asked.values(), &options, watcher))?;
    let tips = tip_errors(robot, &asked, |_| TargetRow::from_slice(asked.values()), &options, &core.q)?;
    let surroundings = options.surroundings;
    let around = (surroundings.apply_to(&robot.core) && core.nearest.is_none())
        .then(|| Box::new(Around { robot: robot.core.clone(), surroundings, whole: OnceLock::new() }));
    Ok(PySolution { around, ..PySolution::new(py, core, in_force, tips) })
}

/// Reads the target of the only tip, or a dict of targets.
pub fn read_targets(what: &str, robot: &PyRobot, value: &Bound<'_, PyAny>) -> PyResult<Asked<Target>> {
    let asked = Asked::read(what, robot, value, read_target)?;
    for (subject, target) in asked.iter() {
        units::doubt(units::of_target(&robot.core, what, subject, target))?;
    }
    Ok(asked)
}

/// Reads a pose (4, 4) or a position (3,).
pub fn read_target(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Target> {
    read_target_by(what, value, |rows| rigid_rows(what, rows))
}

/// Reads a pose (4, 4) by `rigid`, or a position (3,).
pub fn read_target_by(
    what: &str,
    value: &Bound<'_, PyAny>,
    rigid: impl FnOnce(&[f64]) -> PyResult<Pose>,
) -> PyResult<Target> {
    let numbers = array(what, value)?;
    match numbers.shape() {
        [3] => Ok(Target::Position(point(what, value)?)),
        [4, 4] => Ok(Target::Pose(Frame::from(&rigid(numbers.as_slice()?)?))),
        shape => {
            let got = shape_text(shape);
            let remedy = match shape {
                [6] => "; bik.pose(t[:3], rpy=t[3:]) makes a pose of a position and angles",
                [16] => "; .reshape(4, 4) makes a matrix of 16 numbers, row by row",
                [7] => "; bik.pose(t[:3], xyzw=t[3:]) makes a pose of a position and a quaternion, or wxyz=",
                _ => "",
            };
            Err(invalid(format!("{what}: expected a pose (4, 4) or a position (3,), got shape {got}{remedy}")))
        }
    }
}
