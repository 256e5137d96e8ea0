//! Obstacles made of many pieces: meshes, point clouds and occupancy grids.

use ikcore::shape::{Geometry, Shape};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::arrays::{Coordinates, faces, occupied, points, read_faces, read_occupied, read_points};
use super::body::{PyObstacle, made};
use super::touch::{Touch, read_touch};
use crate::convert::{Array, point, table};
use crate::monitor::on_a_thread;

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

/// A point cloud, for example from a depth camera: balls of one `radius` (m) about points (k, 3) (m).
#[pyclass(name = "PointCloud", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyPointCloud {
    /// Radius of the ball about each point (m).
    #[pyo3(get)]
    pub(super) radius: f64,
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
        made(Ok(on_a_thread(py, move || Shape::point_cloud(points, radius))?), touch, Self { radius })
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
/// `occupied` is a boolean array (nx, ny, nz).
#[pyclass(name = "Grid", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyGrid {
    /// Lowest corner of the first voxel (3,) (m).
    #[pyo3(get)]
    pub(super) origin: Coordinates<3>,
    /// Edge of a voxel (m).
    #[pyo3(get)]
    pub(super) voxel: f64,
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
        made(Ok(grid), touch, Self { origin: Coordinates(origin), voxel })
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
