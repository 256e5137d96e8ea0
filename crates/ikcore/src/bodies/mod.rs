//! Collision bodies of an arm, prepared once: capsules and convex shapes, each in the frame that carries it.
//!
//! | file | what |
//! |---|---|
//! | `carried_body` | a body in the frame of the moving element that carries it |
//! | `body_poses` | frames and axes of all bodies at one configuration |
//! | `body_groups` | bodies by moving element, with a bounding ball each, in the lanes of the registers |
//! | `eight_bodies` | the bodies at eight configurations, in single precision |
//! | `body_model` | bodies, groups, and the pairs that must not touch |

mod body_groups;
mod body_model;
mod body_poses;
mod carried_body;
mod eight_bodies;

pub(crate) use body_groups::{Balls, BodyGroups, BodyTest, Group, GroupPair};
pub(crate) use body_model::{BodyModel, BodyPair};
pub(crate) use body_poses::BodyPoses;
pub(crate) use carried_body::CarriedBody;
pub(crate) use eight_bodies::EightPoses;
