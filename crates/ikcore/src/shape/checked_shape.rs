//! Validated shape with its pose.

use std::sync::Arc;

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::bounding_ball::BoundingBall;
use super::convex_hull::Hull;
use super::geometry::Geometry;
use super::grid::Grid;
use super::mesh::Mesh;
use super::point_cloud::PointCloud;
use crate::error::{Error, Result, require_finite, require_positive};
use crate::math::{Pose, pose};

/// Validated shape with its pose: an obstacle in the base frame of a robot, or a body in the frame of its link. Copies share
/// the data of meshes, clouds and grids.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    geometry: Geometry,
    bounds: BoundingBall,
    /// Allowance for rounding in distances from nearby points (m).
    rounding: f64,
}

/// Rounding error of distances, for coordinates of 1 m (m).
pub(super) const ROUNDING: f64 = 1e-12;
/// Largest coordinate in computations (m): products of six larger ones would overflow.
pub(super) const LARGEST: f64 = 1e30;

impl Shape {
    fn made(geometry: Geometry, bounds: BoundingBall) -> Self {
        let reach = if matches!(geometry, Geometry::HalfSpace { .. }) { 0.0 } else { bounds.radius };
        let scale = bounds.center.iter().fold(1.0 + reach, |largest, x| largest.max(reach + x.abs()));
        Self { geometry, bounds, rounding: ROUNDING * scale }
    }

    /// Creates a ball about `center` (m).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a radius that is not positive.
    pub fn sphere(center: [f64; 3], radius: f64) -> Result<Self> {
        require_point("center", &center)?;
        require_positive("radius of the sphere", radius)?;
        Ok(Self::made(Geometry::Sphere { center, radius }, BoundingBall { center, radius }))
    }

    /// Creates a box about `center` with edges `size` (m), rotated by `rotation`.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for an edge that is not positive, [`Error::NotRigid`].
    pub fn cuboid(center: [f64; 3], size: [f64; 3], rotation: Option<Matrix3<f64>>) -> Result<Self> {
        let pose = checked_pose(center, rotation)?;
        require_sizes("size of the box", &size)?;
        let bounds = BoundingBall { center, radius: 0.5 * Vector3::from(size).norm() };
        Ok(Self::made(Geometry::Box { pose, size }, bounds))
    }

    /// Creates a capsule: all points within `radius` of the segment from `a` to `b` (m).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a radius that is not positive.
    pub fn capsule(a: [f64; 3], b: [f64; 3], radius: f64) -> Result<Self> {
        require_point("a", &a)?;
        require_point("b", &b)?;
        require_positive("radius of the capsule", radius)?;
        let center = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        let bounds = BoundingBall { center, radius: 0.5 * (Vector3::from(a) - Vector3::from(b)).norm() + radius };
        Ok(Self::made(Geometry::Capsule { a, b, radius }, bounds))
    }

    /// Creates the set of points within `radius` >= 0 of the segment from `a` to `b` (m): a sphere if the ends are equal,
    /// else a capsule. A radius of zero makes a rod or a point, for bodies of robots.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a negative radius.
    pub(crate) fn swept_ball(a: [f64; 3], b: [f64; 3], radius: f64) -> Result<Self> {
        if radius > 0.0 {
            return if a == b { Self::sphere(a, radius) } else { Self::capsule(a, b, radius) };
        }
        require_point("a", &a)?;
        require_point("b", &b)?;
        if radius != 0.0 {
            return Err(Error::out_of_range("radius of the capsule", "zero or more and finite", radius));
        }
        let center = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        let bounds = BoundingBall { center, radius: 0.5 * (Vector3::from(a) - Vector3::from(b)).norm() };
        let geometry = if a == b { Geometry::Sphere { center: a, radius } } else { Geometry::Capsule { a, b, radius } };
        Ok(Self::made(geometry, bounds))
    }

    /// Creates a cylinder of this radius and length (m) about `center`, along `axis` (of any length).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for an axis of length zero, or a radius or length that is not positive.
    pub fn cylinder(center: [f64; 3], axis: [f64; 3], radius: f64, length: f64) -> Result<Self> {
        let axis = checked_direction("axis of the cylinder", axis)?.into();
        require_point("center", &center)?;
        require_positive("radius of the cylinder", radius)?;
        require_positive("length of the cylinder", length)?;
        let bounds = BoundingBall { center, radius: radius.hypot(0.5 * length) };
        Ok(Self::made(Geometry::Cylinder { center, axis, radius, length }, bounds))
    }

    /// Creates a half-space: all points x with normal . x <= offset (m). A floor is `half_space([0, 0, 1], height)`. The
    /// normal may have any length; `offset` refers to the unit normal.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a normal of length zero.
    pub fn half_space(normal: [f64; 3], offset: f64) -> Result<Self> {
        let normal: [f64; 3] = checked_direction("normal of the half-space", normal)?.into();
        require_finite("offset of the half-space", &[offset], |_| "it".into())?;
        let center = normal.map(|n| n * offset);
        let bounds = BoundingBall { center, radius: f64::INFINITY };
        Ok(Self::made(Geometry::HalfSpace { normal, offset }, bounds))
    }

