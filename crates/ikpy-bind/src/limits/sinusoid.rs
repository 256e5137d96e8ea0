//! `Sinusoid`.

use ikcore::limits::{Profile, Sinusoid};
use pyo3::prelude::*;

use super::per_joint::PerJoint;
use crate::error::invalid;
use crate::hash::content_hash;
use crate::options::{NewArguments, keywords};

/// A sinusoidal limit: mean + amplitude sin(angular_frequency t + phase), eq. (7) of Cheng et al. (2020) with its sign
/// corrected.
///
/// Args:
///     mean, amplitude: in the unit of the limit; a number for all joints, or (n,).
///     angular_frequency: angular frequency (rad/s); a number or (n,).
///     phase: phase at t = 0 (rad); a number or (n,).
#[pyclass(name = "Sinusoid", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PySinusoid {
    mean: PerJoint,
    amplitude: PerJoint,
    angular_frequency: PerJoint,
    phase: PerJoint,
}

#[pymethods]
impl PySinusoid {
    #[new]
    #[pyo3(signature = (*, mean, amplitude, angular_frequency, phase=None))]
    fn new(
        mean: &Bound<'_, PyAny>,
        amplitude: &Bound<'_, PyAny>,
        angular_frequency: &Bound<'_, PyAny>,
        phase: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let none = PerJoint { values: vec![0.0], single: true };
        let sinusoid = Self {
            mean: PerJoint::read("mean", mean)?,
            amplitude: PerJoint::read("amplitude", amplitude)?,
            angular_frequency: PerJoint::read("angular_frequency", angular_frequency)?,
            phase: phase.map_or(Ok(none), |phase| PerJoint::read("phase", phase))?,
        };
        sinusoid.profiles()?;
        Ok(sinusoid)
    }

    /// Mean, as given.
    #[getter]
    fn mean<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.mean.show(py)
    }

    /// Amplitude, as given.
    #[getter]
    fn amplitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.amplitude.show(py)
    }

    /// Angular frequency (rad/s), as given.
    #[getter]
    fn angular_frequency<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.angular_frequency.show(py)
    }

    /// Phase at t = 0 (rad), as given.
    #[getter]
    fn phase<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.phase.show(py)
    }

    pub fn __repr__(&self) -> String {
        let Self { mean, amplitude, angular_frequency, phase } = self;
        format!(
            "Sinusoid(mean={}, amplitude={}, angular_frequency={}, phase={})",
            mean.repr(),
            amplitude.repr(),
            angular_frequency.repr(),
            phase.repr()
        )
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["mean", "amplitude", "angular_frequency", "phase"])
    }
}

impl PySinusoid {
    /// Returns one profile per joint, or one for all joints.
    pub fn profiles(&self) -> PyResult<Vec<Profile>> {
        let fields = [&self.mean, &self.amplitude, &self.angular_frequency, &self.phase];
        let count = fields.iter().map(|numbers| numbers.values.len()).max().unwrap_or(1);
        if let Some(odd) = fields.iter().find(|numbers| ![1, count].contains(&numbers.values.len())) {
            let got = odd.values.len();
            return Err(invalid(format!(
                "Sinusoid: its fields have {count} and {got} values; give a number or one per joint"
            )));
        }
        let joint = |j: usize| Sinusoid {
            mean: self.mean.at(j),
            amplitude: self.amplitude.at(j),
            angular_frequency: self.angular_frequency.at(j),
            phase: self.phase.at(j),
        };
        Ok((0..count).map(|j| Profile::Sinusoid(joint(j))).collect())
    }
}
