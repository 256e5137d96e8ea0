//! Interruption of long computations that have no partial result.
//!
//! A search takes a [`Monitor`](crate::solver::Monitor) and returns its best point when interrupted. A computation with
//! nothing to return calls [`checkpoint`] in its loops instead; the checkpoint calls the function that [`interruptible`]
//! installed on this thread, and so needs no argument through the layers above it.

use std::cell::RefCell;

use crate::error::{Error, Result};

type KeepGoing = Box<dyn FnMut() -> bool>;

thread_local! {
    static KEEP_GOING: RefCell<Option<KeepGoing>> = const { RefCell::new(None) };
}

/// Number of rows between two checkpoints of a loop.
const ROWS: usize = 256;

/// Runs `work`. Its checkpoints on this thread call `keep_going`, and fail once that function returns false.
pub fn interruptible<T>(keep_going: impl FnMut() -> bool + 'static, work: impl FnOnce() -> T) -> T {
    /// Guard that restores the function of the enclosing call, also after a panic.
    struct Restore(Option<KeepGoing>);
    impl Drop for Restore {
        fn drop(&mut self) {
            KEEP_GOING.set(self.0.take());
        }
    }
    let _outer = Restore(KEEP_GOING.replace(Some(Box::new(keep_going))));
    work()
}

/// Checks whether the computation may continue.
///
/// # Errors
/// [`Error::Interrupted`] if it may not.
pub fn checkpoint() -> Result<()> {
    // The function is removed during the call, which may run user code that starts another computation.
    let Some(mut keep_going) = KEEP_GOING.take() else { return Ok(()) };
    let goes_on = keep_going();
    KEEP_GOING.set(Some(keep_going));
    if goes_on { Ok(()) } else { Err(Error::Interrupted) }
}

/// Calls [`checkpoint`] at every 256th `row` of a loop.
///
/// # Errors
/// As [`checkpoint`].
#[inline]
pub fn checkpoint_at(row: usize) -> Result<()> {
    if row.is_multiple_of(ROWS) { checkpoint() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::rc::Rc;

    use super::*;

    #[test]
    fn checkpoints_end_work_once_told_to() {
        let calls = Rc::new(Cell::new(0));
        let counted = calls.clone();
        let keep_going = move || {
            counted.set(counted.get() + 1);
            counted.get() < 3
        };
        let rows = interruptible(keep_going, || (0..10_000).find(|row| checkpoint_at(*row).is_err()));
        assert_eq!((rows, calls.get()), (Some(2 * ROWS), 3));
        assert_eq!(checkpoint(), Ok(()), "nobody asks outside");
    }

    #[test]
    fn a_call_within_a_call_asks_its_own_caller() {
        interruptible(
            || false,
            || {
                assert_eq!(interruptible(|| true, checkpoint), Ok(()));
                assert_eq!(checkpoint(), Err(Error::Interrupted));
            },
        );
    }
}
