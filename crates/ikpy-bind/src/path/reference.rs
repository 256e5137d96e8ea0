//! `Path`: a curve and an orientation, each from the core or from a Python function.

use ikcore::math::pose::from_rotation_matrix;
use ikcore::nalgebra::Matrix3;
use ikcore::path::Path;
use ikcore::stored::{from_bytes, to_bytes};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use pyo3::{PyTraverseError, PyVisit};

use crate::convert::{Array, matrix3, own, point, row, shortened, summary, table, times};
use crate::error::{invalid, raise};
use crate::pickling::{self, Reduced};
use crate::signals::check_signals_at;
use crate::traversal::{Traversed, traversed};

/// A reference path of the tip: position, and optionally orientation, for each time in [0, duration]. Times outside are
/// clamped.
#[pyclass(name = "Path", module = "beetle_ik", frozen)]
pub struct PyPath {
    pub(super) curve: Curve,
    pub(super) orientation: Orientation,
}

traversed!(PyPath: curve, orientation);

/// The source of the orientation.
pub(super) enum Orientation {
    OfCurve,
    Constant(Matrix3<f64>),
    Function(Py<PyAny>),
}

pub(super) enum Curve {
    Core(Path),
    Function { function: Py<PyAny>, duration: f64 },
}

impl Traversed for Curve {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        match self {
            Self::Core(_) => Ok(()),
            Self::Function { function, .. } => function.traverse(visit),
        }
    }
}

impl Traversed for Orientation {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        match self {
            Self::OfCurve | Self::Constant(_) => Ok(()),
            Self::Function(function) => function.traverse(visit),
        }
    }
}

/// Half-width of the central difference for velocities of Python functions, as a fraction of the duration.
const DIFFERENCE: f64 = 1e-5;

#[pymethods]
impl PyPath {
    /// Duration (s).
    #[getter]
    pub fn duration(&self) -> f64 {
        match &self.curve {
            Curve::Core(path) => path.duration(),
            Curve::Function { duration, .. } => *duration,
        }
    }

    /// Returns the position (m): (3,) for a number t (s), (k, 3) for t (k,).
    fn position<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        each(py, t, [3], |t| Ok(self.position_at(py, t)?.to_vec()))
    }

    /// Returns the velocity (m/s): (3,) for a number t (s), (k, 3) for t (k,). Velocities of Python functions are
    /// central differences.
    fn velocity<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        each(py, t, [3], |t| Ok(self.velocity_at(py, t)?.to_vec()))
    }

    /// Returns the pose: (4, 4) for a number t (s), (k, 4, 4) for t (k,). The path must have an orientation.
    fn pose<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        each(py, t, [4, 4], |t| {
            let Some(rotation) = self.rotation_at(py, t)? else {
                return Err(invalid("this path has no orientation: use path.with_orientation(R)".into()));
            };
            Ok(ikcore::math::pose::rows(&ikcore::math::pose::from_parts(self.position_at(py, t)?, rotation)).to_vec())
        })
    }

    /// Returns the times (k,) (s) from 0 in steps of `dt`, and the positions (k, 3) (m): the samples that a tracker follows.
    fn sample<'py>(&self, py: Python<'py>, dt: f64) -> PyResult<(Bound<'py, PyArray1<f64>>, Array<'py>)> {
        let reference = self.reference(py, dt)?;
        let count = reference.len();
        let positions = (0..count).flat_map(|i| reference.position(i)).collect();
        let times = row(py, (0..count).map(|i| reference.time(i)).collect());
        Ok((own(times), own(table(py, positions, &[count, 3])?)))
    }

    /// Returns a copy with an orientation: a rotation matrix (3, 3), or a callable of t (s) that returns one.
    fn with_orientation(&self, py: Python<'_>, orientation: &Bound<'_, PyAny>) -> PyResult<Self> {
        let orientation = if orientation.is_callable() {
            Orientation::Function(orientation.clone().unbind())
        } else {
            let rotation = matrix3("orientation", orientation)?;
            let pose = from_rotation_matrix("orientation", rotation, [0.0; 3]).map_err(raise)?;
            Orientation::Constant(*pose.rotation.matrix())
        };
        Ok(Self { curve: self.curve.clone_ref(py), orientation })
    }

    fn __repr__(&self) -> String {
        let oriented = match (&self.orientation, &self.curve) {
            (Orientation::OfCurve, Curve::Core(path)) => path.rotation(0.0).is_some(),
            (Orientation::OfCurve, Curve::Function { .. }) => false,
            _ => true,
        };
        format!("<Path of {} s{}>", shortened(self.duration()), if oriented { ", with orientation" } else { "" })
    }

    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        self.state(py)?.eq(other.state(py)?)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        self.state(py)?.hash()
    }

    /// Pickles the path. Functions of a module can be pickled, lambdas cannot.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickling::restored_from::<Self>(py, self.state(py)?)
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (curve, duration, orientation))]
    fn _restore(curve: &Bound<'_, PyAny>, duration: f64, orientation: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let curve = match curve.cast::<PyBytes>() {
            Ok(bytes) => Curve::Core(Path::from_bytes(bytes.as_bytes()).map_err(raise)?),
            Err(_) => Curve::of_function(curve, duration)?,
        };
        let orientation = match orientation {
            None => Orientation::OfCurve,
            Some(value) => match value.cast::<PyBytes>() {
                Ok(bytes) => {
                    let rotation = from_bytes("orientation", bytes.as_bytes()).map_err(raise)?;
                    from_rotation_matrix("orientation", rotation, [0.0; 3]).map_err(raise)?;
                    Orientation::Constant(rotation)
                }
                Err(_) => Orientation::Function(value.clone().unbind()),
            },
        };
        Ok(Self { curve, orientation })
    }
}

