//! A robot and a target as something to minimise.

use crate::math::box_step::ROWS;
use crate::objective::{Bounds, LeastSquares, Linearization, Objective, Residual, Score};
use crate::rng::LazyRng;
use crate::robot::{Robot, Seeds};
use crate::task::{SquaredError, Target, TipError, Tolerance};

/// The inverse kinematics problem; it borrows everything, so that building one per tick costs nothing.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    robot: &'a Robot,
    target: &'a Target,
    tolerance: Tolerance,
    /// Found when the first start is asked for.
    seeds: Option<Seeds<'a>>,
}

impl<'a> Problem<'a> {
    /// The problem of bringing the tip of `robot` to `target`.
    pub fn new(robot: &'a Robot, target: &'a Target, tolerance: Tolerance) -> Self {
        Self { robot, target, tolerance, seeds: None }
    }

    /// The errors at `q`, by forward kinematics.
    pub fn verify(&self, q: &[f64]) -> TipError {
        self.target.error(self.robot, q).into()
    }

    #[inline]
    fn score(&self, error: SquaredError) -> Score {
        Score { value: error.sum(), solved: error.within(&self.tolerance) }
    }
}

impl Objective for Problem<'_> {
    fn dimension(&self) -> usize {
        self.robot.dof()
    }

    #[inline]
    fn evaluate(&mut self, q: &[f64]) -> Score {
        self.score(self.target.error(self.robot, q))
    }

    fn evaluate_all(&mut self, qs: &[f64], out: &mut [Score]) {
        let mut scores = out.iter_mut();
        self.target.errors(self.robot, qs, |error| {
            if let Some(score) = scores.next() {
                *score = self.score(error);
            }
        });
    }

    /// The nearest of the robot's indexed configurations, then uniform in the box, where a side without a limit is drawn
    /// from the joint's sampling range. Whoever brings a start of their own gets the nearest as their second.
    fn propose_start(&mut self, _attempt: usize, bounds: &Bounds, rng: &mut LazyRng, q: &mut [f64]) {
        let seeds = self.seeds.get_or_insert_with(|| match self.target {
            Target::Position(position) => self.robot.seeds_near_position(position),
            Target::Pose(pose) => self.robot.seeds_near_pose(pose),
        });
        if seeds.write_next(bounds.lower(), bounds.upper(), q) {
            return;
        }
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let (lower, upper) = joint.sampling_range_within(bounds.lower()[i], bounds.upper()[i]);
            q[i] = rng.uniform_in(lower, upper);
        }
    }
}

impl Residual for Problem<'_> {
    fn residual(&mut self, q: &[f64], out: &mut [f64; ROWS]) -> Score {
        // No columns are completed: the residual needs the tip alone.
        let mut completed = Linearization::default();
        let error = self.target.complete(&self.robot.tip(q), 0, &mut completed);
        *out = completed.residual;
        self.score(error)
    }
}

impl LeastSquares for Problem<'_> {
    #[inline]
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> Score {
        let error = self.target.linearize(self.robot, q, out);
        self.score(error)
    }
}
