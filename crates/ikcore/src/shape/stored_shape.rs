//! Serialized shape, validated when it is read.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::checked_shape::Shape;
use super::geometry::Geometry;
use crate::error::Error;
use crate::math::Pose;

/// Construction parameters of a shape.
#[derive(Serialize, Deserialize)]
enum StoredShape {
    Sphere([f64; 3], f64),
    Box(Pose, [f64; 3]),
    Capsule([f64; 3], [f64; 3], f64),
    Cylinder([f64; 3], [f64; 3], f64, f64),
    HalfSpace([f64; 3], f64),
    Ellipsoid(Pose, [f64; 3]),
    Ellipse([f64; 2], [f64; 2], f64),
    ConvexMesh(Vec<[f64; 3]>),
    Mesh(Vec<[f64; 3]>, Vec<[u32; 3]>),
    PointCloud(Vec<[f64; 3]>, f64),
    Grid([f64; 3], f64, [usize; 3], Vec<bool>),
}

impl Serialize for Shape {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StoredShape::from(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Shape {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::try_from(StoredShape::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

impl From<&Shape> for StoredShape {
    fn from(shape: &Shape) -> Self {
        match shape.geometry() {
            Geometry::Sphere { center, radius } => Self::Sphere(*center, *radius),
            Geometry::Box { pose, size } => Self::Box(*pose, *size),
            Geometry::Capsule { a, b, radius } => Self::Capsule(*a, *b, *radius),
            Geometry::Cylinder { center, axis, radius, length } => Self::Cylinder(*center, *axis, *radius, *length),
            Geometry::HalfSpace { normal, offset } => Self::HalfSpace(*normal, *offset),
            Geometry::Ellipsoid { pose, semi_axes } => Self::Ellipsoid(*pose, *semi_axes),
            Geometry::Ellipse { center, semi_axes, angle } => Self::Ellipse(*center, *semi_axes, *angle),
            Geometry::ConvexMesh(hull) => Self::ConvexMesh(hull.points().to_vec()),
            Geometry::Mesh(mesh) => Self::Mesh(mesh.vertices().to_vec(), mesh.faces().to_vec()),
            Geometry::PointCloud(cloud) => Self::PointCloud(cloud.points().to_vec(), cloud.radius()),
            Geometry::Grid(grid) => Self::Grid(grid.origin(), grid.voxel(), grid.counts(), grid.occupied().to_vec()),
        }
    }
}

impl TryFrom<StoredShape> for Shape {
    type Error = Error;

    fn try_from(stored: StoredShape) -> Result<Self, Error> {
        let rotation = |pose: &Pose| Some(*pose.rotation.matrix());
        let center = |pose: &Pose| pose.translation.vector.into();
        match stored {
            StoredShape::Sphere(center, radius) => Self::swept_ball(center, center, radius),
            StoredShape::Box(pose, size) => Self::cuboid(center(&pose), size, rotation(&pose)),
            StoredShape::Capsule(a, b, radius) if a == b => Self::capsule(a, b, radius),
            StoredShape::Capsule(a, b, radius) => Self::swept_ball(a, b, radius),
            StoredShape::Cylinder(center, axis, radius, length) => Self::cylinder(center, axis, radius, length),
            StoredShape::HalfSpace(normal, offset) => Self::half_space(normal, offset),
            StoredShape::Ellipsoid(pose, semi_axes) => Self::ellipsoid(center(&pose), semi_axes, rotation(&pose)),
            StoredShape::Ellipse(center, semi_axes, angle) => Self::ellipse(center, semi_axes, angle),
            StoredShape::ConvexMesh(points) => Self::convex_mesh(&points),
            StoredShape::Mesh(vertices, faces) => Self::mesh(vertices, faces),
            StoredShape::PointCloud(points, radius) => Self::point_cloud(points, radius),
            StoredShape::Grid(origin, voxel, counts, occupied) => Self::grid(origin, voxel, counts, occupied),
        }
    }
}
