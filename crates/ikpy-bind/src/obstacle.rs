//! `bik.obstacles`.

use ikcore::math::Pose;
use ikcore::nalgebra::Matrix3;
use ikcore::obstacle::{Obstacle, Scene, Shape};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};

use crate::convert::{Array, Rows, array, matrix3, point, row, rows, shape_text, summary, table, vector};
use crate::error::{invalid, raise};
use crate::robot::PyRobot;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyObstacle>()?;
    module.add_class::<PySphere>()?;
    module.add_class::<PyBox>()?;
    module.add_class::<PyCapsule>()?;
    module.add_class::<PyEllipsoid>()?;
    module.add_class::<PyEllipse>()?;
    module.add_class::<PyConvexMesh>()?;
    module.add_function(wrap_pyfunction!(clearance, module)?)
}

/// A convex body that stands still in the frame of the robot's base: what all obstacles have in common.
#[pyclass(name = "Obstacle", module = "beetle_ik.obstacles", frozen, eq, subclass)]
#[derive(Clone, PartialEq)]
pub struct PyObstacle {
    core: Obstacle,
}

/// Positional arguments, then named ones.
type Arguments<'py> = (Bound<'py, PyTuple>, Bound<'py, PyDict>);

#[pymethods]
impl PyObstacle {
    /// Corners (t, 3, 3) (m) of triangles that show its surface, for drawing; those of round shapes touch it with their
    /// corners.
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

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Arguments<'py>> {
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

/// The rotation row after row; None where there is none.
fn rotation_rows(pose: &Pose) -> Option<[[f64; 3]; 3]> {
    let rotation = pose.rotation.matrix();
    let turned = *rotation != Matrix3::identity();
    turned.then(|| rotation.transpose().into())
}

fn rotation_text(pose: &Pose) -> String {
    rotation_rows(pose).map_or(String::new(), |rows| format!(", rotation={rows:?}"))
}

fn read_rotation(rotation: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Matrix3<f64>>> {
    rotation.map(|rotation| matrix3("rotation", rotation)).transpose()
}

fn pair(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    let numbers = vector(what, value)?;
    let got = numbers.len();
    <[f64; 2]>::try_from(numbers).map_err(|_| invalid(format!("{what}: expected shape (2,), got ({got},)")))
}

/// An obstacle with what its class alone has, as given.
fn made<C>(core: ikcore::Result<Obstacle>, own: C) -> PyResult<PyClassInitializer<C>>
where
    C: PyClass<BaseType = PyObstacle>,
{
    Ok(PyClassInitializer::from(PyObstacle { core: core.map_err(raise)? }).add_subclass(own))
}

/// A ball: centre (3,) and radius (m).
#[pyclass(name = "Sphere", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PySphere {
    center: [f64; 3],
    radius: f64,
}

#[pymethods]
impl PySphere {
    #[new]
    fn new(center: &Bound<'_, PyAny>, radius: f64) -> PyResult<PyClassInitializer<Self>> {
        let center = point("center", center)?;
        made(Obstacle::sphere(center, radius), Self { center, radius })
    }

    /// Centre (3,) (m).
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.center.to_vec())
    }

    /// Radius (m).
    #[getter]
    fn radius(&self) -> f64 {
        self.radius
    }
}

/// A box: centre (3,), edges (3,) along its own axes (m), and how those are turned (3, 3).
#[pyclass(name = "Box", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyBox {
    center: [f64; 3],
    size: [f64; 3],
    rotation: Matrix3<f64>,
}

#[pymethods]
impl PyBox {
    #[new]
    #[pyo3(signature = (center, size, rotation=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        size: &Bound<'_, PyAny>,
        rotation: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (center, size) = (point("center", center)?, point("size", size)?);
        let rotation = read_rotation(rotation)?;
        let own = Self { center, size, rotation: rotation.unwrap_or_else(Matrix3::identity) };
        made(Obstacle::cuboid(center, size, rotation), own)
    }

    /// Centre (3,) (m).
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.center.to_vec())
    }

    /// Edges (3,) (m).
    #[getter]
    fn size<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.size.to_vec())
    }

    /// Its axes as columns (3, 3).
    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        table(py, self.rotation.transpose().as_slice().to_vec(), &[3, 3])
    }
}

/// All points within `radius` (m) of the segment from a (3,) to b (3,).
#[pyclass(name = "Capsule", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyCapsule {
    a: [f64; 3],
    b: [f64; 3],
    radius: f64,
}

#[pymethods]
impl PyCapsule {
    #[new]
    fn new(a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>, radius: f64) -> PyResult<PyClassInitializer<Self>> {
        let (a, b) = (point("a", a)?, point("b", b)?);
        made(Obstacle::capsule(a, b, radius), Self { a, b, radius })
    }

    /// One end of its axis (3,) (m).
    #[getter]
    fn a<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.a.to_vec())
    }

    /// The other end (3,) (m).
    #[getter]
    fn b<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.b.to_vec())
    }

    /// Radius (m).
    #[getter]
    fn radius(&self) -> f64 {
        self.radius
    }
}

/// An ellipsoid: centre (3,), semi-axes (3,) (m), and how they are turned (3, 3).
#[pyclass(name = "Ellipsoid", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyEllipsoid {
    center: [f64; 3],
    semi_axes: [f64; 3],
    rotation: Matrix3<f64>,
}

