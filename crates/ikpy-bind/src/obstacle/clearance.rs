//! `obstacles.clearance`.

use ikcore::obstacle::Scene;
use pyo3::prelude::*;

use super::GivenObstacles;
use crate::convert::{Rows, own, row};
use crate::error::raise;
use crate::joint_order::joint_rows;
use crate::monitor::in_pieces;
use crate::robot::PyRobot;

/// Rows between two checks for Ctrl-C; among many obstacles a row takes a millisecond.
const ROWS: usize = 128;

/// Returns the smallest distance (m) between the robot's bodies and obstacles, or between two of its bodies: a number
/// for q (n,), (m,) for q (m, n). A negative value is the depth of the deepest overlap; inf means nothing can touch.
///
/// The result is never more than the true distance: for capsules at most 1e-9 m less, for bodies of other shapes about
/// 1e-7 m. Farther than 1 km from the base, 1e-12 of the coordinates is lost; beyond 1e30 m, a body that may be near
/// gives -inf.
///
/// The depth of a capsule in an obstacle is the depth of the deepest point of its axis, plus its radius. It is measured
/// to the surface of a closed mesh (to 1 % or 0.1 mm), within the nearest block of voxels of a grid, or within the
/// nearest ball of a point cloud. The inside of a mesh with `Mesh.closed` False is known only in part.
///
/// Args:
///     robot: an arm with bodies.
///     q: joint positions (n,) or (m, n) (rad, m).
///     obstacles: obstacles in the frame of the robot's base. Each is compared with all bodies, including those of the
///         base and of held links, except for the links in its `touch`.
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
    let obstacles = GivenObstacles::read_for(py, robot, obstacles)?.core;
    let scene = Scene::new(&robot.core, &obstacles).map_err(raise)?;
    match joint_rows(&robot.core, "joint angles", q)? {
        Rows::One(q) => Ok(scene.clearance(q.as_slice()?).map_err(raise)?.into_pyobject(py)?.into_any()),
        Rows::Many(q, _) => {
            let clearances = in_pieces(py, q.as_slice()?, robot.core.dof(), ROWS, |q| scene.clearances(q))?;
            Ok(own(row(py, clearances)).into_any())
        }
    }
}
