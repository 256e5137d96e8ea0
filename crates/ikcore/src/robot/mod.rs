//! Robots: a serial chain from a base link to a tip link, its joints, limits and links.

mod batched;
mod bodies;
mod builder;
mod joint;
mod manufacturing_errors;
mod model;
mod serialization;

pub(crate) use bodies::CollisionModel;
pub use bodies::LinkCapsule;
pub use builder::{ChainBuilder, Drive, Element};
pub use joint::{Joint, JointKind};
pub use model::Robot;
