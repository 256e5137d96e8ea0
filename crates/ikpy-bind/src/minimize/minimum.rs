//! `minimize` and `Minimum`.

use ikcore::minimize::{self, MinimizeOptions};
use ikcore::solver::Stop;
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use super::function::{Attendant, Failure, Function};
use crate::convert::{copied, count, summary, table, vector};
use crate::error::{invalid, raise};
use crate::limits::PyLimits;
use crate::monitor::followed;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::solver::{PyStop, derivative_free_solver};

/// The best point found by `minimize`, and what became of the search.
#[pyclass(name = "Minimum", module = "beetle_ik", frozen)]
pub struct PyMinimum {
    core: minimize::Minimum,
    /// The point (n,), inside the box.
    #[pyo3(get)]
    x: Py<PyArray1<f64>>,
    /// (k, 2): evaluations made, and the best value then. A row for the start, for every improvement and for the end.
    #[pyo3(get)]
    history: Py<PyArrayDyn<f64>>,
    /// The box, as `lower` and `upper`.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

outcome! {
    PyMinimum = |result|
    /// Whether the value is below the one asked for by `Stop(value_below=...)`; without one, nothing is known to be good
    /// enough, and this is False.
    success,
    /// SOLVED as `success`; STALLED by the solver's own rule; BUDGET_SPENT, TIME_UP or INTERRUPTED.
    status: result.core.status,
    message: result.core.message(),
    /// Evaluations of the function.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PyMinimum {
    /// The function's value at `x`; inf where it was finite nowhere.
    #[getter]
    fn value(&self) -> f64 {
        self.core.value
    }

    /// Iterations over all starts: generations of swarms, passes of BAS.
    #[getter]
    fn iterations(&self) -> usize {
        self.core.iterations
    }

    /// Starts beyond the first.
    #[getter]
    fn restarts(&self) -> usize {
        self.core.restarts
    }

    fn __repr__(&self) -> String {
        format!("<Minimum {}: {}>", self.core.status.name(), self.core.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("minimum", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.limits))
    }

    /// What pickle stored.
    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8], limits: Py<PyLimits>) -> PyResult<Self> {
        Self::new(py, from_bytes("minimum", bytes).map_err(raise)?, limits)
    }
}

impl PyMinimum {
    fn new(py: Python<'_>, core: minimize::Minimum, limits: Py<PyLimits>) -> PyResult<Self> {
        let history = table(py, core.history.as_flattened().to_vec(), &[core.history.len(), 2])?.unbind();
        Ok(Self { x: copied(py, &core.x).unbind(), history, limits, core })
    }
}

/// Searches a box for the least value of a function of which nothing but values is known.
///
/// Args:
///     function: takes x (n,) and returns a number; NaN and infinities count as the worst value.
///     lower: (n,), finite.
///     upper: (n,), finite.
///     solver: one that needs values alone, such as `PSO` or `BAS`, or `MultiStart` of one. BAS has antennae as long as
///         c1 times the root of the value: it suits functions whose least value is zero.
///     start: (n,), where to begin; None draws it. It is a member of the first generation of swarms.
///     stop: budgets; None: 30000 evaluations. `Stop(value_below=...)` says what is good enough.
///     seed: of the random draws: the same seed, the same bits.
///     vectorized: the function takes (m, n) and returns (m,), whole generations at once.
///     progress: True for a bar on the terminal, or a callable of (done, total), evaluations.
///
/// Returns:
///     A `Minimum`, its `success` only where a value was asked for and found.
///
/// Raises:
///     InvalidInputError: wrong shape, an open or an empty box, a start outside it, a population larger than the budget, a
///         function that returns something else than numbers.
///
/// What the function raises comes out as it is, and so does KeyboardInterrupt; both have the best point so far, a
/// `Minimum`, as attribute `best`, and a note that says so.
#[pyfunction(name = "minimize")]
#[pyo3(signature = (function, lower, upper, *, solver, start=None, stop=None, seed=0, vectorized=false,
                    progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn minimize_function(
    py: Python<'_>,
    function: &Bound<'_, PyAny>,
    lower: &Bound<'_, PyAny>,
    upper: &Bound<'_, PyAny>,
    solver: &Bound<'_, PyAny>,
    start: Option<&Bound<'_, PyAny>>,
    stop: Option<&PyStop>,
    seed: i128,
    vectorized: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyMinimum> {
    if !function.is_callable() {
        return Err(invalid(format!("function must be a callable of x, got {}", summary(function))));
    }
    let (lower, upper) = (vector("lower", lower)?, vector("upper", upper)?);
    let options = MinimizeOptions {
        solver: derivative_free_solver("minimize", solver)?,
        start: start.map(|start| vector("start", start)).transpose()?,
        stop: stop.map_or(Stop::default(), PyStop::core),
        seed: count("seed", seed)?,
    };
    let failure = Failure::default();
    let mut objective = Function { function: function.clone(), dimension: lower.len(), vectorized, failure: &failure };
    let (core, stopped) = followed(py, progress, |watcher| {
        let mut attendant = Attendant { watcher, failure: &failure };
        minimize::minimize(&mut objective, &lower, &upper, &options, &mut attendant)
    })?;
    let found = PyMinimum::new(py, core.map_err(raise)?, Py::new(py, PyLimits::of_box(lower, upper))?)?;
    match stopped.or(failure.into_inner()) {
        Some(error) => Err(with_best(py, error, found)?),
        None => Ok(found),
    }
}

/// The error with what was found before it.
fn with_best(py: Python<'_>, error: PyErr, found: PyMinimum) -> PyResult<PyErr> {
    let value = error.value(py);
    let note = match found.core.value.is_finite() {
        true => format!("minimize: {}; kept as `best` of this exception", found.core.message()),
        false => "minimize: no finite value was found before".into(),
    };
    // A class may refuse attributes; its exception comes out all the same.
    let kept = value.setattr("best", Bound::new(py, found)?);
    if kept.is_ok() {
        value.call_method1("add_note", (note,))?;
    }
    Ok(error)
}
