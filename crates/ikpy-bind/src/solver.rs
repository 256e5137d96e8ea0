//! Solvers, budgets and statuses.

use std::time::Duration;

use ikcore::solver::{Algorithm, AnySolver, Bas, LevenbergMarquardt, MultiStart, Status, Stop, Variant};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};

use crate::convert::{count, optional_count, summary};
use crate::error::{invalid, raise};

static STATUS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyBas>()?;
    module.add_class::<PyLevenbergMarquardt>()?;
    module.add_class::<PyMultiStart>()?;
    module.add_class::<PyStop>()?;
    module.add("Status", status_class(module.py())?)
}

/// `beetle_ik.Status`, an IntEnum with the names and numbers of the core.
fn status_class(py: Python<'_>) -> PyResult<&Bound<'_, PyAny>> {
    let class = STATUS.get_or_try_init(py, || {
        let members: Vec<(&str, u8)> = Status::ALL.iter().map(|status| (status.name(), *status as u8)).collect();
        let options = [("module", "beetle_ik")].into_py_dict(py)?;
        let class = py.import("enum")?.getattr("IntEnum")?.call(("Status", members), Some(&options))?;
        class.setattr(
            "__doc__",
            "How a solve, one item of a batch or one step of a track ended. `SOLVED` alone is success.",
        )?;
        Ok::<_, PyErr>(class.unbind())
    })?;
    Ok(class.bind(py))
}

/// The member of `Status`.
pub fn status(py: Python<'_>, status: Status) -> PyResult<Bound<'_, PyAny>> {
    status_class(py)?.call1((status as u8,))
}

/// Beetle antennae search (Cheng et al. 2020, Algorithm 1): uses values of the error alone, no derivative.
///
/// Args:
///     variant: "star", each exploration of a pass from the same point (eq. 8-11 to the letter); "chain", from where
///         the beetle went (the original beetle search, faster); "greedy", from the better of the two, the antennae
///         following the error at once (fastest for small tolerances).
///     c1: antenna length over error, eq. (12) (rad per m); None: what suits the variant (3, 1 and 3).
///     c2: step length over antenna length, eq. (13); None: 1.
///     explorations: per pass, the paper's n; None: what suits the variant (50, 30 and 5).
///     max_passes: after so many it gives up; the paper would go on for ever.
///
/// The error band of the paper is the tolerance of the call.
#[pyclass(name = "BAS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyBas(Bas);

#[pymethods]
impl PyBas {
    #[new]
    #[pyo3(signature = (*, variant="star", c1=None, c2=None, explorations=None, max_passes=200))]
    fn new(
        variant: &str,
        c1: Option<f64>,
        c2: Option<f64>,
        explorations: Option<i128>,
        max_passes: i128,
    ) -> PyResult<Self> {
        let standard = Bas::of(variant.parse::<Variant>().map_err(raise)?);
        let bas = Bas {
            c1: c1.unwrap_or(standard.c1),
            c2: c2.unwrap_or(standard.c2),
            explorations: optional_count("explorations", explorations)?.unwrap_or(standard.explorations),
            max_passes: count("max_passes", max_passes)?,
            ..standard
        };
        bas.validate().map_err(raise)?;
        Ok(Self(bas))
    }

    /// "star", "chain" or "greedy".
    #[getter]
    fn variant(&self) -> String {
        self.0.variant.to_string()
    }

    /// Antenna length over error (rad per m).
    #[getter]
    fn c1(&self) -> f64 {
        self.0.c1
    }

    /// Step length over antenna length.
    #[getter]
    fn c2(&self) -> f64 {
        self.0.c2
    }

    /// Explorations per pass.
    #[getter]
    fn explorations(&self) -> usize {
        self.0.explorations
    }

    /// Passes after which it gives up.
    #[getter]
    fn max_passes(&self) -> usize {
        self.0.max_passes
    }

    fn __repr__(&self) -> String {
        let Bas { variant, c1, c2, explorations, max_passes } = self.0;
        format!("BAS(variant='{variant}', c1={c1}, c2={c2}, explorations={explorations}, max_passes={max_passes})")
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let options = PyDict::new(py);
        options.set_item("variant", self.variant())?;
        options.set_item("c1", self.0.c1)?;
        options.set_item("c2", self.0.c2)?;
        options.set_item("explorations", self.0.explorations)?;
        options.set_item("max_passes", self.0.max_passes)?;
        Ok((PyTuple::empty(py), options))
    }
}

/// Levenberg-Marquardt on the box of the limits, by the analytic Jacobian: joints at a bound are held and the step is
/// solved again for the others.
///
/// Args:
///     initial_damping: damping over squared error at the start; larger is more careful far from the target.
#[pyclass(name = "LevenbergMarquardt", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyLevenbergMarquardt(LevenbergMarquardt);

#[pymethods]
impl PyLevenbergMarquardt {
    #[new]
    #[pyo3(signature = (*, initial_damping=LevenbergMarquardt::default().initial_damping))]
    fn new(initial_damping: f64) -> PyResult<Self> {
        let solver = LevenbergMarquardt { initial_damping, ..LevenbergMarquardt::default() };
        solver.validate().map_err(raise)?;
        Ok(Self(solver))
    }

    /// Damping over squared error at the start.
    #[getter]
    fn initial_damping(&self) -> f64 {
        self.0.initial_damping
    }

    fn __repr__(&self) -> String {
        format!("LevenbergMarquardt(initial_damping={})", self.0.initial_damping)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        Ok((PyTuple::empty(py), [("initial_damping", self.0.initial_damping)].into_py_dict(py)?))
    }
}

/// A solver begun again from random starts when it stalls, or when its attempt is hopeless: a few steps that bring
/// little.
///
/// Args:
///     solver: `BAS` or `LevenbergMarquardt`.
///     max_starts: starts in all; None: as many as the evaluation budget allows.
#[pyclass(name = "MultiStart", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct PyMultiStart(MultiStart<Algorithm>);

#[pymethods]
impl PyMultiStart {
    #[new]
    #[pyo3(signature = (solver, *, max_starts=None))]
    fn new(solver: &Bound<'_, PyAny>, max_starts: Option<i128>) -> PyResult<Self> {
        let AnySolver::Single(algorithm) = any_solver(solver)? else {
            return Err(invalid("MultiStart takes a single solver, not another MultiStart".into()));
        };
        let mut multi_start = algorithm.into_multi_start();
        if let Some(starts) = max_starts {
            multi_start.rule.max_starts = count("max_starts", starts)?;
        }
        multi_start.validate().map_err(raise)?;
        Ok(Self(multi_start))
    }

    /// The solver that is begun again.
    #[getter]
    fn solver<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.0.solver {
            Algorithm::Bas(bas) => Ok(Bound::new(py, PyBas(*bas))?.into_any()),
            Algorithm::LevenbergMarquardt(solver) => Ok(Bound::new(py, PyLevenbergMarquardt(*solver))?.into_any()),
        }
    }

    /// Starts in all; None: as many as the evaluation budget allows.
    #[getter]
    fn max_starts(&self) -> Option<usize> {
        Some(self.0.rule.max_starts).filter(|starts| *starts != usize::MAX)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let starts = self.max_starts().map_or_else(String::new, |count| format!(", max_starts={count}"));
        Ok(format!("MultiStart({}{starts})", self.solver(py)?.repr()?))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let options = PyDict::new(py);
        options.set_item("max_starts", self.max_starts())?;
        Ok((PyTuple::new(py, [self.solver(py)?])?, options))
    }
}

/// When to stop; whichever comes first. None leaves the default, a count of evaluations that keeps a 7-joint arm under
/// about 10 ms.
///
/// Args:
///     max_evaluations: evaluations of the forward kinematics, the start included.
///     max_iterations: iterations of the solver; passes of BAS.
///     max_time: seconds. Setting it gives up repeatability.
#[pyclass(name = "Stop", module = "beetle_ik", frozen, eq)]
#[derive(PartialEq)]
pub struct PyStop {
    /// See the class.
    #[pyo3(get)]
    max_evaluations: Option<usize>,
    /// See the class.
    #[pyo3(get)]
    max_iterations: Option<usize>,
    /// See the class (s).
    #[pyo3(get)]
    max_time: Option<f64>,
}

#[pymethods]
impl PyStop {
    #[new]
    #[pyo3(signature = (*, max_evaluations=None, max_iterations=None, max_time=None))]
    fn new(max_evaluations: Option<i128>, max_iterations: Option<i128>, max_time: Option<f64>) -> PyResult<Self> {
        if let Some(seconds) = max_time
            && Duration::try_from_secs_f64(seconds).is_err()
        {
            return Err(invalid(format!("max_time must be zero or more seconds, got {seconds}")));
        }
        let stop = Self {
            max_evaluations: optional_count("max_evaluations", max_evaluations)?,
            max_iterations: optional_count("max_iterations", max_iterations)?,
            max_time,
        };
        stop.core().validate().map_err(raise)?;
        Ok(stop)
    }

    fn __repr__(&self) -> String {
        let shown = |value: Option<String>| value.unwrap_or_else(|| "None".into());
        format!(
            "Stop(max_evaluations={}, max_iterations={}, max_time={})",
            shown(self.max_evaluations.map(|v| v.to_string())),
            shown(self.max_iterations.map(|v| v.to_string())),
            shown(self.max_time.map(|v| v.to_string())),
        )
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let options = PyDict::new(py);
        options.set_item("max_evaluations", self.max_evaluations)?;
        options.set_item("max_iterations", self.max_iterations)?;
        options.set_item("max_time", self.max_time)?;
        Ok((PyTuple::empty(py), options))
    }
}

impl PyStop {
    /// With the defaults filled in.
    pub fn core(&self) -> Stop {
        let standard = Stop::default();
        Stop {
            max_evaluations: match (self.max_evaluations, self.max_time) {
                (Some(count), _) => count,
                // Who gives a time and no count means the time.
                (None, Some(_)) => usize::MAX,
                (None, None) => standard.max_evaluations,
            },
            max_iterations: self.max_iterations.unwrap_or(standard.max_iterations),
            max_time: self.max_time.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
            ..standard
        }
    }
}

/// A solver argument.
pub fn any_solver(solver: &Bound<'_, PyAny>) -> PyResult<AnySolver> {
    if let Ok(bas) = solver.cast::<PyBas>() {
        return Ok(AnySolver::Single(Algorithm::Bas(bas.get().0)));
    }
    if let Ok(descent) = solver.cast::<PyLevenbergMarquardt>() {
        return Ok(AnySolver::Single(Algorithm::LevenbergMarquardt(descent.get().0)));
    }
    if let Ok(multi_start) = solver.cast::<PyMultiStart>() {
        return Ok(AnySolver::MultiStart(multi_start.get().0.clone()));
    }
    Err(invalid(format!("solver must be BAS, LevenbergMarquardt or MultiStart, got {}", summary(solver))))
}
