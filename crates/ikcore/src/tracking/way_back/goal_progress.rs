//! Progress of an arm towards the goal of its way back.

use crate::math::vector::largest_difference;
use crate::objective::Point;

/// Relative decrease of the distance that is progress.
const PROGRESS: f64 = 0.02;

/// Distance (rad, m) by which a goal moves with its target before progress towards it is counted anew; noise moves it less.
const MOVED: f64 = 0.05;

/// Progress towards a goal.
#[derive(Debug)]
pub(super) struct GoalProgress {
    /// The goal when it was last new.
    goal: Point,
    /// Smallest distance from it; the largest as long as the arm swings out.
    nearest: f64,
    /// Whether the arm still swings away from the goal, as it does until the motion that it came with is braked.
    swings_out: bool,
    /// Time without progress (s).
    pub waited: f64,
}

impl GoalProgress {
    /// No progress towards `goal` yet.
    pub fn towards(goal: &[f64]) -> Self {
        Self { goal: Point::from_slice(goal), nearest: 0.0, swings_out: true, waited: 0.0 }
    }

    /// Notes a tick of `dt` (s) that ends at this `distance` from the goal.
    pub fn note(&mut self, goal: &[f64], distance: f64, dt: f64) {
        if largest_difference(goal, &self.goal) > MOVED {
            *self = Self::towards(goal);
        }
        if distance < (1.0 - PROGRESS) * self.nearest {
            (self.nearest, self.swings_out, self.waited) = (distance, false, 0.0);
            return;
        }
        self.waited += dt;
        if self.swings_out {
            self.nearest = self.nearest.max(distance);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time without progress after these distances from goals, a second each.
    fn waited(ticks: &[(f64, f64)]) -> f64 {
        let mut progress = GoalProgress::towards(&[0.0]);
        ticks.iter().for_each(|(goal, distance)| progress.note(&[*goal], *distance, 1.0));
        progress.waited
    }

    #[test]
    fn an_arm_that_swings_out_and_returns_makes_progress() {
        assert_eq!(waited(&[(0.0, 1.0), (0.0, 1.2), (0.0, 1.1)]), 0.0);
        assert_eq!(waited(&[(0.0, 1.0), (0.0, 0.9), (0.0, 1.2), (0.0, 1.1)]), 2.0);
    }

    #[test]
    fn an_arm_that_stands_makes_none() {
        assert_eq!(waited(&[(0.0, 1.0); 5]), 5.0);
        assert_eq!(waited(&[(0.0, 1.0), (0.01, 1.01), (-0.01, 0.99)]), 3.0);
    }

    #[test]
    fn a_goal_that_has_moved_is_new() {
        assert_eq!(waited(&[(0.0, 1.0), (0.0, 0.5), (2.0, 2.5), (2.0, 2.3)]), 0.0);
    }
}
