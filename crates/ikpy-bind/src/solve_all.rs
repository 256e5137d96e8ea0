//! `solve_all` and `SolutionSet`.

use ikcore::ik::{self, AllOptions};
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::Target;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyIterator, PyList};
use pyo3::{PyTraverseError, PyVisit};

use crate::convert::{count, table};
use crate::error::raise;
use crate::ik::{PySolution, read_targets};
use crate::indexing::{Selection, iterate, select};
use crate::joint_order::joint_vector;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;
use crate::solve_arguments::SolveArguments;
use crate::solver::PyStop;
use crate::tips::{Asked, TipErrors, ToleranceArgument, read_tolerance, tip_errors};
use crate::traversal::{Traversed, traversed};

/// The distinct solutions for one target, a sequence of `Solution`.
#[pyclass(name = "SolutionSet", module = "beetle_ik", frozen, sequence)]
pub struct PySolutionSet {
    core: ik::SolutionSet,
    dof: usize,
    /// Configurations as an array, made at the first access.
    q: PyOnceLock<Py<PyArrayDyn<f64>>>,
    /// Call that finds the configuration nearest to a target proven out of reach, at the first access to `miss`.
    unreached: Option<Box<Unreached>>,
    miss: PyOnceLock<ik::Solution>,
    /// Errors by tip: of each solution, then of the best miss.
    tips: TipErrors,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PySolutionSet: limits, unreached);

/// A target without a solution, and the call that looked for one.
struct Unreached {
    robot: Py<PyRobot>,
    target: Target,
    options: AllOptions,
}

impl Traversed for Unreached {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.robot.traverse(visit)
    }
}

outcome! {
    PySolutionSet = |result|
    /// Whether a solution was found.
    success,
    /// SOLVED if a solution was found; otherwise the reason why the last search ended.
    status: result.core.status(),
    message: result.core.message(),
    /// Evaluations of the forward kinematics.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PySolutionSet {
    /// Whether it is proven that no other solution exists inside the limits, whole turns aside; False after a search,
    /// where `limit` or `separation` left solutions out, beside singular poses, for tolerances above 1e-5, and with `turns` for
    /// an arm with an unlimited joint.
    #[getter]
    fn complete(&self) -> bool {
        self.core.complete
    }

    /// Whether the pose is singular: at least one solution then represents a family in which a joint is free.
    #[getter]
    fn singular(&self) -> bool {
        self.core.singular
    }

    /// The configurations (k, n) (rad, m), inside the limits.
    #[getter]
    fn q(&self, py: Python<'_>) -> PyResult<Py<PyArrayDyn<f64>>> {
        let rows = || table(py, self.core.solutions.values().to_vec(), &[self.core.solutions.len(), self.dof]);
        Ok(self.q.get_or_try_init(py, || rows().map(Bound::unbind))?.clone_ref(py))
    }

    /// Nearest `Solution` that misses the target, if no solution was found; otherwise None. For a target proven out of
    /// reach, it is computed at the first access.
    #[getter]
    fn miss(&self, py: Python<'_>) -> PyResult<Option<PySolution>> {
        let miss = self.nearest_miss(py)?;
        let tips = || self.tips.select(&[self.core.solutions.len()]);
        Ok(miss.map(|miss| PySolution::new(py, miss.clone(), self.limits.clone_ref(py), tips())))
    }

    fn __len__(&self) -> usize {
        self.core.solutions.len()
    }

    /// Returns a `Solution`, or a list of them for a slice, a mask or several indices.
    fn __getitem__<'py>(&self, py: Python<'py>, index: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let solution = |i: usize| {
            let found = self.core.solution(i);
            let outside =
                || PyIndexError::new_err(format!("index {i} is outside a set of {}", self.core.solutions.len()));
            let tips = || self.tips.select(&[i]);
            found.map(|found| PySolution::new(py, found, self.limits.clone_ref(py), tips())).ok_or_else(outside)
        };
        match select("a set", index, self.core.solutions.len())? {
            Selection::One(i) => Ok(Bound::new(py, solution(i)?)?.into_any()),
            Selection::Many(rows) => {
                Ok(PyList::new(py, rows.into_iter().map(solution).collect::<PyResult<Vec<_>>>()?)?.into_any())
            }
        }
    }

    /// Iterates over the solutions.
    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyIterator>> {
        iterate(slf.as_any())
    }

    fn __repr__(&self) -> String {
        format!("<SolutionSet: {}>", self.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let miss = self.nearest_miss(py)?.cloned().map(Box::new);
        let complete = ik::SolutionSet { miss, ..self.core.clone() };
        let core = pickling::bytes(py, to_bytes("set of solutions", &complete))?;
        pickling::restored_from::<Self>(py, (core, self.dof, self.limits.clone_ref(py), self.tips.bytes(py)?))
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (bytes, dof, limits, tips=None))]
    fn _restore(bytes: &[u8], dof: usize, limits: Py<PyLimits>, tips: Option<&[u8]>) -> PyResult<Self> {
        let core = from_bytes("set of solutions", bytes).map_err(raise)?;
        Ok(Self::new(core, dof, limits, None, TipErrors::restored(tips)?))
    }
}

