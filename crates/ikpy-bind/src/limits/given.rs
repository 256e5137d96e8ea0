//! The value of a field of `Limits`, as given.

use ikcore::limits::{Field, Profile};
use pyo3::prelude::*;
use pyo3::{PyTraverseError, PyVisit};

use super::per_joint::PerJoint;
use super::sampling::{Sampling, sampled};
use super::sinusoid::PySinusoid;
use crate::convert::summary;
use crate::hash::content_hash;
use crate::traversal::Traversed;

/// Numbers, a sinusoid, or a function of time.
pub enum GivenLimit {
    Numbers(PerJoint),
    Sinusoid(PySinusoid),
    Function(Py<PyAny>),
}

impl Traversed for GivenLimit {
    fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        match self {
            Self::Function(function) => function.traverse(visit),
            Self::Numbers(_) | Self::Sinusoid(_) => Ok(()),
        }
    }
}

impl GivenLimit {
    pub fn read(field: Field, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(sinusoid) = value.cast::<PySinusoid>() {
            return Ok(Self::Sinusoid(sinusoid.get().clone()));
        }
        if value.is_callable() {
            return Ok(Self::Function(value.clone().unbind()));
        }
        PerJoint::read(&format!("{field} limit"), value).map(Self::Numbers)
    }

    pub fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Numbers(numbers) => Self::Numbers(numbers.clone()),
            Self::Sinusoid(sinusoid) => Self::Sinusoid(sinusoid.clone()),
            Self::Function(function) => Self::Function(function.clone_ref(py)),
        }
    }

    /// Compares functions as Python does: two bound methods of one object are equal.
    pub fn equals(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        match (self, other) {
            (Self::Numbers(one), Self::Numbers(other)) => Ok(one == other),
            (Self::Sinusoid(one), Self::Sinusoid(other)) => Ok(one == other),
            (Self::Function(one), Self::Function(other)) => one.bind(py).eq(other),
            _ => Ok(false),
        }
    }

    /// Returns a hash that is equal for equal values.
    pub fn hash(&self, py: Python<'_>) -> PyResult<isize> {
        match self {
            Self::Numbers(numbers) => Ok(content_hash(numbers) as isize),
            Self::Sinusoid(sinusoid) => Ok(content_hash(sinusoid) as isize),
            Self::Function(function) => function.bind(py).hash(),
        }
    }

    pub fn show<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::Numbers(numbers) => numbers.show(py),
            Self::Sinusoid(sinusoid) => Ok(Bound::new(py, sinusoid.clone())?.into_any()),
            Self::Function(function) => Ok(function.bind(py).clone()),
        }
    }

    pub fn repr(&self, py: Python<'_>) -> String {
        match self {
            Self::Numbers(numbers) => numbers.repr(),
            Self::Sinusoid(sinusoid) => sinusoid.__repr__(),
            Self::Function(function) => summary(function.bind(py)),
        }
    }

    pub fn profiles(&self, py: Python<'_>, field: Field, sampling: &Sampling, n: usize) -> PyResult<Vec<Profile>> {
        match self {
            Self::Numbers(numbers) => Ok(numbers.values.iter().map(|value| Profile::Constant(*value)).collect()),
            Self::Sinusoid(sinusoid) => sinusoid.profiles(),
            Self::Function(function) => sampled(function.bind(py), field, sampling, n),
        }
    }
}
