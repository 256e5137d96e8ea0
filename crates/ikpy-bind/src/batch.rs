//! `solve_batch` and `BatchSolution`.

use std::time::Duration;

use ikcore::batch::{self, Batch, BatchOptions, OnInvalid, Targets};
use ikcore::ik::{Solution, SolveReport};
use ikcore::objective::Point;
use ikcore::robot::Robot;
use ikcore::solver::Status;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::Subject;
use ikcore::units::UnitDoubt;
use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator};

use crate::convert::{Numbers, Rows, array, count, optional_count, row, shape_text, table};
use crate::error::{invalid, raise};
use crate::ik::PySolution;
use crate::indexing::{Selection, iterate, select};
use crate::joint_order::joint_rows;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::solve_arguments::SolveArguments;
use crate::solver::PyStop;
use crate::tips::{Asked, TipErrors, ToleranceArgument, read_tolerance, tip_errors};
use crate::traversal::traversed;
use crate::units;
use crate::wording::said;

/// Solutions in the order of the targets, stored as columns. `b[i]` is a `Solution`; `b[10:20]` and `b[~b.success]` are
/// batches.
#[pyclass(name = "BatchSolution", module = "beetle_ik", frozen)]
pub struct PyBatchSolution {
    items: Vec<SolveReport>,
    dof: usize,
    /// The best configurations found (m, n) (rad, m), inside the limits; NaN in rows whose `status` is INVALID.
    #[pyo3(get)]
    q: Py<PyArrayDyn<f64>>,
    /// Whether each target was reached within the tolerances (m,).
    #[pyo3(get)]
    success: Py<PyArray1<bool>>,
    /// Reason why each search ended (m,), values of `Status`.
    #[pyo3(get)]
    status: Py<PyArray1<u8>>,
    /// Distances of the tip from the targets (m,) (m), by forward kinematics of `q`; the largest of several tips.
    #[pyo3(get)]
    position_error: Py<PyArray1<f64>>,
    /// Geodesic angles to the targets' orientations (m,) (rad), the largest of several tips; NaN if the task leaves the orientation free.
    #[pyo3(get)]
    rotation_error: Py<PyArray1<f64>>,
    /// Smallest distances to obstacles or between links (m,) (m), as in `Solution.clearance`.
    #[pyo3(get)]
    clearance: Py<PyArray1<f64>>,
    /// Iterations over all starts (m,).
    #[pyo3(get)]
    iterations: Py<PyArray1<i64>>,
    /// Restarts after the first start (m,).
    #[pyo3(get)]
    restarts: Py<PyArray1<i64>>,
    /// Evaluations of the forward kinematics (m,).
    #[pyo3(get)]
    evaluations: Py<PyArray1<i64>>,
    elapsed: Duration,
    /// Errors by tip.
    tips: TipErrors,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    /// Number of solved targets, and advice on the others.
    #[pyo3(get)]
    message: String,
}

traversed!(PyBatchSolution: limits);

#[pymethods]
impl PyBatchSolution {
    /// Errors of each target, by the keys of the call or the name of the only tip: {tip: (position (m,) (m), rotation (m,) (rad))}.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.tips.dict(py, self.items.iter().map(|item| item.error), |errors| {
            let (position, rotation) = errors.map(|error| (error.position, error.rotation)).unzip();
            (row::<f64>(py, position), row::<f64>(py, rotation))
        })
    }

    /// Total time (s).
    #[getter]
    fn elapsed(&self) -> f64 {
        self.elapsed.as_secs_f64()
    }

    fn __len__(&self) -> usize {
        self.items.len()
    }

    /// Returns a `Solution`, or a `BatchSolution` for a slice, a mask or several indices. The `elapsed` of a selection
    /// is the sum over its items.
    fn __getitem__<'py>(&self, py: Python<'py>, index: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        match select("a batch", index, self.items.len())? {
            Selection::One(i) => {
                let q = self.q.bind(py).readonly();
                let q = Point::from_slice(&q.as_slice()?[i * self.dof..(i + 1) * self.dof]);
                let solution = Solution { q, report: self.items[i].clone() };
                let tips = self.tips.select(&[i]);
                Ok(Bound::new(py, PySolution::new(py, solution, self.limits.clone_ref(py), tips))?.into_any())
            }
            Selection::Many(rows) => {
                let batch = self.core(py)?.select(&rows);
                let tips = self.tips.select(&rows);
                Ok(Bound::new(py, Self::new(py, batch, self.limits.clone_ref(py), tips)?)?.into_any())
            }
        }
    }

    /// Iterates over the solutions.
    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyIterator>> {
        iterate(slf.as_any())
    }

    fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::html(slf.into_any(), "result")
    }

    fn __repr__(&self) -> String {
        format!("<BatchSolution: {}>", self.message)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("batch of solutions", &self.core(py)?))?;
        pickling::restored_from::<Self>(py, (core, self.limits.clone_ref(py), self.tips.bytes(py)?))
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (bytes, limits, tips=None))]
    fn _restore(py: Python<'_>, bytes: &[u8], limits: Py<PyLimits>, tips: Option<&[u8]>) -> PyResult<Self> {
        Self::new(py, from_bytes("batch of solutions", bytes).map_err(raise)?, limits, TipErrors::restored(tips)?)
    }
}

