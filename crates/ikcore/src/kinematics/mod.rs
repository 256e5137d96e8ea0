//! Kinematics of a serial chain given as plain data: tip, Jacobian, joint torques, link frames, screws, reach.

pub(crate) mod chain;
mod dispatch;
mod fixed_direction;
pub(crate) mod forward;
mod four_jacobians;
mod reach;
mod screws;
mod stages;
mod task_rank;

pub use fixed_direction::Upright;
pub use forward::{Columns, Wrench};
pub use four_jacobians::FourColumns;
pub use reach::{Beyond, Reach};
pub use screws::{Screw, Screws};
pub use task_rank::Directions;
