//! The nearest configuration that reaches a target.

use crate::math::MAX_DOF;
use crate::objective::{Bounds, Linearization};
use crate::planning::tip_path::{Borders, PathTarget};
use crate::robot::Robot;

/// Maximum number of steps; the projection converges quadratically.
const STEPS: usize = 12;

/// A target counts as met at this squared distance (m^2, rad^2), far below the accuracy of limits and paths.
const MET: f64 = 1e-16;

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
    for _ in 0..STEPS {
        value = target.linearize(robot, q, &mut borders, scratch);
        if value <= MET {
            return 0.0;
        }
        let next = &mut next[..q.len()];
        scratch.write_step(DAMPING * value, q, [bounds.lower(), bounds.upper()], next);
        q.copy_from_slice(next);
    }
    value.sqrt()
}
