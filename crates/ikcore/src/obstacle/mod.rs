//! Obstacles and the room that links take up: distances, and motions certified to keep clear between samples too.
//!
//! | file | what |
//! |---|---|
//! | [`shape`] | the obstacles: sphere, box, capsule, ellipsoid, flat ellipse, convex hull |
//! | `tangent` | signed distance of a point to a convex set, with a plane that bounds it from below |
//! | `ellipsoid` | the nearest point of an ellipsoid |
//! | `convert` | convex hulls from the collision crate; the only file that knows its types |
//! | `segment` | distance of a segment to a convex set or another segment, certified from below |
//! | [`scene`] | a robot among obstacles: which pairs can touch, and how near they are at one configuration |
//! | `displacement` | how far a link can move while the joints move by so much |
//! | `surface` | triangles for drawing |
//! | [`sweep`] | whether a whole motion keeps clear, and its smallest clearance |

#[cfg(feature = "convex-mesh")]
mod convert;
mod displacement;
mod ellipsoid;
pub mod scene;
mod segment;
pub mod shape;
mod surface;
pub mod sweep;
mod tangent;

pub use scene::{Contact, Party, Scene};
pub use shape::{Obstacle, Shape};
pub use sweep::{Edge, Motion, Sweep};
