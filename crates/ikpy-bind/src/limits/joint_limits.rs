//! `Limits`: the given fields, and the limits in force.

use ikcore::Error;
use ikcore::limits::{Field, Limits, TipField};
use ikcore::robot::Robot;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::given::GivenLimit;
use super::of_tips::{GivenTips, keyword};
use super::per_joint::PerJoint;
use super::sampling::Sampling;
use crate::error::{limit_error, raise};
use crate::hash::content_hash;
use crate::options::NewArguments;
use crate::traversal::traversed;

/// Limits on joint motion. A given field replaces the robot's limit, None keeps the robot's limit, and np.inf removes it.
///
/// Args:
///     lower, upper: position limits (rad, m).
///     velocity: velocity limits (rad/s, m/s).
///     acceleration, jerk: acceleration limits (rad/s^2, m/s^2) and jerk limits (rad/s^3, m/s^3).
///     tip_speed, tip_acceleration, tip_turn_speed: limits of the motion of the robot's tips, seen from its base: speed of the tip's
///         origin (m/s), its acceleration (m/s^2), and how fast the tip turns (rad/s). A number for all tips, or a dict by tip; None: no
///         limit. Planned motions keep them at every instant, not only at samples.
///     torque: limits of the torques of the joints (N m, N), a number or (n,); `robot.torque_limit` has those of the robot's file. None: not
///         limited. Planned motions keep them at every instant, with the masses, payload, gravity and friction of the robot; they do not
///         count on friction where it would help.
///
/// Limits of joints are a number for all joints, (n,), a `Sinusoid`, or a callable of t (s) that returns a number or (n,). Callables
/// are sampled at the ends and in the middle of each tick. A method that cannot keep a limit raises `UnsupportedLimit`;
/// no limit is ignored.
///
/// For example, a cobot whose tool moves at 0.25 m/s at most:
///
///     >>> limits = bik.Limits(velocity=2.0, acceleration=8.0, tip_speed=0.25)
///     >>> plan = bik.plan_point_to_point(bik.Robot.named("ur5e"), start_q=[0, -1.5, 1.5, 0, 0, 0], end_q=[1, -1, 1, 0, 0, 0], limits=limits)
///     >>> plan.success
///     True
///
/// Raises:
///     LimitError: a negative limit; a limit of a tip that is not positive.
///     InvalidInputError: NaN, no number, or a dict that is not by tip.
#[pyclass(name = "Limits", module = "beetle_ik", frozen)]
pub struct PyLimits {
    /// Given values, in the order of [`FIELDS`].
    given: [Option<GivenLimit>; 5],
    /// Given limits of tips, in the order of [`TipField::ALL`].
    tips: [Option<GivenTips>; 3],
    /// Given torque limits.
    torque: Option<PerJoint>,
}

traversed!(PyLimits: given);

const NO_TIPS: [Option<GivenTips>; 3] = [const { None }; 3];

const FIELDS: [Field; 5] = [Field::Lower, Field::Upper, Field::Velocity, Field::Acceleration, Field::Jerk];

