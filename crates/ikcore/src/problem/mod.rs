//! The inverse kinematics problem: a robot and a target as an [objective](crate::objective).
//!
//! `inverse_kinematics` is the objective that solvers minimise; `aim` says for which tips, `tip_starts` where searches for several
//! begin. `obstruction` explains why a target was missed.

mod aim;
mod inverse_kinematics;
mod obstruction;
mod tip_starts;

pub use inverse_kinematics::Problem;
