//! `Obstacle`, the base class of all shapes.

use ikcore::math::Pose;
use ikcore::nalgebra::Matrix3;
use ikcore::obstacle::Obstacle;
use ikcore::shape::{Geometry, Grid, Shape};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::arrays::{faces, occupied, points};
use super::touch::Touch;
use crate::convert::{Array, summary, table};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::NewArguments;

/// The base class of obstacles: a shape, fixed in the frame of the robot's base.
///
/// Each shape takes `touch=`, names of links that need not keep clear of it. A floor under the robot is
/// `HalfSpace((0, 0, 1), 0.0, touch=["panda_link0"])`.
#[pyclass(name = "Obstacle", module = "beetle_ik.obstacles", frozen, eq, subclass)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyObstacle {
    pub core: Obstacle,
}

/// Makes an instance of an obstacle's class, with its own fields.
pub(super) fn made<C>(core: ikcore::Result<Shape>, touch: Touch, own: C) -> PyResult<PyClassInitializer<C>>
where
    C: PyClass<BaseType = PyObstacle>,
{
    let core = Obstacle::new(core.map_err(raise)?, touch.unwrap_or_default());
    Ok(PyClassInitializer::from(PyObstacle { core }).add_subclass(own))
}

#[pymethods]
impl PyObstacle {
    /// Triangles of the surface (t, 3, 3) (m), for drawing. Their corners lie on the surface. A half-space is drawn as
    /// a square of 4 m, a point cloud as octahedra about at most 2,000 of its points.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let triangles = self.core.shape.triangles();
        let count = triangles.len();
        table(py, triangles.as_flattened().as_flattened().to_vec(), &[count, 3, 3])
    }

    /// Sorted names of the links that may touch the shape. They remain allowed when it is attached to a robot
    /// (`robot.with_attached`).
    #[getter]
    fn touch<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.core.touch())
    }

    fn __repr__(&self) -> String {
        let arguments = match self.core.shape.geometry() {
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
            Geometry::ConvexMesh(hull) => list_text(hull.points(), "points"),
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
        let touch = match self.core.touch() {
            [] => String::new(),
            links => format!(", touch={links:?}"),
        };
        format!("obstacles.{}({arguments}{touch})", self.core.shape.name())
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let named = PyDict::new(py);
        if !self.core.touch().is_empty() {
            named.set_item("touch", self.core.touch())?;
        }
        let turned = |pose: &Pose| rotation_rows(pose).map_or(Ok(()), |rows| named.set_item("rotation", rows));
        let arguments = match self.core.shape.geometry() {
            Geometry::Sphere { center, radius } => (*center, *radius).into_pyobject(py)?,
            Geometry::Box { pose, size } => {
                turned(pose)?;
                (point_of(pose), *size).into_pyobject(py)?
            }
            Geometry::Capsule { a, b, radius } => (*a, *b, *radius).into_pyobject(py)?,
            Geometry::Ellipsoid { pose, semi_axes } => {
                turned(pose)?;
                (point_of(pose), *semi_axes).into_pyobject(py)?
            }
            Geometry::Ellipse { center, semi_axes, angle } => {
                named.set_item("angle", angle)?;
                (*center, *semi_axes).into_pyobject(py)?
            }
            Geometry::Cylinder { center, axis, radius, length } => {
                (*center, *axis, *radius, *length).into_pyobject(py)?
            }
            Geometry::HalfSpace { normal, offset } => (*normal, *offset).into_pyobject(py)?,
            Geometry::ConvexMesh(hull) => (hull.points().to_vec(),).into_pyobject(py)?,
            Geometry::Mesh(mesh) => (points(py, mesh.vertices())?, faces(py, mesh.faces())?).into_pyobject(py)?,
            Geometry::PointCloud(cloud) => (points(py, cloud.points())?, cloud.radius()).into_pyobject(py)?,
            Geometry::Grid(grid) => (grid.origin(), grid.voxel(), occupied(py, grid)?).into_pyobject(py)?,
        };
        Ok((arguments, named))
    }
}

/// Longest list that `repr` writes out.
const MOST_ENTRIES: usize = 8;

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
    // A restored grid may have sides of no voxels.
    let slab = |voxels: &[bool]| format!("[{}]", voxels.chunks(z.max(1)).map(row).collect::<Vec<_>>().join(", "));
    format!("[{}]", grid.occupied().chunks((y * z).max(1)).map(slab).collect::<Vec<_>>().join(", "))
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

/// Returns the error for a value that is no obstacle; `place` names where it was given.
pub(super) fn not_made_here(place: &str, got: &Bound<'_, PyAny>) -> PyErr {
    let got = summary(got);
    invalid(format!("{place} must be made by bik.obstacles, such as Sphere or Box, got {got}"))
}
