//! Signed distance of two convex sets.
//!
//! For a unit vector n the sets lie at least min n . x of one less max n . x of the other apart; the signed distance is the
//! largest such separation, negative where they overlap: then they must be moved so far to part. The collision crate proposes
//! n, so that the result is never more than the truth, whatever the error of the crate.

use nalgebra::Vector3;

use super::checked_shape::ROUNDING;
use super::collision_crate::{Proposal, deepest, nearest};
use super::convex::Convex;

/// Where two sets are nearest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// Signed distance (m).
    pub distance: f64,
    /// Unit normal from the other set to the own one.
    pub normal: Vector3<f64>,
    /// The nearest point of the own set (m).
    pub point: Vector3<f64>,
}

/// Turns of the normal tried, ...
const CLIMBS: usize = 30;
/// ... the first by this angle (rad).
const FIRST_ANGLE: f64 = 1e-3;
/// A gradient shorter than this (m) is none.
const SHORTEST: f64 = 1e-12;

impl Gap {
    /// Nothing within `distance`.
    pub fn beyond(distance: f64) -> Self {
        Self { distance, normal: Vector3::x(), point: Vector3::zeros() }
    }
}

/// The gap between two sets: at most the truth, and exact to about 1e-7 m where it is below `enough`.
pub(super) fn gap(own: &Convex, other: &Convex, enough: f64) -> Gap {
    let radii = own.radius() + other.radius();
    let (here, there) = (own.support(&Vector3::x()), other.support(&Vector3::x()));
    let towards = (here - there).try_normalize(0.0).unwrap_or(Vector3::x());
    let (support, other_support) = (|n: &Vector3<f64>| own.support(n), |n: &Vector3<f64>| other.support(n));
    match nearest(&support, &other_support, &towards, enough + radii) {
        Proposal::Apart { point, normal } => {
            let found = separated(own, other, &normal, point);
            if own.is_round() || other.is_round() { climbed(own, other, found) } else { found }
        }
        Proposal::Beyond(normal) => {
            let found = separated(own, other, &normal, here);
            if found.distance >= enough { found } else { overlapping(own, other, &[normal, towards], here) }
        }
        Proposal::Overlapping => match deepest(&support, &other_support, &towards) {
            Some((point, normal)) => overlapping(own, other, &[normal, -normal, towards], point),
            None => overlapping(own, other, &[towards, -towards, Vector3::x(), Vector3::y(), Vector3::z()], here),
        },
    }
}

/// The gap along `normal`; `point` is of the core of `own`.
fn separated(own: &Convex, other: &Convex, normal: &Vector3<f64>, point: Vector3<f64>) -> Gap {
    let [lowest, highest] = [own.support(&-normal), other.support(normal)];
    let rounding = ROUNDING * (1.0 + lowest.amax().max(highest.amax()) + own.radius() + other.radius());
    let distance = normal.dot(&lowest) - normal.dot(&highest) - own.radius() - other.radius() - rounding;
    Gap { distance, normal: *normal, point: point - own.radius() * normal }
}

/// The largest gap along some normals, and along those that climbing from the best of them finds.
fn overlapping(own: &Convex, other: &Convex, normals: &[Vector3<f64>], point: Vector3<f64>) -> Gap {
    let gaps = normals.iter().map(|normal| separated(own, other, normal, point));
    climbed(own, other, gaps.fold(Gap::beyond(f64::NEG_INFINITY), larger))
}

/// A gap at least as large, along a normal nearby: of round sets the crate's normal is not exact.
fn climbed(own: &Convex, other: &Convex, mut best: Gap) -> Gap {
    let mut angle = FIRST_ANGLE;
    for _ in 0..CLIMBS {
        // The gradient of the gap by the normal is the vector between the points that are farthest along it.
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
