//! Obstacles made of many pieces: meshes, point clouds and occupancy grids.

use ikcore::shape::{Geometry, Shape};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::arrays::{Coordinates, faces, occupied, points, read_faces, read_occupied, read_points};
use super::body::{PyObstacle, made};
use super::touch::{Touch, read_touch};
use crate::convert::{Array, point, table, vector};
use crate::error::invalid;
use crate::monitor::{long_call, on_a_thread};
use crate::robot::PyRobot;

/// A triangle mesh, convex or not: vertices (k, 3) (m) and faces (t, 3), indices of vertices. Closed parts are solid;
/// open parts are surfaces without thickness.
///
/// A part is a set of triangles connected along edges; coincident vertices count as one. It is closed if each edge
/// belongs to two triangles, in any orientation, or if the orientations of the triangles along each edge cancel.
/// Overlapping and inside-out parts are solid too. A part is the wall of a cavity if it lies inside another part,
/// separate from all others, and its triangles have the opposite orientation.
#[pyclass(name = "Mesh", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyMesh;

#[pymethods]
impl PyMesh {
    #[new]
    #[pyo3(signature = (vertices, faces, *, touch=None))]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (vertices, faces) = (read_points("vertices", vertices)?, read_faces(faces)?);
        made(Ok(on_a_thread(py, move || Shape::mesh(vertices, faces))?), touch, Self)
    }

    /// The vertices (k, 3) (m).
    #[getter]
    fn vertices<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Array<'py>> {
        match this.as_super().core.shape.geometry() {
            Geometry::Mesh(mesh) => points(py, mesh.vertices()),
            _ => points(py, &[]),
        }
    }

    /// The faces (t, 3): indices of vertices.
    #[getter]
    fn faces<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        match this.as_super().core.shape.geometry() {
            Geometry::Mesh(mesh) => faces(py, mesh.faces()),
            _ => faces(py, &[]),
        }
    }

    /// Whether the inside of the mesh is known everywhere: all parts are closed, and by winding numbers no triangle has
    /// the outside on both sides. Coincident layers of opposite orientation fail this test if their triangles differ.
    /// In a large part, about 128 triangles are tested.
    #[getter]
    fn closed(this: PyRef<'_, Self>) -> bool {
        matches!(this.as_super().core.shape.geometry(), Geometry::Mesh(mesh) if mesh.is_closed())
    }
}

/// A point cloud, for example from a depth camera: balls of one `radius` (m) about points (k, 3) (m). A cloud without points
/// touches nothing.
///
/// The robot is often in the picture: `without_robot` takes its own points out.
#[pyclass(name = "PointCloud", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyPointCloud {
    /// Radius of the ball about each point (m).
    #[pyo3(get)]
    pub(super) radius: f64,
    /// Number of the robot's own points that `without_robot` removed to make this cloud; 0 for other clouds, copies and
    /// files.
    #[pyo3(get)]
    pub(super) removed: usize,
}

#[pymethods]
impl PyPointCloud {
    #[new]
    #[pyo3(signature = (points, radius, *, touch=None))]
    fn new(
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        radius: f64,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let points = read_points("points", points)?;
        require_measured(&points)?;
        made(Ok(on_a_thread(py, move || Shape::point_cloud(points, radius))?), touch, Self { radius, removed: 0 })
    }

    /// Returns the cloud without the robot's own points: those whose ball is at most `padding` from a body of the robot.
    ///
    /// All bodies count: those of the base, of held and branched-off links, and attached shapes (`robot.with_attached`). The
    /// distance is that of `clearance`, so after this every body is more than `padding` from the cloud. `removed` of the new cloud
    /// is the number of points that are gone.
    ///
    /// Something that the robot touches or holds loses its points within `padding` too: attach what is in the hand.
    ///
    /// Args:
    ///     robot: an arm with bodies.
    ///     q: joint positions (n,) at which the cloud was taken (rad, m).
    ///     padding: largest distance (m) of the robot's own points from its model: the noise of the sensor, and errors of model,
    ///         calibration and time.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without bodies, wrong joint positions, or a padding that is negative or not finite.
    #[pyo3(signature = (robot, q, *, padding=0.02))]
    fn without_robot(
        this: PyRef<'_, Self>,
        py: Python<'_>,
        robot: &PyRobot,
        q: &Bound<'_, PyAny>,
        padding: f64,
    ) -> PyResult<Py<Self>> {
        let radius = this.radius;
        let (base, removed) = without_robot(py, this.as_super(), robot, q, padding)?;
        Py::new(py, base.add_subclass(Self { radius, removed }))
    }