impl PyBatchSolution {
    fn new(py: Python<'_>, batch: Batch, limits: Py<PyLimits>, tips: TipErrors) -> PyResult<Self> {
        let message = said(&batch.message());
        let Batch { dof, q, items, elapsed } = batch;
        Ok(Self {
            dof,
            q: table(py, q, &[items.len(), dof])?.unbind(),
            success: column(py, &items, |item| item.status == Status::Solved),
            status: column(py, &items, |item| item.status as u8),
            position_error: column(py, &items, |item| item.error.position),
            rotation_error: column(py, &items, |item| item.error.rotation),
            clearance: column(py, &items, SolveReport::clearance),
            iterations: column(py, &items, |item| item.iterations as i64),
            restarts: column(py, &items, |item| item.restarts as i64),
            evaluations: column(py, &items, |item| item.evaluations as i64),
            elapsed,
            tips,
            limits,
            message,
            items,
        })
    }
}

impl PyBatchSolution {
    fn core(&self, py: Python<'_>) -> PyResult<Batch> {
        let q = self.q.bind(py).readonly().as_slice()?.to_vec();
        Ok(Batch { dof: self.dof, q, items: self.items.clone(), elapsed: self.elapsed })
    }
}

/// Returns the message of a batch in which `counts[status]` targets ended with `status`.
#[pyfunction]
#[pyo3(name = "_batch_message")]
#[allow(clippy::needless_pass_by_value)]
pub fn batch_message(counts: Vec<usize>) -> String {
    said(&batch::message_of_counts(&counts))
}

fn column<T: Element>(py: Python<'_>, items: &[SolveReport], of: impl Fn(&SolveReport) -> T) -> Py<PyArray1<T>> {
    row(py, items.iter().map(of).collect()).unbind()
}

/// Solves many targets at once, on all cores.
///
/// The result is bit-identical for any number of threads. An item does not depend on the items after it, and item 0 equals
/// the result of `solve`.
///
/// Args:
///     robot: the arm.
///     targets: poses (m, 4, 4), or positions (m, 3) (m) with the orientations left free; for a robot with several
///         tips, a dict of targets as for `solve`.
///     start_q: the start of each target, (m, n), or (n,) for all, as in `solve`.
///     first_row: row of the first of these targets in a larger batch. `solve_batch(robot, targets[k:], first_row=k)`
///         gives the rows of `solve_batch(robot, targets)` from k on, to the bit, and errors name the rows of the
///         larger batch.
///     threads: number of threads; None: one per core. With 1, everything runs in the calling thread.
///     on_invalid: treatment of an invalid target or start. "raise": raises an error that names the row; "skip": solves
///         the other rows and marks this row `Status.INVALID`, with q NaN.
///     progress: True shows a progress bar; a callable is called with (done, total).
///     task: as for `solve`.
///     solver: the solver of a search; None: the closed form of the arm for poses, where it has one (`Robot.closed_form`), and
///         Levenberg-Marquardt from many starts for everything else.
///     position_tolerance: largest position error (m).
///     rotation_tolerance: largest rotation error, a geodesic angle (rad).
///     goals, prefer, joint_weights: as for `solve`; the weights need `start_q`.
///     limits: position limits; None: the robot's.
///     obstacles, margin, self_collision: as for `solve`.
///     stop: budgets of each target; None: as for `solve`.
///     seed: seed of the random draws; the same seed gives the same bits.
///
/// Returns:
///     A `BatchSolution`. If a target is not reached, its status says why, and its q is the best configuration found.
///
/// Raises:
///     InvalidInputError: wrong shape; NaN, or a target that is not a rigid transform (names the row).
///     LimitError: limits that contradict each other.
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> targets = robot.fk(robot.random_configurations(100, seed=1))
///     >>> batch = bik.solve_batch(robot, targets)
///     >>> batch.q.shape, int(batch.success.sum())
///     ((100, 6), 100)
#[pyfunction]
#[pyo3(signature = (robot, targets, *, start_q=None, first_row=0, threads=None, on_invalid="raise", progress=None, task=None,
                    solver=None, position_tolerance=ToleranceArgument::All(1e-6),
                    rotation_tolerance=ToleranceArgument::All(1e-6), goals=None, prefer="any", joint_weights=None, limits=None, obstacles=None, margin=None,
                    self_collision=None, stop=None, seed=0),
       text_signature = "(robot, targets, *, start_q=None, first_row=0, threads=None, on_invalid='raise', progress=None, task=None, solver=None, position_tolerance=1e-06, rotation_tolerance=1e-06, goals=None, prefer='any', joint_weights=None, limits=None, obstacles=None, margin=None, self_collision=None, stop=None, seed=0)")]
