//! Python values to Rust and back: the only file that knows how numpy lays out memory.

use std::ops::Deref;

use ikcore::math::{Pose, pose};
use ikcore::nalgebra::{Matrix3, Matrix4};
use numpy::npyffi::NPY_ARRAY_WRITEABLE;
use numpy::{
    AsSliceError, Element, IntoPyArray, PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyException;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBytes, PyList, PyString, PyTuple, PyType};

use crate::error::{invalid, raise};

/// A float64 array of any shape, as results hold it.
pub type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// The numbers of an argument, in C order.
///
/// numpy's `readonly()` would register every one in a table of borrows, which costs as much as a step of a solver and guards
/// against mutable borrows alone: there are none here.
pub struct Numbers<'py>(Array<'py>);

impl Numbers<'_> {
    /// Row after row.
    pub fn as_slice(&self) -> Result<&[f64], AsSliceError> {
        // SAFETY: nothing in this library writes into an argument. That no other thread does, while a long call has let go of
        // the interpreter, is the caller's part; numpy's table would not stop it either.
        unsafe { self.0.as_slice() }
    }
}

impl<'py> Deref for Numbers<'py> {
    type Target = Array<'py>;

    fn deref(&self) -> &Array<'py> {
        &self.0
    }
}

/// Any array-like as float64 in C order; not copied where it already is one. `what` names it in errors.
pub fn array<'py>(what: &str, value: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
    if let Ok(array) = value.cast::<PyArrayDyn<f64>>()
        && array.is_c_contiguous()
    {
        return Ok(Numbers(array.clone()));
    }
    let no_numbers = || invalid(format!("{what} must be an array of numbers, got {}", summary(value)));
    if is_misread(value)? {
        return Err(no_numbers());
    }
    let converted = float64(value).or_else(|error| match matrices(value)? {
        Some(matrices) => float64(&matrices),
        None => Err(error),
    });
    match converted {
        Ok(array) => Ok(Numbers(array.cast_into()?)),
        // A Ctrl-C that falls into the conversion is not the value's fault.
        Err(error) if error.is_instance_of::<PyException>(value.py()) => Err(no_numbers()),
        Err(interrupt) => Err(interrupt),
    }
}

/// What numpy would turn into other numbers than were meant: None into NaN, a text into what it spells, complex numbers
/// into their real parts, dates into seconds.
fn is_misread(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    if value.is_none() || value.is_instance_of::<PyString>() || value.is_instance_of::<PyBytes>() {
        return Ok(true);
    }
    let py = value.py();
    let Some(kind) = value.getattr_opt(intern!(py, "dtype"))?.map(|dtype| dtype.getattr_opt(intern!(py, "kind")))
    else {
        return Ok(false);
    };
    Ok(kind?.is_some_and(|kind| kind.extract::<char>().is_ok_and(|kind| "cmMSUV".contains(kind))))
}

/// What numpy makes of the value.
fn float64<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let options = [("dtype", "float64"), ("order", "C")].into_py_dict(py)?;
    py.import(intern!(py, "numpy"))?.call_method(intern!(py, "asarray"), (value,), Some(&options))
}

/// The matrices of another library's poses and rotations, one or several in a list; None for anything else.
fn matrices<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let each = value.try_iter()?.map(|item| matrix(&item?)).collect::<PyResult<Option<Vec<_>>>>()?;
        return each.map(|each| Ok(PyList::new(value.py(), each)?.into_any())).transpose();
    }
    matrix(value)
}

/// The matrix of an object that is known by what it offers: `homogeneous` (Pinocchio's SE3) or `as_matrix()` (scipy's
/// RigidTransform and Rotation).
fn matrix<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let py = value.py();
    if let Some(matrix) = value.getattr_opt(intern!(py, "homogeneous"))? {
        return Ok(Some(matrix));
    }
    value.getattr_opt(intern!(py, "as_matrix"))?.map(|matrix| matrix.call0()).transpose()
}

/// A count or a seed. Taken as i128, because the overflow error of a narrower type would not say what was wrong.
pub fn count<T: TryFrom<i128>>(what: &str, value: i128) -> PyResult<T> {
    let bound = || if value < 0 { "zero or more".into() } else { format!("below 2^{}", 8 * size_of::<T>()) };
    T::try_from(value).map_err(|_| invalid(format!("{what} must be {}, got {value}", bound())))
}

/// [`count`] where one was given.
pub fn optional_count<T: TryFrom<i128>>(what: &str, value: Option<i128>) -> PyResult<Option<T>> {
    value.map(|value| count(what, value)).transpose()
}

/// So many of a thing, in words.
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// The repr of a value, cut to a readable length. A class of this library stands where a value of it was meant.
pub fn summary(value: &Bound<'_, PyAny>) -> String {
    if let Ok(class) = value.cast::<PyType>()
        && class.module().is_ok_and(|module| module.to_string_lossy().starts_with("beetle_ik"))
        && let Ok(name) = class.name()
    {
        return format!("the class {name} itself: did you mean {name}()?");
    }
    let repr = value.repr().map_or_else(|_| "an object without a repr".into(), |text| text.to_string());
    if repr.chars().count() > 60 { repr.chars().take(57).chain("...".chars()).collect() } else { repr }
}

