//! The change of each joint towards a moving goal, inside its reachable set.
//!
//! Relative to the goal, a joint follows a linear law with a double pole at 1 - 1/p. The time p, in ticks, is a part of the
//! memory of the goal, less far from the goal, and no shorter than the jerk limit allows with its noise: the law then adds
//! little to the noise that the goal has. It is slow, so it applies only as long as the fastest stop after it would end
//! within the noise around the goal. Otherwise the change is the one after which the stop ends at the edge of the noise:
//! that is the time-optimal way. Without noise the edge is the goal, and the joint arrives exactly.
//!
//! A goal far away is approached by all joints in proportion: the limits of each are scaled by its fraction of the way.

use super::bracket::largest_not_positive;
use super::braking::{Braking, longest_first};
use super::goal_scales::Scales;
use super::joint_state::JointState;
use super::moving_goal::MovingGoal;
use crate::objective::{Bounds, Point};

/// Half width of the noise around the goal, in standard deviations of a sample.
const EDGE: f64 = 4.0;

/// Length of a stop, as a fraction of the edge, from which on a joint aims at the goal itself, not at the edge.
const FAST: f64 = 0.125;

/// Time of the linear law, as a fraction of the memory of the goal.
const SHARPER: f64 = 0.35;

/// Distance, in standard deviations of the goal, at which the linear law takes half the time.
const NEAR: f64 = 3.0;

/// Fraction of the jerk limit by which noise of the goal may change the change of the linear law.
const JERK_FRACTION: f64 = 0.125;

/// Distance of a goal, in changes plus standard deviations of its noise, from which on joints approach it in
/// proportion.
const FAR: f64 = 16.0;

/// Smallest fraction of its limits that a joint keeps.
const LEAST_FRACTION: f64 = 0.1;

/// A pursuit in one tick.
#[derive(Debug)]
pub(crate) struct Pursuit<'a> {
    /// The goal at the end of the tick.
    pub goal: &'a MovingGoal,
    /// Braking of the joints.
    pub braking: &'a [Braking],
    /// Largest steps and changes.
    pub scales: &'a Scales,
    /// The reachable set.
    pub reachable: &'a Bounds,
}

/// A joint, relative to its goal.
struct Relative {
    /// Distance before the tick.
    distance: f64,
    step: f64,
    /// The last change.
    change: f64,
    /// Admissible changes.
    changes: [f64; 2],
}

impl Pursuit<'_> {
    /// Writes the configuration at the end of the tick of an arm that is at `q` in `state`.
    pub fn write(&self, q: &[f64], state: &JointState, out: &mut [f64]) {
        let fractions = self.fractions(q);
        let (slowest, quickest) = self.law_times();
        for j in 0..q.len() {
            let goal_step = self.goal.step()[j];
            // Far from the goal its acceleration does not count, but its noise would.
            let goal_change = if fractions.is_some() { 0.0 } else { self.goal.change()[j] };
            let [of_step, of_change, of_jerk] =
                fractions.as_ref().map_or([1.0; 3], |[step, change, jerk]| [step[j], change[j], jerk[j]]);
            let straight = q[j] + state.step[j] + goal_change;
            let relative = Relative {
                distance: q[j] - (self.goal.q()[j] - goal_step),
                step: state.step[j] - (goal_step - goal_change),
                change: state.change[j] - goal_change,
                changes: [self.reachable.lower()[j] - straight, self.reachable.upper()[j] - straight],
            };
            let Braking { acceleration, jerk } = self.braking[j];
            let acceleration = (of_change * acceleration - goal_change.abs()).max(LEAST_FRACTION * acceleration);
            let braking = Braking { acceleration, jerk: of_jerk * jerk };
            let scale = self.scales.change[j];
            let noise = if scale.is_finite() { self.goal.uncertainty_of(j) * scale } else { 0.0 };
            let law = if noise > 0.0 {
                let away = relative.distance / (NEAR * noise);
                (1.0 + (slowest - 1.0) / (1.0 + away * away)).max(quickest)
            } else {
                slowest
            };
            out[j] = straight + relative.next_change(&braking, law, EDGE * noise, of_step * self.scales.step[j]);
        }
        self.reachable.clip(out);
    }

    /// Longest and shortest time of the linear law, in ticks.
    fn law_times(&self) -> (f64, f64) {
        let memory = self.goal.memory();
        let quickest = (self.goal.jitter() / (JERK_FRACTION * self.scales.jerk_fraction)).sqrt().min(memory).max(1.0);
        ((SHARPER * memory).max(quickest), quickest)
    }

    /// The fractions of largest step, acceleration and jerk that each joint uses on a way to a far goal; `None` near it. A joint that moves
    /// with its goal has no way to go, however fast.
    fn fractions(&self, q: &[f64]) -> Option<[Point; 3]> {
        let way = |j: usize| (self.goal.q()[j] - self.goal.step()[j] - q[j]).abs();
        let n = q.len();
        let farthest = (0..n).map(|j| way(j) / self.scales.change[j]).fold(0.0, f64::max);
        if farthest <= FAR * (1.0 + self.goal.noise()) {
            return None;
        }
        let of = |limit: &dyn Fn(usize) -> f64| -> Point {
            let longest = (0..n).map(|j| way(j) / limit(j)).fold(0.0, f64::max);
            let fraction =
                |j: usize| if longest > 0.0 { (way(j) / limit(j) / longest).max(LEAST_FRACTION) } else { 1.0 };
            (0..n).map(fraction).collect()
        };
        Some([of(&|j| self.scales.step[j]), of(&|j| self.braking[j].acceleration), of(&|j| self.braking[j].jerk)])
    }
}

impl Relative {
    /// The change of the joint, relative to the goal. `law` is the time of the linear law.
    fn next_change(&self, braking: &Braking, law: f64, edge: f64, fastest: f64) -> f64 {
        let [least, most] = self.changes;
        let toward = |speed: f64| if speed >= 0.0 { longest_first(speed, braking.jerk) } else { speed };
        let [least, most] =
            [least.max(-toward(fastest + self.step)).min(most), most.min(toward(fastest - self.step)).max(least)];
        // Speeding up is in proportion too; braking may take all that there is.
        let eager = |change: f64| (change.max(0.0) + braking.jerk).min(braking.acceleration);
        let most = if self.step >= 0.0 { most.min(eager(self.change)).max(least) } else { most };
        let least = if self.step <= 0.0 { least.max(-eager(-self.change)).min(most) } else { least };
        let pole = 1.0 - 1.0 / law;
        let linear = -(1.0 - pole).powi(2) * self.distance - (1.0 - pole * pole) * self.step;
        let linear = linear.clamp(least.min(most), most);
        let end = |change: f64| {
            let step = self.step + change;
            self.distance + step + braking.stop(step, change).end
        };
        let slack = |edge: f64| (edge - braking.stop(self.step, 0.0).end.abs() / FAST).max(0.0);
        let edge = if edge > 0.0 { slack(edge) } else { 0.0 };
        let there = end(linear);
        if there > edge {
            largest_not_positive(least, [linear, there - edge], |change| end(change) - edge).unwrap_or(least)
        } else if there < -edge {
            let excess = |change: f64| -end(-change) - edge;
            -largest_not_positive(-most, [-linear, -there - edge], excess).unwrap_or(-most)
        } else {
            linear
        }
    }
}
