//! `Plan`.

use ikcore::planning::Plan;
use ikcore::stored::{from_bytes, to_bytes};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::violation::PyViolation;
use crate::convert::table;
use crate::error::raise;
use crate::limits::PyLimits;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::robot::PyRobot;
use crate::trajectory::PyTrajectory;

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
    /// Positions (k, 3) (m) that the tip was to follow, straight in between; None for a plan from end to end.
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

    /// Largest distance of the tip from the path (m), at its points and between them; NaN for a plan from end to end.
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
        python_calls::plot(slf.into_any(), "plan")
    }

    fn __repr__(&self) -> String {
        format!("<Plan {}: {}>", self.core.status.name(), self.core.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("plan", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.robot, &self.limits, &self.obstacles))
    }

    /// What pickle stored.
    #[staticmethod]
    fn _restore(
        bytes: &[u8],
        robot: &Bound<'_, PyRobot>,
        limits: Py<PyLimits>,
        obstacles: Py<PyTuple>,
    ) -> PyResult<Self> {
        Self::new(from_bytes("plan", bytes).map_err(raise)?, robot, limits, obstacles)
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
