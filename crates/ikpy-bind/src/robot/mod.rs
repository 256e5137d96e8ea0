//! `Robot`: its methods, grouped by topic.

mod chain_elements;
mod constructors;
mod kinematics;
mod manipulability;
mod model;
mod modified_copies;

pub use manipulability::PyVelocityEllipsoid;
pub use model::PyRobot;
