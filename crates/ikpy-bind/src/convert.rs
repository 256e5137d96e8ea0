//! Conversion between Python and Rust values. No other file depends on numpy's memory layout.

#![allow(unsafe_code, reason = "memory of numpy arrays")]

use std::ops::Deref;
use std::path::PathBuf;

use ikcore::math::pose::Drift;
use ikcore::math::{Pose, pose};
use ikcore::nalgebra::{Matrix3, Matrix4};
use numpy::ndarray::{Dimension, IntoDimension};
use numpy::npyffi::{NPY_ARRAY_ALIGNED, NPY_ARRAY_WRITEABLE};
use numpy::{
    AsSliceError, Element, IntoPyArray, PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyException, PyUnicodeError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBytes, PyList, PyString, PyTuple, PyType};

use crate::error::{invalid, raise};
use crate::python_calls;
use crate::signals::check_signals_at;

/// A float64 array of any shape.
pub type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// The numbers of an argument, in C order.
///
/// Avoids numpy's `readonly()`, which registers each array in a table of borrows. That costs as much as a step of a
/// solver, and guards only against mutable borrows, which this library never makes.
pub struct Numbers<'py>(Array<'py>);

impl Numbers<'_> {
    /// The numbers, row by row.
    pub fn as_slice(&self) -> Result<&[f64], AsSliceError> {
        // SAFETY: this library never writes into an argument. The caller must ensure that no other thread does so while
        // a long call has released the interpreter; numpy's table would not prevent it either.
        unsafe { self.0.as_slice() }
    }
}

impl<'py> Deref for Numbers<'py> {
    type Target = Array<'py>;

    fn deref(&self) -> &Array<'py> {
        &self.0
    }
}

/// Arguments with an entry for each joint. A table with the names of the joints may have them in another order.
const OF_JOINTS: [&str; 12] = [
    "waypoints_q",
    "start_q",
    "end_q",
    "q",
    "qd",
    "qdd",
    "posture",
    "joint angles",
    "joint velocities",
    "joint accelerations",
    "joint torques",
    "start_qd",
];

/// Whether the value is a plain list or tuple.
pub fn is_list(value: &Bound<'_, PyAny>) -> bool {
    value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>()
}

/// Returns the numbers of an array of float64 in C order, which can be read as they are; None for any other value.
pub fn as_they_are<'py>(value: &Bound<'py, PyAny>) -> Option<Numbers<'py>> {
    let array = value.cast::<PyArrayDyn<f64>>().ok()?;
    let can_be_read = value.is_exact_instance_of::<PyUntypedArray>() && array.is_c_contiguous() && is_aligned(array);
    can_be_read.then(|| Numbers(array.clone()))
}

/// Converts an array-like to float64 in C order; copies only if needed. `what` names it in errors.
pub fn array<'py>(what: &str, value: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
    if let Some(numbers) = as_they_are(value) {
        return Ok(numbers);
    }
    if is_masked(value)? {
        return Err(invalid(format!("{what} has masked entries: replace them first, such as by .filled(value)")));
    }
    if OF_JOINTS.contains(&what) && !is_list(value) && python_calls::labelled(value)?.is_some() {
        return Err(invalid(format!(
            "{what} has names: robot.q_from puts its numbers in the order of the joints, and .to_numpy() takes them as they are"
        )));
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
        Ok(array) => {
            let array: Array<'py> = array.cast_into()?;
            let aligned = is_aligned(&array);
            Ok(Numbers(if aligned { array } else { array.call_method0(intern!(value.py(), "copy"))?.cast_into()? }))
        }
        // Passes on Ctrl-C during the conversion, which is no error of the value.
        Err(error) if error.is_instance_of::<PyException>(value.py()) => Err(no_numbers()),
        Err(interrupt) => Err(interrupt),
    }
}

/// Whether each number starts at a multiple of its size; fields of packed structures do not.
fn is_aligned(array: &Array<'_>) -> bool {
    // SAFETY: the array is alive, and only its flags are read.
    unsafe { (*array.as_array_ptr()).fields.flags & NPY_ARRAY_ALIGNED != 0 }
}

