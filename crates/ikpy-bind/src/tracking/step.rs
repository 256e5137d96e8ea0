//! `Step`.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use ikcore::limits::JointOutside;
use ikcore::math::pose::Drift;
use ikcore::message::Message;
use ikcore::obstacle::{ClearSpace, Clearance, Contact, NearestContact};
use ikcore::solver::Status;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::TipError;
use ikcore::tracking::Step;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::row;
use crate::error::raise;
use crate::limits::PyLimits;
use crate::obstacle::PyNearest;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::tips::TipErrors;
use crate::traversal::traversed;
use crate::wording::said;

/// The result of one step of a `Tracker` or a `ControlSession`.
#[pyclass(name = "Step", module = "beetle_ik", frozen)]
pub struct PyStep {
    core: Step,
    /// The configuration to command (n,) (rad, m).
    #[pyo3(get)]
    q: Py<PyArray1<f64>>,
    /// The joint velocity over the step (n,) (rad/s, m/s).
    #[pyo3(get)]
    qd: Py<PyArray1<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    elapsed: Duration,
    /// Joints that began outside their limits, if any still was.
    outside: Vec<JointOutside>,
    /// Errors by tip.
    tips: TipErrors,
    /// Names of the joints, if the message may name some.
    joints: Vec<String>,
    /// Clear space and configuration of the arm; `None` without obstacles and self-collision.
    among: Option<(Arc<ClearSpace<'static>>, Vec<f64>)>,
    /// Names the joints that limits of zero lock.
    lock: Option<Arc<Message>>,
    /// The constraint that holds the arm, or the levels of its targets, in words.
    held_by: Option<String>,
    /// Sentence about a target whose rotation had drifted.
    drift: Option<String>,
    /// Clearance, computed at the first access; `None` without obstacles and self-collision.
    around: OnceLock<Option<Clearance>>,
}

traversed!(PyStep: limits);

outcome! {
    PyStep = |result|
    /// Whether the tip is within the tolerances.
    success,
    /// SOLVED within the tolerances; IN_COLLISION nearer than the margin to an obstacle or between links;
    /// HELD_BY_OBSTACLE if an obstacle keeps the tip from the target; HELD_BY_CONSTRAINT if what is to be kept does;
    /// HELD_BY_TORQUE if a torque limit does, or is exceeded by what the arm carries;
    /// LEVEL_GIVEN_UP if the lowest level of the targets of several tips is met, not all;
    /// IMPROVED if nearer than in the previous step; otherwise CAPPED.
    status: result.core.status,
    message: result.sentence(),
    /// Evaluations of the forward kinematics.
    evaluations: result.core.evaluations,
    elapsed: result.elapsed,
}

#[pymethods]
impl PyStep {
    /// Errors of each target, by the keys of the last call or the name of the only tip: {tip: (position (m), rotation (rad))}, as
    /// `position_error` and `rotation_error`; empty before the first target of several tips.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.tips.dict(py, std::iter::once(self.core.error), |errors| {
            errors.next().map(|TipError { position, rotation }| (position, rotation))
        })
    }

    /// Distance of the tip from the target (m); the largest of several tips.
    #[getter]
    fn position_error(&self) -> f64 {
        self.core.error.position
    }

    /// Geodesic angle to the target's orientation (rad), the largest of several tips; NaN if the task leaves the orientation free.
    #[getter]
    fn rotation_error(&self) -> f64 {
        self.core.error.rotation
    }

    /// Whether the step keeps all limits; False if a joint cannot be brought within its position limits, or slowed down
    /// to its velocity limit.
    #[getter]
    fn inside_limits(&self) -> bool {
        self.core.inside_limits
    }

    /// Smallest distance (m) between the robot and obstacles, or between two of its links, at `q`; negative by the depth of an overlap.
    /// NaN where nothing is checked; inf if nothing can touch.
    #[getter]
    fn clearance(&self) -> f64 {
        self.around().as_ref().map_or(f64::NAN, |clearance| clearance.distance)
    }

    /// The nearest two bodies at `q`, a `Nearest`; None where nothing is checked, or if nothing can touch.
    #[getter]
    fn nearest(&self) -> Option<PyNearest> {
        self.around().as_ref()?.nearest.clone().map(PyNearest::from)
    }

    fn __repr__(&self) -> String {
        format!("<Step {}: {}>", self.core.status.name(), self.message())
    }
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let (q, qd) = (self.q.bind(py).readonly(), self.qd.bind(py).readonly());
        let around = self.around();
        let state = (self.core, q.as_slice()?, qd.as_slice()?, self.elapsed, around, &self.outside, &self.joints);
        let bytes = pickling::bytes(py, to_bytes("step", &state))?;
        let lock = self.lock.as_deref().map(said);
        pickling::restored_from::<Self>(
            py,
            (bytes, &self.limits, self.tips.bytes(py)?, lock, &self.drift, &self.held_by),
        )
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (bytes, limits, tips=None, lock=None, drift=None, held_by=None))]
    fn _restore(
        py: Python<'_>,
        bytes: &[u8],
        limits: Py<PyLimits>,
        tips: Option<&[u8]>,
        lock: Option<String>,
        drift: Option<String>,
        held_by: Option<String>,
    ) -> PyResult<Self> {
        let (core, q, qd, elapsed, around, outside, joints): (_, Vec<f64>, Vec<f64>, _, Option<Clearance>, _, _) =
            from_bytes("step", bytes).map_err(raise)?;
        let tips = TipErrors::restored(tips)?;
        let step = Self::new(py, core, [q, qd], limits, elapsed).of_tips(tips).led_from(outside).naming(joints);
        let lock = lock.map(|lock| Arc::new(lock.into()));
        Ok(Self { around: OnceLock::from(around), lock, drift, held_by, ..step })
    }
}

