//! A robot and a target as an objective.

use crate::math::box_step::ROWS;
use crate::objective::{Bounds, Gradient, LeastSquares, Linearization, Objective, Residual, Score, SmoothScore};
use crate::obstacle::ClearSpace;
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::starts::Starts;
use crate::task::residual::entrywise;
use crate::task::{Assessment, Criterion, Target};

/// The inverse kinematics problem. It borrows everything, so building one per tick costs nothing.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    robot: &'a Robot,
    target: &'a Target,
    criterion: Criterion,
    /// Looked up when the first start is needed.
    seeds: Option<Starts<'a>>,
    turns: Turns,
    /// What a solution must keep clear of, for solvers that need values alone.
    space: Option<&'a ClearSpace<'a>>,
}

/// Whether configurations that differ by whole turns count as different.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turns {
    /// Different, as in tracking, where the arm would have to make the turns.
    Distinct,
    /// Equivalent, as for a single configuration.
    Equivalent,
}

impl<'a> Problem<'a> {
    /// The problem of moving the tip of `robot` to `target`.
    pub fn new(robot: &'a Robot, target: &'a Target, criterion: impl Into<Criterion>) -> Self {
        Self { robot, target, criterion: criterion.into(), seeds: None, turns: Turns::Distinct, space: None }
    }

    /// The same problem, in which full turns of a joint do not matter.
    pub fn disregarding_turns(self) -> Self {
        Self { turns: Turns::Equivalent, ..self }
    }

    /// The same problem with a penalty on its values outside `space`, where no configuration is a solution.
    pub(crate) fn penalized(self, space: Option<&'a ClearSpace<'a>>) -> Self {
        Self { space, ..self }
    }

    /// The target of the tip.
    pub fn target(&self) -> &'a Target {
        self.target
    }

    pub(super) fn robot(&self) -> &'a Robot {
        self.robot
    }

    /// The criterion of the target.
    pub(crate) fn criterion(&self) -> &Criterion {
        &self.criterion
    }

    /// The assessment of `q`, by forward kinematics.
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
        let score = self.assess(q).score;
        self.space.map_or(score, |space| kept_clear(score, space, q))
    }

    fn evaluate_all(&mut self, qs: &[f64], out: &mut [Score]) {
        let mut scores = out.iter_mut();
        self.target.assess_all(self.robot, qs, &self.criterion, |assessment| {
            if let Some(score) = scores.next() {
                *score = assessment.score;
            }
        });
        if let Some(space) = self.space {
            for (q, score) in qs.chunks_exact(self.robot.dof()).zip(out) {
                *score = kept_clear(*score, space, q);
            }
        }
    }

    fn period(&self, joint: usize) -> Option<f64> {
        let repeats = self.turns == Turns::Equivalent && self.robot.repeats_every_turn(joint);
        repeats.then_some(std::f64::consts::TAU)
    }

    /// Proposes the robot's indexed configurations, the nearest first, then uniform draws in the box; unlimited sides
    /// end at the joint's sampling range. The indexed configurations also follow a start given by the caller.
    fn propose_start(&mut self, _attempt: usize, bounds: &Bounds, rng: &mut LazyRng, q: &mut [f64]) {
        if self.seeds.is_none() {
            let aim = self.criterion.aim(self.target);
            self.seeds = match (&aim, aim.position()) {
                (Target::Pose(pose), _) => Some(self.robot.starts_near_pose(pose)),
                (_, Some(position)) => Some(self.robot.starts_near_position(&position)),
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

/// The score of `q` with the penalty: squares of distances, beside the squares of errors of position.
fn kept_clear(score: Score, space: &ClearSpace<'_>, q: &[f64]) -> Score {
    if space.holds(q) {
        return score;
    }
    Score { value: score.value + space.squared_shortfall(q), solved: false }
}

impl Residual for Problem<'_> {
    fn residual(&mut self, q: &[f64], out: &mut [f64; ROWS]) -> Score {
        // Without a Jacobian: the residual needs only the tip.
        let mut linearization = Linearization::default();
        let assessment = self.target.linearize_tip(&self.robot.tip(q), 0, &self.criterion, &mut linearization);
        *out = linearization.residual;
        assessment.score
    }
}

impl Gradient for Problem<'_> {
    /// E of eq. (11) of Yuan et al. 2016; with component weights or a region, half the weighted sum of squares.
    #[inline]
    fn differentiate(&mut self, q: &[f64], gradient: &mut [f64]) -> SmoothScore {
        if self.criterion.components.is_some() || self.criterion.region.is_some() {
            let mut linearization = Linearization::default();
            let score = self.linearize(q, &mut linearization);
            linearization.gradient(gradient);
            return SmoothScore { error: 0.5 * score.value, score };
        }
        let target = self.target;
        let tip = self.robot.tip_and_torques(q, &|tip| entrywise::wrench(target, tip), gradient);
        gradient.iter_mut().for_each(|slope| *slope = -*slope);
        SmoothScore { error: entrywise::error(target, &tip), score: target.assess_tip(&tip, &self.criterion).score }
    }
}

impl LeastSquares for Problem<'_> {
    #[inline]
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> Score {
        self.target.linearize(self.robot, q, &self.criterion, out).score
    }
}
