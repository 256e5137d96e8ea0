//! `obstacles.nearest`.

use ikcore::obstacle::{NearestContact, Scene};
use numpy::PyArray1;
use pyo3::prelude::*;

use super::Obstacles;
use crate::convert::{copied, vector};
use crate::error::raise;
use crate::robot::PyRobot;

/// The nearest two bodies at a configuration, from `obstacles.nearest`.
#[pyclass(name = "Nearest", module = "beetle_ik.obstacles", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyNearest {
    core: NearestContact,
}

#[pymethods]
impl PyNearest {
    /// The link of the robot.
    #[getter]
    fn body(&self) -> &str {
        &self.core.contact.link
    }

    /// What it is near to: "obstacle 0 (Box)" or "link 'panda_link0'".
    #[getter]
    fn other(&self) -> String {
        self.core.contact.other.to_string()
    }

    /// Distance between their surfaces (m); negative by how deep they reach into each other.
    #[getter]
    fn distance(&self) -> f64 {
        self.core.contact.distance
    }

    /// The nearest point of the link (3,) (m), in the frame of the robot's base. That of the other body is
    /// `point - distance * normal`.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.core.point)
    }

    /// Unit vector (3,) from the other body to the link, along which the distance grows fastest.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.core.normal)
    }

    /// Derivative of the distance by each joint (n,) (m/rad, m/m).
    #[getter]
    fn gradient<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.core.gradient)
    }

    fn __repr__(&self) -> String {
        let contact = &self.core.contact;
        format!(
            "Nearest(body={:?}, other={:?}, distance={:?})",
            contact.link,
            contact.other.to_string(),
            contact.distance
        )
    }
}

/// Returns the two bodies that are nearest to each other: a link and an obstacle, or two links; the deepest overlap if
/// bodies overlap. None if nothing can touch. The pairs and the meaning of the distance are those of `clearance`.
///
/// Args:
///     robot: an arm with capsules.
///     q: joint positions (n,) (rad, m).
///     obstacles: obstacles in the frame of the robot's base.
///
/// Raises:
///     InvalidInputError: a robot without capsules, or an obstacle that is not of `bik.obstacles`.
#[pyfunction]
#[pyo3(signature = (robot, q, obstacles=None))]
pub fn nearest(
    py: Python<'_>,
    robot: &PyRobot,
    q: &Bound<'_, PyAny>,
    obstacles: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<PyNearest>> {
    let obstacles = Obstacles::read(py, obstacles)?.core;
    let scene = Scene::new(&robot.core, &obstacles).map_err(raise)?;
    let found = scene.nearest_contact(&vector("joint angles", q)?).map_err(raise)?;
    Ok(found.map(|core| PyNearest { core }))
}