    /// Creates an ellipsoid about `center` with these semi-axes (m), rotated by `rotation`.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a semi-axis that is not positive, [`Error::NotRigid`].
    pub fn ellipsoid(center: [f64; 3], semi_axes: [f64; 3], rotation: Option<Matrix3<f64>>) -> Result<Self> {
        let pose = checked_pose(center, rotation)?;
        require_sizes("semi-axes of the ellipsoid", &semi_axes)?;
        let bounds = BoundingBall { center, radius: semi_axes.into_iter().fold(0.0, f64::max) };
        Ok(Self::made(Geometry::Ellipsoid { pose, semi_axes }, bounds))
    }

    /// Creates an ellipse in the plane z = 0 about `center` with these semi-axes (m), its first axis at `angle` (rad).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a semi-axis that is not positive.
    pub fn ellipse(center: [f64; 2], semi_axes: [f64; 2], angle: f64) -> Result<Self> {
        require_point("center", &center)?;
        require_sizes("semi-axes of the ellipse", &semi_axes)?;
        require_finite("angle of the ellipse", &[angle], |_| "it".into())?;
        let bounds = BoundingBall { center: [center[0], center[1], 0.0], radius: semi_axes[0].max(semi_axes[1]) };
        Ok(Self::made(Geometry::Ellipse { center, semi_axes, angle }, bounds))
    }

    /// Creates the convex hull of `points` (m), at least four that do not lie in a plane.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::InvalidObstacle`] for fewer points or a flat body.
    pub fn convex_mesh(points: &[[f64; 3]]) -> Result<Self> {
        require_points("points of the convex mesh", points)?;
        let hull = Hull::new(points).map_err(|problem| Error::InvalidObstacle { problem })?;
        let bounds = hull.bounding_ball();
        Ok(Self::made(Geometry::ConvexMesh(Arc::new(hull)), bounds))
    }

