//! What the tip is to reach: residuals of a frame task and their derivatives, and goals beside it.

mod criterion;
mod four_targets;
mod goal;
mod region;
pub(crate) mod residual;
mod target;
mod target_motion;
mod tip_error;
mod tip_task;

pub use criterion::{Assessment, Components, Criterion};
pub use goal::{Goal, Goals};
pub use region::{Outside, Region};
pub use target::Target;
pub use target_motion::{TargetMotion, Twist};
pub use tip_error::{SquaredError, TipError, Tolerance};
pub use tip_task::{Kind, Task};
