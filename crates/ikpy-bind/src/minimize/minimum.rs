//! `minimize` and `Minimum`.

use ikcore::minimize::{self, MinimizeOptions};
use ikcore::solver::{AnySolver, DifferentialEvolution, Stop};
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use super::function::{Attendant, Failure, Function};
use crate::convert::{copied, count, summary, table, vector};
use crate::error::{invalid, raise};
use crate::limits::PyLimits;
use crate::monitor::watched_keeping_result;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::solver::{PyStop, derivative_free_solver};
use crate::traversal::traversed;

/// The best point found by `minimize`, and the outcome of the search.
#[pyclass(name = "Minimum", module = "beetle_ik", frozen)]
pub struct PyMinimum {
    core: minimize::Minimum,
    /// The point (n,), inside the box.
    #[pyo3(get)]
    x: Py<PyArray1<f64>>,
    /// Progress of the search (k, 2): number of evaluations, best value so far. One row for the start, one for each
    /// improvement and one for the end.
    #[pyo3(get)]
    history: Py<PyArrayDyn<f64>>,
    /// The box, given by `lower` and `upper`.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PyMinimum: limits);

outcome! {
    PyMinimum = |result|
    /// Whether the value is below that of `Stop(value_below=...)`; False if none was given.
    success,
    /// SOLVED on `success`; STALLED if the solver's own rule ended the search; BUDGET_SPENT, TIME_UP or INTERRUPTED.
    status: result.core.status,
    message: result.core.message(),
    /// Evaluations of the function.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PyMinimum {
    /// The function's value at `x`; inf if no value was finite.
    #[getter]
    fn value(&self) -> f64 {
        self.core.value
    }

    /// Iterations over all starts: generations of swarms, passes of BAS.
    #[getter]
    fn iterations(&self) -> usize {
        self.core.iterations
    }

    /// Restarts after the first start.
    #[getter]
    fn restarts(&self) -> usize {
        self.core.restarts
    }

    fn __repr__(&self) -> String {
        format!("<Minimum {}: {}>", self.core.status.name(), self.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("minimum", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.limits))
    }

    /// Restores a pickled value.
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

/// Minimises a function over a box by a derivative-free solver.
///
/// Args:
///     function: takes x (n,) and returns a number; NaN and infinities count as the worst value.
///     lower: (n,), finite.
///     upper: (n,), finite.
///     solver: a derivative-free solver, for example `PSO`, or `MultiStart` of one; None: `DifferentialEvolution()`.
///         BAS suits few functions, whose minimum must be zero: see `BAS`.
///     start: (n,), first point; None: drawn at random. Swarms include it in the first generation.
///     stop: budgets; None: 30000 evaluations. `Stop(value_below=...)` sets a target value.
///     seed: seed of the random draws; the same seed gives the same bits.
///     vectorized: whether the function takes whole generations (m, n) and returns (m,).
///     progress: True shows a progress bar; a callable is called with (done, total) evaluations.
///
/// Returns:
///     A `Minimum`; its `success` is True only if a target value was given and reached.
///
/// Raises:
///     InvalidInputError: wrong shape, an infinite or empty box, a start outside it, a population larger than the budget, or
///         a function that does not return numbers.
///
/// For example:
///
///     >>> minimum = bik.minimize(lambda x: (x[0] - 1) ** 2 + x[1] ** 2, [-5, -5], [5, 5])
///     >>> minimum.value < 1e-12
///     True
///
/// Exceptions of the function and KeyboardInterrupt propagate unchanged. Their attribute `best` holds the best point so far,
/// a `Minimum`, and a note on the exception says so.
#[pyfunction(name = "minimize")]
#[pyo3(signature = (function, lower, upper, *, solver=None, start=None, stop=None, seed=0, vectorized=false,
                    progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn minimize_function(
    py: Python<'_>,
    function: &Bound<'_, PyAny>,
    lower: &Bound<'_, PyAny>,
    upper: &Bound<'_, PyAny>,
    solver: Option<&Bound<'_, PyAny>>,
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
        solver: match solver {
            None => AnySolver::Single(DifferentialEvolution::default().into()),
            Some(solver) => derivative_free_solver("minimize", solver)?,
        },
        start: start.map(|start| vector("start", start)).transpose()?,
        stop: stop.map_or(Stop::default(), PyStop::core),
        seed: count("seed", seed)?,
    };
    let failure = Failure::default();
    let mut objective = Function { function: function.clone(), dimension: lower.len(), vectorized, failure: &failure };
    let (core, stopped) = watched_keeping_result(py, progress, |watcher| {
        let mut attendant = Attendant { watcher, failure: &failure };
        minimize::minimize(&mut objective, &lower, &upper, &options, &mut attendant)
    })?;
    let found = PyMinimum::new(py, core.map_err(raise)?, Py::new(py, PyLimits::of_box(lower, upper))?)?;
    match stopped.or(failure.into_inner()) {
        Some(error) => Err(with_best(py, error, found)?),
        None => Ok(found),
    }
}

/// Attaches the best point found so far to the error.
fn with_best(py: Python<'_>, error: PyErr, found: PyMinimum) -> PyResult<PyErr> {
    let value = error.value(py);
    let note = match found.core.value.is_finite() {
        true => format!("minimize: {}; kept as `best` of this exception", found.message()),
        false => "minimize: no finite value was found before".into(),
    };
    // Exception classes may refuse attributes; the exception is raised anyway.
    let kept = value.setattr("best", Bound::new(py, found)?);
    if kept.is_ok() {
        value.call_method1("add_note", (note,))?;
    }
    Ok(error)
}