#[pymethods]
impl PyEllipsoid {
    #[new]
    #[pyo3(signature = (center, semi_axes, rotation=None))]
    fn new(
        center: &Bound<'_, PyAny>,
        semi_axes: &Bound<'_, PyAny>,
        rotation: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (center, semi_axes) = (point("center", center)?, point("semi_axes", semi_axes)?);
        let rotation = read_rotation(rotation)?;
        let own = Self { center, semi_axes, rotation: rotation.unwrap_or_else(Matrix3::identity) };
        made(Obstacle::ellipsoid(center, semi_axes, rotation), own)
    }

    /// Centre (3,) (m).
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.center.to_vec())
    }

    /// Semi-axes (3,) (m).
    #[getter]
    fn semi_axes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.semi_axes.to_vec())
    }

    /// Its axes as columns (3, 3).
    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        table(py, self.rotation.transpose().as_slice().to_vec(), &[3, 3])
    }
}

/// An ellipse in the plane z = 0, for planar arms: centre (2,), semi-axes (2,) (m), angle of the first one (rad).
#[pyclass(name = "Ellipse", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyEllipse {
    center: [f64; 2],
    semi_axes: [f64; 2],
    angle: f64,
}

#[pymethods]
impl PyEllipse {
    #[new]
    #[pyo3(signature = (center, semi_axes, angle=0.0))]
    fn new(center: &Bound<'_, PyAny>, semi_axes: &Bound<'_, PyAny>, angle: f64) -> PyResult<PyClassInitializer<Self>> {
        let (center, semi_axes) = (pair("center", center)?, pair("semi_axes", semi_axes)?);
        made(Obstacle::ellipse(center, semi_axes, angle), Self { center, semi_axes, angle })
    }

    /// Centre (2,) (m).
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.center.to_vec())
    }

    /// Semi-axes (2,) (m).
    #[getter]
    fn semi_axes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.semi_axes.to_vec())
    }

    /// Angle of the first semi-axis (rad).
    #[getter]
    fn angle(&self) -> f64 {
        self.angle
    }
}

/// The smallest convex body that holds points (k, 3) (m), at least four that do not lie in a plane.
#[pyclass(name = "ConvexMesh", module = "beetle_ik.obstacles", frozen, extends = PyObstacle)]
pub struct PyConvexMesh {
    points: Vec<[f64; 3]>,
}

#[pymethods]
impl PyConvexMesh {
    #[new]
    fn new(points: &Bound<'_, PyAny>) -> PyResult<PyClassInitializer<Self>> {
        let numbers = array("points", points)?;
        match numbers.shape() {
            [_, 3] => {
                let points = numbers.as_slice()?.as_chunks().0.to_vec();
                made(Obstacle::convex_mesh(&points), Self { points })
            }
            shape => Err(invalid(format!("points: expected shape (k, 3), got {}", shape_text(shape)))),
        }
    }

    /// The points as given (k, 3) (m).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        table(py, self.points.as_flattened().to_vec(), &[self.points.len(), 3])
    }
}

/// Obstacles as a caller gave them.
pub struct Given {
    /// For the core.
    pub core: Vec<Obstacle>,
    /// For results that carry them along.
    pub tuple: Py<PyTuple>,
}

impl Given {
    /// Any sequence of obstacles; None is none.
    pub fn read(py: Python<'_>, value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let wrong = |place: &str, got: &Bound<'_, PyAny>| {
            let got = summary(got);
            invalid(format!("{place} must be made by bik.obstacles, such as Sphere or Box, got {got}"))
        };
        let items: Vec<Bound<'_, PyAny>> = match value {
            None => vec![],
            Some(value) => value.try_iter().map_err(|_| wrong("obstacles", value))?.collect::<PyResult<_>>()?,
        };
        let core = items.iter().enumerate().map(|(i, item)| match item.cast::<PyObstacle>() {
            Ok(obstacle) => Ok(obstacle.get().core.clone()),
            Err(_) => Err(wrong(&format!("obstacle {i}"), item)),
        });
        Ok(Self { core: core.collect::<PyResult<_>>()?, tuple: PyTuple::new(py, items)?.unbind() })
    }
}

/// Distance between `robot` and what it is nearest to, at q (n,) or (m, n): a number or (m,) (m). Negative by the depth
/// of the deepest overlap; inf where nothing can touch.
///
/// Args:
///     robot: an arm with capsules.
///     q: joint angles.
///     obstacles: in the frame of the robot's base. Links that no joint moves are not held against them.
///
/// Of the links' own capsules those are compared that have another one between them and do not touch with all joints in
/// the middle of their ranges.
///
/// Raises:
///     InvalidInputError: a robot without capsules, an obstacle of another kind.
#[pyfunction]
#[pyo3(signature = (robot, q, obstacles=None))]
pub fn clearance<'py>(
    py: Python<'py>,
    robot: &PyRobot,
    q: &Bound<'py, PyAny>,
    obstacles: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let obstacles = Given::read(py, obstacles)?.core;
    let scene = Scene::new(&robot.core, &obstacles).map_err(raise)?;
    match rows("joint angles", robot.core.name(), robot.core.dof(), q)? {
        Rows::One(q) => Ok(scene.clearance(q.as_slice()?).map_err(raise)?.into_pyobject(py)?.into_any()),
        Rows::Many(q, _) => {
            let (scene, q) = (&scene, q.as_slice()?);
            Ok(row(py, py.detach(|| scene.clearances(q)).map_err(raise)?).into_any())
        }
    }
}
