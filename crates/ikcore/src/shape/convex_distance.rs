//! Signed distance of two convex sets.
//!
//! A unit vector n separates the sets by min n . x over one, less max n . x over the other. The signed distance is the
//! largest such separation; a negative one is the penetration depth, the shortest translation that parts overlapping sets.
//! The collision crate proposes n, so the result is a lower bound whatever the error of the crate.

use nalgebra::Vector3;

use super::checked_shape::ROUNDING;
use super::collision_crate::{ContactQuery, deepest, nearest};
use super::convex::Convex;

/// Separation of two sets along one normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// Signed distance (m).
    pub distance: f64,
    /// Unit normal from the other set to the own one.
    pub normal: Vector3<f64>,
    /// Nearest point of the own set (m).
    pub point: Vector3<f64>,
}

/// Largest number of rotations of the normal.
const CLIMBS: usize = 30;
/// First rotation of the normal (rad).
const FIRST_ANGLE: f64 = 1e-3;
/// Length (m) below which a gradient counts as zero.
const SHORTEST: f64 = 1e-12;

impl Gap {
    /// Returns a bound for sets at least `distance` apart.
    pub fn beyond(distance: f64) -> Self {
        Self { distance, normal: Vector3::x(), point: Vector3::zeros() }
    }
}

/// Returns the gap between two sets: a lower bound, exact to about 1e-7 m where it is below `enough`.
pub(super) fn gap(own: &Convex, other: &Convex, enough: f64) -> Gap {
    let radii = own.radius() + other.radius();
    let (here, there) = (own.support(&Vector3::x()), other.support(&Vector3::x()));
    let towards = (here - there).try_normalize(0.0).unwrap_or(Vector3::x());
    let (support, other_support) = (|n: &Vector3<f64>| own.support(n), |n: &Vector3<f64>| other.support(n));
    match nearest(&support, &other_support, &towards, enough + radii) {
        ContactQuery::Apart { point, normal } => {
            let found = separated(own, other, &normal, point);
            if own.is_round() || other.is_round() { ascended(own, other, found) } else { found }
        }
        ContactQuery::Beyond(normal) => {
            let found = separated(own, other, &normal, here);
            if found.distance >= enough { found } else { overlapping(own, other, &[normal, towards], here) }
        }
        ContactQuery::Overlapping => match deepest(&support, &other_support, &towards) {
            Some((point, normal)) => overlapping(own, other, &[normal, -normal, towards], point),
            None => overlapping(own, other, &[towards, -towards, Vector3::x(), Vector3::y(), Vector3::z()], here),
        },
    }
}

/// Returns the gap along `normal`; `point` belongs to the core of `own`.
fn separated(own: &Convex, other: &Convex, normal: &Vector3<f64>, point: Vector3<f64>) -> Gap {
    let [lowest, highest] = [own.support(&-normal), other.support(normal)];
    let rounding = ROUNDING * (1.0 + lowest.amax().max(highest.amax()) + own.radius() + other.radius());
    let distance = normal.dot(&lowest) - normal.dot(&highest) - own.radius() - other.radius() - rounding;
    Gap { distance, normal: *normal, point: point - own.radius() * normal }
}

/// Returns the largest gap along the given normals, improved by gradient ascent from the best of them.
fn overlapping(own: &Convex, other: &Convex, normals: &[Vector3<f64>], point: Vector3<f64>) -> Gap {
    let gaps = normals.iter().map(|normal| separated(own, other, normal, point));
    ascended(own, other, gaps.fold(Gap::beyond(f64::NEG_INFINITY), larger))
}

/// Increases the gap by gradient ascent on the normal: for curved sets the normal of the crate is not exact.
fn ascended(own: &Convex, other: &Convex, mut best: Gap) -> Gap {
    let mut angle = FIRST_ANGLE;
    for _ in 0..CLIMBS {
        // Gradient of the gap with respect to the normal: the vector between the two support points.
        let between = own.support(&-best.normal) - other.support(&best.normal);
        let uphill = between - between.dot(&best.normal) * best.normal;
        let Some(uphill) = uphill.try_normalize(SHORTEST) else { break };
        let normal = (best.normal + angle * uphill).normalize();
        let next = separated(own, other, &normal, best.point + own.radius() * best.normal);
        angle *= if next.distance > best.distance { 1.5 } else { 0.4 };
        best = larger(best, next);
    }
    best
}

fn larger(best: Gap, next: Gap) -> Gap {
    if next.distance > best.distance { next } else { best }
}
