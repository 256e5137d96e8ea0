//! Collisions of links with obstacles and with each other: distances, and certified motions.
//!
//! | file | what |
//! |---|---|
//! | `obstacles` | what to keep clear of, prepared once |
//! | `placement` | where the bodies of a robot are at a configuration |
//! | `allowed_contacts` | which bodies may touch which obstacles |
//! | `body_groups` | bodies by moving element, in the lanes of the registers: is everything clear? |
//! | `surroundings`, `clear_space` | what a caller wants to keep clear of, and whether a configuration does |
//! | `body_model` | bodies, groups and pairs of a robot, made once |
//! | `eight_scene`, `eight_bodies`, `travel_bounds` | which pairs are near each other at eight configurations? |
//! | `which_clear` | which of many configurations are clear? |
//! | `sampled_line` | is a straight line in joint space clear, for searches? |
//! | `contact` | what a robot is near to, where and how far |
//! | `scene` | a robot among obstacles: pairs that can touch, and their distances at one configuration |
//! | `near_pairs` | the nearest pairs |
//! | `link_displacement` | bound on the motion of a link for given joint motions |
//! | `near_rows` | near pairs, linearised at a configuration |
//! | `coming_rows` | obstacles that come too near, linearised at their closest approach |
//! | `joint_motion` | motions that can be certified |
//! | `motion_certificate`, `required_distance` | pairs of bodies, certified to keep their distances during a motion |
//! | `clearance_sweep` | a whole motion, certified, and its smallest clearance |

mod allowed_contacts;
mod body_groups;
mod body_model;
mod clear_space;
mod clearance_sweep;
mod coming_rows;
mod contact;
mod eight_bodies;
mod eight_scene;
mod joint_motion;
mod link_displacement;
mod motion_certificate;
mod near_pairs;
mod near_rows;
mod obstacles;
mod placement;
mod required_distance;
mod sampled_line;
mod scene;
mod surroundings;
mod travel_bounds;
mod which_clear;

pub(crate) use clear_space::Blocked;
pub use clear_space::ClearSpace;
pub use clearance_sweep::{ClearanceSweep, TooNear};
pub(crate) use coming_rows::{Coming, ComingRows, MOST_COMING};
pub use contact::{Contact, NearestContact, Neighbor};
pub use joint_motion::{Edge, JointMotion};
pub(crate) use motion_certificate::MotionCertificate;
pub(crate) use near_rows::{MOST_ROWS, NearRow, NearRows};
pub use obstacles::Obstacles;
pub(crate) use required_distance::RequiredDistance;
pub use sampled_line::SampledLine;
pub use scene::Scene;
pub use surroundings::Surroundings;
pub(crate) use surroundings::kept_margin;
