//! Solution nearest to the start: [`Prefer::Nearest`](super::Prefer::Nearest).

use std::f64::consts::TAU;

use super::attempt::Attempt;
use super::goal_descent::difference;
use super::solution::Solution;
use super::whole_turns::bring_near;
use crate::math::vector::norm;
use crate::objective::{Bounds, Point};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::Status;

/// Consecutive solutions without improvement after which the search ends.
const PATIENCE: usize = 24;

/// Largest difference of distances (rad, m) that count as equal.
const SAME: f64 = 1e-9;

/// Returns the nearest solution to `start` found before [`PATIENCE`] consecutive solutions were no nearer; the best miss if
/// there is none.
pub(super) fn nearest_solution(attempt: &mut Attempt<'_, '_>, start: &[f64]) -> Solution {
    let (robot, bounds) = (attempt.context.robot(), attempt.context.bounds());
    let weights = attempt.context.weights();
    let mut goals = attempt.context.distance_from(start);
    let mut nearest: Option<(f64, Point)> = None;
    let (mut x0, mut no_nearer) = (Point::from_slice(start), 0);
    let last = loop {
        let mut solution = attempt.solve_from(&x0);
        if solution.status != Status::Solved {
            break solution;
        }
        bring_near(robot, bounds, start, &mut solution.q);
        attempt.descend_goals(&mut goals, &mut solution.q);
        let way = difference(&solution.q, start);
        let distance = weights.map_or_else(|| norm(&way), |weights| weights.dot(&way, &way).sqrt());
        if nearest.as_ref().is_none_or(|(least, _)| distance < least - SAME) {
            (nearest, no_nearer) = (Some((distance, solution.q.clone())), 0);
        } else {
            no_nearer += 1;
        }
        if no_nearer == PATIENCE || attempt.budget.is_spent() {
            break solution;
        }
        let fraction = (no_nearer + 1) as f64 / PATIENCE as f64;
        Spread { robot, bounds, start }.draw(fraction, attempt.rng, &mut x0);
    };
    match nearest {
        Some((_, q)) => attempt.solution(Status::Solved, q),
        None => last,
    }
}

/// Random starts around the caller's start.
struct Spread<'a> {
    robot: &'a Robot,
    bounds: &'a Bounds,
    start: &'a [f64],
}

impl Spread<'_> {
    /// Draws a point whose joints differ from the start by at most `fraction` of their ranges, or of one turn if that is less
    /// and the joint is periodic, since whole turns bring back any point beyond.
    fn draw(&self, fraction: f64, rng: &mut LazyRng, x: &mut [f64]) {
        let Self { robot, bounds, start } = self;
        for (j, joint) in robot.joints().iter().enumerate() {
            let (lower, upper) = joint.sampling_range_within(bounds.lower()[j], bounds.upper()[j]);
            let range = if robot.repeats_every_turn(j) { (upper - lower).min(TAU) } else { upper - lower };
            x[j] = start[j] + fraction * range * rng.uniform_in(-1.0, 1.0);
        }
        bounds.clip(x);
    }
}
