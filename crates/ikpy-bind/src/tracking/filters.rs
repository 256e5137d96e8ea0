//! `beetle_ik.filters`.

use ikcore::tracking::{LowPass, OneEuro, TargetFilter};
use pyo3::prelude::*;

use crate::convert::summary;
use crate::error::{invalid, raise};
use crate::options::options;

/// First-order low-pass for the targets of a `Tracker`, for positions and orientations.
///
/// A target that moves steadily is delayed by 1 / (2 pi cutoff): 32 ms at 5 Hz.
///
/// Args:
///     cutoff: cutoff (Hz).
#[pyclass(name = "LowPass", module = "beetle_ik.filters", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyLowPass(LowPass);

#[pymethods]
impl PyLowPass {
    #[new]
    #[pyo3(signature = (cutoff))]
    fn new(cutoff: f64) -> PyResult<Self> {
        let filter = LowPass { cutoff };
        TargetFilter::LowPass(filter).validate().map_err(raise)?;
        Ok(Self(filter))
    }
}

options! {
    PyLowPass, "LowPass" {
        /// Cutoff (Hz).
        cutoff: f64,
    }
}

/// One-euro filter for the targets of a `Tracker`, for positions and orientations: a low-pass whose cutoff rises with the
/// speed of the target (Casiez, Roussel and Vogel 2012).
///
/// A target that moves steadily at speed v is delayed by 1 / (2 pi (min_cutoff + beta v)).
///
/// Args:
///     min_cutoff: cutoff at rest (Hz).
///     beta: increase of the cutoff with speed: Hz per m/s for positions, Hz per rad/s for orientations.
#[pyclass(name = "OneEuro", module = "beetle_ik.filters", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyOneEuro(OneEuro);

#[pymethods]
impl PyOneEuro {
    #[new]
    #[pyo3(signature = (*, min_cutoff=1.0, beta=10.0))]
    fn new(min_cutoff: f64, beta: f64) -> PyResult<Self> {
        let filter = OneEuro { min_cutoff, beta };
        TargetFilter::OneEuro(filter).validate().map_err(raise)?;
        Ok(Self(filter))
    }
}

options! {
    PyOneEuro, "OneEuro" {
        /// Cutoff at rest (Hz).
        min_cutoff: f64,
        /// Increase of the cutoff with speed (Hz per m/s, Hz per rad/s).
        beta: f64,
    }
}

/// Reads the `target_filter` argument.
pub fn read_filter(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<TargetFilter>> {
    let Some(value) = value else { return Ok(None) };
    if let Ok(filter) = value.cast::<PyLowPass>() {
        return Ok(Some(TargetFilter::LowPass(filter.get().0)));
    }
    if let Ok(filter) = value.cast::<PyOneEuro>() {
        return Ok(Some(TargetFilter::OneEuro(filter.get().0)));
    }
    let got = summary(value);
    Err(invalid(format!("target_filter must be filters.OneEuro, filters.LowPass or None, got {got}")))
}
