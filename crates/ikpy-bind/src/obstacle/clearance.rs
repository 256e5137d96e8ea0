//! `obstacles.clearance`.

use ikcore::obstacle::Scene;
use pyo3::prelude::*;

use super::GivenObstacles;
use crate::convert::{Rows, row, rows};
use crate::error::raise;
use crate::monitor::in_pieces;
use crate::robot::PyRobot;

/// Rows between two checks for Ctrl-C; among many obstacles a row takes a millisecond.
const ROWS: usize = 128;

/// Returns the smallest distance (m) between the robot's bodies and obstacles, or between two of its bodies: a number
/// for q (n,), (m,) for q (m, n). A negative value is the depth of the deepest overlap; inf means nothing can touch.
///
/// Never more than the true distance, and at most 1e-9 m less. Where a capsule reaches into an obstacle, the depth is that of
/// the deepest point of its axis, plus its radius: to the surface of a closed mesh (to 1 % or 0.1 mm), in the nearest block of
/// voxels of a grid, in the nearest ball of a point cloud. Where `Mesh.closed` is False, not all of the inside is known. Of coordinates
/// above a kilometre 1e-12 is lost; beyond 1e30 m whatever may be near gives -inf.
///
/// Args:
///     robot: an arm with bodies.
///     q: joint positions (n,) or (m, n) (rad, m).
///     obstacles: obstacles in the frame of the robot's base. All bodies are compared with them, those of the base and of held
///         links too, but for the links that an obstacle names in its `touch`.
///
/// Two links of the robot are compared if they are among `robot.collision_pairs`.
///
/// Raises:
///     InvalidInputError: a robot without bodies, or an obstacle that is not of `bik.obstacles`.
#[pyfunction]
#[pyo3(signature = (robot, q, obstacles=None))]
pub fn clearance<'py>(
    py: Python<'py>,
    robot: &PyRobot,
    q: &Bound<'py, PyAny>,
    obstacles: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let obstacles = GivenObstacles::read(py, obstacles)?.core;
    let scene = Scene::new(&robot.core, &obstacles).map_err(raise)?;
    match rows("joint angles", robot.core.name(), robot.core.dof(), q)? {
        Rows::One(q) => Ok(scene.clearance(q.as_slice()?).map_err(raise)?.into_pyobject(py)?.into_any()),
        Rows::Many(q, _) => {
            let clearances = in_pieces(py, q.as_slice()?, robot.core.dof(), ROWS, |q| scene.clearances(q))?;
            Ok(row(py, clearances).into_any())
        }
    }
}
