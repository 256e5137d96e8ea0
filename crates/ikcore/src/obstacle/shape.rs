//! Obstacles: convex shapes, fixed in the frame of the robot's base.

use nalgebra::{Matrix3, Rotation3, Vector3};

#[cfg(feature = "convex-mesh")]
use super::convex_hull::Hull;
#[cfg(feature = "convex-mesh")]
use crate::error::Error;
use crate::error::{Result, require_finite, require_positive};
use crate::math::{Pose, pose};

/// The geometry of an obstacle (m, rad).
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
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
    #[cfg(feature = "convex-mesh")]
    ConvexMesh(Hull),
}

/// A validated obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    shape: Shape,
    /// Centre of a sphere that holds the shape (m).
    pub(super) bounding_center: [f64; 3],
    /// Its radius (m).
    pub(super) bounding_radius: f64,
}

impl Obstacle {
    /// A ball about `center` (m).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a radius that is not positive.
    pub fn sphere(center: [f64; 3], radius: f64) -> Result<Self> {
        require_point("center", &center)?;
        require_positive("radius of the sphere", radius)?;
        Ok(Self { shape: Shape::Sphere { center, radius }, bounding_center: center, bounding_radius: radius })
    }

    /// A box about `center` with these edges (m), turned by `rotation`.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for an edge that is not positive, [`Error::NotRigid`].
    pub fn cuboid(center: [f64; 3], size: [f64; 3], rotation: Option<Matrix3<f64>>) -> Result<Self> {
        let pose = placed(center, rotation)?;
        require_sizes("size of the box", &size)?;
        Ok(Self {
            shape: Shape::Box { pose, size },
            bounding_center: center,
            bounding_radius: 0.5 * Vector3::from(size).norm(),
        })
    }

    /// All points within `radius` of the segment from `a` to `b` (m).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a radius that is not positive.
    pub fn capsule(a: [f64; 3], b: [f64; 3], radius: f64) -> Result<Self> {
        require_point("a", &a)?;
        require_point("b", &b)?;
        require_positive("radius of the capsule", radius)?;
        let bounding_center = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        let bounding_radius = 0.5 * (Vector3::from(a) - Vector3::from(b)).norm() + radius;
        Ok(Self { shape: Shape::Capsule { a, b, radius }, bounding_center, bounding_radius })
    }

    /// An ellipsoid about `center` with these semi-axes (m), turned by `rotation`.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a semi-axis that is not positive, [`Error::NotRigid`].
    pub fn ellipsoid(center: [f64; 3], semi_axes: [f64; 3], rotation: Option<Matrix3<f64>>) -> Result<Self> {
        let pose = placed(center, rotation)?;
        require_sizes("semi-axes of the ellipsoid", &semi_axes)?;
        let bounding_radius = semi_axes.into_iter().fold(0.0, f64::max);
        Ok(Self { shape: Shape::Ellipsoid { pose, semi_axes }, bounding_center: center, bounding_radius })
    }

    /// An ellipse in the plane z = 0 about `center` with these semi-axes (m), its first axis at `angle` (rad).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OutOfRange`] for a semi-axis that is not positive.
    pub fn ellipse(center: [f64; 2], semi_axes: [f64; 2], angle: f64) -> Result<Self> {
        require_point("center", &center)?;
        require_sizes("semi-axes of the ellipse", &semi_axes)?;
        require_finite("angle of the ellipse", &[angle], |_| "it".into())?;
        let bounding_radius = semi_axes[0].max(semi_axes[1]);
        Ok(Self {
            shape: Shape::Ellipse { center, semi_axes, angle },
            bounding_center: [center[0], center[1], 0.0],
            bounding_radius,
        })
    }

    /// The convex hull of `points` (m), at least four that do not lie in a plane.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::InvalidObstacle`] for fewer points or a flat body.
    #[cfg(feature = "convex-mesh")]
    pub fn convex_mesh(points: &[[f64; 3]]) -> Result<Self> {
        require_finite("points of the convex mesh", points.as_flattened(), |i| {
            format!("coordinate {} of point {}", ["x", "y", "z"][i % 3], i / 3)
        })?;
        let hull = Hull::new(points).map_err(|problem| Error::InvalidObstacle { problem })?;
        let (bounding_center, bounding_radius) = hull.bounding_sphere();
        Ok(Self { shape: Shape::ConvexMesh(hull), bounding_center, bounding_radius })
    }

    /// The geometry.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Its name, such as "Sphere".
    pub fn name(&self) -> &'static str {
        match self.shape {
            Shape::Sphere { .. } => "Sphere",
            Shape::Box { .. } => "Box",
            Shape::Capsule { .. } => "Capsule",
            Shape::Ellipsoid { .. } => "Ellipsoid",
            Shape::Ellipse { .. } => "Ellipse",
            #[cfg(feature = "convex-mesh")]
            Shape::ConvexMesh(_) => "ConvexMesh",
        }
    }

    /// Whether it is flat, in the plane z = 0, and so undefined for an arm that leaves that plane.
    pub fn is_flat(&self) -> bool {
        matches!(self.shape, Shape::Ellipse { .. })
    }
}

fn placed(center: [f64; 3], rotation: Option<Matrix3<f64>>) -> Result<Pose> {
    require_point("center", &center)?;
    match rotation {
        None => Ok(Pose::from_parts(center.into(), Rotation3::identity())),
        Some(rotation) => pose::from_rotation_matrix("rotation", rotation, center),
    }
}

fn require_point(what: &str, point: &[f64]) -> Result<()> {
    require_finite(what, point, |i| format!("coordinate {}", ["x", "y", "z"][i]))
}

fn require_sizes(what: &str, sizes: &[f64]) -> Result<()> {
    let along = |i: usize| format!("{what} along {}", ["x", "y", "z"][i]);
    sizes.iter().enumerate().try_for_each(|(i, size)| require_positive(&along(i), *size))
}
