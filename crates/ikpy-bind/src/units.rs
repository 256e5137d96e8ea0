//! `UnitsWarning`: doubts of the core about the units of arguments, raised once per call.
//!
//! Doubts found while a call reads its arguments are kept until the outermost call returns. If it raises an error, they become the
//! end of its message instead.

use std::cell::{Cell, RefCell};

use ikcore::obstacle::Obstacle;
use ikcore::robot::Robot;
use ikcore::task::{Subject, Target};
use ikcore::units::{self, UnitDoubt};
use pyo3::prelude::*;

use crate::error::with_reason;
use crate::python_calls;
use crate::wording::said;

thread_local! {
    /// Number of calls in progress, one inside another.
    static CALLS: Cell<u32> = const { Cell::new(0) };
    /// Whether there are doubts.
    static DOUBTED: Cell<bool> = const { Cell::new(false) };
    /// Sentences of the doubts.
    static DOUBTS: RefCell<Vec<String>> = const { RefCell::new(vec![]) };
}

/// Counts a call that begins.
#[inline]
pub fn begin_call() {
    CALLS.set(CALLS.get() + 1);
}

/// Counts a call that ends with a result, and warns of its doubts if it is the outermost one.
#[inline]
pub fn end_call() -> PyResult<()> {
    CALLS.set(CALLS.get().saturating_sub(1));
    if CALLS.get() > 0 || !DOUBTED.get() { Ok(()) } else { warn_of_doubts() }
}

/// Counts a call that ends with a pending exception, and adds the doubts to the message of an error of this library: they are
/// probably its reason.
pub fn end_call_with_error() {
    CALLS.set(CALLS.get().saturating_sub(1));
    if CALLS.get() == 0 && DOUBTED.get() {
        let doubts = taken();
        Python::attach(|py| {
            if let Some(error) = PyErr::take(py) {
                with_reason(py, error, &doubts).restore(py);
            }
        });
    }
}

fn taken() -> String {
    DOUBTED.set(false);
    DOUBTS.take().join("; ")
}

#[cold]
fn warn_of_doubts() -> PyResult<()> {
    let doubts = taken();
    Python::attach(|py| python_calls::warn_of_units(py, &doubts))
}

/// Keeps doubts for the end of the call; outside calls, as where an attribute is set, warns at once.
pub fn doubt(found: impl IntoIterator<Item = UnitDoubt>) -> PyResult<()> {
    let mut any = false;
    for found in found {
        let sentence = said(&found.message());
        DOUBTS.with_borrow_mut(|doubts| {
            if !doubts.contains(&sentence) {
                doubts.push(sentence);
            }
        });
        any = true;
    }
    if !any {
        return Ok(());
    }
    DOUBTED.set(true);
    if CALLS.get() == 0 { warn_of_doubts() } else { Ok(()) }
}

/// Doubts a target.
pub fn of_target(robot: &Robot, what: &str, subject: Subject, target: &Target) -> Option<UnitDoubt> {
    of_point(robot, what, subject, &target.position()?)
}

/// Doubts the position of a target or a point of a path.
pub fn of_point(robot: &Robot, what: &str, subject: Subject, position: &[f64; 3]) -> Option<UnitDoubt> {
    match subject {
        Subject::Tip(tip) => units::of_position(robot, what, &[tip], position),
        Subject::Pair { from, of } => units::of_position(robot, what, &[from, of], position),
    }
}

/// Doubts obstacles.
pub fn of_obstacles(robot: &Robot, obstacles: &[Obstacle]) -> Option<UnitDoubt> {
    units::of_obstacles(robot, obstacles.iter().map(|obstacle| &obstacle.shape))
}
