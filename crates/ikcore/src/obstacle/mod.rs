//! Collisions of links with obstacles and with each other: distances, and certified motions.
//!
//! | file | what |
//! |---|---|
//! | `placement` | where the bodies of a robot are at a configuration |
//! | `body_groups` | bodies by moving element, in the lanes of the registers: is everything clear? |
//! | `contact` | what a robot is near to, where and how far |
//! | `scene` | a robot among obstacles: pairs that can touch, and their distances at one configuration |
//! | `link_displacement` | bound on the motion of a link for given joint motions |
//! | `sweep` | continuous collision checking of a whole motion, and its smallest clearance |

mod body_groups;
mod contact;
mod link_displacement;
mod placement;
mod scene;
mod sweep;

pub use contact::{Contact, NearestContact, Neighbor};
pub use scene::Scene;
pub use sweep::{Edge, JointMotion, Sweep, TooNear};
