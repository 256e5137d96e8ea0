//! Ctrl-C and progress in long calls.

use std::time::Duration;

use ikcore::solver::Monitor;
use ikcore::solver::Stopwatch;
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::convert::summary;
use crate::error::{invalid, raise};
use crate::python_calls;

/// Time between two checks for signals, and between two reports of progress: short enough to feel immediate, long enough to cost
/// nothing.
const INTERVAL: Duration = Duration::from_millis(20);

/// Monitors a long call: checks for Ctrl-C and reports progress.
pub struct Watcher {
    since_last_look: Stopwatch,
    since_last_report: Stopwatch,
    progress: Option<Py<PyAny>>,
    failure: Option<PyErr>,
}

impl Watcher {
    /// A watcher that only checks for Ctrl-C.
    pub fn new() -> Self {
        let now = Stopwatch::start();
        Self { since_last_look: now, since_last_report: now, progress: None, failure: None }
    }

    /// Returns the exception that occurred during the call, if any.
    pub fn finish(self) -> PyResult<()> {
        self.failure.map_or(Ok(()), Err)
    }
}

/// Runs a long call that holds the interpreter, with checks for Ctrl-C and reports to `progress`. Their exceptions take
/// precedence over the result of the call.
pub fn watched_with_interpreter<T>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    call: impl FnOnce(&mut Watcher) -> PyResult<T>,
) -> PyResult<T> {
    let (found, failure) = watched_keeping_result(py, progress, call)?;
    failure.map_or(found, Err)
}

/// Runs such a call; returns its result and the exception of Ctrl-C or `progress`, if any.
pub fn watched_keeping_result<T>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    call: impl FnOnce(&mut Watcher) -> T,
) -> PyResult<(T, Option<PyErr>)> {
    let progress = progress.map_or(Ok(Progress::default()), Progress::new)?;
    let mut watcher = Watcher { progress: progress.update(py), ..Watcher::new() };
    let found = call(&mut watcher);
    progress.close(py)?;
    Ok((found, watcher.failure))
}

/// Runs a long call of the core, which releases the interpreter.
pub fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    call: impl FnOnce(&mut Watcher) -> ikcore::Result<T> + Send,
) -> PyResult<T> {
    watched_with_interpreter(py, progress, |watcher| py.detach(|| call(watcher)).map_err(raise))
}

/// Whether the interval has passed; if so, restarts it.
fn due(since: &mut Stopwatch) -> bool {
    let due = since.elapsed() >= INTERVAL;
    if due {
        *since = Stopwatch::start();
    }
    due
}

impl Monitor for Watcher {
    fn keep_going(&mut self) -> bool {
        if self.failure.is_none() && due(&mut self.since_last_look) {
            self.failure = Python::attach(|py| py.check_signals()).err();
        }
        self.failure.is_none()
    }

    fn progress(&mut self, done: usize, total: usize) {
        let Some(update) = &self.progress else { return };
        if self.failure.is_none() && (done == total || due(&mut self.since_last_report)) {
            self.failure = Python::attach(|py| update.call1(py, (done, total))).err();
        }
    }
}

/// The `progress` argument: None or False, True for a progress bar, or a callable of (done, total).
#[derive(Default)]
struct Progress {
    update: Option<Py<PyAny>>,
    bar: Option<Py<PyAny>>,
}

impl Progress {
    fn new(argument: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(wanted) = argument.cast::<PyBool>() {
            return if wanted.is_true() { Self::bar(argument.py()) } else { Ok(Self::default()) };
        }
        if argument.is_callable() {
            return Ok(Self { update: Some(argument.clone().unbind()), bar: None });
        }
        let got = summary(argument);
        Err(invalid(format!("progress must be True, False or a callable of (done, total), got {got}")))
    }

    fn bar(py: Python<'_>) -> PyResult<Self> {
        let bar = python_calls::progress_bar(py)?;
        Ok(Self { update: Some(bar.getattr("update")?.unbind()), bar: Some(bar.unbind()) })
    }

    /// The function to call with (done, total).
    fn update(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.update.as_ref().map(|update| update.clone_ref(py))
    }

    /// Stops the progress bar.
    fn close(self, py: Python<'_>) -> PyResult<()> {
        self.bar.map_or(Ok(()), |bar| bar.call_method0(py, "close").map(|_| ()))
    }
}
