//! What the tip is to reach: residuals of a frame task and their derivatives, and goals beside it.

mod criterion;
pub mod entrywise;
mod error;
mod four_targets;
mod goal;
mod kind;
mod motion;
mod orientation;
mod pointing;
mod pose;
mod position;
mod reach;
mod region;
mod target;

pub use criterion::{Assessment, Components, Criterion};
pub use error::{SquaredError, TipError, Tolerance};
pub use goal::{Goal, Goals};
pub use kind::{Kind, Task};
pub use motion::{TargetMotion, Twist};
pub use region::{Outside, Region};
pub use target::Target;
