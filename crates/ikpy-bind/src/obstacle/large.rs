//! Obstacles made of many pieces: meshes, point clouds and occupancy grids.

use ikcore::shape::{Geometry, Grid, Shape};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;

use super::body::PyObstacle;
use super::shapes::{Coordinates, made};
use crate::convert::{Array, array, point, shape_text, summary, table};
use crate::error::invalid;
use crate::monitor::on_a_thread;

/// Reads points (k, 3).
pub(super) fn read_points(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 3]>> {
    let numbers = array(what, value)?;
    match numbers.shape() {
        [_, 3] => Ok(numbers.as_slice()?.as_chunks().0.to_vec()),
        shape => Err(invalid(format!("{what}: expected shape (k, 3), got {}", shape_text(shape)))),
    }
}

/// Reads triangles (t, 3): indices of vertices.
fn read_faces(value: &Bound<'_, PyAny>) -> PyResult<Vec<[u32; 3]>> {
    let numbers = array("faces", value)?;
    let [_, 3] = numbers.shape() else {
        return Err(invalid(format!("faces: expected shape (t, 3), got {}", shape_text(numbers.shape()))));
    };
    let index = |(i, number): (usize, &f64)| {
        let whole = number.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(number);
        let wrong = || invalid(format!("face {}: expected indices of vertices, from 0, got {number}", i / 3));
        if whole { Ok(*number as u32) } else { Err(wrong()) }
    };
    let indices: Vec<u32> = numbers.as_slice()?.iter().enumerate().map(index).collect::<PyResult<_>>()?;
    Ok(indices.as_chunks().0.to_vec())
}

/// Reads occupied voxels: a boolean array (nx, ny, nz).
fn read_occupied(value: &Bound<'_, PyAny>) -> PyResult<([usize; 3], Vec<bool>)> {
    let wrong = |got: &str| invalid(format!("occupied must be a boolean array (nx, ny, nz), got {got}"));
    let py = value.py();
    let converted = py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "ascontiguousarray"), (value,));
    let converted = converted.map_err(|_| wrong(&summary(value)))?;
    let Ok(array) = converted.cast::<PyArrayDyn<bool>>() else {
        let given = converted.cast::<PyUntypedArray>().map(|array| array.dtype().to_string());
        return Err(wrong(&given.map_or_else(|_| summary(value), |kind| format!("an array of {kind}"))));
    };
    match array.shape() {
        [x, y, z] => Ok(([*x, *y, *z], array.readonly().as_slice()?.to_vec())),
        shape => Err(wrong(&format!("shape {}", shape_text(shape)))),
    }
}

/// Returns points as an array (k, 3).
pub(super) fn points<'py>(py: Python<'py>, points: &[[f64; 3]]) -> PyResult<Array<'py>> {
    table(py, points.as_flattened().to_vec(), &[points.len(), 3])
}

/// Returns triangles as an array (t, 3).
pub(super) fn faces<'py>(py: Python<'py>, faces: &[[u32; 3]]) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
    table(py, faces.as_flattened().to_vec(), &[faces.len(), 3])
}

/// Returns the occupied voxels as an array (nx, ny, nz).
pub(super) fn occupied<'py>(py: Python<'py>, grid: &Grid) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
    table(py, grid.occupied().to_vec(), &grid.counts())
}

/// A mesh of triangles: vertices (k, 3) (m) and faces (t, 3), indices of vertices. It need not be convex. If it is closed,
/// its inside counts too; else it is a surface without thickness.
#[pyclass(name = "Mesh", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyMesh;

#[pymethods]
impl PyMesh {
    #[new]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (vertices, faces) = (read_points("vertices", vertices)?, read_faces(faces)?);
        made(Ok(on_a_thread(py, move || Shape::mesh(vertices, faces))?), Self)
    }

    /// The vertices (k, 3) (m).
    #[getter]
    fn vertices<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Array<'py>> {
        match this.as_super().core.geometry() {
            Geometry::Mesh(mesh) => points(py, mesh.vertices()),
            _ => points(py, &[]),
        }
    }

    /// The faces (t, 3): indices of vertices.
    #[getter]
    fn faces<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<u32>>> {
        match this.as_super().core.geometry() {
            Geometry::Mesh(mesh) => faces(py, mesh.faces()),
            _ => faces(py, &[]),
        }
    }

    /// Whether the mesh encloses a volume: every edge belongs to two triangles that run along it in opposite directions.
    #[getter]
    fn closed(this: PyRef<'_, Self>) -> bool {
        matches!(this.as_super().core.geometry(), Geometry::Mesh(mesh) if mesh.is_closed())
    }
}

/// Balls of one `radius` (m) about points (k, 3) (m), such as from a depth camera.
#[pyclass(name = "PointCloud", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyPointCloud {
    /// Radius of the ball about each point (m).
    #[pyo3(get)]
    radius: f64,
}

#[pymethods]
impl PyPointCloud {
    #[new]
    fn new(py: Python<'_>, points: &Bound<'_, PyAny>, radius: f64) -> PyResult<PyClassInitializer<Self>> {
        let points = read_points("points", points)?;
        made(Ok(on_a_thread(py, move || Shape::point_cloud(points, radius))?), Self { radius })
    }

    /// The points (k, 3) (m).
    #[getter]
    fn points<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Array<'py>> {
        match this.as_super().core.geometry() {
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
    origin: Coordinates<3>,
    /// Edge of a voxel (m).
    #[pyo3(get)]
    voxel: f64,
}

#[pymethods]
impl PyGrid {
    #[new]
    fn new(
        py: Python<'_>,
        origin: &Bound<'_, PyAny>,
        voxel: f64,
        occupied: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let origin = point("origin", origin)?;
        let (counts, occupied) = read_occupied(occupied)?;
        let grid = on_a_thread(py, move || Shape::grid(origin, voxel, counts, occupied))?;
        made(Ok(grid), Self { origin: Coordinates(origin), voxel })
    }

    /// Whether each voxel is occupied (nx, ny, nz).
    #[getter]
    fn occupied<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        match this.as_super().core.geometry() {
            Geometry::Grid(grid) => occupied(py, grid),
            _ => table(py, vec![], &[0, 0, 0]),
        }
    }
}
