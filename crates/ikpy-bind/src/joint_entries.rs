//! `_JointEntries`: joint positions among the entries of another library's arrays, which may be in degrees. Python would take seven calls of
//! numpy for each, and thus longer than a closed form takes to solve a pose.

use ikcore::robot::Robot;
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::convert::{Numbers, array, copied, one_dimension, own, shape_text};
use crate::error::{invalid, raise};
use crate::robot::PyRobot;
use crate::traversal::traversed;

/// Where the joints of a robot are in arrays of another library, for `beetle_ik.interop`.
///
/// Args:
///     robot: the robot.
///     at: index of each joint of the robot among the entries.
///     count: number of entries that an array must have; more may follow.
///     unit: what one unit of each entry is (rad, m), one per joint of the robot.
#[pyclass(name = "_JointEntries", module = "beetle_ik._core", frozen)]
pub struct PyJointEntries {
    robot: Py<PyRobot>,
    at: Vec<usize>,
    count: usize,
    unit: Vec<f64>,
}

traversed!(PyJointEntries: robot);

#[pymethods]
impl PyJointEntries {
    #[new]
    fn new(robot: &Bound<'_, PyRobot>, at: Vec<usize>, count: usize, unit: Vec<f64>) -> PyResult<Self> {
        let n = robot.get().core.dof();
        if [at.len(), unit.len()] != [n, n] || at.iter().any(|place| *place >= count) {
            return Err(invalid(format!("at and unit: expected {n} each, one per joint, below {count}")));
        }
        Ok(Self { robot: robot.clone().unbind(), at, count, unit })
    }

    /// Returns the entries (k,), a copy.
    fn read<'py>(&self, name: &str, values: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let entries = self.entries(name, values)?;
        self.joints(name, entries.as_slice()?)?;
        Ok(own(copied(values.py(), entries.as_slice()?)))
    }

    /// Returns the joint positions of the robot (n,) (rad, m).
    fn q<'py>(&self, name: &str, values: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let q = self.joints(name, self.entries(name, values)?.as_slice()?)?;
        Ok(own(copied(values.py(), &q)))
    }

    /// Returns the joint positions of the robot (n,) (rad, m), each at its nearest limit if it is outside.
    fn inside<'py>(&self, name: &str, values: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let q = self.joints(name, self.entries(name, values)?.as_slice()?)?;
        Ok(own(copied(values.py(), &self.core().clip_all(&q).map_err(raise)?)))
    }

    /// Returns a copy of the entries with the joint positions q (n,) (rad, m) in their places.
    fn placed<'py>(&self, q: &Bound<'py, PyAny>, entries: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut placed = one_dimension("entries", &array("entries", entries)?)?;
        let q = array("q", q)?;
        for ((place, value), unit) in self.at.iter().zip(q.as_slice()?).zip(&self.unit) {
            placed[*place] = value / unit;
        }
        Ok(own(copied(entries.py(), &placed)))
    }

    fn __getnewargs__(&self, py: Python<'_>) -> (Py<PyRobot>, Vec<usize>, usize, Vec<f64>) {
        (self.robot.clone_ref(py), self.at.clone(), self.count, self.unit.clone())
    }
}

impl PyJointEntries {
    fn core(&self) -> &Robot {
        &self.robot.get().core
    }

    fn entries<'py>(&self, name: &str, values: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
        let entries = array(name, values)?;
        match entries.shape() {
            [k] if *k >= self.count => Ok(entries),
            shape => {
                let (count, got) = (self.count, shape_text(shape));
                Err(invalid(format!("{name}: expected at least {count} entries, one per joint name, got shape {got}")))
            }
        }
    }

    fn joints(&self, name: &str, entries: &[f64]) -> PyResult<Vec<f64>> {
        let values = self.at.iter().map(|place| entries[*place]);
        if let Some((joint, value)) =
            self.core().joints().iter().zip(values.clone()).find(|(_, value)| !value.is_finite())
        {
            let value = value.to_string().to_lowercase();
            return Err(invalid(format!("{name}: joint '{}' must be finite, got {value}", joint.name)));
        }
        Ok(values.zip(&self.unit).map(|(value, unit)| value * unit).collect())
    }
}
