//! `Stop` and `Status`.

use std::time::Duration;

use ikcore::solver::{Status, Stop};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::IntoPyDict;

use crate::convert::optional_count;
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, keywords};

static STATUS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();

/// Returns the class `beetle_ik.Status`, an IntEnum with the names and numbers of the core.
pub fn status_class(py: Python<'_>) -> PyResult<&Bound<'_, PyAny>> {
    let class = STATUS.get_or_try_init(py, || {
        let members: Vec<(&str, u8)> = Status::ALL.iter().map(|status| (status.name(), *status as u8)).collect();
        let options = [("module", "beetle_ik")].into_py_dict(py)?;
        let enums = py.import("enum")?;
        let class = enums.getattr("IntEnum")?.call(("Status", members), Some(&options))?;
        // Prints the name of a status; IntEnum would print its number.
        let plain = enums.getattr("Enum")?;
        class.setattr("__str__", plain.getattr("__str__")?)?;
        class.setattr("__format__", plain.getattr("__format__")?)?;
        // The number of SOLVED is 0: `if solution.status` would hold for failures alone.
        class.setattr("__bool__", py.eval(c"lambda status: status == 0", None, None)?)?;
        class.setattr("__doc__", documentation())?;
        for status in Status::ALL {
            class.getattr(status.name())?.setattr("__doc__", status.meaning())?;
        }
        Ok::<_, PyErr>(class.unbind())
    })?;
    Ok(class.bind(py))
}

fn documentation() -> String {
    let members = Status::ALL.iter().map(|status| format!("- `{}`: {}\n", status.name(), status.meaning()));
    let summary =
        "How a solve, an item of a batch or a step of a track ended. Only `SOLVED` is success, and true in conditions.";
    format!("{summary}\n\n{}", members.collect::<String>())
}

/// Returns the member of `Status` for a status of the core.
pub fn status(py: Python<'_>, status: Status) -> PyResult<Bound<'_, PyAny>> {
    status_class(py)?.call1((status as u8,))
}

/// Budgets of a search, which ends when the first one is spent. Without any, the default is a number of evaluations that
/// keeps a 7-joint arm under about 10 ms.
///
/// Args:
///     max_evaluations: largest number of evaluations of the forward kinematics, including the start.
///     max_iterations: largest number of iterations of the solver; passes of BAS.
///     max_time: largest time (s). Results are then no longer repeatable.
///     value_below: the search ends at a value below this one. In `minimize` it is a value of the function, and reaching it
///         is success. Elsewhere it is a weighted sum of squared errors (m, rad), and the status is IMPROVED.
#[pyclass(name = "Stop", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyStop {
    /// Largest number of evaluations, including the start.
    #[pyo3(get)]
    max_evaluations: Option<usize>,
    /// Largest number of iterations.
    #[pyo3(get)]
    max_iterations: Option<usize>,
    /// Largest time (s).
    #[pyo3(get)]
    max_time: Option<f64>,
    /// Value below which the search ends.
    #[pyo3(get)]
    value_below: Option<f64>,
}

#[pymethods]
impl PyStop {
    #[new]
    #[pyo3(signature = (*, max_evaluations=None, max_iterations=None, max_time=None, value_below=None))]
    fn new(
        max_evaluations: Option<i128>,
        max_iterations: Option<i128>,
        max_time: Option<f64>,
        value_below: Option<f64>,
    ) -> PyResult<Self> {
        if let Some(seconds) = max_time
            && Duration::try_from_secs_f64(seconds).is_err()
        {
            return Err(invalid(format!("max_time must be zero or more seconds, got {seconds}")));
        }
        let stop = Self {
            max_evaluations: optional_count("max_evaluations", max_evaluations)?,
            max_iterations: optional_count("max_iterations", max_iterations)?,
            max_time,
            value_below,
        };
        stop.core().validate().map_err(raise)?;
        Ok(stop)
    }

    fn __repr__(&self) -> String {
        let Self { max_evaluations, max_iterations, max_time, value_below } = self;
        format!(
            "Stop(max_evaluations={}, max_iterations={}, max_time={}, value_below={})",
            max_evaluations.text(),
            max_iterations.text(),
            max_time.text(),
            value_below.text(),
        )
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["max_evaluations", "max_iterations", "max_time", "value_below"])
    }
}

impl PyStop {
    /// Returns the budgets with defaults filled in.
    pub fn core(&self) -> Stop {
        let standard = Stop::default();
        Stop {
            max_evaluations: match (self.max_evaluations, self.max_time) {
                (Some(count), _) => count,
                // Lifts the limit on evaluations if only a time is given.
                (None, Some(_)) => usize::MAX,
                (None, None) => standard.max_evaluations,
            },
            max_iterations: self.max_iterations.unwrap_or(standard.max_iterations),
            max_time: self.max_time.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            value_below: self.value_below,
            ..standard
        }
    }
}
