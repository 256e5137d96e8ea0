//! The curve that the tip is to follow, whatever the time.
//!
//! | file | what |
//! |---|---|
//! | `curve` | [`TipPath`]: straight segments from place to place |
//! | `sampling` | the same of a path in time |
//! | `corners` | where its direction jumps |
//! | `segment` | angles and distances of single segments |
//! | `repetition` | points that must differ |

mod corners;
mod curve;
mod repetition;
mod sampling;
mod segment;

pub use curve::TipPath;
pub(super) use repetition::refuse_repetition;
