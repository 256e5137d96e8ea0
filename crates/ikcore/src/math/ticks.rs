//! Number of clock ticks that cover a motion.

use crate::error::{Error, Result, require_positive};

/// Largest number of ticks; more indicate a mistake in `dt` (2.7 hours at 1 kHz).
const MAX_TICKS: f64 = 1e7;

/// Returns the number of ticks of `dt` (s) that cover `duration` (s): the ceiling of their ratio, where a remainder below
/// 1e-9 of a tick counts as rounding.
///
/// # Errors
/// [`Error::OutOfRange`] if `dt` is not positive, or so small that more than 10 million ticks would result.
pub fn ticks(duration: f64, dt: f64) -> Result<usize> {
    require_positive("dt", dt)?;
    let count = (duration / dt - 1e-9).ceil().max(1.0);
    if count > MAX_TICKS {
        let requirement = format!("at least {} s to cover {duration} s in 10 million ticks", duration / MAX_TICKS);
        return Err(Error::out_of_range("dt", &requirement, dt));
    }
    Ok(count as usize)
}

/// Returns the number of [`ticks`] of a path; a tick longer than the path is rejected, since it would sample only the ends.
///
/// # Errors
/// [`Error::OutOfRange`] as [`ticks`], and if `dt` is longer than `duration`.
pub fn ticks_of_path(duration: f64, dt: f64) -> Result<usize> {
    let count = ticks(duration, dt)?;
    if dt > duration * (1.0 + 1e-9) {
        let requirement = format!("at most {duration} s, which the path takes");
        return Err(Error::out_of_range("dt", &requirement, dt));
    }
    Ok(count)
}
