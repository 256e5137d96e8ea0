//! Inverse kinematics as an objective: a robot, tasks and targets.

use smallvec::SmallVec;

use super::tip_starts::TipStarts;
use crate::objective::{
    Bounds, Gradient, LeastSquares, Linearization, Objective, Residual, Score, SmoothScore, TaskResiduals,
};
use crate::obstacle::ClearSpace;
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::starts::Starts;
use crate::task::residual::entrywise;
use crate::task::{Aims, Assessment, Criterion, Subject, Target};

/// Inverse kinematics problem. It borrows everything, so building one per tick costs nothing.
#[derive(Debug, Clone)]
pub struct Problem<'a> {
    robot: &'a Robot,
    aims: Aims<'a>,
    /// Indexed starts, looked up when the first is needed.
    seeds: Option<Starts<'a>>,
    /// Starts of attempts for several tips.
    tip_starts: Option<Box<TipStarts>>,
    turns: Turns,
    /// Clear space, whose violation is penalised for derivative-free solvers.
    space: Option<&'a ClearSpace<'a>>,
}

/// Equivalence of configurations that differ by whole turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turns {
    /// Distinct, as in tracking, where the arm would have to make the turns.
    Distinct,
    /// Equivalent, as for a single configuration.
    Equivalent,
}

impl<'a> Problem<'a> {
    /// Problem of moving the tips of `robot` onto their targets.
    pub fn new(robot: &'a Robot, aims: Aims<'a>) -> Self {
        Self { robot, aims, seeds: None, tip_starts: None, turns: Turns::Distinct, space: None }
    }

    /// Treats full turns of a joint as equivalent.
    pub fn disregarding_turns(self) -> Self {
        Self { turns: Turns::Equivalent, ..self }
    }

    /// Problem of a single configuration, with full turns equivalent, and a penalty on configurations outside `space`, none of
    /// which is a solution.
    #[inline]
    pub(crate) fn of_configuration(robot: &'a Robot, aims: Aims<'a>, space: Option<&'a ClearSpace<'a>>) -> Self {
        // Built in one expression: copying a problem takes longer than many a closed-form solve.
        let tip_starts = (robot.tip_count() > 1).then(Box::default);
        Self { robot, aims, seeds: None, tip_starts, turns: Turns::Equivalent, space }
    }

    /// Target and criterion of the only tip; `None` for several tips.
    #[inline]
    pub(crate) fn only_target(&self) -> Option<(&'a Target, &'a Criterion)> {
        self.aims.only(self.robot)
    }

    /// Frame numbers of the tips with targets that fix the whole pose.
    pub(crate) fn fixed_frames(&self) -> SmallVec<[usize; 2]> {
        let fixed = self.aims.iter().filter_map(|(task, target)| match task.subject {
            Subject::Tip(tip) if task.criterion.fixes_pose(target) => Some(self.robot.frame_of_tip(tip)),
            _ => None,
        });
        fixed.collect()
    }

    /// Tasks and targets.
    pub(crate) fn aims(&self) -> Aims<'a> {
        self.aims
    }

    pub(super) fn robot(&self) -> &'a Robot {
        self.robot
    }

    /// Assesses `q` by forward kinematics.
    #[inline]
    pub fn assess(&self, q: &[f64]) -> Assessment {
        match self.only_target() {
            Some((target, criterion)) => target.assess(self.robot, q, criterion),
            None => assess_several(self.aims, self.robot, q),
        }
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
        let mut keep = |assessment: Assessment| {
            if let Some(score) = scores.next() {
                *score = assessment.score;
            }
        };
        match self.only_target() {
            Some((target, criterion)) => target.assess_all(self.robot, qs, criterion, keep),
            None => qs.chunks_exact(self.robot.dof()).for_each(|q| keep(self.assess(q))),
        }
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

    /// Proposes the robot's indexed configurations, the nearest first, then uniform draws in the box; an unlimited side ends at
    /// the joint's sampling range. The indexed configurations also follow a start given by the caller. For several tips see
    /// `tip_starts`.
    fn propose_start(&mut self, _attempt: usize, bounds: &Bounds, rng: &mut LazyRng, q: &mut [f64]) {
        let Some((target, criterion)) = self.only_target() else {
            if let Some(starts) = &mut self.tip_starts {
                starts.propose(self.robot, &self.aims, bounds, rng, q);
            }
            return;
        };
        if self.seeds.is_none() {
            let aim = criterion.aim(target);
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

/// Score of `q` with a penalty outside `space`: squared distances, added to the squared errors of position.
fn kept_clear(score: Score, space: &ClearSpace<'_>, q: &[f64]) -> Score {
    if space.holds(q) {
        return score;
    }
    Score { value: score.value + space.squared_shortfall(q), solved: false }
}

impl Residual for Problem<'_> {
    fn residual(&mut self, q: &[f64], out: &mut TaskResiduals) -> Score {
        out.clear();
        self.aims.residuals(self.robot, q, |residual| out.push(residual)).score
    }
}

impl Gradient for Problem<'_> {
    /// Computes E of eq. (11) of Yuan et al. 2016; with component weights, a region or several tips, half the weighted sum of
    /// squares.
    #[inline]
    fn differentiate(&mut self, q: &[f64], gradient: &mut [f64]) -> SmoothScore {
        let plain = |criterion: &Criterion| criterion.components.is_none() && criterion.region.is_none();
        let Some((target, criterion)) = self.only_target().filter(|(_, criterion)| plain(criterion)) else {
            let mut linearization = Linearization::default();
            let score = self.linearize(q, &mut linearization);
            linearization.gradient(gradient);
            return SmoothScore { error: 0.5 * score.value, score };
        };
        let tip = self.robot.tip_and_torques(q, &|tip| entrywise::wrench(target, tip), gradient);
        gradient.iter_mut().for_each(|slope| *slope = -*slope);
        SmoothScore { error: entrywise::error(target, &tip), score: target.assess_tip(&tip, criterion).score }
    }
}

impl LeastSquares for Problem<'_> {
    #[inline]
    fn linearize(&mut self, q: &[f64], out: &mut Linearization) -> Score {
        // Records solved tasks, on which the next start builds.
        let note = |task: usize| {
            if let Some(starts) = &mut self.tip_starts {
                starts.note(task, q);
            }
        };
        self.aims.linearize(self.robot, q, out, note).score
    }
}

// Kept out of line: inlining would slow down the case of one tip.
#[cold]
#[inline(never)]
fn assess_several(aims: Aims<'_>, robot: &Robot, q: &[f64]) -> Assessment {
    aims.assess(robot, q)
}
