//! `KinematicPlant`, and plants written in Python.

use std::sync::{Mutex, PoisonError};

use ikcore::tracking::{Fault, KinematicPlant, Plant, TipPose};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::PyException;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyListMethods, PyTuple};

use crate::convert::{array, count, own, pose_array, rigid_rows, shape_text, summary};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::joint_order::joint_vector;
use crate::options::NewArguments;
use crate::robot::PyRobot;
use crate::traversal::traversed;

/// A simulated arm that executes commands exactly, with a sensor at its tip; it runs without Python in the loop. To simulate
/// an arm whose model is wrong, pass a modified robot, for example `robot.with_errors(...)`.
///
/// Args:
///     robot: the arm as built.
///     noise: standard deviation of the measured position on each axis (m).
///     rotation_noise: standard deviation of the measured orientation about each axis (rad); 0 measures it exactly. None: the
///         sensor measures positions only.
///     seed: seed of the noise. Each run of `track_model_free` restarts the noise.
#[pyclass(name = "KinematicPlant", module = "beetle_ik", frozen)]
pub struct PyKinematicPlant {
    /// The arm as built.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    seed: u64,
    core: KinematicPlant,
    /// A copy for `move`, whose noise continues from call to call.
    moving: Mutex<KinematicPlant>,
}

traversed!(PyKinematicPlant: robot);

#[pymethods]
impl PyKinematicPlant {
    #[new]
    #[pyo3(signature = (robot, *, noise=0.0, rotation_noise=None, seed=0))]
    fn new(robot: &Bound<'_, PyRobot>, noise: f64, rotation_noise: Option<f64>, seed: i128) -> PyResult<Self> {
        let seed = count("seed", seed)?;
        let core = KinematicPlant::new(robot.get().core.as_ref().clone(), noise, seed);
        let core = match rotation_noise {
            Some(rotation_noise) => core.and_then(|core| core.with_orientation(rotation_noise)),
            None => core,
        }
        .map_err(raise)?;
        Ok(Self { robot: robot.clone().unbind(), seed, moving: Mutex::new(core.clone()), core })
    }

    /// Standard deviation of the measured position on each axis (m).
    #[getter]
    fn noise(&self) -> f64 {
        self.core.noise()
    }

    /// Standard deviation of the measured orientation about each axis (rad); None if only the position is measured.
    #[getter]
    fn rotation_noise(&self) -> Option<f64> {
        self.core.rotation_noise()
    }

    /// Seed of the noise.
    #[getter]
    fn seed(&self) -> u64 {
        self.seed
    }

    /// Moves the arm to q (n,) (rad, m), and returns the measurement of the sensor: the position of the tip (3,) (m), or its
    /// pose (4, 4).
    #[pyo3(name = "move")]
    fn move_to<'py>(&self, py: Python<'py>, q: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let q = joint_vector(self.core.robot(), "q", q)?;
        self.core.robot().check("q", &q).map_err(raise)?;
        let mut plant = self.moving.lock().unwrap_or_else(PoisonError::into_inner);
        let tip = plant.measure(&q).map_err(|Fault(reason)| invalid(format!("the plant {reason}")))?;
        match tip.pose() {
            Some(pose) => Ok(own(pose_array(py, &pose)).into_any()),
            None => Ok(PyArray1::from_slice(py, tip.position()).into_any()),
        }
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| {
            let other = other.get();
            let [a, b] =
                [self, other].map(|plant| (plant.core.robot(), plant.noise(), plant.rotation_noise(), plant.seed));
            a == b
        })
    }

    fn __hash__(&self) -> u64 {
        content_hash(&(self.core.robot().name(), self.noise(), self.rotation_noise(), self.seed))
    }

    fn __repr__(&self) -> String {
        let rotation_noise =
            self.rotation_noise().map_or_else(String::new, |noise| format!(", rotation_noise={noise}"));
        let (name, noise, seed) = (self.core.robot().name(), self.noise(), self.seed);
        format!("<KinematicPlant of '{name}': noise={noise}{rotation_noise}, seed={seed}>")
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let options = PyDict::new(py);
        options.set_item("noise", self.noise())?;
        options.set_item("rotation_noise", self.rotation_noise())?;
        options.set_item("seed", self.seed)?;
        Ok((PyTuple::new(py, [self.robot.bind(py)])?, options))
    }
}

impl PyKinematicPlant {
    /// Returns a plant at the start of its noise; an error unless `start` fits the robot.
    pub fn fresh(&self, start: &[f64]) -> PyResult<KinematicPlant> {
        self.core.robot().check("start_q", start).map_err(raise)?;
        Ok(self.core.clone())
    }
}

/// A callable of q, and the exception that it raised.
pub struct PythonPlant<'py> {
    call: Bound<'py, PyAny>,
    /// Description of the value that the callable must return.
    wanted: &'static str,
    pub exception: Option<PyErr>,
}

impl<'py> PythonPlant<'py> {
    /// Takes a callable, or the method `move` of an object, for a path with orientations or without.
    pub fn new(plant: &Bound<'py, PyAny>, oriented: bool) -> PyResult<Self> {
        let call = match plant.getattr_opt(intern!(plant.py(), "move"))? {
            Some(method) if method.is_callable() => method,
            _ if plant.is_callable() => plant.clone(),
            _ => {
                let got = summary(plant);
                return Err(invalid(format!(
                    "plant must be a KinematicPlant, a callable of q or an object with move(q), got {got}"
                )));
            }
        };
        let wanted = if oriented { "a pose (4, 4)" } else { "a position (3,)" };
        Ok(Self { call, wanted, exception: None })
    }

    /// Stores the exception and ends the run.
    fn failed(&mut self, error: PyErr) -> Fault {
        let fault = Fault(format!("raised {error}"));
        self.exception = Some(error);
        fault
    }

    /// Takes the exception if it is Ctrl-C or an exit, not an error.
    pub fn take_interrupt(&mut self) -> Option<PyErr> {
        let py = self.call.py();
        self.exception.take_if(|error| !error.is_instance_of::<PyException>(py))
    }
}

impl Plant for PythonPlant<'_> {
    fn measure(&mut self, command: &[f64]) -> Result<TipPose, Fault> {
        let command = PyArray1::from_slice(self.call.py(), command);
        let answer = match self.call.call1((command,)) {
            Ok(answer) => answer,
            Err(error) => return Err(self.failed(error)),
        };
        read_answer(&answer, self.wanted)
    }
}

/// Reads a position or a pose, with fast paths for tuples and lists of three numbers.
fn read_answer(answer: &Bound<'_, PyAny>, wanted: &str) -> Result<TipPose, Fault> {
    if let Ok(tuple) = answer.cast_exact::<PyTuple>()
        && let Ok((x, y, z)) = tuple.extract()
    {
        return Ok([x, y, z].into());
    }
    if let Ok(list) = answer.cast_exact::<PyList>()
        && let Ok((x, y, z)) = list.to_tuple().extract()
    {
        return Ok([x, y, z].into());
    }
    let Ok(array) = array("position", answer) else {
        return Err(Fault(format!("returned {}, not {wanted}", summary(answer))));
    };
    match (array.shape(), array.as_slice()) {
        ([3], Ok(&[x, y, z])) => Ok([x, y, z].into()),
        ([4, 4], Ok(rows)) => match rigid_rows("it", rows) {
            Ok(pose) => Ok(TipPose::from(&pose)),
            Err(error) => Err(Fault(format!("returned an invalid pose: {}", error.value(answer.py())))),
        },
        (shape, _) => Err(Fault(format!("returned shape {}, not {wanted}", shape_text(shape)))),
    }
}
