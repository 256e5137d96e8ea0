//! `Obstacle`, the base class of all shapes.

use ikcore::math::Pose;
use ikcore::nalgebra::Matrix3;
use ikcore::shape::{Geometry, Grid, Shape};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use super::arrays::{faces, occupied, points};
use crate::convert::{Array, table};
use crate::error::raise;
use crate::hash::content_hash;
use crate::options::NewArguments;

/// The base class of obstacles: a shape, fixed in the frame of the robot's base.
#[pyclass(name = "Obstacle", module = "beetle_ik.obstacles", frozen, eq, subclass)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyObstacle {
    pub core: Shape,
}

/// Makes an instance of an obstacle's class, with its own fields.
pub(super) fn made<C>(core: ikcore::Result<Shape>, own: C) -> PyResult<PyClassInitializer<C>>
where
    C: PyClass<BaseType = PyObstacle>,
{
    Ok(PyClassInitializer::from(PyObstacle { core: core.map_err(raise)? }).add_subclass(own))
}

#[pymethods]
impl PyObstacle {
    /// Triangles of the surface (t, 3, 3) (m), for drawing. Their corners lie on the surface; a half-space is a square of 4 m,
    /// a point cloud octahedra about at most 2,000 of its points.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let triangles = self.core.triangles();
        let count = triangles.len();
        table(py, triangles.as_flattened().as_flattened().to_vec(), &[count, 3, 3])
    }

    fn __repr__(&self) -> String {
        let arguments = match self.core.geometry() {
            Geometry::Sphere { center, radius } => format!("{center:?}, {radius:?}"),
            Geometry::Box { pose, size } => {
                format!("{:?}, {size:?}{}", point_of(pose), rotation_text(pose))
            }
            Geometry::Capsule { a, b, radius } => format!("{a:?}, {b:?}, {radius:?}"),
            Geometry::Ellipsoid { pose, semi_axes } => {
                format!("{:?}, {semi_axes:?}{}", point_of(pose), rotation_text(pose))
            }
            Geometry::Ellipse { center, semi_axes, angle } => format!("{center:?}, {semi_axes:?}, angle={angle:?}"),
            Geometry::Cylinder { center, axis, radius, length } => {
                format!("{center:?}, {axis:?}, {radius:?}, {length:?}")
            }
            Geometry::HalfSpace { normal, offset } => format!("{normal:?}, {offset:?}"),
            Geometry::ConvexMesh(hull) => format!("{:?}", hull.points()),
            Geometry::Mesh(mesh) => {
                format!("{}, {}", list_text(mesh.vertices(), "points"), list_text(mesh.faces(), "triangles"))
            }
            Geometry::PointCloud(cloud) => {
                format!("{}, radius={:?}", list_text(cloud.points(), "points"), cloud.radius())
            }
            Geometry::Grid(grid) => {
                format!("{:?}, {:?}, {}", grid.origin(), grid.voxel(), voxels_text(grid))
            }
        };
        format!("obstacles.{}({arguments})", self.core.name())
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let none = PyDict::new(py);
        let turned = |pose: &Pose| rotation_rows(pose).map(|rows| [("rotation", rows)].into_py_dict(py)).transpose();
        Ok(match self.core.geometry() {
            Geometry::Sphere { center, radius } => ((*center, *radius).into_pyobject(py)?, none),
            Geometry::Box { pose, size } => ((point_of(pose), *size).into_pyobject(py)?, turned(pose)?.unwrap_or(none)),
            Geometry::Capsule { a, b, radius } => ((*a, *b, *radius).into_pyobject(py)?, none),
            Geometry::Ellipsoid { pose, semi_axes } => {
                ((point_of(pose), *semi_axes).into_pyobject(py)?, turned(pose)?.unwrap_or(none))
            }
            Geometry::Ellipse { center, semi_axes, angle } => {
                ((*center, *semi_axes).into_pyobject(py)?, [("angle", *angle)].into_py_dict(py)?)
            }
            Geometry::Cylinder { center, axis, radius, length } => {
                ((*center, *axis, *radius, *length).into_pyobject(py)?, none)
            }
            Geometry::HalfSpace { normal, offset } => ((*normal, *offset).into_pyobject(py)?, none),
            Geometry::ConvexMesh(hull) => ((hull.points().to_vec(),).into_pyobject(py)?, none),
            Geometry::Mesh(mesh) => ((points(py, mesh.vertices())?, faces(py, mesh.faces())?).into_pyobject(py)?, none),
            Geometry::PointCloud(cloud) => ((points(py, cloud.points())?, cloud.radius()).into_pyobject(py)?, none),
            Geometry::Grid(grid) => ((grid.origin(), grid.voxel(), occupied(py, grid)?).into_pyobject(py)?, none),
        })
    }
}

/// Longer lists are not written out.
const MOST_ENTRIES: usize = 100;

/// Formats a list in Python syntax if it is short, else as its length.
fn list_text<T: std::fmt::Debug>(list: &[T], entries: &str) -> String {
    if list.len() > MOST_ENTRIES { format!("<{} {entries}>", list.len()) } else { format!("{list:?}") }
}

/// Formats occupied voxels as nested lists in Python syntax if they are few, else as their number.
fn voxels_text(grid: &Grid) -> String {
    let [x, y, z] = grid.counts();
    if grid.occupied().len() > MOST_ENTRIES {
        return format!("<{x} x {y} x {z} voxels>");
    }
    let word = |occupied: &bool| if *occupied { "True" } else { "False" };
    let row = |voxels: &[bool]| format!("[{}]", voxels.iter().map(word).collect::<Vec<_>>().join(", "));
    let slab = |voxels: &[bool]| format!("[{}]", voxels.chunks(z).map(row).collect::<Vec<_>>().join(", "));
    format!("[{}]", grid.occupied().chunks(y * z).map(slab).collect::<Vec<_>>().join(", "))
}

fn point_of(pose: &Pose) -> [f64; 3] {
    pose.translation.vector.into()
}

/// Returns the rows of the rotation; None without one.
fn rotation_rows(pose: &Pose) -> Option<[[f64; 3]; 3]> {
    let rotation = pose.rotation.matrix();
    let turned = *rotation != Matrix3::identity();
    turned.then(|| rotation.transpose().into())
}

fn rotation_text(pose: &Pose) -> String {
    rotation_rows(pose).map_or(String::new(), |rows| format!(", rotation={rows:?}"))
}
