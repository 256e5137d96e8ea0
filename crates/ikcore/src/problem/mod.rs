//! The inverse kinematics problem: a robot and a target as an [objective](crate::objective).
//!
//! `inverse_kinematics` is the objective that solvers minimise; `obstruction` explains why a target was missed.

mod inverse_kinematics;
mod obstruction;

pub use inverse_kinematics::Problem;
