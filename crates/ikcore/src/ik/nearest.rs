//! Of several solutions, the one nearest to where the arm is.

use std::f64::consts::TAU;

use super::attempt::Run;
use super::context::Prepared;
use super::goal_descent::SelfMotion;
use super::solution::Solution;
use crate::math::vector::distance;
use crate::objective::{Bounds, Point};
use crate::problem::Problem;
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{Goal, Goals, Target};

/// Solutions in a row that are no nearer, before the search is over.
const PATIENCE: usize = 24;

/// Distances that differ by less (rad, m) are the same.
const SAME: f64 = 1e-9;

impl Prepared<'_> {
    /// The solution nearest to `start` among those found until [`PATIENCE`] of them in a row were no nearer; the best
    /// miss where there is none.
    pub(super) fn run_nearest(
        &self,
        target: &Target,
        start: &[f64],
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Solution {
        let goal = Goal::Posture { posture: start.to_vec(), weight: 1.0 };
        let mut goals = Goals::new(&[goal], self.robot(), self.bounds());
        let mut problem = self.problem(target);
        let mut run = Run::new(self.options().stop);
        let mut nearest: Option<(f64, Point)> = None;
        let (mut x0, mut no_nearer) = (Point::from_slice(start), 0);
        let solution = loop {
            let mut solution = run.attempt(self, &mut problem, &x0, rng, monitor);
            if solution.status != Status::Solved {
                break solution;
            }
            bring_near(self.robot(), self.bounds(), start, &mut solution.q);
            self.descend_to(&mut problem, &mut goals, &mut run, &mut solution.q);
            let distance = distance(&solution.q, start);
            if nearest.as_ref().is_none_or(|(least, _)| distance < least - SAME) {
                (nearest, no_nearer) = (Some((distance, solution.q.clone())), 0);
            } else {
                no_nearer += 1;
            }
            if no_nearer == PATIENCE || run.is_spent() {
                break solution;
            }
            spread(self.robot(), self.bounds(), start, (no_nearer + 1) as f64 / PATIENCE as f64, rng, &mut x0);
        };
        match nearest {
            Some((_, q)) => run.solution(Status::Solved, q, &problem),
            None => solution,
        }
    }

    /// Moves `q` along its self-motion to where `goals` are best; false where it is at no solution, nor near one.
    pub(super) fn descend_to(
        &self,
        problem: &mut Problem<'_>,
        goals: &mut Goals,
        run: &mut Run,
        q: &mut Point,
    ) -> bool {
        let (robot, max_evaluations) = (self.robot(), run.left());
        let mut motion = SelfMotion { robot, problem, goals, bounds: self.bounds(), evaluations: 0, max_evaluations };
        let is_solved = motion.descend(q);
        run.count(motion.evaluations);
        is_solved
    }
}

/// Turns each joint by whole turns to the place nearest to `reference` between its limits.
pub(crate) fn bring_near(robot: &Robot, bounds: &Bounds, reference: &[f64], q: &mut [f64]) {
    for j in (0..q.len()).filter(|j| robot.repeats_every_turn(*j)) {
        let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
        let turns = ((reference[j] - q[j]) / TAU).round();
        let (fewest, most) = (((lower - q[j]) / TAU).ceil(), ((upper - q[j]) / TAU).floor());
        let turned = q[j] + turns.max(fewest).min(most) * TAU;
        // Rounding may pass a limit.
        if lower <= turned && turned <= upper {
            q[j] = turned;
        }
    }
}

/// A random point no farther from `start` than `share` of each joint's range: of one turn where that is less and repeats,
/// as what lies beyond comes back by whole turns.
fn spread(robot: &Robot, bounds: &Bounds, start: &[f64], share: f64, rng: &mut LazyRng, x: &mut [f64]) {
    for (j, joint) in robot.joints().iter().enumerate() {
        let (lower, upper) = joint.sampling_range_within(bounds.lower()[j], bounds.upper()[j]);
        let range = if robot.repeats_every_turn(j) { (upper - lower).min(TAU) } else { upper - lower };
        x[j] = start[j] + share * range * rng.uniform_in(-1.0, 1.0);
    }
    bounds.clip(x);
}
