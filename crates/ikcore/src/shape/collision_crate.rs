//! Interface to the collision crate (parry); no other file uses its types.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::PointQuery;
use parry3d_f64::query::epa::EPA;
use parry3d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex, closest_points};
use parry3d_f64::shape::{ConvexPolyhedron, SupportMap};

/// Convex polyhedron.
#[derive(Debug, Clone)]
pub(super) struct Polyhedron(ConvexPolyhedron);

impl Polyhedron {
    /// Returns the convex hull of `points`; `None` if they lie in a plane. The crate takes bodies thinner than a
    /// three-thousandth for flat, so `stretch` first makes them about equally wide in all directions; it must keep their
    /// orientation.
    pub fn hull_of(points: &[[f64; 3]], stretch: &Matrix3<f64>) -> Option<Self> {
        let stretched: Vec<Vector> = points.iter().map(|point| to_crate(&(stretch * Vector3::from(*point)))).collect();
        let bits = |point: &Vector| <[f64; 3]>::from(*point).map(f64::to_bits);
        let given: HashMap<[u64; 3], &[f64; 3]> = stretched.iter().map(bits).zip(points).collect();
        let (vertices, triangles) = parry3d_f64::transformation::try_convex_hull(&stretched).ok()?;
        let corner = |vertex: &Vector| given.get(&bits(vertex)).map(|point| to_crate(&(**point).into()));
        let corners = vertices.iter().map(corner).collect::<Option<Vec<Vector>>>()?;
        ConvexPolyhedron::from_convex_mesh(corners, &triangles).map(Self)
    }

    /// Returns the corners.
    pub fn corners(&self) -> Vec<Vector3<f64>> {
        self.0.points().iter().copied().map(from_crate).collect()
    }

    /// Returns the outward normals of the faces.
    pub fn normals(&self) -> Vec<Vector3<f64>> {
        self.0.faces().iter().map(|face| from_crate(face.normal)).collect()
    }

    /// Returns the corners of the triangles.
    pub fn triangles(&self) -> Vec<[[f64; 3]; 3]> {
        let (corners, triangles) = self.0.to_trimesh();
        let corner = |i: u32| <[f64; 3]>::from(corners[i as usize]);
        triangles.into_iter().map(|triangle| triangle.map(corner)).collect()
    }

    /// Returns the point of the polyhedron nearest to `point`.
    pub fn nearest_point(&self, point: &Vector3<f64>) -> Vector3<f64> {
        from_crate(self.0.project_local_point(to_crate(point), true).point)
    }
}

/// Result of the crate for two convex sets; normals are unit vectors from the other set to the own one.
pub(super) enum ContactQuery {
    /// Disjoint sets with this direction of smallest distance, and the nearest `point` of the own set.
    Apart { point: Vector3<f64>, normal: Vector3<f64> },
    /// Sets that appear to be farther apart than `enough`, along this normal.
    Beyond(Vector3<f64>),
    /// Overlapping sets.
    Overlapping,
}

/// Finds the nearest points of two convex sets if they are within `enough`; each set is given by its support function.
pub(super) fn nearest(
    own: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
    other: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
    towards: &Vector3<f64>,
    enough: f64,
) -> ContactQuery {
    let mut simplex = VoronoiSimplex::new();
    match searched(own, other, towards, enough, &mut simplex) {
        GJKResult::ClosestPoints(point, _, direction) => {
            ContactQuery::Apart { point: from_crate(point), normal: -from_crate(direction) }
        }
        GJKResult::NoIntersection(direction) | GJKResult::Proximity(direction) => {
            ContactQuery::Beyond(-from_crate(direction))
        }
        GJKResult::Intersection => ContactQuery::Overlapping,
    }
}

/// Returns the deepest point of the own set inside the other, and the normal of shortest separation; `None` if the crate
/// finds none.
pub(super) fn deepest(
    own: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
    other: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
    towards: &Vector3<f64>,
) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let mut simplex = VoronoiSimplex::new();
    searched(own, other, towards, f64::MAX, &mut simplex);
    let (own, other) = (SupportPoints(own), SupportPoints(other));
    let (point, _, normal) = EPA::new().closest_points(&Pose::IDENTITY, &own, &other, &simplex)?;
    let normal = from_crate(normal).try_normalize(0.0).filter(|normal| normal.iter().all(|x| x.is_finite()))?;
    Some((from_crate(point), normal))
}

fn searched(
    own: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
    other: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
    towards: &Vector3<f64>,
    enough: f64,
    simplex: &mut VoronoiSimplex,
) -> GJKResult {
    let (own, other) = (SupportPoints(own), SupportPoints(other));
    simplex.reset(CsoPoint::from_shapes(&Pose::IDENTITY, &own, &other, to_crate(&-towards)));
    closest_points(&Pose::IDENTITY, &own, &other, enough.min(f64::MAX), true, simplex)
}

/// Convex set given by its support function.
struct SupportPoints<'a, S>(&'a S);

impl<S: Fn(&Vector3<f64>) -> Vector3<f64>> SupportMap for SupportPoints<'_, S> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        to_crate(&self.0(&from_crate(direction)))
    }
}

fn to_crate(vector: &Vector3<f64>) -> Vector {
    Vector::new(vector.x, vector.y, vector.z)
}

fn from_crate(vector: Vector) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, vector.z)
}
