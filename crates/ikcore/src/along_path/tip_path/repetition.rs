//! Repeated points.

use crate::error::{Error, Result};
use crate::path::Waypoints;

/// Checks that no point repeats the previous one: a spline needs points that differ.
///
/// # Errors
/// [`Error::InvalidPath`].
pub(crate) fn refuse_repetition(points: &Waypoints) -> Result<()> {
    let repeats =
        |i: &usize| points.position(*i) == points.position(i - 1) && points.rotation(*i) == points.rotation(i - 1);
    match (1..points.len()).find(repeats) {
        None => Ok(()),
        Some(i) => Err(Error::InvalidPath { problem: format!("point {i} repeats point {}: leave it out", i - 1) }),
    }
}