#[pymethods]
impl PyLimits {
    #[new]
    #[pyo3(signature = (*, lower=None, upper=None, velocity=None, acceleration=None, jerk=None, tip_speed=None,
                        tip_acceleration=None, tip_turn_speed=None, torque=None))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        acceleration: Option<&Bound<'_, PyAny>>,
        jerk: Option<&Bound<'_, PyAny>>,
        tip_speed: Option<&Bound<'_, PyAny>>,
        tip_acceleration: Option<&Bound<'_, PyAny>>,
        tip_turn_speed: Option<&Bound<'_, PyAny>>,
        torque: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let mut given = [const { None }; 5];
        for ((slot, field), value) in given.iter_mut().zip(FIELDS).zip([lower, upper, velocity, acceleration, jerk]) {
            *slot = value.map(|value| GivenLimit::read(field, value)).transpose()?;
            if let Some(GivenLimit::Numbers(numbers)) = slot
                && !matches!(field, Field::Lower | Field::Upper)
                && let Some((j, value)) = numbers.values.iter().enumerate().find(|(_, value)| **value < 0.0)
            {
                let joint = if numbers.single { String::new() } else { format!(" of joint {}", j + 1) };
                return Err(limit_error(format!("{field} limit{joint} is {value}: a limit cannot be negative")));
            }
        }
        let mut tips = [const { None }; 3];
        let of_tips = [tip_speed, tip_acceleration, tip_turn_speed];
        for ((slot, field), value) in tips.iter_mut().zip(TipField::ALL).zip(of_tips) {
            *slot = value.map(|value| GivenTips::read(field, value)).transpose()?;
        }
        Ok(Self { given, tips, torque: torque.map(torque_limit).transpose()? })
    }

    /// Lower position limits (rad, m), as given.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, Field::Lower)
    }

    /// Upper position limits (rad, m), as given.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, Field::Upper)
    }

    /// Velocity limits (rad/s, m/s), as given.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, Field::Velocity)
    }

    /// Acceleration limits (rad/s^2, m/s^2), as given.
    #[getter]
    fn acceleration<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, Field::Acceleration)
    }

    /// Jerk limits (rad/s^3, m/s^3), as given.
    #[getter]
    fn jerk<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show(py, Field::Jerk)
    }

    /// Limits of the speed of tips (m/s), as given.
    #[getter]
    fn tip_speed<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show_tips(py, TipField::Speed)
    }

    /// Limits of the acceleration of tips (m/s^2), as given.
    #[getter]
    fn tip_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show_tips(py, TipField::Acceleration)
    }

    /// Limits of how fast tips turn (rad/s), as given.
    #[getter]
    fn tip_turn_speed<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.show_tips(py, TipField::TurnSpeed)
    }

    /// Limits of the torques of the joints (N m, N), as given.
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.torque.as_ref().map(|given| given.show(py)).transpose()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let mut shown = vec![];
        for (given, field) in self.given.iter().zip(FIELDS) {
            if let Some(given) = given {
                shown.push(format!("{field}={}", given.repr(py)));
            }
        }
        for (given, field) in self.tips() {
            shown.push(format!("{}={}", keyword(field), given.repr()));
        }
        if let Some(torque) = &self.torque {
            shown.push(format!("torque={}", torque.repr()));
        }
        Ok(format!("Limits({})", shown.join(", ")))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        let Ok(other) = other.cast::<Self>() else { return Ok(false) };
        if self.tips != other.get().tips || self.torque != other.get().torque {
            return Ok(false);
        }
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

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let fields = self.given.iter().map(|given| given.as_ref().map(|given| given.hash(py)).transpose());
        let mut hashes = fields.collect::<PyResult<Vec<_>>>()?;
        hashes.extend(self.tips.iter().map(|given| given.as_ref().map(|given| content_hash(given) as isize)));
        hashes.push(self.torque.as_ref().map(|given| content_hash(given) as isize));
        PyTuple::new(py, hashes)?.hash()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let options = PyDict::new(py);
        for (given, field) in self.given.iter().zip(FIELDS) {
            if let Some(given) = given {
                options.set_item(field.to_string(), given.show(py)?)?;
            }
        }
        for (given, field) in self.tips() {
            options.set_item(keyword(field), given.show(py)?)?;
        }
        if let Some(torque) = &self.torque {
            options.set_item("torque", torque.show(py)?)?;
        }
        Ok((PyTuple::empty(py), options))
    }
}

impl PyLimits {
    /// Returns the robot's own limits.
    pub fn of(robot: &Robot) -> Self {
        let joints = robot.joints();
        Self {
            given: [
                numbers(joints.iter().map(|joint| joint.lower).collect()),
                numbers(joints.iter().map(|joint| joint.upper).collect()),
                numbers(joints.iter().map(|joint| joint.velocity).collect()),
                None,
                None,
            ],
            tips: NO_TIPS,
            torque: None,
        }
    }

    /// Returns the robot's limits plus the maker's acceleration and jerk limits, where known. Unknown velocity limits are left out:
    /// given infinite ones would say that jumps are meant.
    pub fn rated(robot: &Robot) -> Self {
        let mut limits = Self::of(robot);
        let known = |values: Vec<f64>| if values.iter().any(|v| v.is_finite()) { numbers(values) } else { None };
        limits.given[Field::Velocity as usize] = known(robot.joints().iter().map(|j| j.velocity).collect());
        let joints = robot.joints().iter();
        limits.given[Field::Acceleration as usize] = known(joints.clone().map(|j| j.rated_acceleration).collect());
        limits.given[Field::Jerk as usize] = known(joints.map(|j| j.rated_jerk).collect());
        limits
    }

    /// Returns position limits alone.
    pub fn of_box(lower: Vec<f64>, upper: Vec<f64>) -> Self {
        Self { given: [numbers(lower), numbers(upper), None, None, None], tips: NO_TIPS, torque: None }
    }

