//! Ctrl-C in loops of the binding.

use pyo3::prelude::*;

/// Checks for Ctrl-C at every 4096th call, every few milliseconds: functions written in C do not check for it.
pub fn check_signals_at(py: Python<'_>, call: usize) -> PyResult<()> {
    if call % 4096 == 4095 { py.check_signals() } else { Ok(()) }
}
