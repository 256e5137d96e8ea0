//! Seeds of the descents to a pose of which one part comes first.

use smallvec::SmallVec;

use crate::closed_form::{SEEDS, Seed};
use crate::ik::attempt::Attempt;
use crate::math::Frame;
use crate::objective::{Differentiable, Objective, Point};
use crate::problem::Problem;
use crate::solver::{Evaluator, LevenbergMarquardt, Stop, run};
use crate::task::{Aims, CheckedTask, First, Target, Tolerance};

/// Starts of an arm without a closed form for positions.
const STARTS: usize = 48;

/// Evaluation budget of the descent from such a start to the first part alone.
const TO_FIRST: usize = 30;

/// Start of a descent.
pub(super) struct RankedStart {
    pub q: Point,
    /// Least value of the second part that the descent can be expected to reach.
    pub least: f64,
}

impl Attempt<'_, '_> {
    /// Seeds for an arm with a closed form for positions; `None` for others.
    pub(super) fn closed_form_seeds(&self, pose: &Frame, first: First) -> Option<SmallVec<[RankedStart; SEEDS]>> {
        let robot = self.context.robot();
        let mut seeds = SmallVec::new();
        if first != First::Position || !robot.position_seeds(pose, self.context.sampling_ranges(), &mut seeds) {
            return None;
        }
        let start = |seed: &Seed| RankedStart { q: Point::from_slice(&seed.q[..robot.dof()]), least: seed.least };
        Some(seeds.iter().map(start).collect())
    }

    /// Seeds by descents to the first part alone, from `near` and from other starts: those of the robot's index that are nearest to that
    /// part, and scattered ones.
    pub(super) fn searched_seeds(&mut self, pose: &Frame, first: First, near: &[&[f64]]) -> Vec<RankedStart> {
        let target = match first {
            First::Position => Target::Position(pose.origin),
            First::Orientation => Target::Orientation(*pose),
        };
        let task = CheckedTask::from(Tolerance { position: 1e-9, rotation: 1e-9 });
        let robot = self.context.robot();
        let bounds = self.context.bounds();
        let of_point = |q: &[f64]| RankedStart { q: Point::from_slice(q), least: f64::NEG_INFINITY };
        let mut seeds: Vec<RankedStart> = near.iter().map(|q| of_point(q)).collect();
        let mut problem = Problem::new(robot, Aims::of_one(&task, &target)).disregarding_turns();
        let mut start = Point::from_elem(0.0, robot.dof());
        for number in 0..STARTS {
            problem.propose_start(number, bounds, self.rng, &mut start);
            seeds.push(of_point(&start));
        }
        for RankedStart { q, .. } in &mut seeds {
            if self.budget.left() < TO_FIRST || !self.monitor.keep_going() {
                break;
            }
            let objective: &mut dyn Differentiable = &mut problem;
            let stop = Stop { max_evaluations: TO_FIRST, ..Stop::default() };
            let mut evaluator = Evaluator::new(objective, bounds, stop, self.rng, self.monitor);
            run(&LevenbergMarquardt::default(), &mut evaluator, q);
            self.budget.add(&evaluator);
            q.copy_from_slice(&evaluator.best().x);
        }
        seeds
    }
}
