//! Elbows as arguments.

use ikcore::planning::Elbow;
use pyo3::PyResult;

use crate::error::invalid;

/// Which way a planar arm bends.
pub fn read_elbow(name: &str, sign: i128) -> PyResult<Elbow> {
    match sign {
        1 => Ok(Elbow::Positive),
        -1 => Ok(Elbow::Negative),
        _ => Err(invalid(format!("{name} must be 1 or -1, the sign of the second joint's angle, got {sign}"))),
    }
}

/// The same at start and end.
pub fn read_elbows([start, end]: [i128; 2]) -> PyResult<[Elbow; 2]> {
    Ok([read_elbow("elbows[0]", start)?, read_elbow("elbows[1]", end)?])
}
