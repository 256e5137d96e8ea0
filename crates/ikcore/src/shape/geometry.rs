//! The kinds of shapes.

use std::sync::Arc;

use super::convex_hull::Hull;
use super::grid::Grid;
use super::mesh::Mesh;
use super::point_cloud::PointCloud;
use crate::math::Pose;

/// The geometry of a shape (m, rad), in the frame in which the shape was made.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// A ball.
    Sphere {
        /// Its centre.
        center: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A box.
    Box {
        /// Its centre and axes.
        pose: Pose,
        /// Its edges along those axes.
        size: [f64; 3],
    },
    /// All points within `radius` of the segment from `a` to `b`.
    Capsule {
        /// One end of the axis.
        a: [f64; 3],
        /// The other end.
        b: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A cylinder with flat ends.
    Cylinder {
        /// Its centre.
        center: [f64; 3],
        /// Its axis, of unit length.
        axis: [f64; 3],
        /// Its radius.
        radius: f64,
        /// Its length along the axis.
        length: f64,
    },
    /// All points x with normal . x <= offset, such as a floor.
    HalfSpace {
        /// The outward normal, of unit length.
        normal: [f64; 3],
        /// Distance of the surface from the origin along the normal.
        offset: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Its centre and axes.
        pose: Pose,
        /// Half its extent along those axes.
        semi_axes: [f64; 3],
    },
    /// An ellipse in the plane z = 0, for planar arms.
    Ellipse {
        /// Its centre (x, y).
        center: [f64; 2],
        /// Half its extent along its own x and y axis.
        semi_axes: [f64; 2],
        /// Angle from the x axis of the base to its own.
        angle: f64,
    },
    /// The convex hull of some points.
    ConvexMesh(Arc<Hull>),
    /// A surface of triangles, with what its closed parts enclose.
    Mesh(Arc<Mesh>),
    /// Balls of one radius about many points.
    PointCloud(Arc<PointCloud>),
    /// The occupied voxels of a grid.
    Grid(Arc<Grid>),
}

impl Geometry {
    /// The name of the kind, such as "Sphere".
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
