//! Numbers of obstacles as arrays, read and returned.

use std::convert::Infallible;

use ikcore::nalgebra::Matrix3;
use ikcore::shape::Grid;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;

use crate::convert::{Array, array, copied, matrix3, shape_text, summary, table};
use crate::error::invalid;
use crate::signals::check_signals_at;

/// A vector stored by a class; Python gets a read-only array.
#[derive(Clone, Copy)]
pub(super) struct Coordinates<const N: usize>(pub [f64; N]);

impl<'py, const N: usize> IntoPyObject<'py> for Coordinates<N> {
    type Target = PyArray1<f64>;
    type Output = Bound<'py, Self::Target>;
    type Error = Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Infallible> {
        Ok(copied(py, &self.0))
    }
}

/// A rotation stored by a class; Python gets a read-only matrix (3, 3).
#[derive(Clone, Copy)]
pub(super) struct Rotation(pub Matrix3<f64>);

impl Rotation {
    /// Returns this rotation, or the identity if none was given.
    pub fn or_none(given: Option<Matrix3<f64>>) -> Self {
        Self(given.unwrap_or_else(Matrix3::identity))
    }
}

impl<'py> IntoPyObject<'py> for Rotation {
    type Target = PyArrayDyn<f64>;
    type Output = Bound<'py, Self::Target>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        table(py, self.0.transpose().as_slice().to_vec(), &[3, 3])
    }
}

pub(super) fn read_rotation(rotation: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Matrix3<f64>>> {
    rotation.map(|rotation| matrix3("rotation", rotation)).transpose()
}

/// Reads points (k, 3).
pub(super) fn read_points(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<[f64; 3]>> {
    let numbers = array(what, value)?;
    match numbers.shape() {
        [_, 3] => Ok(numbers.as_slice()?.as_chunks().0.to_vec()),
        shape => Err(invalid(format!("{what}: expected shape (k, 3), got {}", shape_text(shape)))),
    }
}

/// Reads triangles (t, 3): indices of vertices.
pub(super) fn read_faces(value: &Bound<'_, PyAny>) -> PyResult<Vec<[u32; 3]>> {
    let numbers = array("faces", value)?;
    let [_, 3] = numbers.shape() else {
        return Err(invalid(format!("faces: expected shape (t, 3), got {}", shape_text(numbers.shape()))));
    };
    let index = |(i, number): (usize, &f64)| {
        check_signals_at(value.py(), i)?;
        let whole = number.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(number);
        let wrong = || invalid(format!("face {}: expected indices of vertices, from 0, got {number}", i / 3));
        if whole { Ok(*number as u32) } else { Err(wrong()) }
    };
    let indices: Vec<u32> = numbers.as_slice()?.iter().enumerate().map(index).collect::<PyResult<_>>()?;
    Ok(indices.as_chunks().0.to_vec())
}

/// Reads occupied voxels: a boolean array (nx, ny, nz).
pub(super) fn read_occupied(value: &Bound<'_, PyAny>) -> PyResult<([usize; 3], Vec<bool>)> {
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
