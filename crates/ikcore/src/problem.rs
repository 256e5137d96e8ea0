//! A robot and a target as something to minimise.

use crate::objective::{Bounds, Gradient, LeastSquares, Linearization, Objective, Score, Slope};
use crate::rng::LazyRng;
use crate::robot::{Robot, Seeds};
use crate::task::{SquaredError, Target, TipError, Tolerance, entrywise};

/// The inverse kinematics problem; it borrows everything, so that building one per tick costs nothing.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    robot: &'a Robot,
    target: &'a Target,
    tolerance: Tolerance,
    /// Found when the first start is asked for.
    seeds: Option<Seeds<'a>>,
    turns: Turns,
}

/// Whether it matters how often a joint has turned round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turns {
    /// On the way from one tick to the next it does.
    Count,
    /// For a configuration that stands alone it does not.
    Repeat,
}

impl<'a> Problem<'a> {
    /// The problem of bringing the tip of `robot` to `target`.
    pub fn new(robot: &'a Robot, target: &'a Target, tolerance: Tolerance) -> Self {
        Self { robot, target, tolerance, seeds: None, turns: Turns::Count }
    }

    /// The same problem where a joint may be brought back by whole turns: the robot is free to get there in any way.
    pub fn disregarding_turns(self) -> Self {
        Self { turns: Turns::Repeat, ..self }
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

    fn period(&self, joint: usize) -> Option<f64> {
        let repeats = self.turns == Turns::Repeat && self.robot.repeats(joint);
        repeats.then_some(std::f64::consts::TAU)
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

impl Gradient for Problem<'_> {
    #[inline]
    fn differentiate(&mut self, q: &[f64], gradient: &mut [f64]) -> Slope {
        let target = self.target;
        let tip = self.robot.tip_and_torques(q, &|tip| entrywise::pull(target, tip), gradient);
        gradient.iter_mut().for_each(|slope| *slope = -*slope);
        Slope { error: entrywise::error(target, &tip), score: self.score(target.error_of(&tip)) }
    }
}

impl LeastSquares for Problem<'_> {
    #[inline]
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> Score {
        let error = self.target.linearize(self.robot, q, out);
        self.score(error)
    }
}
