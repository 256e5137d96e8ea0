//! The nearest configuration that reaches a target.

use crate::math::MAX_DOF;
use crate::objective::{Bounds, Linearization};
use crate::planning::tip_path::{Borders, PathTarget};
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

/// Damping relative to squared error, as in the library's Levenberg-Marquardt.
const DAMPING: f64 = 0.05;

/// Moves `q` onto the target, to a nearby solution. Returns the remaining error (m, rad); 0 if the target is met.
pub(in crate::planning) fn project(
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
