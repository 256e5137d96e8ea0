//! `goals`: secondary objectives in the null space of the task.

use ikcore::manipulability::Motion;
use ikcore::task::Goal;
use numpy::PyArray1;
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::{row, scalar_or_vector, summary, vector};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::NewArguments;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyGoal>()?;
    module.add_class::<PyPosture>()?;
    module.add_class::<PyCentring>()?;
    module.add_class::<PyManipulability>()?;
    module.add_class::<PyLinkManipulability>()?;
    module.add_class::<PyClearance>()?;
    module.add_class::<PyLeastTorque>()
}

/// A secondary objective, optimised in the null space of the task: `Posture`, `Centring`, `Manipulability`,
/// `LinkManipulability`, `Clearance` or `LeastTorque`.
#[pyclass(name = "Goal", module = "beetle_ik.goals", frozen, subclass, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyGoal {
    core: Goal,
}

#[pymethods]
impl PyGoal {
    /// Weight relative to other goals; of a `Posture` with a weight for each joint (n,).
    #[getter]
    fn weight<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.core {
            Goal::WeightedPosture { weights, .. } => Ok(row(py, weights.clone()).into_any()),
            other => Ok(other.weight().into_pyobject(py)?.into_any()),
        }
    }

    fn __repr__(&self) -> String {
        let weight = self.core.weight();
        match &self.core {
            Goal::Posture { posture, .. } => format!("goals.Posture({posture:?}, weight={weight:?})"),
            Goal::WeightedPosture { posture, weights } => format!("goals.Posture({posture:?}, weight={weights:?})"),
            Goal::Centring { .. } => format!("goals.Centring(weight={weight:?})"),
            Goal::Manipulability { motion, tip: None, .. } => {
                format!("goals.Manipulability(motion='{motion}', weight={weight:?})")
            }
            Goal::Manipulability { motion, tip: Some(tip), .. } => {
                format!("goals.Manipulability(motion='{motion}', tip='{tip}', weight={weight:?})")
            }
            Goal::LinkManipulability { motion, .. } => {
                format!("goals.LinkManipulability(motion='{motion}', weight={weight:?})")
            }
            Goal::Clearance { up_to, .. } => format!("goals.Clearance(weight={weight:?}, up_to={up_to:?})"),
            Goal::LeastTorque { relative_to: None, .. } => format!("goals.LeastTorque(weight={weight:?})"),
            Goal::LeastTorque { relative_to: Some(scale), .. } => {
                format!("goals.LeastTorque(relative_to={scale:?}, weight={weight:?})")
            }
        }
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let options = PyDict::new(py);
        options.set_item("weight", self.weight(py)?)?;
        let arguments = match &self.core {
            Goal::Posture { posture, .. } | Goal::WeightedPosture { posture, .. } => {
                PyTuple::new(py, [row(py, posture.clone())])?
            }
            Goal::Centring { .. } => PyTuple::empty(py),
            Goal::Manipulability { motion, tip, .. } => {
                options.set_item("motion", motion.name())?;
                if let Some(tip) = tip {
                    options.set_item("tip", tip)?;
                }
                PyTuple::empty(py)
            }
            Goal::LinkManipulability { motion, .. } => {
                options.set_item("motion", motion.name())?;
                PyTuple::empty(py)
            }
            Goal::Clearance { up_to, .. } => {
                options.set_item("up_to", *up_to)?;
                PyTuple::empty(py)
            }
            Goal::LeastTorque { relative_to, .. } => {
                if let Some(scale) = relative_to {
                    options.set_item("relative_to", row(py, scale.clone()))?;
                }
                PyTuple::empty(py)
            }
        };
        Ok((arguments, options))
    }
}

/// Makes an instance of a goal class; the class itself adds no fields.
fn made<C>(core: Goal, class: C) -> PyResult<PyClassInitializer<C>>
where
    C: PyClass<BaseType = PyGoal>,
{
    core.validate_numbers().map_err(raise)?;
    Ok(PyClassInitializer::from(PyGoal { core }).add_subclass(class))
}

/// Stays close to a posture: minimises weight * |q - posture|^2 or, with a weight for each joint, the sum of
/// (weight * (q - posture))^2.
///
/// Args:
///     posture: (n,) (rad, m).
///     weight: weight relative to other goals; or the cost of moving each joint (n,): joints of a large weight move little
///         where others can do it, such as a base that is to stay while the arm moves.
#[pyclass(name = "Posture", module = "beetle_ik.goals", extends = PyGoal, frozen)]
pub struct PyPosture;

#[pymethods]
impl PyPosture {
    #[new]
    #[pyo3(signature = (posture, *, weight=None), text_signature = "(posture, *, weight=1.0)")]
    fn new(posture: &Bound<'_, PyAny>, weight: Option<&Bound<'_, PyAny>>) -> PyResult<PyClassInitializer<Self>> {
        let posture = vector("posture", posture)?;
        let goal = match weight.map(|weight| scalar_or_vector("weight", weight)).transpose()? {
            None => Goal::Posture { posture, weight: 1.0 },
            Some((weights, true)) => Goal::Posture { posture, weight: weights[0] },
            Some((weights, false)) => Goal::WeightedPosture { posture, weights },
        };
        made(goal, Self)
    }

    /// The posture (n,) (rad, m).
    #[getter]
    fn posture<'py>(self_: PyRef<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        let py = self_.py();
        match &self_.as_super().core {
            Goal::Posture { posture, .. } | Goal::WeightedPosture { posture, .. } => Some(row(py, posture.clone())),
            _ => None,
        }
    }
}