    /// The points (k, 3) (m).
    #[getter]
    fn points<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Array<'py>> {
        match this.as_super().core.shape.geometry() {
            Geometry::PointCloud(cloud) => points(py, cloud.points()),
            _ => points(py, &[]),
        }
    }
}

/// An occupancy grid: cubic voxels with edges of `voxel` (m), the first with its lowest corner at `origin` (3,) (m).
/// `occupied` is a boolean array (nx, ny, nz). A grid without occupied voxels touches nothing.
///
/// The robot is often in what was measured: `without_robot` takes its own voxels out.
#[pyclass(name = "Grid", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyGrid {
    /// Lowest corner of the first voxel (3,) (m).
    #[pyo3(get)]
    pub(super) origin: Coordinates<3>,
    /// Edge of a voxel (m).
    #[pyo3(get)]
    pub(super) voxel: f64,
    /// Number of the robot's own voxels that `without_robot` removed to make this grid; 0 for other grids, copies and files.
    #[pyo3(get)]
    pub(super) removed: usize,
}

#[pymethods]
impl PyGrid {
    #[new]
    #[pyo3(signature = (origin, voxel, occupied, *, touch=None))]
    fn new(
        py: Python<'_>,
        origin: &Bound<'_, PyAny>,
        voxel: f64,
        occupied: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let origin = point("origin", origin)?;
        let (counts, occupied) = read_occupied(occupied)?;
        let grid = on_a_thread(py, move || Shape::grid(origin, voxel, counts, occupied))?;
        made(Ok(grid), touch, Self { origin: Coordinates(origin), voxel, removed: 0 })
    }

    /// Returns the grid without the robot's own voxels: those that are at most `padding` from a body of the robot.
    ///
    /// All bodies count, as in `PointCloud.without_robot`. The distance is that of `clearance` from the voxel alone. `removed` of
    /// the new grid is the number of voxels that are free now.
    ///
    /// Args:
    ///     robot: an arm with bodies.
    ///     q: joint positions (n,) at which the grid was measured (rad, m).
    ///     padding: largest distance (m) of the robot's own voxels from its model.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without bodies, wrong joint positions, or a padding that is negative or not finite.
    #[pyo3(signature = (robot, q, *, padding=0.02))]
    fn without_robot(
        this: PyRef<'_, Self>,
        py: Python<'_>,
        robot: &PyRobot,
        q: &Bound<'_, PyAny>,
        padding: f64,
    ) -> PyResult<Py<Self>> {
        let (origin, voxel) = (this.origin, this.voxel);
        let (base, removed) = without_robot(py, this.as_super(), robot, q, padding)?;
        Py::new(py, base.add_subclass(Self { origin, voxel, removed }))
    }

    /// Whether each voxel is occupied (nx, ny, nz).
    #[getter]
    fn occupied<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        match this.as_super().core.shape.geometry() {
            Geometry::Grid(grid) => occupied(py, grid),
            _ => table(py, vec![], &[0, 0, 0]),
        }
    }
}

/// Returns an obstacle without the robot's own points, and their number.
fn without_robot(
    py: Python<'_>,
    obstacle: &PyObstacle,
    robot: &PyRobot,
    q: &Bound<'_, PyAny>,
    padding: f64,
) -> PyResult<(PyClassInitializer<PyObstacle>, usize)> {
    let q = vector("joint angles", q)?;
    let left = long_call(py, || obstacle.core.without_robot(&robot.core, &q, padding))?;
    Ok((PyClassInitializer::from(PyObstacle { core: left.obstacle }), left.removed))
}

/// Refuses the holes of a depth image, and says how to leave them out.
fn require_measured(points: &[[f64; 3]]) -> PyResult<()> {
    let is_hole = |point: &[f64; 3]| point.iter().any(|x| !x.is_finite());
    let Some(first) = points.iter().position(is_hole) else { return Ok(()) };
    let ([x, y, z], count) = (points[first], points.iter().filter(|point| is_hole(point)).count());
    let (got, total) = (format!("[{x}, {y}, {z}]"), points.len());
    Err(invalid(format!(
        "points of the point cloud: {count} of {total} are not finite, the first is point {first}, {got}: leave out what was \
         not measured: points[np.isfinite(points).all(axis=1)]"
    )))
}
