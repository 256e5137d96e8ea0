//! `Step`.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use ikcore::limits::JointOutside;
use ikcore::message::Message;
use ikcore::obstacle::{ClearSpace, Clearance, Contact, NearestContact};
use ikcore::solver::Status;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::TipError;
use ikcore::tracking::Step;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::copied;
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
    pub core: Step,
    /// The configuration to command (n,) (rad, m).
    #[pyo3(get)]
    pub q: Py<PyArray1<f64>>,
    /// The joint velocity over the step (n,) (rad/s, m/s).
    #[pyo3(get)]
    pub qd: Py<PyArray1<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    pub limits: Py<PyLimits>,
    pub elapsed: Duration,
    /// Errors by tip.
    pub tips: TipErrors,
    pub remarks: Remarks,
    /// Clear space and configuration of the arm; `None` without obstacles and self-collision.
    pub among: Option<(Arc<ClearSpace<'static>>, Vec<f64>)>,
    /// Clearance, computed at the first access; `None` without obstacles and self-collision.
    pub around: OnceLock<Option<Box<Clearance>>>,
}

/// Remarks of the message of a step, besides its outcome.
#[derive(Debug, Default)]
pub struct Remarks {
    /// Joints that began outside their limits, if any still was.
    pub outside: Vec<JointOutside>,
    /// Names of the joints, if the message may name some.
    pub joints: Vec<String>,
    /// Names the joints that limits of zero lock.
    pub lock: Option<Arc<Message>>,
    /// The constraint that holds the arm, or the levels of its targets, in words.
    pub held_by: Option<String>,
    /// Sentence about a target whose rotation had drifted.
    pub drift: Option<String>,
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
        self.around().map_or(f64::NAN, |clearance| clearance.distance)
    }

    /// The nearest two bodies at `q`, a `Nearest`; None where nothing is checked, or if nothing can touch.
    #[getter]
    fn nearest(&self) -> Option<PyNearest> {
        self.around()?.nearest.clone().map(PyNearest::from)
    }

    fn __repr__(&self) -> String {
        format!("<Step {}: {}>", self.core.status.name(), self.message())
    }
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let (q, qd) = (self.q.bind(py).readonly(), self.qd.bind(py).readonly());
        let Remarks { outside, joints, lock, held_by, drift } = &self.remarks;
        let state = (self.core, q.as_slice()?, qd.as_slice()?, self.elapsed, self.around(), outside, joints);
        let bytes = pickling::bytes(py, to_bytes("step", &state))?;
        let lock = lock.as_deref().map(said);
        pickling::restored_from::<Self>(py, (bytes, &self.limits, self.tips.bytes(py)?, lock, drift, held_by))
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
        let (core, q, qd, elapsed, around, outside, joints): (_, Vec<f64>, Vec<f64>, _, Option<Box<Clearance>>, _, _) =
            from_bytes("step", bytes).map_err(raise)?;
        let lock = lock.map(|lock| Arc::new(lock.into()));
        Ok(Self {
            core,
            q: copied(py, &q).unbind(),
            qd: copied(py, &qd).unbind(),
            limits,
            elapsed,
            tips: TipErrors::restored(tips)?,
            remarks: Remarks { outside, joints, lock, held_by, drift },
            among: None,
            around: OnceLock::from(around),
        })
    }
}

impl PyStep {
    fn around(&self) -> Option<&Clearance> {
        self.around.get_or_init(|| self.among.as_ref().map(|(space, q)| Box::new(space.clearance(q)))).as_deref()
    }

    /// Returns the message: the outcome, advice, and the body in the way.
    fn sentence(&self) -> Message {
        let Remarks { outside, joints, lock, held_by, drift } = &self.remarks;
        let nearest = self.around().and_then(|clearance| clearance.nearest.as_ref());
        let lock = lock.as_ref().filter(|_| self.core.status == Status::Capped && self.core.idle.is_none());
        let advice = match (lock, nearest) {
            (Some(lock), _) => Message::clone(lock),
            (_, Some(nearest)) => self.core.advice_near(&nearest.contact),
            _ => self.core.status.advice(),
        };
        // A lock is the reason why the arm stays away.
        let step = if lock.is_some() { Step { away: None, ..self.core } } else { self.core };
        let message = step.message_with(advice, outside, |j| joints.get(j).cloned().unwrap_or_default());
        let message = match drift {
            Some(drift) => format!("{}; {drift}", said(&message)).into(),
            None => message,
        };
        match (self.core.status, nearest) {
            (Status::HeldByObstacle | Status::InCollision, Some(NearestContact { contact, .. })) => {
                let Contact { link, other, distance } = contact;
                format!("{} ({link} is {distance:.4} m from {other})", said(&message)).into()
            }
            _ => match held_by {
                Some(held_by) => format!("{} ({held_by})", said(&message)).into(),
                None => message,
            },
        }
    }
}