/// Whether the value is a masked array with masked entries; numpy would use the numbers behind the mask.
fn is_masked(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let py = value.py();
    if !value.is_instance_of::<PyUntypedArray>() || value.is_exact_instance_of::<PyUntypedArray>() {
        return Ok(false);
    }
    py.import(intern!(py, "numpy.ma"))?.call_method1(intern!(py, "is_masked"), (value,))?.extract()
}

/// Whether numpy would silently convert the value to unintended numbers: None to NaN, text to the number it spells, complex
/// numbers to their real parts, dates to seconds.
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

/// Calls `numpy.asarray`.
fn float64<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let options = [("dtype", "float64"), ("order", "C")].into_py_dict(py)?;
    py.import(intern!(py, "numpy"))?.call_method(intern!(py, "asarray"), (value,), Some(&options))
}

/// Returns the matrices of another library's poses or rotations, one or a list of them; None for anything else.
fn matrices<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let each = value.try_iter()?.map(|item| matrix(&item?)).collect::<PyResult<Option<Vec<_>>>>()?;
        return each.map(|each| Ok(PyList::new(value.py(), each)?.into_any())).transpose();
    }
    matrix(value)
}

/// Returns the matrix of an object with an attribute `homogeneous` (Pinocchio's SE3) or a method `as_matrix` (scipy's
/// RigidTransform and Rotation).
fn matrix<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let py = value.py();
    if let Some(matrix) = value.getattr_opt(intern!(py, "homogeneous"))? {
        return Ok(Some(matrix));
    }
    value.getattr_opt(intern!(py, "as_matrix"))?.map(|matrix| matrix.call0()).transpose()
}

/// Reads a count or a seed; as i128, because the overflow error of a narrower type would not name the argument.
pub fn count<T: TryFrom<i128>>(what: &str, value: i128) -> PyResult<T> {
    let bound = || if value < 0 { "zero or more".into() } else { format!("below 2^{}", 8 * size_of::<T>()) };
    T::try_from(value).map_err(|_| invalid(format!("{what} must be {}, got {value}", bound())))
}

/// Reads a string. An unpaired surrogate raises an error of this library instead of Python's own.
pub fn text<'a>(value: &'a Bound<'_, PyAny>) -> PyResult<&'a str> {
    value.cast::<PyString>()?.to_str().map_err(|_| not_unicode(value))
}

/// Reads an optional string.
pub fn optional_text<'a>(value: &'a Bound<'_, PyAny>) -> PyResult<Option<&'a str>> {
    if value.is_none() { Ok(None) } else { text(value).map(Some) }
}

/// Reads a path, or XML as text; `what` names the argument in errors.
pub fn path_or_text(what: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = value.extract::<String>() {
        return Ok(text);
    }
    match value.extract::<PathBuf>() {
        Ok(path) => Ok(path.to_string_lossy().into_owned()),
        Err(_) => Err(invalid(format!("{what} must be a path, or XML as text, got {}", summary(value)))),
    }
}

/// Reads an optional list of strings.
pub fn optional_texts(value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    if value.is_none() {
        return Ok(None);
    }
    let encodes =
        |error: PyErr| if error.is_instance_of::<PyUnicodeError>(value.py()) { not_unicode(value) } else { error };
    value.extract().map(Some).map_err(encodes)
}

fn not_unicode(value: &Bound<'_, PyAny>) -> PyErr {
    invalid(format!("text must be valid Unicode, got {}", summary(value)))
}

/// Reads an optional count.
pub fn optional_count<T: TryFrom<i128>>(what: &str, value: Option<i128>) -> PyResult<Option<T>> {
    value.map(|value| count(what, value)).transpose()
}

/// Formats a count with its noun.
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Returns the repr of a value, cut to a readable length. For a class of this library it suggests an instance.
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

