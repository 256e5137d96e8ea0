//! Whole turns of joints: the equivalent configuration nearest to a reference, or all equivalent ones.

use smallvec::SmallVec;

use super::preference::AT_LIMIT;
use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// Shifts each joint by whole turns to be as near as possible to `reference` within its limits.
pub(crate) fn bring_near(robot: &Robot, bounds: &Bounds, reference: &[f64], q: &mut [f64]) {
    NearestTurns::new(robot, bounds, reference).bring_near(q);
}

/// Whole turns nearest to a reference, prepared for many configurations.
pub(super) struct NearestTurns<'a> {
    reference: &'a [f64],
    joints: SmallVec<[NearestTurn; 8]>,
}

/// Reference and limits of one joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearestTurn {
    /// Limits of the joint (rad, m).
    pub lower: f64,
    pub upper: f64,
    reference: f64,
    /// Period of the joint; 0 if it has none.
    period: f64,
}

impl<'a> NearestTurns<'a> {
    pub fn new(robot: &Robot, bounds: &Bounds, reference: &'a [f64]) -> Self {
        let joint = |j: usize| {
            let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
            NearestTurn { lower, upper, reference: reference[j], period: robot.turn_period(j).unwrap_or(0.0) }
        };
        Self { reference, joints: (0..reference.len()).map(joint).collect() }
    }

    /// Reference configuration (n,).
    pub fn reference(&self) -> &'a [f64] {
        self.reference
    }

    /// The joints, in order.
    pub fn joints(&self) -> &[NearestTurn] {
        &self.joints
    }

    /// Shifts each joint by whole turns to be as near as possible to the reference within its limits.
    pub fn bring_near(&self, q: &mut [f64]) {
        for (joint, value) in self.joints.iter().zip(q) {
            *value = joint.nearest(*value);
        }
    }
}

impl NearestTurn {
    /// Shifts `value` by whole turns as near as possible to the reference within the limits, or as little outside them as
    /// possible. Rounding beyond a limit is clamped.
    #[inline]
    pub fn nearest(&self, value: f64) -> f64 {
        let Self { lower, upper, reference, period } = *self;
        let is_near = 2.0 * (reference - value).abs() < period && lower <= value && value <= upper;
        if is_near || period == 0.0 { value } else { self.turned(value) }
    }

    fn turned(&self, value: f64) -> f64 {
        let Self { lower, upper, reference, period } = *self;
        let turns = ((reference - value) / period).round();
        let (fewest, most) =
            (((lower - AT_LIMIT - value) / period).ceil(), ((upper + AT_LIMIT - value) / period).floor());
        let turned = value + turns.max(fewest).min(most) * period;
        let inside = turned.clamp(lower, upper);
        if (turned - inside).abs() <= AT_LIMIT {
            return inside;
        }
        let above = value + ((lower - value) / period).ceil() * period;
        let below = above - period;
        if above - upper < lower - below { above } else { below }
    }
}

/// Whether a joint may turn on for ever, so that [`all_turns`] cannot return all whole turns.
pub(super) fn has_endless_turns(robot: &Robot, bounds: &Bounds) -> bool {
    let is_open = |(lower, upper): (f64, f64)| lower == f64::NEG_INFINITY || upper == f64::INFINITY;
    let sides = bounds.lower().iter().copied().zip(bounds.upper().iter().copied());
    sides.enumerate().any(|(j, sides)| robot.turn_period(j).is_some() && is_open(sides))
}

/// Returns all configurations inside the limits that differ from `q` by whole turns, `q` first. Joints without limits stay.
pub(super) fn all_turns(robot: &Robot, bounds: &Bounds, q: &[f64]) -> Vec<Point> {
    let mut all = vec![Point::from_slice(q)];
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

/// Number of configurations that [`all_turns`] returns.
pub(super) fn count_of_turns(robot: &Robot, bounds: &Bounds, q: &[f64]) -> f64 {
    (0..q.len()).map(|j| range_of_turns(robot, bounds, q, j).map_or(1.0, |(_, low, high)| high - low + 1.0)).product()
}

/// Other values of joint `j` inside its limits at whole turns.
fn other_turns(robot: &Robot, bounds: &Bounds, q: &[f64], j: usize) -> Vec<f64> {
    let Some((period, low, high)) = range_of_turns(robot, bounds, q, j) else { return vec![] };
    let turns = (low as i64..=high as i64).filter(|turns| *turns != 0);
    turns.map(|turns| (q[j] + turns as f64 * period).clamp(bounds.lower()[j], bounds.upper()[j])).collect()
}

/// Period of joint `j`, and the fewest and most whole turns that keep it inside its limits, up to rounding.
fn range_of_turns(robot: &Robot, bounds: &Bounds, q: &[f64], j: usize) -> Option<(f64, f64, f64)> {
    const PART_OF_A_TURN: f64 = 1e-12;
    let period = robot.turn_period(j)?;
    let (low, high) = ((bounds.lower()[j] - q[j]) / period, (bounds.upper()[j] - q[j]) / period);
    (low.is_finite() && high.is_finite())
        .then(|| (period, (low - PART_OF_A_TURN).ceil(), (high + PART_OF_A_TURN).floor()))
}
