//! `Robot`: its methods, grouped by topic.

mod body;
mod chain_elements;
mod constructors;
mod dynamics;
mod inertia;
mod joint_values;
mod kinematics;
mod manipulability;
mod model;
mod modified_copies;
mod robot_class;

pub use body::PyBody;
pub use inertia::PyInertia;
pub use manipulability::PyVelocityEllipsoid;
pub use robot_class::PyRobot;
