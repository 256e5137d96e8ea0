//! `obstacles.clearance`.

use ikcore::obstacle::Scene;
use pyo3::prelude::*;

use super::Obstacles;
use crate::convert::{Rows, row, rows};
use crate::error::raise;
use crate::robot::PyRobot;

/// Distance between `robot` and what it is nearest to, at q (n,) or (m, n): a number or (m,) (m). Negative by the depth
/// of the deepest overlap; inf where nothing can touch.
///
/// Args:
///     robot: an arm with capsules.
///     q: joint angles.
///     obstacles: in the frame of the robot's base. Links that no joint moves are not held against them.
///
/// Of the links' own capsules those are compared that have another one between them and do not touch with all joints in
/// the middle of their ranges.
///
/// Raises:
///     InvalidInputError: a robot without capsules, an obstacle of another kind.
#[pyfunction]
#[pyo3(signature = (robot, q, obstacles=None))]
pub fn clearance<'py>(
    py: Python<'py>,
    robot: &PyRobot,
    q: &Bound<'py, PyAny>,
    obstacles: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let obstacles = Obstacles::read(py, obstacles)?.core;
    let scene = Scene::new(&robot.core, &obstacles).map_err(raise)?;
    match rows("joint angles", robot.core.name(), robot.core.dof(), q)? {
        Rows::One(q) => Ok(scene.clearance(q.as_slice()?).map_err(raise)?.into_pyobject(py)?.into_any()),
        Rows::Many(q, _) => {
            let (scene, q) = (&scene, q.as_slice()?);
            Ok(row(py, py.detach(|| scene.clearances(q)).map_err(raise)?).into_any())
        }
    }
}
