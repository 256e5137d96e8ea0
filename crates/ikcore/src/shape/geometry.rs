//! Kinds of shapes.

use std::sync::Arc;

use super::convex_hull::Hull;
use super::grid::Grid;
use super::mesh::Mesh;
use super::point_cloud::PointCloud;
use crate::math::Pose;

/// Geometry of a shape (m, rad), in the frame in which the shape was made.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// Ball.
    Sphere {
        /// Centre.
        center: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// Box.
    Box {
        /// Centre and axes.
        pose: Pose,
        /// Edge lengths along the axes of `pose`.
        size: [f64; 3],
    },
    /// Capsule: all points within `radius` of the segment from `a` to `b`.
    Capsule {
        /// First end of the axis.
        a: [f64; 3],
        /// Second end of the axis.
        b: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// Cylinder with flat ends.
    Cylinder {
        /// Centre.
        center: [f64; 3],
        /// Unit vector along the axis.
        axis: [f64; 3],
        /// Radius.
        radius: f64,
        /// Length along the axis.
        length: f64,
    },
    /// Half-space of points x with normal . x <= offset, for example a floor.
    HalfSpace {
        /// Outward unit normal.
        normal: [f64; 3],
        /// Distance of the surface from the origin along the normal.
        offset: f64,
    },
    /// Ellipsoid.
    Ellipsoid {
        /// Centre and axes.
        pose: Pose,
        /// Semi-axes along the axes of `pose`.
        semi_axes: [f64; 3],
    },
    /// Ellipse in the plane z = 0, for planar arms.
    Ellipse {
        /// Centre (x, y).
        center: [f64; 2],
        /// Semi-axes along its own x and y axis.
        semi_axes: [f64; 2],
        /// Angle from the x axis of the base to that of the ellipse.
        angle: f64,
    },
    /// Convex hull of points.
    ConvexMesh(Arc<Hull>),
    /// Triangle mesh, together with the interior of its closed parts.
    Mesh(Arc<Mesh>),
    /// Balls of one radius about many points.
    PointCloud(Arc<PointCloud>),
    /// Occupied voxels of a grid.
    Grid(Arc<Grid>),
}

impl Geometry {
    /// Returns the name of the kind, for example "Sphere".
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "Sphere",
            Self::Box { .. } => "Box",
            Self::Capsule { .. } => "Capsule",
            Self::Cylinder { .. } => "Cylinder",
            Self::HalfSpace { .. } => "HalfSpace",
            Self::Ellipsoid { .. } => "Ellipsoid",
            Self::Ellipse { .. } => "Ellipse",
            Self::ConvexMesh(_) => "ConvexMesh",
            Self::Mesh(_) => "Mesh",
            Self::PointCloud(_) => "PointCloud",
            Self::Grid(_) => "Grid",
        }
    }
}