/// A shape as Python writes it.
pub fn shape_text(shape: &[usize]) -> String {
    match shape {
        [n] => format!("({n},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// The numbers of an array-like of one dimension.
pub fn vector(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = array(what, value)?;
    match array.shape() {
        [_] => Ok(array.as_slice()?.to_vec()),
        shape => Err(invalid(format!("{what}: expected one dimension, got shape {}", shape_text(shape)))),
    }
}

/// A number, or the numbers of an array-like of one dimension; whether it was a number.
pub fn scalar_or_vector(what: &str, value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let array = array(what, value)?;
    match array.shape() {
        [] | [_] => Ok((array.as_slice()?.to_vec(), array.shape().is_empty())),
        shape => Err(invalid(format!("{what}: expected a number or one dimension, got shape {}", shape_text(shape)))),
    }
}

/// Times (s) to look at, a number or one dimension; whether it was a number. Infinite ones are clamped later.
pub fn times(value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let (times, single) = scalar_or_vector("t", value)?;
    match times.iter().position(|t| t.is_nan()) {
        None => Ok((times, single)),
        Some(i) => Err(invalid(format!("t must be a time, but entry {i} is NaN"))),
    }
}

/// The N numbers of an array-like of one dimension.
pub fn entries<const N: usize>(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let array = array(what, value)?;
    match <[f64; N]>::try_from(array.as_slice()?) {
        Ok(entries) if array.shape().len() == 1 => Ok(entries),
        _ => Err(invalid(format!("{what}: expected shape ({N},), got {}", shape_text(array.shape())))),
    }
}

/// Three numbers.
pub fn point(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    entries(what, value)
}

/// Two corners of a box, one row each.
pub fn corners(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 2]> {
    let array = array(what, value)?;
    match (array.shape(), array.as_slice()?) {
        ([2, 3], [a, b, c, d, e, f]) => Ok([[*a, *b, *c], [*d, *e, *f]]),
        (shape, _) => Err(invalid(format!("{what}: expected shape (2, 3), got {}", shape_text(shape)))),
    }
}

/// A rigid transform from a 4x4 matrix.
pub fn rigid(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Pose> {
    let array = array(what, value)?;
    match array.shape() {
        [4, 4] => rigid_rows(what, array.as_slice()?),
        shape => Err(invalid(format!("{what}: expected shape (4, 4), got {}", shape_text(shape)))),
    }
}

/// A rigid transform from 16 numbers, row after row.
pub fn rigid_rows(what: &str, rows: &[f64]) -> PyResult<Pose> {
    pose::from_matrix(what, &Matrix4::from_row_slice(rows)).map_err(raise)
}

/// The rigid transforms of a pile of 4x4 matrices.
pub fn rigid_matrices(numbers: &[f64]) -> PyResult<Vec<Pose>> {
    let matrices = numbers.chunks_exact(16).enumerate();
    matrices.map(|(i, rows)| rigid_rows(&format!("pose {i}"), rows)).collect()
}

/// A 3x3 matrix.
pub fn matrix3(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Matrix3<f64>> {
    let array = array(what, value)?;
    match array.shape() {
        [3, 3] => Ok(Matrix3::from_row_slice(array.as_slice()?)),
        shape => Err(invalid(format!("{what}: expected shape (3, 3), got {}", shape_text(shape)))),
    }
}

/// Numbers in C order, moved into a read-only array of this shape.
pub fn table<'py, T: Element>(py: Python<'py>, values: Vec<T>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    Ok(read_only(values.into_pyarray(py).reshape(shape)?))
}

/// A read-only vector that takes the buffer over.
pub fn row<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    read_only(values.into_pyarray(py))
}

/// A read-only vector of these few numbers: cheaper than handing a buffer over.
pub fn copied<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, PyArray1<f64>> {
    read_only(PyArray1::from_slice(py, values))
}

/// A read-only 4x4 matrix.
pub fn pose_array<'py>(py: Python<'py>, pose: &Pose) -> PyResult<Bound<'py, PyArray2<f64>>> {
    Ok(read_only(PyArray1::from_slice(py, &pose::rows(pose)).reshape([4, 4])?))
}

fn read_only<T: Element, D: numpy::ndarray::Dimension>(array: Bound<'_, PyArray<T, D>>) -> Bound<'_, PyArray<T, D>> {
    // SAFETY: the array was made here and nobody else has seen it.
    unsafe { (*array.as_array_ptr()).fields.flags &= !NPY_ARRAY_WRITEABLE };
    array
}

/// The rows (m, n) of a batch, or the single row (n,): the numbers and, for a batch, m. `n` is checked by the core for
/// a single row, and here for a batch.
pub enum Rows<'py> {
    /// One row.
    One(Numbers<'py>),
    /// m rows.
    Many(Numbers<'py>, usize),
}

/// Reads (n,) or (m, n); `owner` is whose joints these are.
pub fn rows<'py>(what: &str, owner: &str, n: usize, value: &Bound<'py, PyAny>) -> PyResult<Rows<'py>> {
    let array = array(what, value)?;
    match array.shape() {
        [_] => Ok(Rows::One(array)),
        [m, columns] if *columns == n => {
            let m = *m;
            Ok(Rows::Many(array, m))
        }
        shape => Err(invalid(format!(
            "{what} of robot '{owner}': expected shape ({n},) or (m, {n}), got {}",
            shape_text(shape)
        ))),
    }
}
