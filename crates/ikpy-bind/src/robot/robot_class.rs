//! `Robot`: the class.

use std::sync::Arc;

use ikcore::robot::Robot;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::limits::PyLimits;
use crate::tip_keys::TipKeys;

/// A robot: the chain of joints from a base link to a tip link, or several chains to several `tips`, and the links that branch off.
/// Immutable; made by `from_urdf`, `from_dh`, `planar` or `named`.
///
/// A joint vector q holds the n independent joints in chain order (rad, m): with several tips one chain after another,
/// shared joints once. Mimic joints follow their masters, and joints beside the chains are held. Poses are 4x4 matrices
/// in the frame of the robot's base.
#[pyclass(name = "Robot", module = "beetle_ik", frozen, eq)]
pub struct PyRobot {
    pub core: Arc<Robot>,
    /// Limits as a Python object, made at the first access. They hold only numbers, so that no reference cycle passes
    /// through them.
    pub(super) limits: PyOnceLock<Py<PyLimits>>,
    /// Names of the tips, for results.
    pub tips: TipKeys,
}

impl PartialEq for PyRobot {
    fn eq(&self, other: &Self) -> bool {
        self.core == other.core
    }
}

impl From<Robot> for PyRobot {
    fn from(robot: Robot) -> Self {
        Self { tips: TipKeys::of(&robot), core: Arc::new(robot), limits: PyOnceLock::new() }
    }
}
