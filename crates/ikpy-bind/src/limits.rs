//! `Limits`.

use ikcore::Error;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::robot::Robot;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{scalar_or_vector, summary};
use crate::error::{invalid, raise};
use crate::robot::PyRobot;
use crate::sinusoid::{Numbers, PySinusoid};

/// What a field of `Limits` was given.
enum Given {
    Numbers(Numbers),
    Sinusoid(PySinusoid),
    Function(Py<PyAny>),
}

impl Given {
    fn read(field: Field, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(sinusoid) = value.cast::<PySinusoid>() {
            return Ok(Self::Sinusoid(sinusoid.get().clone()));
        }
        if value.is_callable() {
            return Ok(Self::Function(value.clone().unbind()));
        }
        Numbers::read(&format!("{field} limit"), value).map(Self::Numbers)
    }

    fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Numbers(numbers) => Self::Numbers(numbers.clone()),
            Self::Sinusoid(sinusoid) => Self::Sinusoid(sinusoid.clone()),
            Self::Function(function) => Self::Function(function.clone_ref(py)),
        }
    }

    /// Functions as Python compares them: two bound methods of one object are equal.
    fn equals(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        match (self, other) {
            (Self::Numbers(one), Self::Numbers(other)) => Ok(one == other),
            (Self::Sinusoid(one), Self::Sinusoid(other)) => Ok(one == other),
            (Self::Function(one), Self::Function(other)) => one.bind(py).eq(other),
            _ => Ok(false),
        }
    }

    fn show<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Numbers(numbers) => numbers.show(py),
            Self::Sinusoid(sinusoid) => Ok(Bound::new(py, sinusoid.clone())?.into_any()),
            Self::Function(function) => Ok(function.bind(py).clone()),
        }
    }

    fn profiles(&self, py: Python<'_>, field: Field, sampling: &Sampling, n: usize) -> PyResult<Vec<Profile>> {
        match self {
            Self::Numbers(numbers) => Ok(numbers.values.iter().map(|value| Profile::Constant(*value)).collect()),
            Self::Sinusoid(sinusoid) => sinusoid.profiles(),
            Self::Function(function) => sampled(function.bind(py), field, sampling, n),
        }
    }
}

/// When functions of time are sampled: before the core runs, since callables never reach its threads.
pub struct Sampling {
    /// Time between samples (s).
    pub step: f64,
    /// Number of samples.
    pub count: usize,
}

impl Sampling {
    /// At both ends and in the middle of each of `ticks` ticks of `dt` seconds.
    pub fn of_ticks(dt: f64, ticks: usize) -> Self {
        Self { step: 0.5 * dt, count: 2 * ticks + 1 }
    }

    /// At t = 0 only.
    pub fn once() -> Self {
        Self { step: 1.0, count: 1 }
    }
}

/// Functions written in C do not look for Ctrl-C themselves: so many calls take some milliseconds.
pub const CALLS_BETWEEN_LOOKS: usize = 4096;

fn sampled(function: &Bound<'_, PyAny>, field: Field, sampling: &Sampling, n: usize) -> PyResult<Vec<Profile>> {
    let mut columns: Vec<Vec<f64>> = vec![];
    for i in 0..sampling.count {
        if i % CALLS_BETWEEN_LOOKS == 0 {
            function.py().check_signals()?;
        }
        let t = i as f64 * sampling.step;
        let what = format!("{field} limit at t = {t} s");
        let (values, _) = scalar_or_vector(&what, &function.call1((t,))?)?;
        if i == 0 {
            columns.resize(values.len(), Vec::with_capacity(sampling.count));
        }
        if values.len() != columns.len() || ![1, n].contains(&values.len()) {
            return Err(invalid(format!(
                "{what}: expected a number, or {n} values at all times, got {}",
                values.len()
            )));
        }
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }
    Ok(columns.into_iter().map(|values| Profile::Sampled { step: sampling.step, values }).collect())
}

/// Limits on joint motion. A field that is given replaces the robot's, a field left None is the robot's, np.inf
/// switches one off.
///
/// Args:
///     lower, upper: positions (rad, m).
///     velocity: rad/s or m/s.
///     acceleration, jerk: rad/s^2 or m/s^2, rad/s^3 or m/s^3.
///
/// Each is a number for all joints, (n,), a `Sinusoid`, or a callable of t (s) that returns a number or (n,). Callables
/// are sampled at the ends and in the middle of every tick. A method that cannot honour a field raises
/// `UnsupportedLimit`; none ignores one.
#[pyclass(name = "Limits", module = "beetle_ik", frozen)]
pub struct PyLimits {
    given: [Option<Given>; 5],
}

/// The fields in the order of `PyLimits::given`.
const FIELDS: [Field; 5] = [Field::Lower, Field::Upper, Field::Velocity, Field::Acceleration, Field::Jerk];

#[pymethods]
impl PyLimits {
    #[new]
    #[pyo3(signature = (*, lower=None, upper=None, velocity=None, acceleration=None, jerk=None))]
    fn new(
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        acceleration: Option<&Bound<'_, PyAny>>,
        jerk: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let mut given = [const { None }; 5];
        for ((slot, field), value) in given.iter_mut().zip(FIELDS).zip([lower, upper, velocity, acceleration, jerk]) {
            *slot = value.map(|value| Given::read(field, value)).transpose()?;
        }
        Ok(Self { given })
    }

