//! The gate for starts: the argument `start_slack`, and joints of a start that are outside their limits.

use ikcore::limits::{JointOutside, StartSlack};
use pyo3::prelude::*;

use crate::convert::scalar_or_vector;
use crate::error::raise;

/// A joint outside its limits: (name, value, limit).
pub type Outside = (String, f64, f64);

/// Reads `start_slack`, a number or one per joint (rad, m); None: the default.
pub fn read_slack(value: Option<&Bound<'_, PyAny>>) -> PyResult<StartSlack> {
    let Some(value) = value else { return Ok(StartSlack::default()) };
    let (slack, _) = scalar_or_vector("start_slack", value)?;
    StartSlack::new(slack).map_err(raise)
}

/// Returns the joints as plain values.
pub fn plain(outside: &[JointOutside]) -> Vec<Outside> {
    outside.iter().map(|joint| (joint.joint.clone(), joint.value, joint.limit)).collect()
}
