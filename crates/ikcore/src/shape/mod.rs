//! Shapes and their distances, independent of robots.
//!
//! A distance is signed: outside it is the gap, inside it is negative. Every result is a lower bound: at most the true
//! distance, with an allowance for rounding subtracted (`ROUNDING` in `checked_shape`).
//!
//! | file | contents |
//! |---|---|
//! | `geometry` | kinds of shapes |
//! | `checked_shape`, `bounding_ball` | validated shape with its bounding ball |
//! | `stored_shape` | serialized shape |
//! | `tangent` | signed distance of a point to a convex set, with a plane that bounds it from below |
//! | `signed_distance` | tangents of the convex shapes |
//! | `ellipsoid` | signed distance to an ellipsoid |
//! | `convex_hull` | convex hulls of points |
//! | `collision_crate` | interface to the collision crate |
//! | `along_segment` | minimum signed distance along a segment |
//! | `segment_distance` | distance of a segment to a shape or another segment |
//! | `bounding_tree`, `nearest_piece` | bounding volume hierarchy for thousands of pieces |
//! | `segment_lanes`, `solid_lanes` | distances of segments, and to boxes and cylinders, for one number or in SIMD lanes |
//! | `body_block`, `eight_shape` | "nearer than m?" for four capsules, and for one at eight configurations |
//! | `shape_index` | shapes near a ball, among many |
//! | `mesh`, `triangle_surface`, `triangle` | triangle meshes, closed or not |
//! | `mesh_pieces`, `enclosure`, `winding` | connected pieces of a mesh, and its interior |
//! | `mesh_hull` | convex hulls of meshes |
//! | `point_cloud`, `grid` | points with a radius, occupied voxels |
//! | `cover` | covers of meshes by few spheres and capsules |
//! | `enclosing_capsule` | capsules that contain other shapes |
//! | `convex`, `convex_distance` | signed distance of any two convex sets |
//! | `near_pieces` | points of a cloud and voxels of a grid near a body |
//! | `posed_body` | body of a robot with its frame, and its distances |
//! | `extent` | extents of bodies and shapes along a direction |
//! | `separation` | nearest point of a capsule to a shape, and the normal there |
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
mod near_pieces;
mod nearest_piece;
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
#[cfg(test)]
mod test_shapes;
mod triangle;
mod triangle_surface;
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