    /// Lower position limits (rad, m), as given.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, 0)
    }

    /// Upper position limits (rad, m), as given.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, 1)
    }

    /// Velocity limits (rad/s, m/s), as given.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, 2)
    }

    /// Acceleration limits (rad/s^2, m/s^2), as given.
    #[getter]
    fn acceleration<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, 3)
    }

    /// Jerk limits (rad/s^3, m/s^3), as given.
    #[getter]
    fn jerk<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, 4)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut shown = vec![];
        for (given, field) in self.given.iter().zip(FIELDS) {
            if let Some(given) = given {
                shown.push(format!("{field}={}", summary(&given.show(py)?)));
            }
        }
        Ok(format!("Limits({})", shown.join(", ")))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        let Ok(other) = other.cast::<Self>() else { return Ok(false) };
        for pair in self.given.iter().zip(&other.get().given) {
            let equal = match pair {
                (Some(one), Some(another)) => one.equals(other.py(), another)?,
                (one, another) => one.is_none() && another.is_none(),
            };
            if !equal {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        let options = PyDict::new(py);
        for (given, field) in self.given.iter().zip(FIELDS) {
            if let Some(given) = given {
                options.set_item(field.to_string(), given.show(py)?)?;
            }
        }
        Ok(((), options))
    }
}

impl PyLimits {
    /// The robot's own limits.
    pub fn of(robot: &Robot) -> Self {
        let numbers = |values: Vec<f64>| Some(Given::Numbers(Numbers { values, single: false }));
        let joints = robot.joints();
        Self {
            given: [
                numbers(joints.iter().map(|joint| joint.lower).collect()),
                numbers(joints.iter().map(|joint| joint.upper).collect()),
                numbers(joints.iter().map(|joint| joint.velocity).collect()),
                None,
                None,
            ],
        }
    }

    /// A box.
    pub fn of_box(lower: Vec<f64>, upper: Vec<f64>) -> Self {
        let numbers = |values: Vec<f64>| Some(Given::Numbers(Numbers { values, single: false }));
        Self { given: [numbers(lower), numbers(upper), None, None, None] }
    }

    /// No limits, for `n` joints.
    fn none(n: usize) -> Self {
        let free = |limit: f64| Some(Given::Numbers(Numbers { values: vec![limit; n], single: false }));
        Self { given: [free(f64::NEG_INFINITY), free(f64::INFINITY), free(f64::INFINITY), None, None] }
    }

    /// The limits in force for `robot`: these where given, else the robot's.
    pub fn in_force(&self, py: Python<'_>, robot: &Robot) -> Self {
        self.else_of(py, Self::of(robot))
    }

    /// These where given, else those of `other`.
    fn else_of(&self, py: Python<'_>, other: Self) -> Self {
        let mut given = other.given;
        for (slot, replacement) in given.iter_mut().zip(&self.given) {
            if let Some(replacement) = replacement {
                *slot = Some(replacement.clone_ref(py));
            }
        }
        Self { given }
    }

    /// Err if a field is a callable of t, for motions without a known end.
    pub fn require_no_functions(&self, method: &str, instead: &str) -> PyResult<()> {
        let is_function = |given: &Option<Given>| matches!(given, Some(Given::Function(_)));
        match self.given.iter().position(is_function) {
            None => Ok(()),
            Some(i) => Err(raise(Error::UnsupportedLimit {
                field: format!("callable {}", FIELDS[i]),
                method: method.into(),
                remedy: format!("it has no end to be sampled to; give numbers or a Sinusoid, or use {instead}"),
            })),
        }
    }

    /// The same for the core, functions of time sampled.
    pub fn resolve(&self, py: Python<'_>, robot: &Robot, sampling: &Sampling) -> PyResult<Limits> {
        self.applied_to(py, Limits::of(robot), robot.dof(), sampling)
    }

    /// The same for joints that belong to no robot: none where no limit is given.
    pub fn for_joints(&self, py: Python<'_>, joints: &[String]) -> PyResult<Limits> {
        self.applied_to(py, Limits::none(joints.to_vec()), joints.len(), &Sampling::once())
    }

    fn applied_to(&self, py: Python<'_>, mut limits: Limits, n: usize, sampling: &Sampling) -> PyResult<Limits> {
        for (given, field) in self.given.iter().zip(FIELDS) {
            if let Some(given) = given {
                limits = limits.replace(field, given.profiles(py, field, sampling, n)?).map_err(raise)?;
            }
        }
        Ok(limits)
    }

    fn show<'py>(&self, py: Python<'py>, field: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.given[field].as_ref().map(|given| given.show(py)).transpose()
    }
}

/// The limits of a call: those in force, for the result, and for the core those that differ from the robot's own.
pub fn limits_of_call(
    py: Python<'_>,
    limits: Option<&PyLimits>,
    robot: &PyRobot,
    sampling: &Sampling,
) -> PyResult<(Py<PyLimits>, Option<Limits>)> {
    match limits {
        None => Ok((robot.limits(py)?, None)),
        Some(limits) => {
            let in_force = Py::new(py, limits.in_force(py, &robot.core))?;
            Ok((in_force, Some(limits.resolve(py, &robot.core, sampling)?)))
        }
    }
}

/// The limits of a call that knows no robot, for `n` joints: for the result and for the core.
pub fn limits_without_robot(
    py: Python<'_>,
    limits: Option<&PyLimits>,
    n: usize,
    sampling: &Sampling,
) -> PyResult<(Py<PyLimits>, Limits)> {
    let none = PyLimits::none(n);
    match limits {
        None => Ok((Py::new(py, none)?, Limits::none_for(n))),
        Some(limits) => {
            let resolved = limits.applied_to(py, Limits::none_for(n), n, sampling)?;
            Ok((Py::new(py, limits.else_of(py, none))?, resolved))
        }
    }
}
