//! `plan_batch` and `BatchPlan`.

use std::sync::Arc;

use ikcore::batch::{self, PlanProblem, plan_status};
use ikcore::planning::Plan;
use ikcore::solver::{Status, Stopwatch};
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyTuple};

use super::plan::PyPlan;
use super::plan_arguments::{PlanArguments, ReadOptions, read_problem};
use crate::convert::{optional_count, row};
use crate::error::{invalid, raise};
use crate::indexing::{Selection, iterate, select};
use crate::monitor::watched;
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::traversal::traversed;

/// Plans in the order of the problems. `b[i]` is a `Plan`, or None if problem i has none; `b[10:20]` and `b[b.success]` are
/// batches.
#[pyclass(name = "BatchPlan", module = "beetle_ik", frozen)]
pub struct PyBatchPlan {
    /// Plan of each problem, or None where `errors` has an exception.
    #[pyo3(get)]
    plans: Py<PyTuple>,
    /// The exception that `plan_point_to_point` raises for each problem; None where there is a plan.
    #[pyo3(get)]
    errors: Py<PyTuple>,
    /// Whether each motion meets all requirements (m,).
    #[pyo3(get)]
    success: Py<PyArray1<bool>>,
    /// Status of each problem (m,), values of `Status`: the status of its plan, or else OUT_OF_REACH for an end out of
    /// reach, IN_COLLISION for an end in collision, INVALID for any other error.
    #[pyo3(get)]
    status: Py<PyArray1<u8>>,
    /// Values of the objective (m,) (s, rad or m); NaN where there is no plan.
    #[pyo3(get)]
    cost: Py<PyArray1<f64>>,
    /// Total time (s).
    #[pyo3(get)]
    elapsed: f64,
    /// Number of planned motions, and the reasons for failures.
    #[pyo3(get)]
    message: String,
}

traversed!(PyBatchPlan: plans, errors);

#[pymethods]
impl PyBatchPlan {
    fn __len__(&self, py: Python<'_>) -> usize {
        self.plans.bind(py).len()
    }

    /// Returns a `Plan` or None, or a `BatchPlan` for a slice, a mask or several indices. The `elapsed` of a selection
    /// is the sum over its plans.
    fn __getitem__<'py>(&self, py: Python<'py>, index: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (plans, errors) = (self.plans.bind(py), self.errors.bind(py));
        match select("a batch", index, plans.len())? {
            Selection::One(i) => plans.get_item(i),
            Selection::Many(rows) => {
                let status = self.status.bind(py).readonly();
                let status = status.as_slice()?;
                let part = |all: &Bound<'py, PyTuple>| -> PyResult<Bound<'py, PyTuple>> {
                    PyTuple::new(py, rows.iter().map(|i| all.get_item(*i)).collect::<PyResult<Vec<_>>>()?)
                };
                let status = rows.iter().map(|i| status[*i]).collect();
                Ok(Bound::new(py, Self::new(&part(plans)?, &part(errors)?, status, None)?)?.into_any())
            }
        }
    }

    /// Iterates over the plans.
    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyIterator>> {
        iterate(slf.as_any())
    }

    fn __repr__(&self) -> String {
        format!("<BatchPlan: {}>", self.message)
    }

    fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::html(slf.into_any(), "result")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let status = self.status.bind(py).readonly().as_slice()?.to_vec();
        pickling::restored_from::<Self>(py, (&self.plans, &self.errors, status, self.elapsed))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(
        plans: &Bound<'_, PyTuple>,
        errors: &Bound<'_, PyTuple>,
        status: Vec<u8>,
        elapsed: f64,
    ) -> PyResult<Self> {
        if plans.len() != errors.len() || plans.len() != status.len() {
            return Err(invalid("cannot restore a batch of plans: its columns differ in length".into()));
        }
        Self::new(plans, errors, status, Some(elapsed))
    }
}

