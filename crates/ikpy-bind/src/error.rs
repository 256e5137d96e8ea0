//! Errors of the core as Python exceptions.

use std::f64::consts::TAU;

use ikcore::Error;
use pyo3::exceptions::{PyException, PyLookupError, PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::wording::spelt;

/// Classes of exceptions and warnings, created once. Several have two bases, which pyo3's macro does not support.
struct Classes {
    base: Py<PyType>,
    invalid_input: Py<PyType>,
    unknown_name: Py<PyType>,
    urdf: Py<PyType>,
    limit: Py<PyType>,
    unsupported_limit: Py<PyType>,
    infeasible: Py<PyType>,
    call: Py<PyType>,
    units: Py<PyType>,
}

impl Classes {
    fn of(&self, error: &Error) -> &Py<PyType> {
        match error {
            Error::InRow { error, .. } | Error::InProblem { error, .. } | Error::InFile { error, .. } => self.of(error),
            Error::UnknownRobot { .. }
            | Error::UnknownLink { .. }
            | Error::UnknownTip { .. }
            | Error::UnknownJoint { .. }
            | Error::NotHeld { .. } => &self.unknown_name,
            Error::Urdf { .. } | Error::Srdf { .. } | Error::AmbiguousTip { .. } => &self.urdf,
            Error::EmptyRange { .. }
            | Error::OutsideLimits { .. }
            | Error::OutsideRegion { .. }
            | Error::NegativeLimit { .. } => &self.limit,
            Error::UnsupportedLimit { .. } => &self.unsupported_limit,
            Error::Infeasible { .. } => &self.infeasible,
            _ => &self.invalid_input,
        }
    }
}

static CLASSES: PyOnceLock<Classes> = PyOnceLock::new();

fn classes(py: Python<'_>) -> PyResult<&Classes> {
    CLASSES.get_or_try_init(py, || {
        let class = |name: &str, doc: &str, bases: Vec<Bound<'_, PyType>>| -> PyResult<Py<PyType>> {
            let namespace = PyDict::new(py);
            namespace.set_item("__module__", "beetle_ik")?;
            namespace.set_item("__doc__", doc)?;
            let made = py.get_type::<PyType>().call1((name, PyTuple::new(py, bases)?, namespace))?;
            Ok(made.cast_into::<PyType>()?.unbind())
        };
        let (value_error, lookup_error) = (py.get_type::<PyValueError>(), py.get_type::<PyLookupError>());
        let base = class("BeetleIkError", "Any error of this library.", vec![py.get_type::<PyException>()])?;
        let bound = |class: &Py<PyType>| class.bind(py).clone();
        let invalid_input = class(
            "InvalidInputError",
            "An argument with a wrong value, shape or unit; the message says what is expected.",
            vec![bound(&base), value_error],
        )?;
        let limit = class(
            "LimitError",
            "Limits that contradict each other or exclude the start.",
            vec![bound(&invalid_input)],
        )?;
        Ok(Classes {
            unknown_name: class(
                "UnknownNameError",
                "Unknown name of a robot, link or option; the message lists the known ones.",
                vec![bound(&base), lookup_error],
            )?,
            urdf: class(
                "UrdfError",
                "A robot description that cannot be read; the message names the line and the joint.",
                vec![bound(&invalid_input)],
            )?,
            unsupported_limit: class(
                "UnsupportedLimit",
                "A limit that the method cannot keep. No method ignores one.",
                vec![bound(&limit)],
            )?,
            infeasible: class(
                "InfeasibleError",
                "Requirements that contradict each other; the message names the two.",
                vec![bound(&invalid_input)],
            )?,
            call: class(
                "CallError",
                "A call that does not fit its signature: an argument of the wrong type, one that is missing or unknown. Also a\n\
                 `TypeError`, which Python raises there.",
                vec![bound(&invalid_input), py.get_type::<PyTypeError>()],
            )?,
            units: class(
                "UnitsWarning",
                "A value that looks like degrees where radians are due, or millimetres for metres. The call has used it as given.",
                vec![py.get_type::<PyUserWarning>()],
            )?,
            base,
            invalid_input,
            limit,
        })
    })
}

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let Classes { base, invalid_input, unknown_name, urdf, limit, unsupported_limit, infeasible, call, units } =
        classes(py)?;
    for class in [base, invalid_input, unknown_name, urdf, limit, unsupported_limit, infeasible, call, units] {
        let class = class.bind(py);
        module.add(class.name()?, class)?;
    }
    Ok(())
}

/// Converts an error of the core to its exception.
pub fn raise(error: Error) -> PyErr {
    Python::attach(|py| {
        let classes = match classes(py) {
            Ok(classes) => classes,
            Err(failure) => return failure,
        };
        let class = classes.of(&error);
        let class = class.bind(py).clone();
        let remedy = remedy(&error);
        PyErr::from_type(class, format!("{}{remedy}", error.worded(spelt)))
    })
}

/// Returns advice for Python callers, which is appended to the message of an error.
fn remedy(error: &Error) -> &'static str {
    match error {
        Error::InRow { error, .. } | Error::InProblem { error, .. } | Error::InFile { error, .. } => remedy(error),
        Error::OutsideLimits { value, lower, upper, .. }
            if value.abs() > TAU && (*lower..=*upper).contains(&value.to_radians()) =>
        {
            "; angles are in radians, and np.radians converts degrees"
        }
        _ => "",
    }
}

/// Makes an `InvalidInputError`, for arguments checked in the binding.
pub fn invalid(message: String) -> PyErr {
    made(|classes| &classes.invalid_input, message)
}

/// Makes a `CallError`, for an argument of the wrong type.
pub fn misfit(message: String) -> PyErr {
    made(|classes| &classes.call, message)
}

/// Makes a `LimitError`, for limits checked in the binding.
pub fn limit_error(message: String) -> PyErr {
    made(|classes| &classes.limit, message)
}

/// Adds a reason to the message of an error of this library, unless it speaks of units already.
pub fn with_reason(py: Python<'_>, error: PyErr, reason: &str) -> PyErr {
    let message = error.value(py).to_string();
    let is_ours = classes(py).is_ok_and(|classes| error.is_instance(py, classes.base.bind(py)));
    if !is_ours || message.contains("np.radians") {
        return error;
    }
    PyErr::from_type(error.get_type(py), format!("{message}; {reason}"))
}

fn made(class: impl Fn(&Classes) -> &Py<PyType>, message: String) -> PyErr {
    Python::attach(|py| match classes(py) {
        Ok(classes) => PyErr::from_type(class(classes).bind(py).clone(), message),
        Err(failure) => failure,
    })
}