    /// Returns infinite limits for `n` joints.
    pub(super) fn none(n: usize) -> Self {
        let free = |limit: f64| numbers(vec![limit; n]);
        let given = [free(f64::NEG_INFINITY), free(f64::INFINITY), free(f64::INFINITY), None, None];
        Self { given, tips: NO_TIPS, torque: None }
    }

    /// Returns the limits in force for `robot`: these, with missing fields from the robot.
    pub fn in_force(&self, py: Python<'_>, robot: &Robot) -> Self {
        self.else_of(py, Self::of(robot))
    }

    /// Returns these limits, with missing fields from `other`.
    pub(super) fn else_of(&self, py: Python<'_>, other: Self) -> Self {
        let mut given = other.given;
        for (slot, replacement) in given.iter_mut().zip(&self.given) {
            if let Some(replacement) = replacement {
                *slot = Some(replacement.clone_ref(py));
            }
        }
        Self { given, tips: self.tips.clone(), torque: self.torque.clone() }
    }

    /// Refuses callables of t, for motions without a known end.
    pub fn require_no_functions(&self, method: &str, instead: &str) -> PyResult<()> {
        let is_function = |given: &Option<GivenLimit>| matches!(given, Some(GivenLimit::Function(_)));
        match self.given.iter().position(is_function) {
            None => Ok(()),
            Some(i) => Err(raise(Error::UnsupportedLimit {
                field: format!("callable {}", FIELDS[i]),
                method: method.into(),
                remedy: format!(
                    "it has no end time up to which to sample; give numbers or a Sinusoid, or use {instead}"
                )
                .into(),
            })),
        }
    }

    /// Converts the limits for the core; samples functions of time.
    pub fn resolve(&self, py: Python<'_>, robot: &Robot, sampling: &Sampling) -> PyResult<Limits> {
        let limits = self.applied_to(py, Limits::of(robot), robot.dof(), sampling)?;
        self.with_tips_and_torque(limits, Some(robot))
    }

    /// Converts the limits for joints without a robot; missing fields are unlimited.
    pub fn for_joints(&self, py: Python<'_>, joints: &[String]) -> PyResult<Limits> {
        let limits = self.applied_to(py, Limits::none(joints.to_vec()), joints.len(), &Sampling::once())?;
        self.with_tips_and_torque(limits, None)
    }

    pub(super) fn applied_to(
        &self,
        py: Python<'_>,
        mut limits: Limits,
        n: usize,
        sampling: &Sampling,
    ) -> PyResult<Limits> {
        for (given, field) in self.given.iter().zip(FIELDS) {
            if let Some(given) = given {
                limits = limits.replace(field, given.profiles(py, field, sampling, n)?).map_err(raise)?;
            }
        }
        Ok(limits)
    }

    /// Adds the limits of tips and torques.
    pub(super) fn with_tips_and_torque(&self, mut limits: Limits, robot: Option<&Robot>) -> PyResult<Limits> {
        for (given, field) in self.tips() {
            limits = limits.with_tip_limit(field, given.values(robot)?).map_err(raise)?;
        }
        match &self.torque {
            Some(torque) => limits.with_torque_limit(torque.values.clone()).map_err(raise),
            None => Ok(limits),
        }
    }

    /// The given limits of tips.
    fn tips(&self) -> impl Iterator<Item = (&GivenTips, TipField)> {
        self.tips.iter().zip(TipField::ALL).filter_map(|(given, field)| Some((given.as_ref()?, field)))
    }

    fn show_tips<'py>(&self, py: Python<'py>, field: TipField) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.tips[field as usize].as_ref().map(|given| given.show(py)).transpose()
    }

    fn show<'py>(&self, py: Python<'py>, field: Field) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.given[field as usize].as_ref().map(|given| given.show(py)).transpose()
    }
}

/// Reads torque limits.
fn torque_limit(value: &Bound<'_, PyAny>) -> PyResult<PerJoint> {
    let given = PerJoint::read("torque limit", value)?;
    match given.values.iter().position(|limit| !(*limit > 0.0)) {
        None => Ok(given),
        Some(j) => {
            let joint = if given.single { String::new() } else { format!(" of joint {}", j + 1) };
            let limit = given.values[j];
            Err(limit_error(format!("torque limit{joint} is {limit}: it must be positive; np.inf means no limit")))
        }
    }
}

/// Makes a field with one number per joint.
fn numbers(values: Vec<f64>) -> Option<GivenLimit> {
    Some(GivenLimit::Numbers(PerJoint { values, single: false }))
}
