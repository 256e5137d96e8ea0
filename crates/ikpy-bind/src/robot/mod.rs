//! `Robot`, its methods by what they are about.

mod chain_elements;
mod constructors;
mod kinematics;
mod manipulability;
mod model;
mod modified_copies;

pub use manipulability::PyVelocityEllipsoid;
pub use model::PyRobot;
