//! `Plan`.

use std::sync::OnceLock;

use ikcore::constraint::Keep;
use ikcore::obstacle::Clearance;
use ikcore::planning::Plan;
use ikcore::stored::to_bytes;
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::move_report::PyMoveReport;
use super::path_break::PyBreak;
use super::violation::PyViolation;
use crate::convert::{row, table};
use crate::error::raise;
use crate::keep::PyKeep;
use crate::limits::{PyLimits, Sampling, limits_of_call, required_limits};
use crate::monitor::long_call;
use crate::obstacle::PyNearest;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::start_gate::{Outside, plain};
use crate::trajectory::PyTrajectory;
use crate::traversal::traversed;

/// A planned motion, and the outcome of its search.
#[pyclass(name = "Plan", module = "beetle_ik", frozen)]
pub struct PyPlan {
    core: Plan,
    /// The motion: the best one that meets all requirements, otherwise the one that violates them least.
    #[pyo3(get)]
    trajectory: Py<PyTrajectory>,
    /// Progress of the search (h, 2): number of evaluations, lowest cost found by then. The cost includes penalties
    /// while the plan has violations.
    #[pyo3(get)]
    history: Py<PyArrayDyn<f64>>,
    /// Absolute orientations of the redundant links of a planar arm along the path (points, links, 3), as value, lowest and
    /// highest possible (rad), from the tip's link down; (0, 0, 3) without redundancy.
    #[pyo3(get)]
    redundancy: Py<PyArrayDyn<f64>>,
    /// Reference positions of the tip (k, 3) (m), joined by straight lines; None for a point-to-point plan.
    #[pyo3(get)]
    reference: Option<Py<PyArrayDyn<f64>>>,
    /// The obstacles, as given.
    #[pyo3(get)]
    obstacles: Py<PyTuple>,
    /// The robot.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    /// Smallest clearance on the trajectory, computed at the first access.
    least_clearance: OnceLock<Option<Clearance>>,
    /// Largest errors of what is kept, computed at the first access.
    kept: OnceLock<Vec<Vec<f64>>>,
}

traversed!(PyPlan: obstacles, robot, limits);

