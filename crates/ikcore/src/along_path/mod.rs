//! Motions along a path of the tip.
//!
//! | file | what |
//! |---|---|
//! | `tip_path` | [`TipPath`]: the curve that the tip follows, and how far it may be off |
//! | `deviation` | the distance of the tip from its path |
//! | `open_turns` | whole turns of joints, left open while a path is followed |
//! | `missed_points` | points of a path that no configuration is found for |
//! | `timed` | redundancy and fastest timing in one search |
//! | `clear_path` | the same among obstacles |

pub(crate) mod clear_path;
mod deviation;
mod missed_points;
mod open_turns;
pub(crate) mod timed;
mod tip_path;

pub(crate) use deviation::{LargestDeviation, TipDeviation};
pub(crate) use missed_points::missed_points;
pub use tip_path::TipPath;
pub(crate) use tip_path::{Borders, PathTarget, ToleranceBand, refuse_repetition};
