//! A robot and a target as something to minimise.

use crate::objective::{Bounds, LeastSquares, Linearization, Objective, Score};
use crate::rng::LazyRng;
use crate::robot::{Robot, Seeds};
use crate::task::{Assessment, Criterion, Target};

/// The inverse kinematics problem; it borrows everything, so that building one per tick costs nothing.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    robot: &'a Robot,
    target: &'a Target,
    criterion: Criterion,
    /// Found when the first start is asked for.
    seeds: Option<Seeds<'a>>,
}

impl<'a> Problem<'a> {
    /// The problem of bringing the tip of `robot` to `target`.
    pub fn new(robot: &'a Robot, target: &'a Target, criterion: impl Into<Criterion>) -> Self {
        Self { robot, target, criterion: criterion.into(), seeds: None }
    }

    /// Where the tip is to be.
    pub fn target(&self) -> &'a Target {
        self.target
    }

    /// The errors at `q` and what they come to, by forward kinematics.
    pub fn assess(&self, q: &[f64]) -> Assessment {
        self.target.assess(self.robot, q, &self.criterion)
    }
}

impl Objective for Problem<'_> {
    fn dimension(&self) -> usize {
        self.robot.dof()
    }

    #[inline]
    fn evaluate(&mut self, q: &[f64]) -> Score {
        self.assess(q).score
    }

    fn evaluate_all(&mut self, qs: &[f64], out: &mut [Score]) {
        let mut scores = out.iter_mut();
        self.target.assess_all(self.robot, qs, &self.criterion, |assessment| {
            if let Some(score) = scores.next() {
                *score = assessment.score;
            }
        });
    }

    /// The nearest of the robot's indexed configurations, then uniform in the box, where a side without a limit is drawn
    /// from the joint's sampling range. Whoever brings a start of their own gets the nearest as their second.
    fn propose_start(&mut self, _attempt: usize, bounds: &Bounds, rng: &mut LazyRng, q: &mut [f64]) {
        if self.seeds.is_none() {
            self.seeds = match (self.target, self.target.position()) {
                (Target::Pose(pose), _) => Some(self.robot.seeds_near_pose(pose)),
                (_, Some(position)) => Some(self.robot.seeds_near_position(&position)),
                _ => None,
            };
        }
        if self.seeds.as_mut().is_some_and(|seeds| seeds.write_next(bounds.lower(), bounds.upper(), q)) {
            return;
        }
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let (lower, upper) = joint.sampling_range_within(bounds.lower()[i], bounds.upper()[i]);
            q[i] = rng.uniform_in(lower, upper);
        }
    }
}

impl LeastSquares for Problem<'_> {
    #[inline]
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> Score {
        self.target.linearize(self.robot, q, &self.criterion, out).score
    }
}
