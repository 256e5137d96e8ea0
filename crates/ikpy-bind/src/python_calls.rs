//! Calls into the Python package: plots, files, models of other libraries and the progress bar. No other file calls it.

use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

fn call<'py>(
    py: Python<'py>,
    module: &str,
    function: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import(module)?.getattr(function)?.call1(arguments)
}

/// Calls `beetle_ik.plot.<function>(result)`.
pub fn plot<'py>(result: Bound<'py, PyAny>, function: &str) -> PyResult<Bound<'py, PyAny>> {
    call(result.py(), "beetle_ik.plot", function, (result,))
}

/// Calls `beetle_ik.figures.notebook.<function>(value)`, for notebooks.
pub fn html<'py>(value: Bound<'py, PyAny>, function: &str) -> PyResult<Bound<'py, PyAny>> {
    call(value.py(), "beetle_ik.figures.notebook", function, (value,))
}

/// Calls `beetle_ik.files.trajectories.<function>(trajectory, file, ...)`.
pub fn write<'py>(py: Python<'py>, function: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyResult<()> {
    call(py, "beetle_ik.files.trajectories", function, arguments).map(|_| ())
}

/// Calls `beetle_ik.files.trajectories.<function>(file)`.
pub fn read<'py>(function: &str, file: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    call(file.py(), "beetle_ik.files.trajectories", function, (file,))
}

/// Calls `beetle_ik.robot_files.<module>.robot(...)`, which makes a robot by means of another library.
pub fn robot<'py>(
    py: Python<'py>,
    module: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    call(py, &format!("beetle_ik.robot_files.{module}"), "robot", arguments)
}

/// Calls `beetle_ik.robot_files.descriptions.named(name, unknown)`, which makes a robot that is not built in.
pub fn described<'py>(py: Python<'py>, name: &str, unknown: String) -> PyResult<Bound<'py, PyAny>> {
    call(py, "beetle_ik.robot_files.descriptions", "named", (name, unknown))
}

/// Calls `beetle_ik.robot_files.xacro.expand(path, package_dirs, trusted)`.
pub fn expand_xacro(py: Python<'_>, path: &str, package_dirs: &[String], trusted: bool) -> PyResult<String> {
    call(py, "beetle_ik.robot_files.xacro", "expand", (path, package_dirs, trusted))?.extract()
}

/// Calls `beetle_ik.calls.labelled.labelled(value)`: names and numbers of a value whose numbers have names.
pub fn labelled<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<(Vec<String>, Bound<'py, PyAny>)>> {
    call(value.py(), "beetle_ik.calls.labelled", "labelled", (value,))?.extract()
}

/// Logs a long call at level INFO under "beetle_ik".
pub fn log(py: Python<'_>, function: &str, message: &str) -> PyResult<()> {
    let message = format!("{function}: {message}");
    call(py, "logging", "getLogger", ("beetle_ik",))?.call_method1("info", ("%s", message)).map(|_| ())
}

/// Calls `beetle_ik.calls.warned.warn(message)`, which raises a `UnitsWarning` in the caller's file.
pub fn warn_of_units(py: Python<'_>, message: &str) -> PyResult<()> {
    call(py, "beetle_ik.calls.warned", "warn", (message,)).map(|_| ())
}

/// Calls `beetle_ik.calls.warned.warn(message, UserWarning)`, which raises a `UserWarning` in the caller's file.
pub fn warn_user(py: Python<'_>, message: &str) -> PyResult<()> {
    call(py, "beetle_ik.calls.warned", "warn", (message, py.get_type::<PyUserWarning>())).map(|_| ())
}

/// Makes a progress bar on the terminal.
pub fn progress_bar(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    call(py, "beetle_ik.calls.progress", "Bar", ())
}

/// Calls `beetle_ik.calls.wording.misfit(argument, value, error)`, which words the error for a value of the wrong type.
pub fn misfit(argument: &str, value: &Bound<'_, PyAny>, error: &PyErr) -> PyResult<String> {
    let py = value.py();
    call(py, "beetle_ik.calls.wording", "misfit", (argument, value, error.value(py)))?.extract()
}

/// Calls `beetle_ik.calls.renamed.renamed(call, keywords)`, which warns of deprecated keywords: the keywords under their
/// new names; None if each has the name of today.
pub fn renamed<'py>(call: &Bound<'py, PyAny>, keywords: &Bound<'py, PyDict>) -> PyResult<Option<Bound<'py, PyDict>>> {
    Ok(self::call(call.py(), "beetle_ik.calls.renamed", "renamed", (call, keywords))?.extract()?)
}

/// Calls `beetle_ik.calls.wording.worded(error, call, arguments, keywords)`, which words the error for arguments
/// that do not fit.
pub fn worded<'py>(
    py: Python<'py>,
    error: &PyErr,
    call: &Bound<'py, PyAny>,
    arguments: &Bound<'py, PyTuple>,
    keywords: &Bound<'py, PyDict>,
) -> PyResult<PyErr> {
    let error = error.value(py);
    self::call(py, "beetle_ik.calls.wording", "worded", (error, call, arguments, keywords)).map(PyErr::from_value)
}
