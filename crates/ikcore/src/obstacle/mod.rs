//! Collisions of capsule-shaped links with convex obstacles and with each other: distances, and certified motions.
//!
//! | file | what |
//! |---|---|
//! | `shape` | the obstacles: sphere, box, capsule, ellipsoid, flat ellipse, convex hull |
//! | `tangent` | signed distance of a point to a convex set, with a plane that bounds it from below |
//! | `ellipsoid` | the nearest point of an ellipsoid |
//! | `convex_hull` | convex hulls from the collision crate; the only file that knows its types |
//! | `segment_distance` | distance of a segment to a convex set or another segment, certified from below |
//! | `scene` | a robot among obstacles: pairs that can touch, and their distances at one configuration |
//! | `link_displacement` | bound on the motion of a link for given joint motions |
//! | `triangles` | triangles for drawing |
//! | `sweep` | continuous collision checking of a whole motion, and its smallest clearance |

#[cfg(feature = "convex-mesh")]
mod convex_hull;
mod ellipsoid;
mod link_displacement;
mod scene;
mod segment_distance;
mod shape;
mod signed_distance;
mod sweep;
mod tangent;
mod triangles;

pub use scene::{Body, Contact, Scene};
pub use shape::{Obstacle, Shape};
pub use sweep::{Edge, JointMotion, Sweep, TooNear};
