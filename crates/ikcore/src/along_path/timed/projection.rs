//! The nearest configuration that reaches a target.

use crate::along_path::tip_path::{Borders, PathTarget};
use crate::math::MAX_DOF;
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Linearization};
use crate::robot::Robot;

/// Steps after which the projection goes on only while it converges: it does so quadratically, but linearly where the arm is singular.
const STEPS: usize = 12;

/// Maximum number of steps.
const MOST_STEPS: usize = 60;

/// A step that converges lowers the squared error at least by this factor.
const CONVERGING: f64 = 0.5;

/// The projection ends at this squared distance (m^2, rad^2), far below the accuracy of limits and paths.
const MET: f64 = 1e-16;

/// A target counts as met at this squared distance too, if no step leads nearer: `solve` takes it for reached.
const AS_NEAR_AS_SOLVES: f64 = 1e-12;

/// A configuration between two others lies this near their middle, relative to their distance; and this near anyway (rad, m).
const STRAY: f64 = 0.3;
const STRAY_ANYWAY: f64 = 0.02;

/// Damping relative to squared error, as in the library's Levenberg-Marquardt.
const DAMPING: f64 = 0.05;

/// The part of the accuracy of a path by which [`approach`] may leave the tip off it.
pub(crate) const NEAR_ENOUGH: f64 = 0.25;

/// Steps of an approach, and their least damping: singular directions with singular values below its root (0.02) hardly move.
const APPROACH_STEPS: usize = 6;
const APPROACH_DAMPING: f64 = 5e-4;

/// Moves `q` near the target: by little where the arm is singular, at the expense of the tip. Returns whether the error is at most
/// `within` (m, rad).
pub(crate) fn approach(
    robot: &Robot,
    target: &PathTarget,
    bounds: &Bounds,
    q: &mut [f64],
    scratch: &mut Linearization,
    within: f64,
) -> bool {
    let mut next = [0.0; MAX_DOF];
    let mut borders = Borders::default();
    for _ in 0..APPROACH_STEPS {
        let value = target.linearize(robot, q, &mut borders, scratch);
        if value.sqrt() <= within {
            return true;
        }
        let next = &mut next[..q.len()];
        scratch.write_step(APPROACH_DAMPING.max(DAMPING * value), q, [bounds.lower(), bounds.upper()], next);
        q.copy_from_slice(next);
    }
    false
}

/// Whether `between`, on the path, is too far from the middle of two configurations that are this far `apart` (rad, m) for the arm to
/// move through it from one to the other.
pub(crate) fn strays(between: &[f64], middle: &[f64], apart: f64) -> bool {
    largest_difference(between, middle) > STRAY * apart + STRAY_ANYWAY
}

/// Moves `q` onto the target, to a nearby solution. Returns the remaining error (m, rad); 0 if the target is met.
pub(crate) fn project(
    robot: &Robot,
    target: &PathTarget,
    bounds: &Bounds,
    q: &mut [f64],
    scratch: &mut Linearization,
) -> f64 {
    let mut next = [0.0; MAX_DOF];
    let mut value = f64::INFINITY;
    let mut borders = Borders::default();
    for step in 0..=MOST_STEPS {
        let before = value;
        value = target.linearize(robot, q, &mut borders, scratch);
        if value <= MET {
            return 0.0;
        }
        if step >= STEPS && (step == MOST_STEPS || !(value < CONVERGING * before)) {
            break;
        }
        let next = &mut next[..q.len()];
        scratch.write_step(DAMPING * value, q, [bounds.lower(), bounds.upper()], next);
        q.copy_from_slice(next);
    }
    if value <= AS_NEAR_AS_SOLVES { 0.0 } else { value.sqrt() }
}