/// Stays away from the joint limits: minimises the sum of ((q - middle) / range)^2 over the joints that have limits.
///
/// Args:
///     weight: weight relative to other goals.
#[pyclass(name = "Centring", module = "beetle_ik.goals", extends = PyGoal, frozen)]
pub struct PyCentring;

#[pymethods]
impl PyCentring {
    #[new]
    #[pyo3(signature = (*, weight=1.0))]
    fn new(weight: f64) -> PyResult<PyClassInitializer<Self>> {
        made(Goal::Centring { weight }, Self)
    }
}

/// Stays away from singularities: minimises -ln w, where w is Yoshikawa's index.
///
/// Args:
///     motion: motion of the tip that counts, "pose", "position" or "rotation", as in `Robot.manipulability`.
///     tip: the tip, of a robot with several; None: the only one.
///     weight: weight relative to other goals.
#[pyclass(name = "Manipulability", module = "beetle_ik.goals", extends = PyGoal, frozen)]
pub struct PyManipulability;

#[pymethods]
impl PyManipulability {
    #[new]
    #[pyo3(signature = (*, motion="pose", tip=None, weight=1.0))]
    fn new(motion: &str, tip: Option<String>, weight: f64) -> PyResult<PyClassInitializer<Self>> {
        let motion = motion.parse::<Motion>().map_err(raise)?;
        made(Goal::Manipulability { motion, tip, weight }, Self)
    }
}

/// Keeps the whole arm away from singularities: minimises -ln of the sum of `Robot.link_manipulability`, so that no two
/// successive links become collinear.
///
/// Args:
///     motion: motion of the link tips that counts, "pose", "position" or "rotation", as in `Robot.manipulability`.
///     weight: weight relative to other goals.
#[pyclass(name = "LinkManipulability", module = "beetle_ik.goals", extends = PyGoal, frozen)]
pub struct PyLinkManipulability;

#[pymethods]
impl PyLinkManipulability {
    #[new]
    #[pyo3(signature = (*, motion="position", weight=1.0))]
    fn new(motion: &str, weight: f64) -> PyResult<PyClassInitializer<Self>> {
        let motion = motion.parse::<Motion>().map_err(raise)?;
        made(Goal::LinkManipulability { motion, weight }, Self)
    }
}

/// Stays away from obstacles, and links from each other: minimises the sum of ((up_to - d) / up_to)^2 over all pairs of
/// bodies whose distance d is below `up_to`. It needs a call with `obstacles=` or `self_collision=True`, whose margin
/// holds in addition.
///
/// Args:
///     weight: weight relative to other goals.
///     up_to: distance beyond which a pair no longer counts (m).
#[pyclass(name = "Clearance", module = "beetle_ik.goals", extends = PyGoal, frozen)]
pub struct PyClearance;

#[pymethods]
impl PyClearance {
    #[new]
    #[pyo3(signature = (*, weight=1.0, up_to=0.1))]
    fn new(weight: f64, up_to: f64) -> PyResult<PyClassInitializer<Self>> {
        made(Goal::Clearance { up_to, weight }, Self)
    }

    /// Distance beyond which a pair no longer counts (m).
    #[getter]
    fn up_to(self_: PyRef<'_, Self>) -> f64 {
        match self_.as_super().core {
            Goal::Clearance { up_to, .. } => up_to,
            _ => f64::NAN,
        }
    }
}

/// Holds the arm up with little torque: minimises the sum of (torque / scale)^2 over the joints, with the torques of `Robot.torques(q)`,
/// payload and gravity included. It needs a robot with masses (`Robot.has_dynamics`).
///
/// Args:
///     relative_to: torque (n,) (N m, N) that the torque of each joint is divided by; inf: the joint does not count. None: the torque limits
///         of the robot, `Robot.torque_limit`, so that joints without one do not count; where no joint has one, all count alike. A
///         floating base has no motors, and never counts.
///     weight: weight relative to other goals.
#[pyclass(name = "LeastTorque", module = "beetle_ik.goals", extends = PyGoal, frozen)]
pub struct PyLeastTorque;

#[pymethods]
impl PyLeastTorque {
    #[new]
    #[pyo3(signature = (*, relative_to=None, weight=1.0))]
    fn new(relative_to: Option<&Bound<'_, PyAny>>, weight: f64) -> PyResult<PyClassInitializer<Self>> {
        let relative_to = relative_to.map(|scale| vector("relative_to", scale)).transpose()?;
        made(Goal::LeastTorque { relative_to, weight }, Self)
    }

    /// Torque (n,) (N m, N) that the torque of each joint is divided by; None: its torque limit.
    #[getter]
    fn relative_to<'py>(self_: PyRef<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        let py = self_.py();
        match &self_.as_super().core {
            Goal::LeastTorque { relative_to, .. } => relative_to.clone().map(|scale| row(py, scale)),
            _ => None,
        }
    }
}

/// Reads the `goals` argument of a call: None, one goal or several.
pub fn read_goals(value: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Goal>> {
    let Some(value) = value else { return Ok(vec![]) };
    let core = |goal: &Bound<'_, PyAny>| goal.cast::<PyGoal>().map(|goal| goal.get().core.clone()).ok();
    if let Some(goal) = core(value) {
        return Ok(vec![goal]);
    }
    let wrong = || invalid(format!("goals must be one or several of beetle_ik.goals, got {}", summary(value)));
    value.try_iter().map_err(|_| wrong())?.map(|goal| core(&goal?).ok_or_else(wrong)).collect()
}