impl PySolutionSet {
    fn new(
        core: ik::SolutionSet,
        dof: usize,
        limits: Py<PyLimits>,
        unreached: Option<Box<Unreached>>,
        tips: TipErrors,
    ) -> Self {
        Self { core, dof, q: PyOnceLock::new(), unreached, miss: PyOnceLock::new(), tips, limits }
    }

    fn nearest_miss(&self, py: Python<'_>) -> PyResult<Option<&ik::Solution>> {
        match (&self.core.miss, &self.unreached) {
            (Some(miss), _) => Ok(Some(miss)),
            (None, None) => Ok(None),
            (None, Some(unreached)) => self.miss.get_or_try_init(py, || unreached.nearest_miss(py)).map(Some),
        }
    }
}

impl Unreached {
    fn nearest_miss(&self, py: Python<'_>) -> PyResult<ik::Solution> {
        let robot = &self.robot.get().core;
        watched(py, None, |watcher| ik::nearest_miss(robot, &self.target, &self.options, watcher))
    }
}

/// Returns all solutions of a pose for an arm with a closed form (`Robot.closed_form`); otherwise searches for distinct
/// solutions.
///
/// The closed form serves whole poses without a `solver`, weights or region. `SolutionSet.complete` says whether it is
/// proven that no solution is missing. A search ends after a hundred known solutions in a row, or when the budget is
/// spent.
///
/// Each solution is returned with the whole turns that bring it nearest to the start, or to the middle of the limits if
/// no start is given. A redundant arm has infinitely many solutions: a closed form returns those at `redundancy` values
/// of its parameter, a search returns some that are at least `separation` apart.
///
/// Args:
///     robot: the arm.
///     target: pose (4, 4), or position (3,) (m).
///     start_q: (n,), a hint as in `solve`; solutions are sorted by |q - start_q| (rad, m). None: they are returned in the order found.
///     limit: largest number of solutions to return. None: all of a closed form, 16 of a search.
///     separation: two solutions are distinct if some joint differs by at least this much (rad, m), modulo whole turns. None: all of
///         a closed form are returned, those of a search differ by 0.1.
///     redundancy: number of parameter values at which a redundant arm with a closed form is solved, spread over the
///         range that its limits allow. 0: a search is used instead.
///     turns: return each solution at all whole turns inside the limits. A joint that is unlimited on a side has infinitely many: it
///         stays at the nearest one, and `complete` is False.
///     task: part of the target that counts, one of `tasks`; None: all of it.
///     solver: the solver of a search; None: the closed form where there is one, and Levenberg-Marquardt from many starts elsewhere.
///     position_tolerance: largest position error (m).
///     rotation_tolerance: largest rotation error, a geodesic angle (rad).
///     limits: position limits; None: the robot's.
///     obstacles: obstacles of `bik.obstacles`, or a `Scene`, that a solution keeps clear of; an empty list for the robot's own
///         links alone. None: nothing is checked.
///     margin: least distance from obstacles and between links (m); None: 1 mm.
///     self_collision: whether links must keep clear of each other; None: where `obstacles` are given, and for a robot with
///         several tips all of whose collision shapes are known.
///     stop: budgets of the whole search; None: as for `solve`. A closed form ignores them.
///     seed: seed of the random draws; the same seed gives the same bits.
///
/// Returns:
///     A `SolutionSet`. If no solution is found, it is empty, and `miss` is the nearest configuration found.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, a target that is not a rigid transform, or `turns` that make more than 10,000
///         configurations; tasks of several tips of different levels, or a task with `first`, which
///         all solutions would meet.
///     LimitError: limits that contradict each other.
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> solutions = bik.solve_all(robot, bik.pose([0.4, 0.1, 0.3], rpy=[3.14, 0, 0]))
///     >>> len(solutions), solutions.complete
///     (8, True)
#[pyfunction]
#[pyo3(signature = (robot, target, *, start_q=None, limit=None, separation=None, redundancy=16, turns=false, task=None, solver=None,
                    position_tolerance=ToleranceArgument::All(1e-6), rotation_tolerance=ToleranceArgument::All(1e-6), limits=None,
                    obstacles=None, margin=None, self_collision=None, stop=None, seed=0),
       text_signature = "(robot, target, *, start_q=None, limit=None, separation=None, redundancy=16, turns=False, task=None, solver=None, position_tolerance=1e-06, rotation_tolerance=1e-06, limits=None, obstacles=None, margin=None, self_collision=None, stop=None, seed=0)")]
