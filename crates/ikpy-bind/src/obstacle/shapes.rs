//! The shapes of obstacles, one class each.

use ikcore::shape::{Geometry, Shape};
use numpy::PyArray1;
use pyo3::prelude::*;

use super::arrays::{Coordinates, Rotation, read_points, read_rotation};
use super::body::{PyObstacle, made};
use super::touch::{Touch, read_touch};
use crate::convert::{Array, copied, entries, point, table};
use crate::monitor::on_a_thread;

/// A sphere: centre (3,) and radius (m).
#[pyclass(name = "Sphere", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PySphere {
    /// Centre (3,) (m).
    #[pyo3(get)]
    pub(super) center: Coordinates<3>,
    /// Radius (m).
    #[pyo3(get)]
    pub(super) radius: f64,
}

#[pymethods]
impl PySphere {
    #[new]
    #[pyo3(signature = (center, radius, *, touch=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        radius: f64,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let center = point("center", center)?;
        made(Shape::sphere(center, radius), touch, Self { center: Coordinates(center), radius })
    }
}

/// A box: centre (3,), edge lengths (3,) along its own axes (m), and the rotation (3, 3) of these axes.
#[pyclass(name = "Box", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyBox {
    /// Centre (3,) (m).
    #[pyo3(get)]
    pub(super) center: Coordinates<3>,
    /// Edge lengths (3,) (m).
    #[pyo3(get)]
    pub(super) size: Coordinates<3>,
    /// Rotation (3, 3); its columns are the axes of the shape.
    #[pyo3(get)]
    pub(super) rotation: Rotation,
}

#[pymethods]
impl PyBox {
    #[new]
    #[pyo3(signature = (center, size, rotation=None, *, touch=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        size: &Bound<'_, PyAny>,
        rotation: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (center, size) = (point("center", center)?, point("size", size)?);
        let rotation = read_rotation(rotation)?;
        let own = Self { center: Coordinates(center), size: Coordinates(size), rotation: Rotation::or_none(rotation) };
        made(Shape::cuboid(center, size, rotation), touch, own)
    }
}

/// A capsule: all points within `radius` (m) of the segment from a (3,) to b (3,).
#[pyclass(name = "Capsule", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyCapsule {
    /// First end of the axis (3,) (m).
    #[pyo3(get)]
    pub(super) a: Coordinates<3>,
    /// Second end of the axis (3,) (m).
    #[pyo3(get)]
    pub(super) b: Coordinates<3>,
    /// Radius (m).
    #[pyo3(get)]
    pub(super) radius: f64,
}

#[pymethods]
impl PyCapsule {
    #[new]
    #[pyo3(signature = (a, b, radius, *, touch=None))]
    fn new(
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        radius: f64,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (a, b) = (point("a", a)?, point("b", b)?);
        made(Shape::capsule(a, b, radius), touch, Self { a: Coordinates(a), b: Coordinates(b), radius })
    }
}

/// A cylinder with flat ends: centre (3,), axis (3,) of any length, radius and length (m).
#[pyclass(name = "Cylinder", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyCylinder {
    /// Centre (3,) (m).
    #[pyo3(get)]
    pub(super) center: Coordinates<3>,
    /// Radius (m).
    #[pyo3(get)]
    pub(super) radius: f64,
    /// Length along the axis (m).
    #[pyo3(get)]
    pub(super) length: f64,
}

#[pymethods]
impl PyCylinder {
    #[new]
    #[pyo3(signature = (center, axis, radius, length, *, touch=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        axis: &Bound<'_, PyAny>,
        radius: f64,
        length: f64,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (center, axis) = (point("center", center)?, point("axis", axis)?);
        let own = Self { center: Coordinates(center), radius, length };
        made(Shape::cylinder(center, axis, radius, length), touch, own)
    }

    /// Axis (3,), of unit length.
    #[getter]
    fn axis<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        match this.as_super().core.shape.geometry() {
            Geometry::Cylinder { axis, .. } => copied(py, axis),
            _ => copied(py, &[]),
        }
    }
}

