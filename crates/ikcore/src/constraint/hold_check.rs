//! Whether joints can hold the arm everywhere along a straight line in joint space.

use super::joint_torques::{JointTorques, TorquePoint, control_points};
use super::largest_factor::TIGHT;
use super::torque_bend::{BendScratch, HOLD, Rest};
use crate::math::majorant::Majorant;

/// Maximum number of halvings of a line.
const DEEPEST: usize = 10;

/// Checks lines; owns its scratch.
pub(crate) struct HoldCheck<'a> {
    torques: &'a JointTorques,
    point: TorquePoint,
    bend: BendScratch,
    rests: Vec<Rest>,
}

/// Straight line in joint space.
struct Line<'a> {
    from: &'a [f64],
    to: &'a [f64],
}

impl<'a> HoldCheck<'a> {
    /// A check of these limits.
    pub fn new(torques: &'a JointTorques) -> Self {
        let rests = vec![[0.0; 3]; torques.dof()];
        Self { torques, point: torques.point(), bend: torques.bend_scratch(), rests }
    }

    /// Whether the joints can hold the arm everywhere from one configuration to another, and move it against dry friction.
    pub fn holds_along(&mut self, from: &[f64], to: &[f64]) -> bool {
        let line = Line { from, to };
        let (start, end) = (self.hold(&line, 0.0), self.hold(&line, 1.0));
        self.holds(&line, [0.0, 1.0], [&start, &end], 0)
    }

    fn holds(&mut self, line: &Line<'_>, [from, to]: [f64; 2], [start, end]: [&[f64]; 2], depth: usize) -> bool {
        let half = 0.5 * (to - from);
        let middle = self.hold(line, from + half);
        if self.torques.beyond(&middle).is_some() {
            return false;
        }
        self.bound(line, half);
        let is_bounded = self.torques.limits().iter().enumerate().all(|(joint, limit)| {
            let hold = control_points([start[joint], middle[joint], end[joint]]);
            let most = hold.into_iter().fold(0.0_f64, |most, hold| most.max(hold.abs()));
            most + self.rests[joint][0] + self.torques.friction(joint).dry <= limit * (1.0 - TIGHT)
        });
        is_bounded
            || depth < DEEPEST
                && self.holds(line, [from, from + half], [start, &middle], depth + 1)
                && self.holds(line, [from + half, to], [&middle, end], depth + 1)
    }

    /// The torques that hold the arm at a fraction of a line.
    fn hold(&mut self, line: &Line<'_>, fraction: f64) -> Vec<f64> {
        for ((q, from), to) in self.point.q.iter_mut().zip(line.from).zip(line.to) {
            *q = from + fraction * (to - from);
        }
        let mut hold = vec![0.0; self.torques.dof()];
        self.torques.write_hold(&mut self.point, &mut hold);
        hold
    }

    /// Bounds the distance of torques from their parabolas over a part of a line, `half` of it to either side.
    fn bound(&mut self, Line { from, to }: &Line<'_>, half: f64) {
        let rates = |joint: usize| Majorant::of([half * (to[joint] - from[joint]).abs()]);
        let farthest = |joint: usize| from[joint].abs().max(to[joint].abs());
        self.torques.rests::<HOLD>(rates, farthest, &mut self.bend, &mut self.rests);
    }
}