#[allow(clippy::too_many_arguments)]
pub fn solve_all(
    py: Python<'_>,
    robot: &Bound<'_, PyRobot>,
    target: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    limit: Option<i128>,
    separation: Option<f64>,
    redundancy: i128,
    turns: bool,
    task: Option<&Bound<'_, PyAny>>,
    solver: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = read_tolerance)] position_tolerance: ToleranceArgument<'_>,
    #[pyo3(from_py_with = read_tolerance)] rotation_tolerance: ToleranceArgument<'_>,
    limits: Option<&PyLimits>,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    stop: Option<&PyStop>,
    seed: i128,
) -> PyResult<PySolutionSet> {
    let owner = robot;
    let robot = owner.get();
    let asked = read_targets("target", robot, target)?;
    let (in_force, resolved) = limits_of_call(py, limits, robot, &Sampling::once())?;
    let arguments = SolveArguments {
        task,
        solver,
        position_tolerance: &position_tolerance,
        rotation_tolerance: &rotation_tolerance,
        goals: None,
        prefer: "any",
        joint_weights: None,
        obstacles,
        margin,
        self_collision,
        stop,
        seed,
    };
    let start = start_q.map(|q| joint_vector(&robot.core, "start_q", q)).transpose()?;
    let each = arguments.read(robot, &asked, start, resolved)?;
    let limit = limit.map(|limit| count("limit", limit)).transpose()?;
    let redundancy = count("redundancy", redundancy)?;
    let options = AllOptions { each, limit, separation, redundancy, turns };
    let core = watched(py, None, |watcher| ik::solve_all_tips(&robot.core, asked.values(), &options, watcher))?;
    let mut qs = core.solutions.values().to_vec();
    qs.extend(core.miss.iter().flat_map(|miss| miss.q.iter().copied()));
    let tips = tip_errors(robot, &asked, |_| asked.values().iter().copied().collect(), &options.each, &qs)?;
    let unreached = match (&asked, &core.obstruction) {
        (Asked::One(target), Some(_)) => {
            Some(Box::new(Unreached { robot: owner.clone().unbind(), target: *target, options }))
        }
        _ => None,
    };
    Ok(PySolutionSet::new(core, robot.core.dof(), in_force, unreached, tips))
}
