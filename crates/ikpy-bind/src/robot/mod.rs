//! `Robot`, its methods by what they are about.

mod chain;
mod kinematics;
mod make;
mod manipulability;
mod model;
mod variants;

pub use manipulability::PyVelocityEllipsoid;
pub use model::PyRobot;
