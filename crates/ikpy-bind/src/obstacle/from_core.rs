//! Obstacles of the core as Python objects.

use ikcore::obstacle::Obstacle;
use ikcore::shape::Geometry;
use pyo3::prelude::*;

use super::arrays::{Coordinates, Rotation};
use super::body::PyObstacle;
use super::large::{PyGrid, PyMesh, PyPointCloud};
use super::shapes::{PyBox, PyCapsule, PyConvexMesh, PyCylinder, PyEllipse, PyEllipsoid, PyHalfSpace, PySphere};

/// Returns an obstacle as an instance of the class of its shape.
pub fn wrapped(py: Python<'_>, obstacle: &Obstacle) -> PyResult<Py<PyAny>> {
    let base = PyClassInitializer::from(PyObstacle { core: obstacle.clone() });
    let object = match obstacle.shape.geometry() {
        Geometry::Sphere { center, radius } => {
            let own = PySphere { center: Coordinates(*center), radius: *radius };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
        Geometry::Box { pose, size } => {
            let (center, rotation) = (pose.translation.vector.into(), *pose.rotation.matrix());
            let own = PyBox { center: Coordinates(center), size: Coordinates(*size), rotation: Rotation(rotation) };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
        Geometry::Capsule { a, b, radius } => {
            let own = PyCapsule { a: Coordinates(*a), b: Coordinates(*b), radius: *radius };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
        Geometry::Cylinder { center, radius, length, .. } => {
            let own = PyCylinder { center: Coordinates(*center), radius: *radius, length: *length };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
        Geometry::Ellipsoid { pose, semi_axes } => {
            let (center, rotation) = (pose.translation.vector.into(), Rotation(*pose.rotation.matrix()));
            let own = PyEllipsoid { center: Coordinates(center), semi_axes: Coordinates(*semi_axes), rotation };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
        Geometry::ConvexMesh(hull) => {
            let own = PyConvexMesh { points: hull.points().to_vec() };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
        Geometry::HalfSpace { offset, .. } => {
            Bound::new(py, base.add_subclass(PyHalfSpace { offset: *offset }))?.into_any()
        }
        Geometry::Ellipse { center, semi_axes, angle } => {
            let (center, semi_axes) = (Coordinates(*center), Coordinates(*semi_axes));
            Bound::new(py, base.add_subclass(PyEllipse { center, semi_axes, angle: *angle }))?.into_any()
        }
        Geometry::Mesh(_) => Bound::new(py, base.add_subclass(PyMesh))?.into_any(),
        Geometry::PointCloud(cloud) => {
            Bound::new(py, base.add_subclass(PyPointCloud { radius: cloud.radius(), removed: 0 }))?.into_any()
        }
        Geometry::Grid(grid) => {
            let own = PyGrid { origin: Coordinates(grid.origin()), voxel: grid.voxel(), removed: 0 };
            Bound::new(py, base.add_subclass(own))?.into_any()
        }
    };
    Ok(object.unbind())
}
