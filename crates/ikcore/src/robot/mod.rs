//! The robot: joints with limits, links, base, tool and bodies. Immutable, validated once, shared without locks.
//!
//! Kernels are in [`kinematics`](crate::kinematics), files and named robots in [`load`](crate::load). Read [`Robot`] first.
//!
//! | file | what |
//! |---|---|
//! | `joint`, `description`, `builder` | from joints and elements to a robot |
//! | `model` | [`Robot`] |
//! | `kinematics`, `batched` | kinematics of one configuration, and of many |
//! | `link_capsule`, `bodies` | capsules on the links |
//! | `manufacturing_errors` | a robot with random manufacturing errors |
//! | `serialization` | robots as bytes |

mod batched;
mod bodies;
mod builder;
mod description;
mod joint;
mod kinematics;
mod link_capsule;
mod manufacturing_errors;
mod model;
mod serialization;

pub use builder::ChainBuilder;
pub(crate) use description::require_supported;
pub use description::{Drive, Element};
pub use joint::{Joint, JointKind};
pub(crate) use link_capsule::Bodies;
pub use link_capsule::LinkCapsule;
pub use model::Robot;
