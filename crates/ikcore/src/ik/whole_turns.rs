//! Whole turns of joints: the equivalent posture nearest to a reference.

use std::f64::consts::TAU;

use crate::objective::Bounds;
use crate::robot::Robot;

/// Shifts each joint by whole turns to be as near as possible to `reference` within its limits.
pub(crate) fn bring_near(robot: &Robot, bounds: &Bounds, reference: &[f64], q: &mut [f64]) {
    for j in (0..q.len()).filter(|j| robot.repeats_every_turn(*j)) {
        let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
        let turns = ((reference[j] - q[j]) / TAU).round();
        let (fewest, most) = (((lower - q[j]) / TAU).ceil(), ((upper - q[j]) / TAU).floor());
        let turned = q[j] + turns.max(fewest).min(most) * TAU;
        // Rounding may exceed a limit.
        if lower <= turned && turned <= upper {
            q[j] = turned;
        }
    }
}
