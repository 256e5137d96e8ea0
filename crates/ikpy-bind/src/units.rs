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
    static CALLS: Calls = const { Calls { depth: Cell::new(0), doubted: Cell::new(false) } };
    /// Sentences of the doubts.
    static DOUBTS: RefCell<Vec<String>> = const { RefCell::new(vec![]) };
}

/// Calls in progress; together, since each look at a variable of a thread costs some nanoseconds.
struct Calls {
    /// Number of calls, one inside another.
    depth: Cell<u32>,
    /// Whether there are doubts.
    doubted: Cell<bool>,
}

/// Counts a call that begins.
#[inline]
pub fn begin_call() {
    CALLS.with(|calls| calls.depth.set(calls.depth.get() + 1));
}

/// Counts a call that ends; returns whether it is the outermost one and there are doubts.
#[inline]
fn ends_in_doubt() -> bool {
    CALLS.with(|calls| {
        let depth = calls.depth.get().saturating_sub(1);
        calls.depth.set(depth);
        depth == 0 && calls.doubted.get()
    })
}

/// Counts a call that ends with a result, and warns of its doubts if it is the outermost one.
#[inline]
pub fn end_call() -> PyResult<()> {
    if ends_in_doubt() { warn_of_doubts() } else { Ok(()) }
}

/// Counts a call that ends with a pending exception, and adds the doubts to the message of an error of this library: they are
/// probably its reason.
pub fn end_call_with_error() {
    if ends_in_doubt() {
        let doubts = taken();
        Python::attach(|py| {
            if let Some(error) = PyErr::take(py) {
                with_reason(py, error, &doubts).restore(py);
            }
        });
    }
}

fn taken() -> String {
    CALLS.with(|calls| calls.doubted.set(false));
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
    let outside = CALLS.with(|calls| {
        calls.doubted.set(true);
        calls.depth.get() == 0
    });
    if outside { warn_of_doubts() } else { Ok(()) }
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
        Subject::CenterOfMass => units::of_center_of_mass(robot, what, position),
    }
}

/// Doubts obstacles.
pub fn of_obstacles(robot: &Robot, obstacles: &[Obstacle]) -> Option<UnitDoubt> {
    units::of_obstacles(robot, obstacles.iter().map(|obstacle| &obstacle.shape))
}
