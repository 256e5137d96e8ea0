//! `self_motion` and `SelfMotion`.

use ikcore::ik::{self, SelfMotionOptions};
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::Subject;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::convert::{count, counted, table};
use crate::error::raise;
use crate::ik::read_target;
use crate::joint_order::joint_vector;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;
use crate::tips::read_only;
use crate::units;

/// A curve of configurations that keep the tip at a target.
#[pyclass(name = "SelfMotion", module = "beetle_ik", frozen)]
pub struct PySelfMotion {
    core: ik::SelfMotion,
    joint_names: Vec<String>,
    /// The configurations (k, n) (rad, m) in order, inside the limits.
    #[pyo3(get)]
    q: Py<PyArrayDyn<f64>>,
}

#[pymethods]
impl PySelfMotion {
    /// Whether the last configuration is followed by the first, modulo whole turns of joints without limits.
    #[getter]
    fn closed(&self) -> bool {
        self.core.closed
    }

    /// Name of the joint whose limit ends the curve at its first configuration; None if the curve is closed or not
    /// followed so far.
    #[getter]
    fn lower_cut(&self) -> Option<&str> {
        self.core.lower_cut.map(|joint| self.joint_names[joint].as_str())
    }

    /// Name of the joint whose limit ends the curve at its last configuration; None if the curve is closed or not
    /// followed so far.
    #[getter]
    fn upper_cut(&self) -> Option<&str> {
        self.core.upper_cut.map(|joint| self.joint_names[joint].as_str())
    }

    /// Whether the closed form shows that the call returned every curve: for arms whose parameter is the arm angle, unless curves
    /// cross, as at singular poses.
    #[getter]
    fn complete(&self) -> bool {
        self.core.complete
    }

    /// Length of the curve in joint space (rad, m).
    #[getter]
    fn length(&self) -> f64 {
        self.core.length()
    }

    fn __len__(&self) -> usize {
        self.core.iter().len()
    }

    fn __repr__(&self) -> String {
        let configurations = counted(self.core.iter().len(), "configuration");
        let ends = match (self.lower_cut(), self.upper_cut()) {
            _ if self.core.closed => "closed".into(),
            (Some(lower), Some(upper)) => format!("from a limit of '{lower}' to one of '{upper}'"),
            _ => "open".into(),
        };
        format!("<SelfMotion: {configurations}, {ends}, {:.3} long>", self.core.length())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("self-motion", &self.core))?;
        pickling::restored_from::<Self>(py, (core, self.joint_names.clone()))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8], joint_names: Vec<String>) -> PyResult<Self> {
        Self::new(py, from_bytes("self-motion", bytes).map_err(raise)?, joint_names)
    }
}

impl PySelfMotion {
    fn new(py: Python<'_>, core: ik::SelfMotion, joint_names: Vec<String>) -> PyResult<Self> {
        let q = table(py, core.values().to_vec(), &[core.iter().len(), joint_names.len()])?.unbind();
        Ok(Self { core, joint_names, q })
    }
}

/// Returns the curves of the self-motion: all configurations, inside the limits, that keep the tip at a target.
///
/// The arm must have one joint more than the target constrains: seven joints for a pose, four for a position. With a
/// closed form (`Robot.closed_form`), curves are sought at 64 values of its parameter, on every branch; otherwise by
/// search. Each curve is followed in short steps past the joint limits and then cut there, so that short parts between
/// two limits are found too. Curves that cross those found, as at singular poses, are followed as well, and so is the curve
/// through a `start_q` that reaches the target, or through the solution that `solve` finds where there would be none. If
/// no curve can be followed through it, it is returned as a curve of one configuration.
///
/// Args:
///     robot: the arm.
///     target: pose (4, 4), or position (3,) (m).
///     start_q: (n,); curves are sorted by their distance from it. None: the longest curve comes first.
///     spacing: largest distance |q - q'| of consecutive configurations (rad, m), from 0.001 to 0.5.
///     limits: position limits; None: the robot's.
///     seed: seed of the random draws of a search; the same seed gives the same bits.
///
/// Returns:
///     A list of `SelfMotion`; empty if no configuration is found. Every configuration reaches the target to 2e-9 m and rad.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, or an arm that does not have one joint more than the target constrains.
///
/// For example:
///
///     >>> robot = bik.Robot.named("panda")
///     >>> curves = bik.self_motion(robot, robot.fk([0.3, 0.2, -0.4, -1.7, 0.2, 1.9, 0.5]))
///     >>> len(curves)
///     3
#[pyfunction]
#[pyo3(signature = (robot, target, *, start_q=None, spacing=0.05, limits=None, seed=0))]
pub fn self_motion(
    py: Python<'_>,
    robot: &PyRobot,
    target: &Bound<'_, PyAny>,
    start_q: Option<&Bound<'_, PyAny>>,
    spacing: f64,
    limits: Option<&PyLimits>,
    seed: i128,
) -> PyResult<Vec<PySelfMotion>> {
    robot.core.require_one_tip("self_motion").map_err(raise)?;
    let target = read_only("target", robot, target, read_target)?;
    units::doubt(units::of_target(&robot.core, "target", Subject::Tip(0), &target))?;
    let (_, limits) = limits_of_call(py, limits, robot, &Sampling::once())?;
    let start = start_q.map(|q| joint_vector(&robot.core, "start_q", q)).transpose()?;
    let options = SelfMotionOptions { start, spacing, limits, seed: count("seed", seed)? };
    let curves = watched(py, None, |watcher| ik::self_motion(&robot.core, &target, &options, watcher))?;
    let names: Vec<String> = robot.core.joints().iter().map(|joint| joint.name.clone()).collect();
    curves.into_iter().map(|curve| PySelfMotion::new(py, curve, names.clone())).collect()
}
