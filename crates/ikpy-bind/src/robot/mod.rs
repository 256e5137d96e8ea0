//! `Robot`: its methods, grouped by topic.

mod body;
mod chain_elements;
mod constructors;
mod joint_values;
mod kinematics;
mod manipulability;
mod model;
mod modified_copies;

pub use body::PyBody;
pub use manipulability::PyVelocityEllipsoid;
pub use model::PyRobot;