impl From<Path> for PyPath {
    fn from(path: Path) -> Self {
        Self { curve: Curve::Core(path), orientation: Orientation::OfCurve }
    }
}

impl Curve {
    /// Makes a curve from a function of t.
    pub(super) fn of_function(function: &Bound<'_, PyAny>, duration: f64) -> PyResult<Self> {
        if !function.is_callable() {
            return Err(invalid(format!("function must be a callable of t, got {}", summary(function))));
        }
        if !(duration.is_finite() && duration > 0.0) {
            return Err(invalid(format!("duration must be positive and finite, got {duration}")));
        }
        Ok(Self::Function { function: function.clone().unbind(), duration })
    }

    fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Core(path) => Self::Core(path.clone()),
            Self::Function { function, duration } => {
                Self::Function { function: function.clone_ref(py), duration: *duration }
            }
        }
    }
}

/// Reads a `path` argument.
pub fn path_argument<'a, 'py>(value: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, PyPath>> {
    value.cast::<PyPath>().map_err(|_| {
        let got = summary(value);
        invalid(format!(
            "path must be a Path, got {got}; bik.paths.from_samples(time, positions_or_poses) makes one from rows"
        ))
    })
}

impl PyPath {
    /// Returns the state for pickling and hashing: (curve, duration, orientation), each as bytes or as the function given.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let curve = match &self.curve {
            Curve::Core(path) => pickling::bytes(py, path.to_bytes())?.into_any(),
            Curve::Function { function, .. } => function.bind(py).clone(),
        };
        let orientation = match &self.orientation {
            Orientation::OfCurve => None,
            Orientation::Constant(rotation) => Some(pickling::bytes(py, to_bytes("orientation", rotation))?.into_any()),
            Orientation::Function(function) => Some(function.bind(py).clone()),
        };
        (curve, self.duration(), orientation).into_pyobject(py)
    }

    pub(super) fn position_at(&self, py: Python<'_>, t: f64) -> PyResult<[f64; 3]> {
        match &self.curve {
            Curve::Core(path) => Ok(path.position(t)),
            Curve::Function { function, duration } => {
                let t = t.clamp(0.0, *duration);
                point(&format!("path at t = {t} s"), &function.bind(py).call1((t,))?)
            }
        }
    }

    pub(super) fn velocity_at(&self, py: Python<'_>, t: f64) -> PyResult<[f64; 3]> {
        match &self.curve {
            Curve::Core(path) => Ok(path.velocity(t)),
            Curve::Function { duration, .. } => {
                let half = DIFFERENCE * duration;
                let (from, to) = ((t - half).max(0.0), (t + half).min(*duration));
                let (before, after) = (self.position_at(py, from)?, self.position_at(py, to)?);
                Ok(std::array::from_fn(|k| (after[k] - before[k]) / (to - from)))
            }
        }
    }

    pub(super) fn rotation_at(&self, py: Python<'_>, t: f64) -> PyResult<Option<Matrix3<f64>>> {
        match (&self.orientation, &self.curve) {
            (Orientation::Constant(rotation), _) => Ok(Some(*rotation)),
            (Orientation::Function(function), _) => {
                let t = t.clamp(0.0, self.duration());
                matrix3(&format!("orientation at t = {t} s"), &function.bind(py).call1((t,))?).map(Some)
            }
            (Orientation::OfCurve, Curve::Core(path)) => Ok(path.rotation(t)),
            (Orientation::OfCurve, Curve::Function { .. }) => Ok(None),
        }
    }
}

/// Returns `value(t)` for a number t, stacked for t (k,).
fn each<'py, const D: usize>(
    py: Python<'py>,
    t: &Bound<'py, PyAny>,
    shape: [usize; D],
    value: impl Fn(f64) -> PyResult<Vec<f64>>,
) -> PyResult<Array<'py>> {
    let (times, single) = times(t)?;
    let mut values = vec![];
    for (i, t) in times.iter().enumerate() {
        check_signals_at(py, i)?;
        values.extend(value(*t)?);
    }
    let mut full = if single { vec![] } else { vec![times.len()] };
    full.extend(shape);
    table(py, values, &full).map(own)
}
