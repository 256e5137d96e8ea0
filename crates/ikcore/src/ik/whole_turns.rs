//! Whole turns of joints: the same posture nearer to a reference, or at every turn.

use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// Shifts each joint by whole turns to be as near as possible to `reference` within its limits.
pub(crate) fn bring_near(robot: &Robot, bounds: &Bounds, reference: &[f64], q: &mut [f64]) {
    for j in 0..q.len() {
        let Some(period) = robot.turn_period(j) else { continue };
        let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
        let turns = ((reference[j] - q[j]) / period).round();
        let (fewest, most) = (((lower - q[j]) / period).ceil(), ((upper - q[j]) / period).floor());
        let turned = q[j] + turns.max(fewest).min(most) * period;
        // Rounding may pass a limit.
        if lower <= turned && turned <= upper {
            q[j] = turned;
        }
    }
}

/// All configurations inside the limits that differ from `q` by whole turns, `q` first. Joints without limits stay.
pub(super) fn all_turns(robot: &Robot, bounds: &Bounds, q: &Point) -> Vec<Point> {
    let mut all = vec![q.clone()];
    for j in 0..q.len() {
        let others = other_turns(robot, bounds, q, j);
        for i in 0..all.len() {
            let turned = |value: &f64| {
                let mut copy = all[i].clone();
                copy[j] = *value;
                copy
            };
            let more: Vec<Point> = others.iter().map(turned).collect();
            all.extend(more);
        }
    }
    all
}

/// How many configurations [`all_turns`] returns.
pub(super) fn count_of_turns(robot: &Robot, bounds: &Bounds, q: &Point) -> f64 {
    (0..q.len()).map(|j| range_of_turns(robot, bounds, q, j).map_or(1.0, |(_, low, high)| high - low + 1.0)).product()
}

/// Where whole turns take joint `j` inside its limits, besides where it is.
fn other_turns(robot: &Robot, bounds: &Bounds, q: &Point, j: usize) -> Vec<f64> {
    let Some((period, low, high)) = range_of_turns(robot, bounds, q, j) else { return vec![] };
    let turns = (low as i64..=high as i64).filter(|turns| *turns != 0);
    turns.map(|turns| (q[j] + turns as f64 * period).clamp(bounds.lower()[j], bounds.upper()[j])).collect()
}

/// The period of joint `j`, and the fewest and most whole turns that keep it inside its limits, up to rounding.
fn range_of_turns(robot: &Robot, bounds: &Bounds, q: &Point, j: usize) -> Option<(f64, f64, f64)> {
    const ROUNDING: f64 = 1e-12;
    let period = robot.turn_period(j)?;
    let (low, high) = ((bounds.lower()[j] - q[j]) / period, (bounds.upper()[j] - q[j]) / period);
    (low.is_finite() && high.is_finite()).then(|| (period, (low - ROUNDING).ceil(), (high + ROUNDING).floor()))
}
