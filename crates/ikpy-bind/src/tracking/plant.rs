//! `KinematicPlant`, and plants written in Python.

use std::sync::{Mutex, PoisonError};

use ikcore::tracking::{Fault, KinematicPlant, Plant};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::PyException;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyListMethods, PyTuple};

use crate::convert::{array, count, shape_text, summary, vector};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::NewArguments;
use crate::robot::PyRobot;
use crate::traversal::traversed;

/// A simulated arm that executes commands exactly, with a sensor at its tip; it runs without Python in the loop. To simulate
/// an arm whose model is wrong, pass a modified robot, such as `robot.with_errors(...)`.
///
/// Args:
///     robot: the arm as built.
///     noise: standard deviation of the sensor on each axis (m).
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
    #[pyo3(signature = (robot, *, noise=0.0, seed=0))]
    fn new(robot: &Bound<'_, PyRobot>, noise: f64, seed: i128) -> PyResult<Self> {
        let seed = count("seed", seed)?;
        let core = KinematicPlant::new(robot.get().core.as_ref().clone(), noise, seed).map_err(raise)?;
        Ok(Self { robot: robot.clone().unbind(), seed, moving: Mutex::new(core.clone()), core })
    }

    /// Standard deviation of the sensor on each axis (m).
    #[getter]
    fn noise(&self) -> f64 {
        self.core.noise()
    }

    /// Seed of the noise.
    #[getter]
    fn seed(&self) -> u64 {
        self.seed
    }

    /// Moves the arm to q (n,) (rad, m), and returns the measured position of its tip (3,) (m).
    #[pyo3(name = "move")]
    fn move_to<'py>(&self, py: Python<'py>, q: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let q = vector("q", q)?;
        self.core.robot().check("q", &q).map_err(raise)?;
        let mut plant = self.moving.lock().unwrap_or_else(PoisonError::into_inner);
        let position = plant.measure(&q).map_err(|Fault(reason)| invalid(format!("the plant {reason}")))?;
        Ok(PyArray1::from_slice(py, &position))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| {
            let other = other.get();
            (self.core.robot(), self.noise(), self.seed) == (other.core.robot(), other.noise(), other.seed)
        })
    }

    fn __hash__(&self) -> u64 {
        content_hash(&(self.core.robot().name(), self.noise(), self.seed))
    }

    fn __repr__(&self) -> String {
        format!("<KinematicPlant of '{}': noise={}, seed={}>", self.core.robot().name(), self.noise(), self.seed)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let options = PyDict::new(py);
        options.set_item("noise", self.noise())?;
        options.set_item("seed", self.seed)?;
        Ok((PyTuple::new(py, [self.robot.bind(py)])?, options))
    }
}

impl PyKinematicPlant {
    /// Returns a plant at the start of its noise; an error unless `start` fits its robot.
    pub fn fresh(&self, start: &[f64]) -> PyResult<KinematicPlant> {
        self.core.robot().check("start", start).map_err(raise)?;
        Ok(self.core.clone())
    }
}

/// A callable of q, and the exception that it raised.
pub struct PythonPlant<'py> {
    call: Bound<'py, PyAny>,
    pub exception: Option<PyErr>,
}

impl<'py> PythonPlant<'py> {
    /// Takes a callable, or the method `move` of an object.
    pub fn new(plant: &Bound<'py, PyAny>) -> PyResult<Self> {
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
        Ok(Self { call, exception: None })
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
    fn measure(&mut self, command: &[f64]) -> Result<[f64; 3], Fault> {
        let command = PyArray1::from_slice(self.call.py(), command);
        let answer = match self.call.call1((command,)) {
            Ok(answer) => answer,
            Err(error) => return Err(self.failed(error)),
        };
        position(&answer)
    }
}

/// Reads three numbers, with fast paths for tuples and lists.
fn position(answer: &Bound<'_, PyAny>) -> Result<[f64; 3], Fault> {
    if let Ok(tuple) = answer.cast_exact::<PyTuple>()
        && let Ok((x, y, z)) = tuple.extract()
    {
        return Ok([x, y, z]);
    }
    if let Ok(list) = answer.cast_exact::<PyList>()
        && let Ok((x, y, z)) = list.to_tuple().extract()
    {
        return Ok([x, y, z]);
    }
    let Ok(array) = array("position", answer) else {
        return Err(Fault(format!("returned {}, not a position (3,)", summary(answer))));
    };
    match array.as_slice() {
        Ok(&[x, y, z]) if array.shape().len() == 1 => Ok([x, y, z]),
        _ => Err(Fault(format!("returned shape {}, not a position (3,)", shape_text(array.shape())))),
    }
}
