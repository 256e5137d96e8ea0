//! The functions of `beetle_ik.paths`.

use ikcore::path::{Circle, Hypotrochoid, Path, Plane, Polyline, Rose, Samples};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use super::reference::{Curve, Orientation, PyPath};
use crate::convert::{array, count, point, rigid_matrices, shape_text, vector};
use crate::error::{invalid, raise};
use crate::monitor::long_call;

/// A direction in the plane of a curve.
pub struct Direction([f64; 3]);

impl<'py> FromPyObject<'_, 'py> for Direction {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        point("direction", &value).map(Self)
    }
}

fn plane(center: &Bound<'_, PyAny>, a: Direction, b: Direction) -> PyResult<Plane> {
    Plane::new(point("center", center)?, a.0, b.0).map_err(raise)
}

/// A circle around `center` (3,) (m), traversed once in `duration` (s), from the direction `a` towards `b`: eq. (14) of
/// Cheng et al. (2020). `a` and `b` (3,) are orthonormal vectors in its plane.
#[pyfunction]
#[pyo3(signature = (center, diameter, duration, *, a=Direction([1.0, 0.0, 0.0]), b=Direction([0.0, 1.0, 0.0])),
       text_signature = "(center, diameter, duration, *, a=(1, 0, 0), b=(0, 1, 0))")]
pub fn circle(center: &Bound<'_, PyAny>, diameter: f64, duration: f64, a: Direction, b: Direction) -> PyResult<PyPath> {
    Ok(Path::new(Circle::new(plane(center, a, b)?, diameter, duration).map_err(raise)?).into())
}

/// The letter M around `center` (3,), `width` along `a` and `height` along `b` (m). Its four segments take equal times
/// (Khan et al. 2022).
#[pyfunction]
#[pyo3(signature = (center, duration, *, width, height, a=Direction([0.0, 1.0, 0.0]), b=Direction([0.0, 0.0, 1.0])),
       text_signature = "(center, duration, *, width, height, a=(0, 1, 0), b=(0, 0, 1))")]
pub fn letter_m(
    center: &Bound<'_, PyAny>,
    duration: f64,
    width: f64,
    height: f64,
    a: Direction,
    b: Direction,
) -> PyResult<PyPath> {
    Ok(Path::new(Polyline::letter_m(&plane(center, a, b)?, width, height, duration).map_err(raise)?).into())
}

/// A hypotrochoid around `center` (3,): the path of a point at `distance` (m) from the centre of a circle that rolls inside
/// another. Eq. (20) of Khan et al. (2022), corrected. The ratio of the radii must be a ratio of small integers.
#[pyfunction]
#[pyo3(signature = (center, duration, *, outer_radius, inner_radius, distance, a=Direction([0.0, 1.0, 0.0]), b=Direction([0.0, 0.0, 1.0])),
       text_signature = "(center, duration, *, outer_radius, inner_radius, distance, a=(0, 1, 0), b=(0, 0, 1))")]
pub fn hypotrochoid(
    center: &Bound<'_, PyAny>,
    duration: f64,
    outer_radius: f64,
    inner_radius: f64,
    distance: f64,
    a: Direction,
    b: Direction,
) -> PyResult<PyPath> {
    let curve = Hypotrochoid::new(plane(center, a, b)?, outer_radius, inner_radius, distance, duration);
    Ok(Path::new(curve.map_err(raise)?).into())
}

/// A five-pointed star around `center` (3,), with its points at `radius` (m): five segments at constant speed, starting at
/// the point in direction `b`.
#[pyfunction]
#[pyo3(signature = (center, duration, *, radius, a=Direction([1.0, 0.0, 0.0]), b=Direction([0.0, 1.0, 0.0])),
       text_signature = "(center, duration, *, radius, a=(1, 0, 0), b=(0, 1, 0))")]
pub fn pentagram(
    center: &Bound<'_, PyAny>,
    duration: f64,
    radius: f64,
    a: Direction,
    b: Direction,
) -> PyResult<PyPath> {
    Ok(Path::new(Polyline::pentagram(&plane(center, a, b)?, radius, duration).map_err(raise)?).into())
}

/// A rose around `center` (3,): at angle u its radius is radius cos(k u) (m). Odd k gives k petals, even k gives 2 k.
#[pyfunction]
#[pyo3(signature = (center, duration, *, radius, k, a=Direction([1.0, 0.0, 0.0]), b=Direction([0.0, 1.0, 0.0])),
       text_signature = "(center, duration, *, radius, k, a=(1, 0, 0), b=(0, 1, 0))")]
pub fn rose(
    center: &Bound<'_, PyAny>,
    duration: f64,
    radius: f64,
    k: i128,
    a: Direction,
    b: Direction,
) -> PyResult<PyPath> {
    Ok(Path::new(Rose::new(plane(center, a, b)?, radius, count("k", k)?, duration).map_err(raise)?).into())
}

/// Straight segments through `points` (k, 3) (m) at constant speed, in `duration` (s).
#[pyfunction]
pub fn polyline(points: &Bound<'_, PyAny>, duration: f64) -> PyResult<PyPath> {
    Ok(Path::new(Polyline::new(&positions("points", points)?, duration).map_err(raise)?).into())
}

/// A path through samples: `time` (k,) (s) from 0, and positions (k, 3) (m) or poses (k, 4, 4). Positions are interpolated
/// linearly, rotations along the shortest rotation.
#[pyfunction]
pub fn from_samples(time: &Bound<'_, PyAny>, positions_or_poses: &Bound<'_, PyAny>) -> PyResult<PyPath> {
    let time = vector("time", time)?;
    let values = array("positions_or_poses", positions_or_poses)?;
    let py = positions_or_poses.py();
    let samples = match values.shape() {
        [_, 4, 4] => {
            let poses = rigid_matrices(values.as_slice()?)?;
            long_call(py, || Samples::from_poses(time, &poses))
        }
        _ => {
            let positions = positions("positions_or_poses", positions_or_poses)?;
            long_call(py, || Samples::from_positions(time, positions))
        }
    };
    Ok(Path::new(samples?).into())
}

/// A path given by `function(t)`, which returns a position (3,) (m) for t (s) in [0, duration]. Trackers sample it at the
/// times of their ticks before they run.
#[pyfunction]
pub fn from_function(function: &Bound<'_, PyAny>, duration: f64) -> PyResult<PyPath> {
    Ok(PyPath { curve: Curve::of_function(function, duration)?, orientation: Orientation::OfCurve })
}

fn positions(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 3]>> {
    let values = array(what, value)?;
    match values.shape() {
        [_, 3] => Ok(values.as_slice()?.as_chunks().0.to_vec()),
        [0] => Ok(vec![]),
        shape => Err(invalid(format!("{what}: expected shape (k, 3), got {}", shape_text(shape)))),
    }
}