outcome! {
    PyPlan = |result|
    /// Whether the trajectory meets all requirements.
    success,
    /// SOLVED on `success`; otherwise the reason why the search ended.
    status: result.core.status,
    message: result.core.message(),
    /// Evaluations of the cost.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PyPlan {
    /// The quantity that was minimised: "time", "joint_travel" or "tip_travel".
    #[getter]
    fn objective(&self) -> String {
        self.core.objective.to_string()
    }

    /// Value of the objective on the trajectory (s, rad or m).
    #[getter]
    fn cost(&self) -> f64 {
        self.core.cost
    }

    /// Smallest distance between robot and obstacles along the trajectory (m), without the contacts that an approach or a retreat
    /// allows; NaN without obstacles.
    #[getter]
    fn clearance(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.least_clearance(py)?.as_ref().map_or(f64::NAN, |clearance| clearance.distance))
    }

    /// Nearest two bodies over the whole trajectory, a `Nearest`; None without obstacles.
    #[getter]
    fn nearest(&self, py: Python<'_>) -> PyResult<Option<PyNearest>> {
        let nearest = self.least_clearance(py)?.as_ref().and_then(|clearance| clearance.nearest.clone());
        Ok(nearest.map(PyNearest::from))
    }

    /// Largest distance of the tip from the path (m), at its points and between them; NaN for a point-to-point plan.
    #[getter]
    fn accuracy(&self) -> f64 {
        self.core.accuracy.unwrap_or(f64::NAN)
    }

    /// Index of the chosen end among those given; None for a plan along a path.
    #[getter]
    fn chosen_end(&self) -> Option<usize> {
        self.core.chosen_end
    }

    /// Joints that begin outside their limits and are led inside, each (joint, value, limit) (rad, m).
    #[getter]
    fn start_outside(&self) -> Vec<Outside> {
        plain(&self.core.start_outside)
    }

    /// Joints that went the short way round, and end whole turns away from the given end_q, each (joint, value at the end, value
    /// given) (rad).
    #[getter]
    fn end_turned(&self) -> Vec<(String, f64, f64)> {
        self.core.end_turned.iter().map(|turned| (turned.joint.clone(), turned.value, turned.given)).collect()
    }

    /// Escape from a start nearer than the margin, with `free_start=True`: the smallest distance at the start (m), and
    /// the time (s) from which on the margin is kept; None if the start was clear.
    #[getter]
    fn freed(&self) -> Option<(f64, f64)> {
        self.core.freed.map(|freed| (freed.clearance, freed.until))
    }

    /// Constraints kept along the way, a list of pairs: each `Keep` of the call, and the largest error of each component of its task on
    /// the whole motion (m, rad), NaN for free ones; distance and angle for a task without weights or tolerances. These are bounds,
    /// at most a hundredth of the tolerance too large, computed at the first access.
    #[getter]
    fn kept<'py>(&self, py: Python<'py>) -> PyResult<Vec<(PyKeep, Bound<'py, PyArray1<f64>>)>> {
        let robot = &self.robot.get().core;
        let largest = match self.kept.get() {
            Some(known) => known,
            None => {
                let found = long_call(py, || Ok(self.core.kept(robot)))?;
                self.kept.get_or_init(|| found)
            }
        };
        let pair = |(keep, largest): (&Keep, &Vec<f64>)| (PyKeep::from_core(keep, robot), row(py, largest.clone()));
        Ok(self.core.keeps.iter().zip(largest).map(pair).collect())
    }

    /// The bounds that the trajectory exceeds, a list of `Violation`; empty on success.
    #[getter]
    fn violations(&self) -> Vec<PyViolation> {
        self.core.violations.iter().cloned().map(PyViolation).collect()
    }

    /// Reports on the moves of a program, a list of `MoveReport` in the order of the moves; empty for other plans.
    #[getter]
    fn moves(&self) -> Vec<PyMoveReport> {
        self.core.moves.iter().cloned().map(PyMoveReport).collect()
    }

    /// Places where the tool leaves its path, with `breaks=True`, a list of `Break` in order; empty where it does not.
    #[getter]
    fn breaks(&self) -> Vec<PyBreak> {
        self.core.breaks.iter().cloned().map(PyBreak).collect()
    }

    /// Returns the plan retimed for other limits: the same path, as fast as they allow. Clearance and accuracy remain, and what
    /// the plan keeps on the way, which is certified again.
    ///
    /// A plan of `plan_along_path` with method "timed" gets a new optimal timing. Any other motion is scaled in time as
    /// a whole and passes exactly the same configurations.
    ///
    /// Args:
    ///     limits: position, velocity, acceleration, jerk, tip and torque limits; a field left out is the robot's.
    ///
    /// Raises:
    ///     TypeError: limits that are no `Limits`.
    ///     InfeasibleError: a plan with violations, one of `plan_moves`, a path outside the position limits, jerk limits on a motion whose
    ///         acceleration jumps, or a margin, or what is to be kept on the way, that the motion timed for jerk limits does not keep.
    ///     UnsupportedLimit: limits that vary in time.
    fn retime(&self, py: Python<'_>, limits: &Bound<'_, PyAny>) -> PyResult<Self> {
        let robot = self.robot.bind(py);
        let (in_force, resolved) = limits_of_call(py, Some(required_limits(limits)?), robot.get(), &Sampling::once())?;
        let arm = robot.get().core.clone();
        let retimed = long_call(py, || self.core.retime(&arm, resolved.as_ref()))?;
        Self::new(retimed, robot, in_force, self.obstacles.clone_ref(py))
    }

    /// Returns the joint torques (k, n) (N m; N for prismatic joints) of the plan at t (k,) (s), (n,) for a number, as `robot.torques`
    /// does. Times outside the plan are clamped.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without dynamics.
    fn torques<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.trajectory.get().torques_of(py, &self.robot.get().core, t)
    }

    /// Draws the arm along its path, the cost over evaluations, and the joint motions with their limits, and torques if the robot
    /// has dynamics; returns a matplotlib
    /// figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::plot(slf.into_any(), "plan")
    }

    fn __repr__(&self) -> String {
        format!("<Plan {}: {}>", self.core.status.name(), self.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("plan", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.robot, &self.limits, &self.obstacles))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(
        bytes: &[u8],
        robot: &Bound<'_, PyRobot>,
        limits: Py<PyLimits>,
        obstacles: Py<PyTuple>,
    ) -> PyResult<Self> {
        Self::new(Plan::from_bytes(bytes).map_err(raise)?, robot, limits, obstacles)
    }
}

impl PyPlan {
    pub fn new(core: Plan, robot: &Bound<'_, PyRobot>, limits: Py<PyLimits>, obstacles: Py<PyTuple>) -> PyResult<Self> {
        let py = robot.py();
        let history: Vec<f64> = core.history.iter().flat_map(|step| [step.evaluations as f64, step.cost]).collect();
        let free = &core.redundancy;
        let orientations = free.iter().flatten().flat_map(|free| [free.value, free.lowest, free.highest]).collect();
        let shape = [free.len(), free.first().map_or(0, |links| links.len()), 3];
        let reference = core
            .reference
            .as_ref()
            .map(|positions| table(py, positions.as_flattened().to_vec(), &[positions.len(), 3]).map(Bound::unbind));
        Ok(Self {
            trajectory: Py::new(py, PyTrajectory::led(core.trajectory.clone(), &core.start_outside))?,
            history: table(py, history, &[core.history.len(), 2])?.unbind(),
            redundancy: table(py, orientations, &shape)?.unbind(),
            reference: reference.transpose()?,
            obstacles,
            robot: robot.clone().unbind(),
            limits,
            least_clearance: OnceLock::new(),
            kept: OnceLock::new(),
            core,
        })
    }

    /// Returns the smallest clearance, computed at the first access.
    fn least_clearance(&self, py: Python<'_>) -> PyResult<&Option<Clearance>> {
        if let Some(known) = self.least_clearance.get() {
            return Ok(known);
        }
        let arm = self.robot.get().core.clone();
        let found = long_call(py, || self.core.least_clearance(&arm))?;
        Ok(self.least_clearance.get_or_init(|| found))
    }
}
