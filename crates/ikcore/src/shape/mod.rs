//! Shapes and their distances; no robots.
//!
//! A distance is signed: outside it is the gap, inside it is negative. Every result is on the safe side: at most the true
//! distance, with an allowance for rounding taken off (`ROUNDING` in `checked_shape`).
//!
//! | file | what |
//! |---|---|
//! | `geometry` | the kinds of shapes |
//! | `checked_shape`, `bounding_ball` | a validated shape with a ball that holds it |
//! | `stored_shape` | a shape as plain data, for storing |
//! | `tangent` | signed distance of a point to a convex set, with a plane that bounds it from below |
//! | `signed_distance` | tangents of the convex shapes |
//! | `ellipsoid` | the nearest point of an ellipsoid |
//! | `convex_hull` | convex hulls of points |
//! | `collision_crate` | the only file that uses the types of the collision crate |
//! | `along_segment` | the lowest signed distance along a segment |
//! | `segment_distance` | distance of a segment to a shape or another segment |
//! | `bounding_tree` | four-way tree of boxes for thousands of pieces |
//! | `segment_lanes`, `solid_lanes` | the same, for one number, or several in the lanes of a register |
//! | `body_block`, `eight_shape` | "nearer than m?" for four capsules at once, and for one at eight configurations |
//! | `shape_index` | finds the shapes near a ball, among many |
//! | `mesh`, `triangle` | triangle meshes, closed or not |
//! | `mesh_pieces`, `enclosure`, `winding` | connected pieces of a mesh, and what they enclose |
//! | `mesh_hull` | convex hulls of meshes |
//! | `point_cloud`, `grid` | points with a radius, occupied voxels |
//! | `cover` | covers of meshes by few spheres and capsules |
//! | `enclosing_capsule` | capsules that hold other shapes |
//! | `convex`, `convex_distance` | the signed distance of any two convex sets |
//! | `posed_body` | a body of a robot at a pose, and its distances |
//! | `extent` | how far bodies and shapes extend along a direction |
//! | `separation` | where a capsule is nearest to a shape, and the normal there |
//! | `triangles` | triangles for drawing |

mod along_segment;
mod body_block;
mod bounding_ball;
mod bounding_tree;
mod checked_shape;
mod collision_crate;
mod convex;
mod convex_distance;
mod convex_hull;
mod cover;
mod eight_shape;
mod ellipsoid;
mod enclosing_capsule;
mod enclosure;
mod extent;
mod geometry;
mod grid;
mod mesh;
mod mesh_hull;
mod mesh_pieces;
mod point_cloud;
mod posed_body;
#[cfg(test)]
mod scale_tests;
mod segment_distance;
mod segment_lanes;
mod separation;
mod shape_index;
mod signed_distance;
mod solid_lanes;
mod stored_shape;
mod tangent;
mod triangle;
mod triangles;
mod winding;

pub(crate) use along_segment::LineSegment;
pub(crate) use body_block::{BodyBlock, clear_of_each_other};
pub use bounding_ball::BoundingBall;
pub use checked_shape::Shape;
pub use convex_hull::Hull;
pub use cover::Cover;
pub(crate) use eight_shape::{EightCapsules, EightShape, LARGEST_IN_SINGLE, Vectors, below_square, splat};
pub use geometry::Geometry;
pub use grid::Grid;
pub use mesh::Mesh;
pub use point_cloud::PointCloud;
pub(crate) use posed_body::PosedBody;
pub(crate) use shape_index::ShapeIndex;
