//! Robots: the serial chain from a base link to a tip link, its joints, limits and kinematics.

mod arrays;
mod as_built;
mod builder;
mod catalog;
mod chain;
mod collision;
mod dh;
mod directions;
mod dispatch;
mod four_kinematics;
mod joint;
mod kinematics;
mod lane_search;
mod model;
mod planar;
mod reach;
mod screws;
mod seed_index;
mod seeds;
mod stages;
mod stored;
mod upright;
mod urdf;

pub use builder::{ChainBuilder, Drive, Element};
pub use collision::LinkCapsule;
pub use dh::{Dh, DhTable};
pub use directions::Directions;
pub use four_kinematics::FourColumns;
pub use joint::{Joint, JointKind};
pub use kinematics::{Columns, Wrench};
pub use model::Robot;
pub use reach::{Beyond, Reach};
pub use screws::{Screw, Screws};
pub use seeds::Seeds;
pub use upright::Upright;

use crate::math::MAX_DOF;
