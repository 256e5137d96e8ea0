//! Motion of the joints to a configuration that meets the target, without acceleration limits: all joints in proportion, one of
//! them at its limit.
//!
//! The goal follows a target that moves, by Gauss-Newton steps within the position limits.

use super::tick::{Tick, TickResult};
use crate::math::vector::largest_difference;
use crate::objective::{Linearization, Point};
use crate::tracking::step_context::StepContext;

/// Largest number of Gauss-Newton steps of the goal in a tick.
const MOST_STEPS: usize = 4;

/// Largest step of the goal (rad, m): a farther one would leave what is known to be clear.
const FARTHEST: f64 = 0.1;

/// Motion towards a goal.
#[derive(Debug)]
pub(crate) struct JointMove {
    goal: Point,
    linearization: Box<Linearization>,
}

impl JointMove {
    /// Motion to `goal`.
    pub(crate) fn to(goal: &[f64]) -> Self {
        Self { goal: Point::from_slice(goal), linearization: Box::default() }
    }

    /// Goal of the motion.
    pub(crate) fn goal(&self) -> &[f64] {
        &self.goal
    }

    /// Runs one tick.
    pub(super) fn advance(&mut self, tick: &Tick<'_>) -> TickResult {
        let StepContext { robot, q, aims, .. } = tick.context;
        let mut found = TickResult::at(q);
        self.follow_target(tick, &mut found);
        let fraction = tick.fraction_within(q, &self.goal);
        found.q.iter_mut().zip(&self.goal).for_each(|(q, goal)| *q += fraction * (goal - *q));
        if fraction == 1.0 {
            found.q.copy_from_slice(&self.goal);
        }
        tick.bounds().clip(&mut found.q);
        found.assess(robot, &aims);
        found.evaluations += 1;
        found.iterations += 1;
        found
    }

    /// Moves the goal onto the target, while the error falls.
    fn follow_target(&mut self, tick: &Tick<'_>, found: &mut TickResult) {
        let StepContext { robot, aims, .. } = tick.context;
        let positions = tick.context.positions();
        let mut lowest = f64::INFINITY;
        let mut kept = self.goal.clone();
        for _ in 0..MOST_STEPS {
            let score = aims.linearize(robot, &self.goal, &mut self.linearization, |_| ()).score;
            found.evaluations += 1;
            if !(score.value < lowest) {
                break;
            }
            (lowest, kept) = (score.value, self.goal.clone());
            if score.solved {
                break;
            }
            let lambda = self.linearization.least_damping(kept.len());
            self.linearization.write_step(lambda, &kept, &positions, &mut self.goal);
            if largest_difference(&self.goal, &kept) > FARTHEST {
                break;
            }
        }
        self.goal = kept;
    }
}
