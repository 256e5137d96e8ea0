//! Search for configurations on the target of an arm, a bounded part in each tick.
//!
//! For a pose, the closed form of the arm gives the starts: all its branches or, for a redundant arm, those at values spread over
//! its parameter. Otherwise, or if none of these meets the target, they are drawn, at increasing distances from the arm. Starts
//! that do not meet the target are moved onto it by short descents. The work of a tick is bounded by evaluations, so that the
//! search takes more ticks, not longer ones.

use smallvec::SmallVec;

use crate::ik::{bring_near, next_branches};
use crate::math::vector::{between, distance, largest_difference};
use crate::objective::{Bounds, Differentiable, Point};
use crate::problem::Problem;
use crate::rng::LazyRng;
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, Stop, run};
use crate::task::Target;
use crate::tracking::progress::time_of_way;
use crate::tracking::step_context::StepContext;

/// Evaluation budget of a descent, and of a tick.
pub(super) const DESCENT: usize = 40;

/// Maximum number of drawn starts, the first half of them at increasing distances.
const DRAWN: usize = 96;
/// Number of solutions that ends the draws.
const ENOUGH: usize = 4;

/// Maximum number of configurations kept.
const KEPT: usize = 8;
/// Smallest distance between two of them (rad, m).
const APART: f64 = 0.1;

/// Excess over a limit (rad, m) that is rounding.
const ROUNDING: f64 = 1e-9;

/// Distance from a limit (rad, m) below which a configuration is cramped: tracking would soon end there again.
const ROOM: f64 = 0.1;
/// Factor on its travel time at the limit itself.
const CRAMPED: f64 = 2.0;

/// Configuration on the target.
#[derive(Debug, Clone)]
pub(super) struct GoalChoice {
    pub q: Point,
    /// Travel time (s), longer near limits.
    cost: f64,
    /// Distance from the arm (rad, m); decides between equal costs.
    distance: f64,
}

/// Search in progress.
#[derive(Debug, Default)]
pub(super) struct GoalSearch {
    /// Configurations found, the quickest to reach first.
    pub found: SmallVec<[GoalChoice; KEPT]>,
    /// Values and starts tried.
    tried: usize,
    /// Solutions found so far.
    solutions: usize,
    /// Whether starts are drawn although there is a closed form: on the rim of the reach its sampled branches may all miss.
    draws: bool,
    /// Evaluations of the forward kinematics, and those before this tick.
    pub evaluations: usize,
    begun: usize,
}

/// Random numbers and monitor of the search of a tick.
pub(super) struct Means<'a> {
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

impl GoalSearch {
    /// Begins anew.
    pub fn restart(&mut self) {
        self.found.clear();
        (self.tried, self.solutions, self.draws) = (0, 0, false);
    }

    /// Searches for one tick. Returns whether the search has ended.
    pub fn advance(&mut self, context: &StepContext<'_>, means: &mut Means<'_>) -> bool {
        self.begun = self.evaluations;
        let bounds = movable(context);
        let pose = match context.aims.only(context.robot) {
            Some((target @ Target::Pose(pose), criterion)) if !self.draws && criterion.fixes_pose(target) => Some(pose),
            _ => None,
        };
        let ranges = finite(context, &bounds);
        let mut tried = self.tried;
        let take = |q: Point| self.take_branch(q, context, &bounds, means);
        let ended = pose.and_then(|pose| next_branches(context.robot, pose, &ranges, &mut tried, take));
        match ended {
            Some(true) if self.found.is_empty() => {
                (self.tried, self.draws) = (0, true);
                false
            }
            Some(ended) => {
                self.tried = tried;
                ended
            }
            None => self.descend_from_drawn(context, (&bounds, &ranges), means),
        }
    }

    /// Takes a configuration of the closed form, if it is inside the limits and the tick has work left.
    fn take_branch(&mut self, mut q: Point, context: &StepContext<'_>, bounds: &Bounds, means: &mut Means<'_>) {
        let left = DESCENT.saturating_sub(self.evaluations - self.begun);
        bring_near(context.robot, bounds, context.q, &mut q);
        let mut inside = q.clone();
        bounds.clip(&mut inside);
        if left < 2 || !(largest_difference(&inside, &q) <= ROUNDING) {
            return;
        }
        self.evaluations += 1;
        if context.aims.assess(context.robot, &inside).score.solved {
            self.offer(inside, context, bounds);
        } else {
            self.take_descent(&inside, left - 1, context, bounds, means);
        }
    }

    /// Descends from the next drawn start. Returns whether it was the last.
    fn descend_from_drawn(
        &mut self,
        context: &StepContext<'_>,
        (bounds, ranges): (&Bounds, &Bounds),
        means: &mut Means<'_>,
    ) -> bool {
        self.tried += 1;
        let share = (2.0 * self.tried as f64 / DRAWN as f64).min(1.0);
        let ends = ranges.lower().iter().zip(ranges.upper());
        let draw = |(q, (lower, upper)): (&f64, (&f64, &f64))| between(*q, means.rng.uniform_in(*lower, *upper), share);
        let start: Point = context.q.iter().zip(ends).map(draw).collect();
        self.take_descent(&start, DESCENT, context, bounds, means);
        self.tried >= DRAWN || self.solutions >= ENOUGH
    }

