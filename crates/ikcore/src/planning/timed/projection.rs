//! The nearest configuration that reaches a target.

use crate::math::MAX_DOF;
use crate::math::box_step::BoxStep;
use crate::objective::{Bounds, LeastSquares, Linearization};
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::{Target, Tolerance};

/// Steps of the projection at the most; it converges quadratically.
const STEPS: usize = 12;

/// A target counts as met at this squared distance (m^2, rad^2), far below what limits or accuracy can show.
const MET: f64 = 1e-16;

/// Damping over squared error, as in the library's own Levenberg-Marquardt.
const DAMPING: f64 = 0.05;

/// Brings `q` onto the target, to a nearby solution; returns by how much that is missed (m, rad), 0 where it is met.
pub(super) fn project(
    robot: &Robot,
    target: &Target,
    bounds: &Bounds,
    q: &mut [f64],
    scratch: &mut Linearization,
) -> f64 {
    let mut problem = Problem::new(robot, target, Tolerance::default());
    let mut next = [0.0; MAX_DOF];
    let mut value = f64::INFINITY;
    for _ in 0..STEPS {
        value = problem.linearize(q, scratch).value;
        if value <= MET {
            return 0.0;
        }
        let next = &mut next[..q.len()];
        let Linearization { columns, residual } = &*scratch;
        let (lower, upper) = (bounds.lower(), bounds.upper());
        BoxStep { columns, residual, lambda: DAMPING * value, x: q, lower, upper }.write(next);
        q.copy_from_slice(next);
    }
    value.sqrt()
}
