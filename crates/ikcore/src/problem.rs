//! A robot and a target as something to minimise.

use crate::objective::{Bounds, LeastSquares, Linearization, Objective, Score};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::task::{Target, TipError, Tolerance};

/// The inverse kinematics problem; it borrows everything, so that building one per tick costs nothing.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    robot: &'a Robot,
    target: &'a Target,
    tolerance: Tolerance,
}

impl<'a> Problem<'a> {
    /// The problem of bringing the tip of `robot` to `target`.
    pub fn new(robot: &'a Robot, target: &'a Target, tolerance: Tolerance) -> Self {
        Self { robot, target, tolerance }
    }

    /// The errors at `q`, by forward kinematics.
    pub fn verify(&self, q: &[f64]) -> TipError {
        self.target.error(self.robot, q)
    }

    #[inline]
    fn score(&self, error: &TipError) -> Score {
        Score { value: error.value(), solved: error.within(&self.tolerance) }
    }

    /// Scores rows from `done` on in groups of `W` while there are so many; returns how many are done then.
    #[inline]
    fn evaluate_lanes<const W: usize>(
        &self,
        target: &[f64; 3],
        qs: &[f64],
        out: &mut [Score],
        mut done: usize,
    ) -> usize {
        let n = self.robot.dof();
        while out.len() - done >= W {
            let rows: [&[f64]; W] = std::array::from_fn(|w| &qs[(done + w) * n..(done + w + 1) * n]);
            for tip in self.robot.tip_positions(&rows) {
                out[done] = self.score(&TipError::of_position(target, &tip));
                done += 1;
            }
        }
        done
    }
}

impl Objective for Problem<'_> {
    fn dimension(&self) -> usize {
        self.robot.dof()
    }

    #[inline]
    fn evaluate(&mut self, q: &[f64]) -> Score {
        self.score(&self.target.error(self.robot, q))
    }

    /// Positions go through the kinematics four and two at a time.
    fn evaluate_all(&mut self, qs: &[f64], out: &mut [Score]) {
        let n = self.dimension();
        let mut done = 0;
        if let Target::Position(target) = self.target {
            done = self.evaluate_lanes::<4>(target, qs, out, done);
            done = self.evaluate_lanes::<2>(target, qs, out, done);
        }
        for (q, score) in qs.chunks_exact(n).zip(out).skip(done) {
            *score = self.evaluate(q);
        }
    }

    /// Uniform in the box; a side without a limit is drawn from the joint's sampling range.
    fn propose_start(&mut self, _attempt: usize, bounds: &Bounds, rng: &mut LazyRng, q: &mut [f64]) {
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let (lower, upper) = joint.sampling_range_within(bounds.lower()[i], bounds.upper()[i]);
            q[i] = rng.uniform_in(lower, upper);
        }
    }
}

impl LeastSquares for Problem<'_> {
    #[inline]
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> Score {
        let error = self.target.linearize(self.robot, q, out);
        self.score(&error)
    }
}