#[allow(clippy::too_many_arguments)]
pub fn solve_batch(
    py: Python<'_>,
    robot: &PyRobot,
    targets: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    first_row: i128,
    threads: Option<i128>,
    #[pyo3(from_py_with = crate::convert::text)] on_invalid: &str,
    progress: Option<&Bound<'_, PyAny>>,
    task: Option<&Bound<'_, PyAny>>,
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
) -> PyResult<PyBatchSolution> {
    let arm = &*robot.core;
    let asked = Asked::read("targets", robot, targets, array)?;
    let each = asked.values().iter().map(read_targets).collect::<PyResult<Vec<_>>>()?;
    let targets = match (&asked, &each[..]) {
        (Asked::One(_), [only]) => *only,
        _ => Targets::Tips(&each),
    };
    for ((subject, _), targets) in asked.iter().zip(&each) {
        units::doubt((0..targets.len()).find_map(|row| doubt_about(arm, subject, targets, row)))?;
    }
    let starts = start_q.map(|q| joint_rows(arm, "start_q", q)).transpose()?;
    let (start_of_each, start_of_all) = match &starts {
        Some(Rows::Many(starts, _)) => (Some(starts.as_slice()?), None),
        Some(Rows::One(start)) => (None, Some(start.as_slice()?.to_vec())),
        None => (None, None),
    };
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
    let options = BatchOptions {
        each: arguments.read(robot, &asked, start_of_all, resolved)?,
        starts: start_of_each,
        first_row: count("first_row", first_row)?,
        threads: optional_count("threads", threads)?,
        on_invalid: on_invalid.parse::<OnInvalid>().map_err(raise)?,
    };
    let batch = watched(py, progress, |watcher| batch::solve_batch(arm, targets, &options, watcher))?;
    python_calls::log(py, "solve_batch", &said(&batch.message()))?;
    let tips = tip_errors(robot, &asked, |row| targets.read(row), &options.each, &batch.q)?;
    PyBatchSolution::new(py, batch, in_force, tips)
}

/// Doubts one row of the targets of a tip.
fn doubt_about(robot: &Robot, subject: Subject, targets: &Targets<'_>, row: usize) -> Option<UnitDoubt> {
    let position = match targets {
        Targets::Positions(rows) => rows[row],
        Targets::Poses(rows) => [rows[row][3], rows[row][7], rows[row][11]],
        Targets::Tips(_) => return None,
    };
    units::of_point(robot, "targets", subject, &position)
}

fn read_targets<'a>(numbers: &'a Numbers<'_>) -> PyResult<Targets<'a>> {
    match numbers.shape() {
        [0] | [_, 3] => Ok(Targets::Positions(numbers.as_slice()?.as_chunks().0)),
        [_, 4, 4] => Ok(Targets::Poses(numbers.as_slice()?.as_chunks().0)),
        shape => {
            let got = shape_text(shape);
            Err(invalid(format!("targets: expected poses (m, 4, 4) or positions (m, 3), got shape {got}")))
        }
    }
}