    /// Creates a mesh of triangles, each given by three indices of `vertices` (m). The mesh may be non-convex. The interior
    /// of each connected part without boundary belongs to the shape, whatever the orientation of its triangles; see
    /// [`Mesh::is_closed`].
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::InvalidObstacle`] for no triangles, or an index that is not of a vertex.
    pub fn mesh(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Result<Self> {
        require_points("vertices of the mesh", &vertices)?;
        let mesh = Mesh::new(vertices, faces).map_err(|problem| Error::InvalidObstacle { problem })?;
        let bounds = ball_about(mesh.vertices(), 0.0);
        Ok(Self::made(Geometry::Mesh(Arc::new(mesh)), bounds))
    }

    /// Creates a point cloud: balls of one `radius` about `points` (m), for example from a depth camera. One without points
    /// touches nothing.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a negative radius.
    pub fn point_cloud(points: Vec<[f64; 3]>, radius: f64) -> Result<Self> {
        require_points("points of the point cloud", &points)?;
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(Error::out_of_range("radius of the point cloud", "zero or more and finite", radius));
        }
        Ok(Self::of_cloud(PointCloud::new(points, radius)))
    }

    fn of_cloud(cloud: PointCloud) -> Self {
        let bounds = ball_about(cloud.points(), cloud.radius());
        Self::made(Geometry::PointCloud(Arc::new(cloud)), bounds)
    }

    /// Creates a voxel grid: cubes with edges of `voxel` (m), the first with its lowest corner at `origin`. `occupied` has
    /// `counts[0] * counts[1] * counts[2]` entries, with z running fastest. One without occupied voxels touches nothing.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for an edge that is not positive, [`Error::WrongLength`].
    pub fn grid(origin: [f64; 3], voxel: f64, counts: [usize; 3], occupied: Vec<bool>) -> Result<Self> {
        require_point("origin", &origin)?;
        require_positive("voxel of the grid", voxel)?;
        let expected = counts.iter().try_fold(1_usize, |product, count| product.checked_mul(*count));
        if expected != Some(occupied.len()) {
            let expected = format!("{} x {} x {} voxels", counts[0], counts[1], counts[2]);
            return Err(Error::WrongLength { what: "occupied voxels".into(), expected, got: occupied.len() });
        }
        let far: [f64; 3] = std::array::from_fn(|k| origin[k] + voxel * counts[k] as f64);
        require_point("far corner of the grid", &far)?;
        Ok(Self::of_grid(Grid::new(origin, voxel, counts, occupied)))
    }

    fn of_grid(grid: Grid) -> Self {
        let corners: Vec<[f64; 3]> =
            grid.blocks().iter().flat_map(|block| [block.lower.into(), block.upper.into()]).collect();
        let bounds = ball_about(&corners, 0.0);
        Self::made(Geometry::Grid(Arc::new(grid)), bounds)
    }

    /// Returns a cloud without the points, or a grid without the voxels, that are `gone`; other shapes as they are.
    pub(crate) fn without_pieces(&self, gone: &[bool]) -> Self {
        match &self.geometry {
            Geometry::PointCloud(cloud) => Self::of_cloud(cloud.without(gone)),
            Geometry::Grid(grid) => {
                let occupied = grid.occupied().iter().zip(gone).map(|(occupied, gone)| *occupied && !gone).collect();
                Self::of_grid(Grid::new(grid.origin(), grid.voxel(), grid.counts(), occupied))
            }
            _ => self.clone(),
        }
    }

    /// Whether nothing belongs to the shape: a cloud without points, or a grid without occupied voxels.
    pub fn is_empty(&self) -> bool {
        match &self.geometry {
            Geometry::PointCloud(cloud) => cloud.points().is_empty(),
            Geometry::Grid(grid) => grid.blocks().is_empty(),
            _ => false,
        }
    }

    /// Returns the geometry.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Returns the name of the kind, for example "Sphere".
    pub fn name(&self) -> &'static str {
        self.geometry.name()
    }

    /// Returns a ball that contains the shape.
    pub fn bounding_ball(&self) -> BoundingBall {
        self.bounds
    }

    /// Returns the allowance for rounding of a distance to something at most `reach` (m) from the origin. It is subtracted
    /// from each computed distance, so that the result stays a lower bound.
    pub(super) fn rounding(&self, reach: f64) -> f64 {
        self.rounding.max(ROUNDING * reach)
    }

    /// Whether the coordinates are too large for their products. Distances are then bounded by the bounding ball alone.
    pub(crate) fn is_huge(&self) -> bool {
        !(self.rounding <= ROUNDING * LARGEST || matches!(self.geometry, Geometry::HalfSpace { .. }))
    }

    /// Whether the shape is flat, in the plane z = 0, and so undefined for an arm that leaves that plane.
    pub fn is_flat(&self) -> bool {
        matches!(self.geometry, Geometry::Ellipse { .. })
    }

    /// Whether the shape is a mesh that is not closed, so that part of its interior is unknown.
    pub fn is_open_mesh(&self) -> bool {
        matches!(&self.geometry, Geometry::Mesh(mesh) if !mesh.is_closed())
    }

    /// Whether the shape can be a body of a robot: convex, bounded and three-dimensional.
    pub fn can_be_carried(&self) -> bool {
        use Geometry::{Box, Capsule, ConvexMesh, Cylinder, Ellipsoid, Sphere};
        matches!(
            self.geometry,
            Sphere { .. } | Box { .. } | Capsule { .. } | Cylinder { .. } | Ellipsoid { .. } | ConvexMesh(_)
        )
    }
}

/// Returns a ball about the middle of the bounding box of `points` that contains the box, enlarged by `margin` (m); about
/// the origin without points.
fn ball_about(points: &[[f64; 3]], margin: f64) -> BoundingBall {
    if points.is_empty() {
        return BoundingBall { center: [0.0; 3], radius: margin };
    }
    let (mut lower, mut upper) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for point in points {
        lower = lower.inf(&Vector3::from(*point));
        upper = upper.sup(&Vector3::from(*point));
    }
    let middle = 0.5 * (lower + upper);
    BoundingBall { center: middle.into(), radius: 0.5 * (upper - lower).norm() + margin }
}

fn checked_pose(center: [f64; 3], rotation: Option<Matrix3<f64>>) -> Result<Pose> {
    require_point("center", &center)?;
    match rotation {
        None => Ok(Pose::from_parts(center.into(), Rotation3::identity())),
        Some(rotation) => pose::from_rotation_matrix("rotation", rotation, center),
    }
}

fn checked_direction(what: &str, direction: [f64; 3]) -> Result<Vector3<f64>> {
    require_point(what, &direction)?;
    let direction = Vector3::from(direction);
    // Normalized in two steps, since squares of very large or small entries would overflow or vanish.
    let largest = direction.amax();
    let length = largest * direction.unscale(if largest > 0.0 { largest } else { 1.0 }).norm();
    require_positive(&format!("length of the {what}"), length)?;
    // Unit vectors keep their bits, so that a shape can be rebuilt from its parts.
    let is_unit = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
    Ok(if is_unit { direction } else { direction.unscale(largest).normalize() })
}

fn require_point(what: &str, point: &[f64]) -> Result<()> {
    require_finite(what, point, |i| format!("coordinate {}", ["x", "y", "z"][i]))
}

fn require_points(what: &str, points: &[[f64; 3]]) -> Result<()> {
    require_finite(what, points.as_flattened(), |i| format!("coordinate {} of point {}", ["x", "y", "z"][i % 3], i / 3))
}

fn require_sizes(what: &str, sizes: &[f64]) -> Result<()> {
    let along = |i: usize| format!("{what} along {}", ["x", "y", "z"][i]);
    sizes.iter().enumerate().try_for_each(|(i, size)| require_positive(&along(i), *size))
}
