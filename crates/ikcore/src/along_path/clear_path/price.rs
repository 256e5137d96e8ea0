//! The cost of a step from one posture to the next.

use crate::along_path::timed::PathProblem;
use crate::objective::Point;
use crate::plan::Cost;

/// A joint that moves farther (rad, m) in one step jumps to another branch.
const JUMP: f64 = 1.0;

/// Weight of the energy beside the joint travel: of steps of equal travel, even ones are better.
const ENERGY: f64 = 1e-3;

/// Cost of the steps from layer to layer.
#[derive(Debug)]
pub(super) struct Price {
    /// Typical speed of each joint (rad/s, m/s).
    pace: Point,
    /// Period of each joint (rad); 0 for a joint without one.
    periods: Point,
    objective: Cost,
}

impl Price {
    pub fn new(problem: &PathProblem<'_>) -> Self {
        let joints = 0..problem.robot.dof();
        let pace = |j: usize| problem.limits.velocity[j].min(problem.limits.acceleration[j].sqrt());
        Self {
            pace: joints.clone().map(pace).collect(),
            periods: joints.map(|j| problem.robot.turn_period(j).unwrap_or(0.0)).collect(),
            objective: problem.options.objective,
        }
    }

    /// The cost of a step over `fraction` of the path; infinite for a jump.
    pub fn of_step(&self, from: &[f64], to: &[f64], fraction: f64) -> f64 {
        self.of_differences((0..from.len()).map(|j| to[j] - from[j]), fraction)
    }

    /// The cost of the same step modulo whole turns.
    pub fn of_turned_step(&self, from: &[f64], to: &[f64], fraction: f64) -> f64 {
        self.of_differences((0..from.len()).map(|j| self.turned(j, to[j] - from[j])), fraction)
    }

    /// The cost of a motion beside the path modulo whole turns, as if it took as long as the whole path.
    pub fn of_way(&self, from: &[f64], to: &[f64]) -> f64 {
        let moved = |j: usize| self.turned(j, to[j] - from[j]).abs();
        let part = |j: usize| match self.objective {
            Cost::JointTravel => moved(j),
            _ => (moved(j) / self.pace[j]).powi(2),
        };
        (0..from.len()).map(part).sum()
    }

    /// Returns `to`, shifted by whole turns to be near `from`.
    pub fn turned_near(&self, from: &[f64], to: &[f64]) -> Point {
        (0..from.len()).map(|j| from[j] + self.turned(j, to[j] - from[j])).collect()
    }

    /// The cost of the steps through `postures`.
    pub fn of_all(&self, postures: &[Point], fractions: &[f64]) -> f64 {
        let step = |i: usize| self.of_step(&postures[i - 1], &postures[i], fractions[i] - fractions[i - 1]);
        (1..postures.len()).map(step).sum()
    }

    fn turned(&self, j: usize, difference: f64) -> f64 {
        let period = self.periods[j];
        if 2.0 * difference.abs() <= period || period == 0.0 {
            return difference;
        }
        difference - (difference / period).round() * period
    }

    #[inline]
    fn of_differences(&self, differences: impl Iterator<Item = f64>, fraction: f64) -> f64 {
        let (mut travel, mut energy) = (0.0, 0.0);
        for (difference, pace) in differences.zip(&self.pace) {
            let moved = difference.abs();
            if moved > JUMP {
                return f64::INFINITY;
            }
            travel += moved;
            energy += (moved / pace) * (moved / pace);
        }
        match self.objective {
            Cost::JointTravel => travel + ENERGY * energy / fraction,
            _ => energy / fraction,
        }
    }
}
