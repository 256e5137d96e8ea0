//! Convex sets with a pose, given by support points.

use nalgebra::Vector3;

use super::along_segment::LineSegment;
use super::bounding_tree::Aabb;
use super::geometry::Geometry;
use super::signed_distance::at_right_angles;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;

/// Bounded convex set: all points within `radius` of a core.
#[derive(Debug, Clone)]
pub(super) struct Convex<'a> {
    core: Core<'a>,
    /// Frame of the core.
    frame: Frame,
    radius: f64,
}

/// Core in its own frame.
#[derive(Debug, Clone)]
enum Core<'a> {
    Segment(LineSegment),
    /// Box, by half its edges.
    Box(Vector3<f64>),
    /// Cylinder along z.
    Cylinder {
        radius: f64,
        half_length: f64,
    },
    /// Ellipsoid, by its semi-axes.
    Ellipsoid(Vector3<f64>),
    /// Convex hull of these points.
    Corners(&'a [Vector3<f64>]),
}

impl<'a> Convex<'a> {
    /// Returns the convex set of a shape given in `frame`; `None` if the shape is not convex or not bounded. An ellipse is
    /// replaced by an ellipsoid that contains it.
    pub fn of(geometry: &'a Geometry, frame: &Frame) -> Option<Self> {
        let there = |core: Core<'a>, radius: f64| Some(Self { core, frame: *frame, radius });
        let turned = |core: Core<'a>, pose: Frame| Some(Self { core, frame: frame.then::<NoFma>(&pose), radius: 0.0 });
        match geometry {
            Geometry::Sphere { center, radius } => there(Core::Segment([(*center).into(); 2]), *radius),
            Geometry::Capsule { a, b, radius } => there(Core::Segment([(*a).into(), (*b).into()]), *radius),
            Geometry::Box { pose, size } => turned(Core::Box(0.5 * Vector3::from(*size)), pose.into()),
            Geometry::Cylinder { center, axis, radius, length } => {
                let z = Vector3::from(*axis);
                let x = at_right_angles(&z);
                let axes = [x, z.cross(&x), z].map(<[f64; 3]>::from);
                let core = Core::Cylinder { radius: *radius, half_length: 0.5 * length };
                turned(core, Frame { axes, origin: *center })
            }
            Geometry::Ellipsoid { pose, semi_axes } => turned(Core::Ellipsoid((*semi_axes).into()), pose.into()),
            Geometry::Ellipse { center, semi_axes: [a, b], angle } => {
                let (sine, cosine) = angle.sin_cos();
                let axes = [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]];
                let pose = Frame { axes, origin: [center[0], center[1], 0.0] };
                turned(Core::Ellipsoid(Vector3::new(*a, *b, a.max(*b))), pose)
            }
            Geometry::ConvexMesh(hull) => there(Core::Corners(hull.corners()), 0.0),
            Geometry::HalfSpace { .. } | Geometry::Mesh(_) | Geometry::PointCloud(_) | Geometry::Grid(_) => None,
        }
    }

    /// Returns all points within `radius` of a segment.
    pub fn capsule(axis: LineSegment, radius: f64) -> Self {
        Self { core: Core::Segment(axis), frame: Frame::IDENTITY, radius }
    }

    /// Returns the convex hull of `corners`, at least one.
    pub fn corners(corners: &'a [Vector3<f64>]) -> Self {
        Self { core: Core::Corners(corners), frame: Frame::IDENTITY, radius: 0.0 }
    }

    /// Returns an axis-aligned box.
    pub fn aligned(bounds: &Aabb) -> Self {
        let origin = (0.5 * (bounds.lower + bounds.upper)).into();
        let core = Core::Box(0.5 * (bounds.upper - bounds.lower));
        Self { core, frame: Frame { origin, ..Frame::IDENTITY }, radius: 0.0 }
    }

    /// Returns the distance (m) from the core within which all points belong to the set.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether the core is curved, so that its normals form a continuum.
    pub fn is_round(&self) -> bool {
        matches!(self.core, Core::Cylinder { .. } | Core::Ellipsoid(_))
    }

    /// Returns the point of the core farthest along `direction`.
    pub fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        let along = Vector3::from(self.frame.turn_back(&(*direction).into()));
        self.frame.transform::<NoFma>(&self.core.support(&along).into()).into()
    }
}

impl Core<'_> {
    fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Segment([a, b]) => {
                if (b - a).dot(direction) > 0.0 {
                    *b
                } else {
                    *a
                }
            }
            Self::Box(half) => half.zip_map(direction, f64::copysign),
            Self::Cylinder { radius, half_length } => {
                let outward = direction.xy().try_normalize(0.0).unwrap_or_default() * *radius;
                Vector3::new(outward.x, outward.y, half_length.copysign(direction.z))
            }
            Self::Ellipsoid(semi_axes) => {
                let scaled = semi_axes.component_mul(direction);
                semi_axes.component_mul(&scaled.try_normalize(0.0).unwrap_or_default())
            }
            Self::Corners(corners) => {
                let mut farthest = (f64::NEG_INFINITY, Vector3::zeros());
                for corner in *corners {
                    let along = corner.dot(direction);
                    if along > farthest.0 {
                        farthest = (along, *corner);
                    }
                }
                farthest.1
            }
        }
    }
}
