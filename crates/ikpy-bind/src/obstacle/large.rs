//! Obstacles made of many pieces: meshes, point clouds and occupancy grids.

use ikcore::shape::{Geometry, Shape};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::arrays::{Coordinates, faces, occupied, points, read_faces, read_occupied, read_points};
use super::body::{PyObstacle, made};
use super::touch::{Touch, read_touch};
use crate::convert::{Array, point, table};
use crate::monitor::on_a_thread;

/// A mesh of triangles: vertices (k, 3) (m) and faces (t, 3), indices of vertices. It need not be convex. What its closed parts
/// enclose counts too; the others are surfaces without thickness.
///
/// A part is a set of triangles connected along edges; vertices at one place count as one. It is closed if each edge belongs to two
/// triangles, in any orientation, or if the orientations of the triangles along each edge cancel. Parts that overlap, or are inside
/// out, all have an inside. A part is the wall of a cavity if it lies inside another one, apart from all others, and its triangles
/// are turned the other way.
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

    /// Whether all that the mesh encloses is known: all its parts are closed, and none has the outside on both sides of a triangle, by
    /// winding numbers, as have two layers of opposite orientation that coincide but are not halved alike. Of large parts some 128
    /// triangles are examined.
    #[getter]
    fn closed(this: PyRef<'_, Self>) -> bool {
        matches!(this.as_super().core.shape.geometry(), Geometry::Mesh(mesh) if mesh.is_closed())
    }
}

/// Balls of one `radius` (m) about points (k, 3) (m), such as from a depth camera.
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

/// The occupied voxels of a grid: cubes with edges of `voxel` (m), the first with its lowest corner at `origin` (3,) (m).
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