    /// Takes the end of a descent from `start` of at most `most` evaluations, if it meets the target.
    fn take_descent(
        &mut self,
        start: &[f64],
        most: usize,
        context: &StepContext<'_>,
        bounds: &Bounds,
        means: &mut Means<'_>,
    ) {
        let end = descended(start, most, context, bounds, means);
        self.evaluations += end.evaluations;
        if end.solved {
            self.offer(end.q, context, bounds);
        }
    }

    /// Keeps `q`, a configuration on the target, if it is among the best that are apart from each other.
    pub fn offer(&mut self, mut q: Point, context: &StepContext<'_>, bounds: &Bounds) {
        bring_near(context.robot, bounds, context.q, &mut q);
        bounds.clip(&mut q);
        self.solutions += 1;
        let candidate =
            GoalChoice { cost: travel_time(context, &q) * cramped(bounds, &q), distance: distance(context.q, &q), q };
        if !(candidate.cost < f64::INFINITY) {
            return;
        }
        let is_near = |other: &GoalChoice| largest_difference(&other.q, &candidate.q) < APART;
        let known = self.found.iter().position(is_near);
        match known {
            Some(known) if candidate.is_before(&self.found[known]) => {
                self.found.remove(known);
            }
            Some(_) => return,
            None if self.found.len() == KEPT => {
                if self.found.last().is_some_and(|last| !candidate.is_before(last)) {
                    return;
                }
                self.found.pop();
            }
            None => {}
        }
        let place = self.found.iter().position(|other| candidate.is_before(other)).unwrap_or(self.found.len());
        self.found.insert(place, candidate);
    }
}

impl GoalChoice {
    fn is_before(&self, other: &Self) -> bool {
        (self.cost, self.distance) < (other.cost, other.distance)
    }
}

/// End of a descent to the targets.
pub(super) struct Descended {
    pub q: Point,
    /// Root of the squared error; zero where the end meets the targets.
    pub error: f64,
    pub solved: bool,
    pub evaluations: usize,
}

/// Descends from `start` to the targets.
pub(super) fn descended(
    start: &[f64],
    most: usize,
    context: &StepContext<'_>,
    bounds: &Bounds,
    means: &mut Means<'_>,
) -> Descended {
    let mut problem = Problem::new(context.robot, context.aims);
    let objective: &mut dyn Differentiable = &mut problem;
    let stop = Stop { max_evaluations: most, ..Stop::default() };
    let mut evaluator = Evaluator::new(objective, bounds, stop, means.rng, means.monitor);
    let mut from = Point::from_slice(start);
    bounds.clip(&mut from);
    run(&LevenbergMarquardt::default(), &mut evaluator, &from);
    let best = evaluator.best();
    let error = if best.solved { 0.0 } else { best.value.sqrt() };
    Descended { q: Point::from_slice(&best.x), error, solved: best.solved, evaluations: evaluator.evaluations() }
}

/// Position limits; a joint that may not move has its position alone.
pub(super) fn movable(context: &StepContext<'_>) -> Bounds {
    let positions = context.positions();
    let range = |j: usize| match context.tick_box.velocity[j] > 0.0 {
        true => (positions.lower()[j], positions.upper()[j]),
        false => (context.q[j], context.q[j]),
    };
    Bounds::from_ranges((0..context.q.len()).map(range))
}

/// The same limits with finite ends.
fn finite(context: &StepContext<'_>, bounds: &Bounds) -> Bounds {
    let joints = context.robot.joints().iter().enumerate();
    Bounds::from_ranges(joints.map(|(j, joint)| joint.sampling_range_within(bounds.lower()[j], bounds.upper()[j])))
}

/// Time of the slowest joint from rest at the arm to rest at `q` (s), at most; zero without limits.
fn travel_time(context: &StepContext<'_>, q: &[f64]) -> f64 {
    let time = |j: usize| {
        let way = (q[j] - context.q[j]).abs();
        if way <= ROUNDING { 0.0 } else { time_of_way(way, context.limits, j, context.time) }
    };
    (0..q.len()).map(time).fold(0.0, f64::max)
}

/// Factor on the travel time to `q` for want of room between joints and limits.
fn cramped(bounds: &Bounds, q: &[f64]) -> f64 {
    let room =
        |(q, (lower, upper)): (&f64, (&f64, &f64))| if lower < upper { (q - lower).min(upper - q) } else { ROOM };
    let least = q.iter().zip(bounds.lower().iter().zip(bounds.upper())).map(room).fold(ROOM, f64::min);
    1.0 + (CRAMPED - 1.0) * (1.0 - least / ROOM)
}