/// All points x with normal . x <= offset, for a normal (3,) of unit length: `HalfSpace([0, 0, 1], 0.0)` is a floor. A
/// normal of another length is scaled; `offset` (m) is not.
#[pyclass(name = "HalfSpace", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyHalfSpace {
    /// Distance of the surface from the origin, along the normal (m).
    #[pyo3(get)]
    pub(super) offset: f64,
}

#[pymethods]
impl PyHalfSpace {
    #[new]
    #[pyo3(signature = (normal, offset, *, touch=None))]
    fn new(
        normal: &Bound<'_, PyAny>,
        offset: f64,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let normal = point("normal", normal)?;
        made(Shape::half_space(normal, offset), touch, Self { offset })
    }

    /// Outward normal (3,), of unit length.
    #[getter]
    fn normal<'py>(this: PyRef<'py, Self>, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        match this.as_super().core.shape.geometry() {
            Geometry::HalfSpace { normal, .. } => copied(py, normal),
            _ => copied(py, &[]),
        }
    }
}

/// An ellipsoid: centre (3,), lengths of the semi-axes (3,) (m), and their rotation (3, 3).
#[pyclass(name = "Ellipsoid", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyEllipsoid {
    /// Centre (3,) (m).
    #[pyo3(get)]
    pub(super) center: Coordinates<3>,
    /// Lengths of the semi-axes (3,) (m).
    #[pyo3(get)]
    pub(super) semi_axes: Coordinates<3>,
    /// Rotation (3, 3); its columns are the axes of the shape.
    #[pyo3(get)]
    pub(super) rotation: Rotation,
}

#[pymethods]
impl PyEllipsoid {
    #[new]
    #[pyo3(signature = (center, semi_axes, rotation=None, *, touch=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        semi_axes: &Bound<'_, PyAny>,
        rotation: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (center, semi_axes) = (point("center", center)?, point("semi_axes", semi_axes)?);
        let rotation = read_rotation(rotation)?;
        let own = Self {
            center: Coordinates(center),
            semi_axes: Coordinates(semi_axes),
            rotation: Rotation::or_none(rotation),
        };
        made(Shape::ellipsoid(center, semi_axes, rotation), touch, own)
    }
}

/// An ellipse in the plane z = 0, for planar arms: centre (2,), lengths of the semi-axes (2,) (m), angle of the first
/// one (rad).
#[pyclass(name = "Ellipse", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyEllipse {
    /// Centre (2,) (m).
    #[pyo3(get)]
    pub(super) center: Coordinates<2>,
    /// Lengths of the semi-axes (2,) (m).
    #[pyo3(get)]
    pub(super) semi_axes: Coordinates<2>,
    /// Angle of the first semi-axis (rad).
    #[pyo3(get)]
    pub(super) angle: f64,
}

#[pymethods]
impl PyEllipse {
    #[new]
    #[pyo3(signature = (center, semi_axes, angle=0.0, *, touch=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        semi_axes: &Bound<'_, PyAny>,
        angle: f64,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (center, semi_axes) = (entries("center", center)?, entries("semi_axes", semi_axes)?);
        let own = Self { center: Coordinates(center), semi_axes: Coordinates(semi_axes), angle };
        made(Shape::ellipse(center, semi_axes, angle), touch, own)
    }
}

/// The convex hull of points (k, 3) (m): at least four, not all in one plane.
#[pyclass(name = "ConvexMesh", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyConvexMesh {
    pub(super) points: Vec<[f64; 3]>,
}

#[pymethods]
impl PyConvexMesh {
    #[new]
    #[pyo3(signature = (points, *, touch=None))]
    fn new(
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
    ) -> PyResult<PyClassInitializer<Self>> {
        let points = read_points("points", points)?;
        let given = points.clone();
        let hull = on_a_thread(py, move || Shape::convex_mesh(&given));
        made(Ok(hull?), touch, Self { points })
    }

    /// The points as given (k, 3) (m).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        table(py, self.points.as_flattened().to_vec(), &[self.points.len(), 3])
    }
}
