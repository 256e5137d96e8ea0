//! Collisions of links with obstacles and with each other: distances, and certified motions.
//!
//! Callers ask for [`Surroundings`]; at the door of a call these become a [`ClearSpace`], with robot, obstacles, margin and pairs.
//! A [`Clearance`] is the answer to "how near?".
//!
//! | file | what |
//! |---|---|
//! | `obstacles` | shapes and the links that may touch them, prepared once |
//! | `surroundings` | obstacles, margin and self-collision, as a caller asks for them |
//! | `clear_space` | configurations at which a robot keeps the margin |
//! | `clearance`, `contact` | the smallest distance, and the two bodies there |
//! | `scene` | a robot among obstacles: pairs that can touch, and their distances at one configuration |
//! | `allowed_contacts` | bodies that may touch an obstacle |
//! | `clear_groups` | clearance test of one configuration, four bodies at a time |
//! | `eight_scene`, `travel_bounds` | near pairs at eight configurations |
//! | `own_points` | advice where measurements contain the robot |
//! | `without_robot` | clouds and grids without the robot's own points |
//! | `which_clear` | clear ones of many configurations |
//! | `sampled_line` | lines in joint space, sampled, for searches |
//! | `near_pairs` | the nearest pairs |
//! | `link_displacement` | bound on the motion of a link for given joint motions |
//! | `near_rows` | near pairs, linearised at a configuration |
//! | `coming_rows` | obstacles that come too near, linearised at their closest approach |
//! | `joint_motion` | motions that can be certified |
//! | `motion_certificate`, `required_distance` | certificate that pairs of bodies keep their distances during a motion |
//! | `clearance_sweep` | certificate of a whole motion, and its smallest clearance |

mod allowed_contacts;
mod clear_groups;
mod clear_space;
mod clearance;
mod clearance_sweep;
mod coming_rows;
mod contact;
mod eight_scene;
mod joint_motion;
mod link_displacement;
mod motion_certificate;
mod near_pairs;
mod near_rows;
mod obstacles;
mod own_points;
mod required_distance;
mod sampled_line;
mod scene;
mod surroundings;
mod travel_bounds;
mod which_clear;
mod without_robot;

pub(crate) use clear_space::Blocked;
pub use clear_space::ClearSpace;
pub use clearance::Clearance;
pub(crate) use clearance::clear_in_words;
pub use clearance_sweep::{ClearanceSweep, TooNear};
pub(crate) use coming_rows::{Coming, ComingRows, MOST_COMING};
pub use contact::{Contact, NearestContact, Neighbor};
pub use joint_motion::{Edge, JointMotion};
pub(crate) use link_displacement::sagitta_along;
pub(crate) use motion_certificate::MotionCertificate;
pub(crate) use near_rows::{MOST_ROWS, NearRow, NearRows};
pub use obstacles::{Obstacle, Obstacles};
pub use own_points::Sensed;
pub(crate) use required_distance::RequiredDistance;
pub use sampled_line::SampledLine;
pub use scene::{Scene, SceneRobot};
pub use surroundings::Surroundings;
pub use without_robot::WithoutRobot;
