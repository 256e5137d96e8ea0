//! Ctrl-C and progress in long calls. Every call that may take longer than 50 ms runs through [`long_call`],
//! [`watched`], [`in_pieces`] or [`on_a_thread`].

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use ikcore::interrupt::{checkpoint, interruptible};
use ikcore::solver::Monitor;
use ikcore::solver::Stopwatch;
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::convert::summary;
use crate::error::{invalid, raise};
use crate::python_calls;

/// Interval between two checks for signals, and between two reports of progress: short enough to feel immediate, long
/// enough to cost nothing.
const INTERVAL: Duration = Duration::from_millis(20);

/// Monitors a search: ends it at Ctrl-C, and reports progress.
pub struct Watcher {
    since_last_report: Stopwatch,
    progress: Option<Py<PyAny>>,
    failure: Option<PyErr>,
}

/// Runs `call`; checkpoints and monitors in it check for Ctrl-C. Returns its result and the exception of Ctrl-C, if any,
/// after which the result is incomplete.
fn with_signals<T>(call: impl FnOnce() -> T) -> (T, Option<PyErr>) {
    let failure = Rc::new(RefCell::new(None));
    let (seen, mut since) = (Rc::clone(&failure), Stopwatch::start());
    let keep_going = move || {
        if seen.borrow().is_none() && due(&mut since) {
            let raised = Python::attach(|py| py.check_signals()).err();
            seen.replace(raised);
        }
        seen.borrow().is_none()
    };
    let result = interruptible(keep_going, call);
    (result, failure.take())
}

/// Runs a computation of the core without the interpreter. Ctrl-C ends it at its next checkpoint.
pub fn long_call<T: Send>(py: Python<'_>, call: impl FnOnce() -> ikcore::Result<T> + Send) -> PyResult<T> {
    let (found, stopped) = with_signals(|| py.detach(call));
    stopped.map_or_else(|| found.map_err(raise), Err)
}

/// Rows between two checks for Ctrl-C in [`in_pieces`], for work of 0.1 microseconds a row.
pub const QUICK_ROWS: usize = 1 << 17;

/// Runs `work` on rows of `n` numbers without the interpreter, and checks for Ctrl-C after every `piece` of rows.
pub fn in_pieces(
    py: Python<'_>,
    rows: &[f64],
    n: usize,
    piece: usize,
    work: impl Fn(&[f64]) -> ikcore::Result<Vec<f64>> + Sync,
) -> PyResult<Vec<f64>> {
    if rows.len() <= piece * n {
        return py.detach(|| work(rows)).map_err(raise);
    }
    let mut results = vec![];
    for piece in rows.chunks(piece * n) {
        py.check_signals()?;
        // Repeats a failed piece on all rows, so that its error message counts from the first row.
        results.extend(py.detach(|| work(piece).or_else(|_| work(rows))).map_err(raise)?);
    }
    Ok(results)
}

/// Runs code of other libraries, which has no checkpoints, on a thread of its own. Ctrl-C ends the call; the thread ends
/// when it is done, and its result is dropped.
pub fn on_a_thread<T: Send + 'static>(
    py: Python<'_>,
    call: impl FnOnce() -> ikcore::Result<T> + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = mpsc::sync_channel(1);
    // Ignores a failure to send: after Ctrl-C nobody receives.
    let work = move || _ = sender.send(call());
    let worker =
        thread::Builder::new().spawn(work).map_err(|error| invalid(format!("cannot start a thread: {error}")))?;
    loop {
        let (returned, answer) = py.detach(move || {
            let answer = receiver.recv_timeout(INTERVAL);
            (receiver, answer)
        });
        receiver = returned;
        match answer {
            Ok(found) => return found.map_err(raise),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                let Err(panic) = worker.join() else { return Err(invalid("a thread gave no result".into())) };
                std::panic::resume_unwind(panic)
            }
        }
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

/// Runs a long call that holds the interpreter; returns its result and the exception of Ctrl-C or `progress`, if any.
pub fn watched_keeping_result<T>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    call: impl FnOnce(&mut Watcher) -> T,
) -> PyResult<(T, Option<PyErr>)> {
    let progress = progress.map_or(Ok(Progress::default()), Progress::new)?;
    let mut watcher = Watcher { since_last_report: Stopwatch::start(), progress: progress.update(py), failure: None };
    let (found, stopped) = with_signals(|| call(&mut watcher));
    progress.close(py)?;
    Ok((found, stopped.or(watcher.failure)))
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
        self.failure.is_none() && checkpoint().is_ok()
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
