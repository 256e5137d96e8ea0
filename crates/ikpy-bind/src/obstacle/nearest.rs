//! `obstacles.nearest`.

use ikcore::obstacle::{NearestContact, Scene};
use ikcore::stored::{from_bytes, to_bytes};
use numpy::PyArray1;
use pyo3::prelude::*;

use super::GivenObstacles;
use crate::convert::copied;
use crate::error::raise;
use crate::hash::content_hash;
use crate::joint_order::joint_vector;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;

/// The nearest two bodies at a configuration, from `obstacles.nearest`.
#[pyclass(name = "Nearest", module = "beetle_ik.obstacles", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyNearest {
    body: String,
    other: String,
    distance: f64,
    point: [f64; 3],
    normal: [f64; 3],
    gradient: Vec<f64>,
}

impl From<NearestContact> for PyNearest {
    fn from(nearest: NearestContact) -> Self {
        let NearestContact { contact, point, normal, gradient } = nearest;
        let other = contact.other.to_string();
        Self { body: contact.link, other, distance: contact.distance, point, normal, gradient }
    }
}

#[pymethods]
impl PyNearest {
    /// The link of the robot.
    #[getter]
    fn body(&self) -> &str {
        &self.body
    }

    /// The other body: "obstacle 0 (Box)" or "link 'panda_link0'".
    #[getter]
    fn other(&self) -> &str {
        &self.other
    }

    /// Distance between the two surfaces (m); minus the depth where they overlap.
    #[getter]
    fn distance(&self) -> f64 {
        self.distance
    }

    /// Nearest point of the link (3,) (m), in the frame of the robot's base. The nearest point of the other body is
    /// `point - distance * normal`.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.point)
    }

    /// Unit vector (3,) from the other body to the link, along which the distance grows fastest.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.normal)
    }

    /// Derivative of the distance with respect to each joint (n,) (m/rad, m/m).
    #[getter]
    fn gradient<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.gradient)
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let fields = (&self.body, &self.other, self.distance, self.point, self.normal, &self.gradient);
        pickling::restored_from::<Self>(py, (pickling::bytes(py, to_bytes("nearest bodies", &fields))?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        let (body, other, distance, point, normal, gradient) = from_bytes("nearest bodies", bytes).map_err(raise)?;
        Ok(Self { body, other, distance, point, normal, gradient })
    }

    fn __repr__(&self) -> String {
        format!("Nearest(body={:?}, other={:?}, distance={:?})", self.body, self.other, self.distance)
    }
}

/// Returns the nearest two bodies: a link and an obstacle, or two links; if bodies overlap, the two with the deepest
/// overlap. None if nothing can touch. Pairs and distance are defined as in `clearance`.
///
/// Args:
///     robot: an arm with bodies.
///     q: joint positions (n,) (rad, m).
///     obstacles: obstacles in the frame of the robot's base.
///
/// Raises:
///     InvalidInputError: a robot without bodies, or an obstacle that is not of `bik.obstacles`.
#[pyfunction]
#[pyo3(signature = (robot, q, obstacles=None))]
pub fn nearest(
    py: Python<'_>,
    robot: &PyRobot,
    q: &Bound<'_, PyAny>,
    obstacles: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<PyNearest>> {
    let obstacles = GivenObstacles::read_for(py, robot, obstacles)?.core;
    let scene = Scene::new(&robot.core, &obstacles).map_err(raise)?;
    let found = scene.nearest_contact(&joint_vector(&robot.core, "joint angles", q)?).map_err(raise)?;
    Ok(found.map(PyNearest::from))
}