/// Rounds a number of a `repr` to six decimals.
pub fn shortened(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Formats a shape in Python syntax.
pub fn shape_text(shape: &[usize]) -> String {
    match shape {
        [n] => format!("({n},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Reads a one-dimensional array-like.
pub fn vector(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    one_dimension(what, &array(what, value)?)
}

/// Copies the numbers of a one-dimensional array.
pub fn one_dimension(what: &str, array: &Numbers<'_>) -> PyResult<Vec<f64>> {
    match array.shape() {
        [_] => Ok(array.as_slice()?.to_vec()),
        shape => Err(invalid(format!("{what}: expected one dimension, got shape {}", shape_text(shape)))),
    }
}

/// Reads a number or a one-dimensional array-like; also returns whether it was a number.
pub fn scalar_or_vector(what: &str, value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let array = array(what, value)?;
    match array.shape() {
        [] | [_] => Ok((array.as_slice()?.to_vec(), array.shape().is_empty())),
        shape => Err(invalid(format!("{what}: expected a number or one dimension, got shape {}", shape_text(shape)))),
    }
}

/// Reads times (s), a number or one dimension; also returns whether it was a number. Infinite times are clamped later.
pub fn times(value: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let (times, single) = scalar_or_vector("t", value)?;
    match times.iter().position(|t| t.is_nan()) {
        None => Ok((times, single)),
        Some(i) => Err(invalid(format!("t must be a time, but entry {i} is NaN"))),
    }
}

/// Reads N numbers from a one-dimensional array-like.
pub fn entries<const N: usize>(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let array = array(what, value)?;
    match <[f64; N]>::try_from(array.as_slice()?) {
        Ok(entries) if array.shape().len() == 1 => Ok(entries),
        _ => Err(invalid(format!("{what}: expected shape ({N},), got {}", shape_text(array.shape())))),
    }
}

/// Reads three numbers.
pub fn point(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    entries(what, value)
}

/// Reads two corners of a box, one row each.
pub fn corners(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 2]> {
    let array = array(what, value)?;
    match (array.shape(), array.as_slice()?) {
        ([2, 3], [a, b, c, d, e, f]) => Ok([[*a, *b, *c], [*d, *e, *f]]),
        (shape, _) => Err(invalid(format!("{what}: expected shape (2, 3), got {}", shape_text(shape)))),
    }
}

/// Reads a rigid transform from a 4x4 matrix.
pub fn rigid(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Pose> {
    let array = array(what, value)?;
    match array.shape() {
        [4, 4] => rigid_rows(what, array.as_slice()?),
        [3] => Err(invalid(format!(
            "{what}: expected shape (4, 4), got (3,), a position; bik.pose(position, rpy=angles) makes a pose of it and angles"
        ))),
        shape => Err(invalid(format!("{what}: expected shape (4, 4), got {}", shape_text(shape)))),
    }
}

/// Makes a rigid transform from 16 numbers, row by row.
pub fn rigid_rows(what: &str, rows: &[f64]) -> PyResult<Pose> {
    pose::from_matrix(what, &Matrix4::from_row_slice(rows)).map_err(raise)
}

/// Makes a rigid transform of 16 numbers, row by row, whose rotation may have drifted; also returns the drift.
pub fn drifted_rows(what: &str, rows: &[f64]) -> PyResult<(Pose, Option<Drift>)> {
    pose::from_drifted(what, &Matrix4::from_row_slice(rows)).map_err(raise)
}

/// Makes rigid transforms from stacked 4x4 matrices.
pub fn rigid_matrices(numbers: &[f64]) -> PyResult<Vec<Pose>> {
    let matrices = numbers.chunks_exact(16).enumerate();
    let read = |(i, rows)| {
        Python::attach(|py| check_signals_at(py, i))?;
        rigid_rows(&format!("pose {i}"), rows)
    };
    matrices.map(read).collect()
}

/// Reads a 3x3 matrix.
pub fn matrix3(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Matrix3<f64>> {
    let array = array(what, value)?;
    match array.shape() {
        [3, 3] => Ok(Matrix3::from_row_slice(array.as_slice()?)),
        shape => Err(invalid(format!("{what}: expected shape (3, 3), got {}", shape_text(shape)))),
    }
}

/// Largest number of values that are copied: an array that takes over a buffer needs two more objects of Python.
const FEW: usize = 256;

/// Puts numbers in C order into a read-only array of this shape.
pub fn table<'py, T: Element + Copy>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let count = values.len();
    if count <= FEW && count == shape.iter().product::<usize>() {
        return Ok(filled(py, &values, shape));
    }
    match values.into_pyarray(py).reshape(shape) {
        Ok(array) => Ok(read_only(array)),
        // Rejects corrupt stored values: all other sizes agree.
        Err(_) => Err(invalid(format!("{count} stored numbers do not fill shape {}", shape_text(shape)))),
    }
}

/// Moves a buffer into a read-only vector.
pub fn row<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    read_only(values.into_pyarray(py))
}

/// Copies a few numbers into a read-only vector, which is cheaper than moving a buffer.
pub fn copied<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, PyArray1<f64>> {
    filled(py, values, values.len())
}

/// Copies numbers in C order into a read-only array of a shape that they fill.
fn filled<'py, T: Element + Copy, S: IntoDimension>(
    py: Python<'py>,
    values: &[T],
    shape: S,
) -> Bound<'py, PyArray<T, S::Dim>> {
    let shape = shape.into_dimension();
    debug_assert_eq!(values.len(), shape.size());
    // SAFETY: the array is new, aligned, in C order, and has room for these numbers.
    let array = unsafe {
        let array = PyArray::<T, S::Dim>::new(py, shape, false);
        array.data().copy_from_nonoverlapping(values.as_ptr(), values.len());
        array
    };
    read_only(array)
}

/// Converts a pose to a read-only 4x4 matrix.
pub fn pose_array<'py>(py: Python<'py>, pose: &Pose) -> Bound<'py, PyArray2<f64>> {
    filled(py, &pose::rows(pose), [4, 4])
}

