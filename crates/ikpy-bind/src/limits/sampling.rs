//! Limits that are functions of time.

use ikcore::limits::{Field, Profile};
use pyo3::prelude::*;

use crate::convert::scalar_or_vector;
use crate::error::invalid;
use crate::signals::check_signals_at;

/// Sample times of limits that are functions of time. Sampling precedes the core, whose threads never call Python.
pub struct Sampling {
    /// Time between samples (s).
    pub step: f64,
    /// Number of samples.
    pub count: usize,
}

impl Sampling {
    /// Samples at both ends and in the middle of each of `ticks` ticks of `dt` seconds.
    pub fn of_ticks(dt: f64, ticks: usize) -> Self {
        Self { step: 0.5 * dt, count: 2 * ticks + 1 }
    }

    /// Samples at t = 0 only.
    pub fn once() -> Self {
        Self { step: 1.0, count: 1 }
    }
}

/// Samples a function at all times, for each of `n` joints or for all of them.
pub fn sampled(function: &Bound<'_, PyAny>, field: Field, sampling: &Sampling, n: usize) -> PyResult<Vec<Profile>> {
    let mut columns: Vec<Vec<f64>> = vec![];
    for i in 0..sampling.count {
        check_signals_at(function.py(), i)?;
        let t = i as f64 * sampling.step;
        let what = format!("{field} limit at t = {t} s");
        let (values, _) = scalar_or_vector(&what, &function.call1((t,))?)?;
        if i == 0 {
            columns.resize(values.len(), Vec::with_capacity(sampling.count));
        }
        if values.len() != columns.len() || ![1, n].contains(&values.len()) {
            return Err(invalid(format!(
                "{what}: expected a number, or {n} values at all times, got {}",
                values.len()
            )));
        }
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }
    Ok(columns.into_iter().map(|values| Profile::Sampled { step: sampling.step, values }).collect())
}
