//! Constraints of a motion: errors of tasks that stay within their tolerances at every instant, such as a cup that stays upright.
//!
//! Each constraint gives its errors at a configuration and a bound of them between two, so that one walker certifies them all: it
//! halves the intervals of a motion until the bounds hold or an error is too large. So no motion leaves a tolerance between samples.
//!
//! | file | what |
//! |---|---|
//! | `keep` | [`Keep`]: a task and its target |
//! | `gauge` | one error of a task: its value, and its bound between two configurations |
//! | `drift` | how a joint changes the errors: their slopes |
//! | `tip_bend` | how far a tip, or one tip seen from another, gets off the straight line between two configurations |
//! | `keep_sweep` | certificate of a motion, and its largest errors |
//! | `onto` | configurations moved to where constraints hold |
//! | `tip_jet` | velocity and turn rate of a tip over an interval |
//! | `tip_rates` | limits of the speed, acceleration and turn speed of tips |

mod drift;
mod gauge;
mod keep;
mod keep_sweep;
mod onto;
mod tip_bend;
mod tip_jet;
mod tip_rates;

pub use keep::Keep;
pub(crate) use keep::{KeepRow, refuse_broken};
pub(crate) use keep_sweep::KeepScratch;
pub use keep_sweep::{Broken, KeepSweep};
pub(crate) use onto::{KeepTasks, Onto};
pub(crate) use tip_jet::{SQUARE, TipJet, VectorJet};
pub(crate) use tip_rates::{JointSpan, TIGHT, TipExcess, TipRates};
