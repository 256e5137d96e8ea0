//! Targets and tasks of the tip, their residuals and derivatives, and secondary goals in the null space.
//!
//! A [`Task`] turns the caller's target into a [`Target`] and a [`Criterion`], which decides when the target is reached
//! ([`Tolerance`], [`Components`], [`Region`]). `residual` holds the mathematics of each kind of target; `tip_assessment`,
//! `region_assessment` and `robot_assessment` apply it to a tip without a region, a tip in a region and a robot at q. A
//! `named_task` is for a tip or a pair of tips; validated, it is a `checked_task`; `aims` are such tasks with their targets.
//! `band` reduces errors to the excess over the tolerances; `region_band` is the part of a region within them; `ranked` models
//! a pose in which one part comes [`First`];
//! `levels` sorts tasks of several tips. [`Goals`] are costs in the null space of the task.

mod aims;
mod assessment;
mod band;
mod checked_task;
mod components;
mod criterion;
mod first;
mod goal;
mod least_torque;
mod levels;
mod named_task;
mod ranked;
mod region;
mod region_assessment;
mod region_band;
pub(crate) mod residual;
mod robot_assessment;
mod subject;
mod target;
mod target_segment;
mod tip_assessment;
mod tip_error;
mod tip_task;

pub use aims::Aims;
pub use assessment::Assessment;
pub use checked_task::CheckedTask;
pub use components::Components;
pub use criterion::Criterion;
pub use first::First;
pub use goal::{Goal, Goals};
pub(crate) use levels::Levels;
pub use named_task::NamedTask;
pub use region::{Outside, Region};
pub use subject::Subject;
pub(crate) use target::check_point;
pub use target::{Target, TargetRow};
pub(crate) use target_segment::TargetSegment;
pub use target_segment::Twist;
pub use tip_error::{SquaredError, TipError, Tolerance};
pub use tip_task::{Task, TaskKind};