impl PyStep {
    /// Makes a step; `motion` is the configuration to command and the joint velocity over the step.
    pub fn new(py: Python<'_>, core: Step, motion: [Vec<f64>; 2], limits: Py<PyLimits>, elapsed: Duration) -> Self {
        let [q, qd] = motion.map(|values| row(py, values).unbind());
        Self {
            core,
            q,
            qd,
            limits,
            elapsed,
            outside: vec![],
            tips: TipErrors::unnamed(),
            joints: vec![],
            among: None,
            lock: None,
            held_by: None,
            drift: None,
            around: OnceLock::new(),
        }
    }

    /// Adds the joints that began outside their limits.
    pub fn led_from(self, outside: Vec<JointOutside>) -> Self {
        Self { outside, ..self }
    }

    /// Adds the errors by tip.
    pub fn of_tips(self, tips: TipErrors) -> Self {
        Self { tips, ..self }
    }

    /// Adds the drift of the target's rotation to the message.
    pub fn of_drifted_target(self, drift: Option<Drift>) -> Self {
        Self { drift: drift.map(|drift| drift.to_string()), ..self }
    }

    /// Adds the constraint that holds the arm, in words.
    pub fn held_by(self, held_by: Option<String>) -> Self {
        Self { held_by, ..self }
    }

    /// Adds the names of the joints.
    pub fn naming(self, joints: Vec<String>) -> Self {
        Self { joints, ..self }
    }

    /// Adds the clear space of an arm, and its configuration `q`.
    pub fn among(self, space: Option<Arc<ClearSpace<'static>>>, q: Vec<f64>) -> Self {
        Self { among: space.map(|space| (space, q)), ..self }
    }

    /// Adds the joints that limits of zero lock.
    pub fn of_locked(self, lock: Option<Arc<Message>>) -> Self {
        Self { lock, ..self }
    }

    fn around(&self) -> &Option<Clearance> {
        self.around.get_or_init(|| self.among.as_ref().map(|(space, q)| space.clearance(q)))
    }

    /// Returns the message: the outcome, advice, and the body in the way.
    fn sentence(&self) -> Message {
        let nearest = self.around().as_ref().and_then(|clearance| clearance.nearest.as_ref());
        let lock = self.lock.as_ref().filter(|_| self.core.status == Status::Capped && self.core.idle.is_none());
        let advice = match (lock, nearest) {
            (Some(lock), _) => Message::clone(lock),
            (_, Some(nearest)) => self.core.advice_near(&nearest.contact),
            _ => self.core.status.advice(),
        };
        // A lock is the reason why the arm stays away.
        let step = if lock.is_some() { Step { away: None, ..self.core } } else { self.core };
        let message = step.message_with(advice, &self.outside, |j| self.joints.get(j).cloned().unwrap_or_default());
        let message = match &self.drift {
            Some(drift) => format!("{}; {drift}", said(&message)).into(),
            None => message,
        };
        match (self.core.status, nearest) {
            (Status::HeldByObstacle | Status::InCollision, Some(NearestContact { contact, .. })) => {
                let Contact { link, other, distance } = contact;
                format!("{} ({link} is {distance:.4} m from {other})", said(&message)).into()
            }
            _ => match &self.held_by {
                Some(held_by) => format!("{} ({held_by})", said(&message)).into(),
                None => message,
            },
        }
    }
}
