//! The curve that the tip follows, without its timing.
//!
//! | file | what |
//! |---|---|
//! | `tip_curve` | [`TipPath`]: straight segments from point to point |
//! | `path_target`, `tolerance_band` | what the tip has to meet at a point of it, and how far it may be off |
//! | `sampling` | the curve of a timed path |
//! | `corners` | where its direction jumps |
//! | `coarseness` | how well its rows determine it |
//! | `rounded` | the curve with rounded corners |
//! | `segment_geometry` | angles and distances of single segments |
//! | `repetition` | points that must differ |

mod coarseness;
mod corners;
mod path_target;
mod repetition;
mod rounded;
mod sampling;
mod segment_geometry;
mod tip_curve;
mod tolerance_band;

pub(crate) use path_target::{PathTarget, angle_between};
pub(crate) use repetition::refuse_repetition;
pub use tip_curve::TipPath;
pub(crate) use tolerance_band::{Borders, Displacement, ToleranceBand};