impl PyBatchPlan {
    /// Makes a batch; `elapsed` defaults to the sum over the plans.
    fn new(
        plans: &Bound<'_, PyTuple>,
        errors: &Bound<'_, PyTuple>,
        status: Vec<u8>,
        elapsed: Option<f64>,
    ) -> PyResult<Self> {
        let py = plans.py();
        let of_each = |name: &str| -> PyResult<Vec<f64>> {
            let number = |plan: Bound<'_, PyAny>| match plan.is_none() {
                true => Ok(f64::NAN),
                false => plan.getattr(name)?.extract(),
            };
            plans.iter().map(number).collect()
        };
        let spent = || of_each("elapsed").map(|times| times.into_iter().filter(|time| !time.is_nan()).sum());
        let solved: Vec<bool> = status.iter().map(|status| *status == Status::Solved as u8).collect();
        Ok(Self {
            message: message(plans, errors, &solved)?,
            cost: column(py, of_each("cost")?),
            success: column(py, solved),
            status: column(py, status),
            elapsed: elapsed.map_or_else(spent, Ok)?,
            plans: plans.clone().unbind(),
            errors: errors.clone().unbind(),
        })
    }
}

/// Number of problems whose failure a message explains.
const EXPLAINED: usize = 3;

/// Returns the number of motions that meet all requirements, and the first reasons for failure.
fn message(plans: &Bound<'_, PyTuple>, errors: &Bound<'_, PyTuple>, solved: &[bool]) -> PyResult<String> {
    let (total, count) = (solved.len(), solved.iter().filter(|solved| **solved).count());
    if total == 0 {
        return Ok("no problems".into());
    }
    if count == total {
        return Ok(format!("all {total} planned"));
    }
    let mut parts = vec![format!("{count} of {total} planned")];
    for i in (0..total).filter(|i| !solved[*i]).take(EXPLAINED) {
        let error = errors.get_item(i)?;
        let why = if error.is_none() { plans.get_item(i)?.getattr("message")?.str()? } else { error.str()? };
        parts.push(format!("problem {i}: {why}"));
    }
    if let Some(more @ 1..) = (total - count).checked_sub(EXPLAINED) {
        parts.push(format!("and {more} more"));
    }
    Ok(parts.join("; "))
}

fn column<T: Element>(py: Python<'_>, values: Vec<T>) -> Py<PyArray1<T>> {
    row(py, values).unbind()
}

/// Plans many motions at once, on all cores.
///
/// Item i is bit-identical to the result of `plan_point_to_point` for problem i, for any number of threads.
///
/// Args:
///     robot: the arm.
///     problems: a sequence of dicts of arguments of `plan_point_to_point`: start or start_q, end or end_q, and any
///         others. The arguments of a problem override the common ones.
///     threads: number of threads; None: one per core. With 1, everything runs in the calling thread.
///     progress: True shows a progress bar; a callable is called with (done, total).
///     approach, retreat, free_start, task, keep, limits, method, objective, obstacles, margin, self_collision, stop, seed: as for
///         `plan_point_to_point`, for all problems.
///
/// Returns:
///     A `BatchPlan`. A problem that raises an error, for example because an end is out of reach or in collision, does
///     not stop the others: its plan is None, and the exception is in `errors`.
///
/// Raises:
///     InvalidInputError: an argument that is no argument of `plan_point_to_point`, wrong shape, NaN (names the problem and
///         the argument), before anything is planned.
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> home = [0, -1.5, 1.5, -1.5, -1.5, 0]
///     >>> problems = [{"start_q": home, "end": [0.4, y, 0.3]} for y in (-0.2, 0.2, 5.0)]
///     >>> plans = bik.plan_batch(robot, problems)
///     >>> plans.success.tolist()
///     [True, True, False]
#[pyfunction]
#[pyo3(signature = (robot, problems, *, threads=None, progress=None, start_slack=None, end_turns=None, approach=None, retreat=None, free_start=None, task=None, keep=None,
                    limits=None, method=None, objective=None, obstacles=None, margin=None, self_collision=None, stop=None, seed=None),
       text_signature = "(robot, problems, *, threads=None, progress=None, start_slack=None, end_turns='nearest', approach=None, retreat=None, \
                         free_start=False, task=None, keep=None, limits=None, method='minmax', objective='time', obstacles=None, \
                         margin=None, self_collision=None, stop=None, seed=0)")]