/// Converts a matrix to a read-only one of Python.
pub fn matrix4_array<'py>(py: Python<'py>, matrix: &Matrix4<f64>) -> Bound<'py, PyArray2<f64>> {
    filled(py, matrix.transpose().as_slice(), [4, 4])
}

/// Makes the array that a method returns writable: it is a copy of the caller's own. Arrays of attributes stay read-only, since
/// writing into them would change a record, or nothing.
pub fn own<T: Element, D: Dimension>(array: Bound<'_, PyArray<T, D>>) -> Bound<'_, PyArray<T, D>> {
    // SAFETY: the array was made for this call and has no other owner yet.
    unsafe { (*array.as_array_ptr()).fields.flags |= NPY_ARRAY_WRITEABLE };
    array
}

fn read_only<T: Element, D: Dimension>(array: Bound<'_, PyArray<T, D>>) -> Bound<'_, PyArray<T, D>> {
    // SAFETY: the array was made here and has no other owner yet.
    unsafe { (*array.as_array_ptr()).fields.flags &= !NPY_ARRAY_WRITEABLE };
    array
}

/// The rows (m, n) of a batch, or a single row (n,): the numbers and, for a batch, m. The core checks n of a single row;
/// [`joint_rows`](crate::joint_order::joint_rows) checks it for a batch.
pub enum Rows<'py> {
    /// One row.
    One(Numbers<'py>),
    /// m rows.
    Many(Numbers<'py>, usize),
}

impl<'py> Rows<'py> {
    /// The number of rows; None for a single one.
    pub fn count(&self) -> Option<usize> {
        match self {
            Self::One(_) => None,
            Self::Many(_, m) => Some(*m),
        }
    }

    /// The numbers of all rows.
    pub fn numbers(&self) -> &Numbers<'py> {
        match self {
            Self::One(numbers) | Self::Many(numbers, _) => numbers,
        }
    }
}
