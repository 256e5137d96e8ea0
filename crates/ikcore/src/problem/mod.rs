//! Inverse kinematics problem: a robot and a target as an [objective](crate::objective).
//!
//! `inverse_kinematics` is the objective that solvers minimise; `tip_starts` proposes starts for several tips; `obstruction`
//! explains why a target was missed.

mod inverse_kinematics;
mod obstruction;
mod tip_starts;

pub use inverse_kinematics::Problem;
