//! `Obstacle`, the base class of all shapes.

use ikcore::math::Pose;
use ikcore::nalgebra::Matrix3;
use ikcore::obstacle::{Obstacle, Shape};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::convert::{Array, table};
use crate::hash::content_hash;
use crate::options::NewArguments;

/// The base class of obstacles: a convex body, fixed in the frame of the robot's base.
#[pyclass(name = "Obstacle", module = "beetle_ik.obstacles", frozen, eq, subclass)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyObstacle {
    pub(super) core: Obstacle,
}

#[pymethods]
impl PyObstacle {
    /// Triangles of the surface (t, 3, 3) (m), for drawing. The corners of triangles lie on the surface.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let triangles = self.core.triangles();
        let count = triangles.len();
        table(py, triangles.as_flattened().as_flattened().to_vec(), &[count, 3, 3])
    }

    fn __repr__(&self) -> String {
        let arguments = match self.core.shape() {
            Shape::Sphere { center, radius } => format!("{center:?}, {radius:?}"),
            Shape::Box { pose, size } => {
                format!("{:?}, {size:?}{}", point_of(pose), rotation_text(pose))
            }
            Shape::Capsule { a, b, radius } => format!("{a:?}, {b:?}, {radius:?}"),
            Shape::Ellipsoid { pose, semi_axes } => {
                format!("{:?}, {semi_axes:?}{}", point_of(pose), rotation_text(pose))
            }
            Shape::Ellipse { center, semi_axes, angle } => format!("{center:?}, {semi_axes:?}, angle={angle:?}"),
            Shape::ConvexMesh(hull) => format!("{:?}", hull.points()),
        };
        format!("obstacles.{}({arguments})", self.core.name())
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let none = PyDict::new(py);
        let turned = |pose: &Pose| rotation_rows(pose).map(|rows| [("rotation", rows)].into_py_dict(py)).transpose();
        Ok(match self.core.shape() {
            Shape::Sphere { center, radius } => ((*center, *radius).into_pyobject(py)?, none),
            Shape::Box { pose, size } => ((point_of(pose), *size).into_pyobject(py)?, turned(pose)?.unwrap_or(none)),
            Shape::Capsule { a, b, radius } => ((*a, *b, *radius).into_pyobject(py)?, none),
            Shape::Ellipsoid { pose, semi_axes } => {
                ((point_of(pose), *semi_axes).into_pyobject(py)?, turned(pose)?.unwrap_or(none))
            }
            Shape::Ellipse { center, semi_axes, angle } => {
                ((*center, *semi_axes).into_pyobject(py)?, [("angle", *angle)].into_py_dict(py)?)
            }
            Shape::ConvexMesh(hull) => ((hull.points().to_vec(),).into_pyobject(py)?, none),
        })
    }
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