#[allow(clippy::too_many_arguments)]
pub fn plan_batch<'py>(
    py: Python<'py>,
    robot: &Bound<'py, PyRobot>,
    problems: &Bound<'py, PyAny>,
    threads: Option<i128>,
    progress: Option<&Bound<'py, PyAny>>,
    start_slack: Option<Bound<'py, PyAny>>,
    end_turns: Option<Bound<'py, PyAny>>,
    approach: Option<Bound<'py, PyAny>>,
    retreat: Option<Bound<'py, PyAny>>,
    free_start: Option<Bound<'py, PyAny>>,
    task: Option<Bound<'py, PyAny>>,
    keep: Option<Bound<'py, PyAny>>,
    limits: Option<Bound<'py, PyAny>>,
    method: Option<Bound<'py, PyAny>>,
    objective: Option<Bound<'py, PyAny>>,
    obstacles: Option<Bound<'py, PyAny>>,
    margin: Option<Bound<'py, PyAny>>,
    self_collision: Option<Bound<'py, PyAny>>,
    stop: Option<Bound<'py, PyAny>>,
    seed: Option<Bound<'py, PyAny>>,
) -> PyResult<PyBatchPlan> {
    let common = PlanArguments {
        start_qd: None,
        start_slack,
        end_turns,
        approach,
        retreat,
        free_start,
        task,
        keep,
        limits,
        method,
        objective,
        obstacles,
        margin,
        self_collision,
        stop,
        seed,
    };
    let threads = optional_count("threads", threads)?;
    let arm = robot.get().core.clone();
    let (read, kept) = read_problems(robot, problems, &common)?;
    let stopwatch = Stopwatch::start();
    let results = watched(py, progress, |watcher| batch::plan_batch(&arm, &read, threads, watcher))?;
    let elapsed = stopwatch.elapsed().as_secs_f64();
    let status = results.iter().map(|result| plan_status(result) as u8).collect();
    let (plans, errors) = converted(robot, results, &kept)?;
    let batch = PyBatchPlan::new(&plans, &errors, status, Some(elapsed))?;
    python_calls::log(py, "plan_batch", &batch.message)?;
    Ok(batch)
}

/// Options of the core, with the limits and obstacles that the plan stores.
type Kept = Arc<ReadOptions>;

/// Reads all problems; problems without options of their own share the common ones.
fn read_problems<'py>(
    robot: &Bound<'py, PyRobot>,
    problems: &Bound<'py, PyAny>,
    common: &PlanArguments<'py>,
) -> PyResult<(Vec<PlanProblem>, Vec<Kept>)> {
    let py = robot.py();
    let of_all = Arc::new(common.read(py, robot.get())?);
    let (mut read, mut kept) = (vec![], vec![]);
    let wrong = || invalid("problems must be a sequence of dicts of arguments of plan_point_to_point".into());
    for (i, problem) in problems.try_iter().map_err(|_| wrong())?.enumerate() {
        py.check_signals()?;
        let problem = problem?;
        let one = || -> PyResult<(PlanProblem, Kept)> {
            let (ends, own) = read_problem(&problem, common)?;
            let (start, ends) = ends.read(robot.get(), own.as_ref().map_or(&common.task, |own| &own.task))?;
            let kept = match own {
                None => of_all.clone(),
                Some(own) => Arc::new(own.read_over(py, robot.get(), common, &of_all)?),
            };
            Ok((PlanProblem { start, ends, options: kept.core.clone() }, kept))
        };
        let (problem, options) = one().map_err(|error| in_problem(py, i, &error))?;
        read.push(problem);
        kept.push(options);
    }
    Ok((read, kept))
}

/// Names the problem in an error of one of its arguments.
fn in_problem(py: Python<'_>, i: usize, error: &PyErr) -> PyErr {
    PyErr::from_type(error.get_type(py), format!("problems[{i}]: {}", error.value(py)))
}

/// Returns the plans, and the exceptions of the problems without a plan.
fn converted<'py>(
    robot: &Bound<'py, PyRobot>,
    results: Vec<ikcore::Result<Plan>>,
    kept: &[Kept],
) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyTuple>)> {
    let py = robot.py();
    let (mut plans, mut errors) = (vec![], vec![]);
    for (result, kept) in results.into_iter().zip(kept) {
        let (plan, error) = match result {
            Ok(plan) => {
                (Some(PyPlan::new(plan, robot, kept.limits.clone_ref(py), kept.obstacles.clone_ref(py))?), None)
            }
            Err(error) => (None, Some(raise(error).into_value(py))),
        };
        plans.push(plan);
        errors.push(error);
    }
    Ok((PyTuple::new(py, plans)?, PyTuple::new(py, errors)?))
}
