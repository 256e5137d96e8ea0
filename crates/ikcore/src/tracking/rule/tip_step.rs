//! Model-based rule for several tips: Gauss-Newton in the box of the tick.
//!
//! A static target that one tick cannot reach is approached by all joints in proportion, as in `approach`. If that does not
//! lower the error, for instance out of reach, Levenberg-Marquardt lowers it as far as the tick allows. Targets of several levels
//! that the tick cannot meet together are met in their order.

use super::tick::{BY_LEVELS, Tick, TickResult};
use crate::ik::LevelDescent;
use crate::objective::{Linearization, Point};
use crate::solver::{LevenbergMarquardt, Stop};
use crate::task::Levels;
use crate::tracking::step_context::StepContext;

/// Largest number of Gauss-Newton steps in a tick; they converge quadratically.
const MOST_STEPS: usize = 6;

/// Evaluation budget of a tick in which Gauss-Newton fails. The next tick continues.
const MOST_EVALUATIONS: usize = 60;

/// Scratch of a tick, without state between ticks.
#[derive(Debug, Default)]
pub(crate) struct TipStep {
    /// Linearization at the start of the tick.
    begin: Box<Linearization>,
    /// Linearization at the last accepted step.
    here: Box<Linearization>,
    trial: Box<Linearization>,
}

impl TipStep {
    /// Runs one tick from `q`.
    pub(super) fn advance(&mut self, mut tick: Tick<'_>) -> TickResult {
        let StepContext { robot, q, aims, tick_box, .. } = tick.context;
        let mut begin = TickResult::at(q);
        tick_box.bounds.clip(&mut begin.q);
        begin.assessment = aims.linearize(robot, &begin.q, &mut self.begin, |_| ());
        begin.evaluations = 1;
        let mut found = begin.clone();
        if tick.takes_its_time() && !tick.has_levels() && self.approach(&begin, &mut found, &tick) {
            return found;
        }
        let preferred = tick.preferred(&begin.q);
        if let Some(preferred) = &preferred {
            self.gauss_newton(&mut found, Some(preferred), &tick);
        }
        if !found.is_solved() || preferred.is_none() {
            found = TickResult { evaluations: found.evaluations, ..begin.clone() };
            self.gauss_newton(&mut found, None, &tick);
        }
        if !found.is_solved() && tick.descend_into_band(&mut found, &tick_box.bounds) {
            found.assess(robot, &aims);
        }
        if !found.is_solved() && tick.has_levels() {
            self.by_levels(&begin, &mut found, &tick);
            return found;
        }
        if !found.is_solved() && !self.approach(&begin, &mut found, &tick) {
            let stop = Stop { max_evaluations: MOST_EVALUATIONS.min(tick.most_evaluations), ..Stop::default() };
            tick.descend(&mut found, &tick_box.bounds, stop);
            found.assess(robot, &aims);
            found.evaluations += 1;
        }
        found
    }

    /// Meets the targets level by level, as far as the tick allows. Where those of the lowest stand still and are far, all joints move
    /// in proportion, if that brings the lowest level nearer.
    fn by_levels(&mut self, begin: &TickResult, found: &mut TickResult, tick: &Tick<'_>) {
        let StepContext { robot, aims, tick_box, .. } = tick.context;
        let levels = Levels::of(&aims);
        let mut descent = LevelDescent::new(robot, &levels, &tick_box.bounds, BY_LEVELS);
        let reached = descent.descend(&begin.q, None);
        found.evaluations += descent.evaluations + 1;
        found.iterations += descent.evaluations;
        found.q.copy_from_slice(&reached.q);
        found.assess(robot, &aims);
        if tick.targets.moves() || levels.lowest_is_met(robot, &found.q) {
            return;
        }
        let lowest = |q: &[f64]| levels.aims(0).assess(robot, q).score.value;
        let mut near = TickResult { evaluations: found.evaluations, iterations: found.iterations, ..begin.clone() };
        if self.approach(begin, &mut near, tick) && lowest(&near.q) < lowest(&begin.q) {
            *found = near;
        }
    }

    /// Steps from `found`, at the start of the tick, while the error falls. The first step, towards the `preferred`
    /// configuration where the targets leave the joints free, may raise it.
    fn gauss_newton(&mut self, found: &mut TickResult, preferred: Option<&Point>, tick: &Tick<'_>) {
        let StepContext { robot, aims, .. } = tick.context;
        let bounds = tick.bounds();
        for i in 0..MOST_STEPS {
            // At least one step: an arm that waits until it is out of its band would move in jerks.
            if i > 0 && found.is_solved() {
                return;
            }
            let at = if i == 0 { &self.begin } else { &self.here };
            let (lambda, preferred) = (at.least_damping(found.q.len()), preferred.filter(|_| i == 0));
            let mut q = found.q.clone();
            match preferred {
                Some(preferred) => at.write_step_near(preferred, lambda, &found.q, bounds, &mut q),
                None => at.write_step(lambda, &found.q, bounds, &mut q),
            }
            let assessment = aims.linearize(robot, &q, &mut self.trial, |_| ());
            found.evaluations += 1;
            found.iterations += 1;
            if !(assessment.score.value < found.value()) && preferred.is_none() {
                return;
            }
            (found.q, found.assessment) = (q, assessment);
            std::mem::swap(&mut self.here, &mut self.trial);
        }
    }

    /// Approaches far targets: all joints move in proportion to their remaining displacement within the position limits or, for
    /// moving targets, each as far as it may. Returns false if the targets are near, or if the arm would come no nearer.
    fn approach(&mut self, begin: &TickResult, found: &mut TickResult, tick: &Tick<'_>) -> bool {
        let n = begin.q.len();
        let StepContext { robot, aims, tick_box, .. } = tick.context;
        let positions = tick.context.positions();
        let least = self.begin.least_damping(n);
        let lambda = least.max(LevenbergMarquardt::default().initial_damping * begin.value());
        let mut end = begin.q.clone();
        self.begin.write_step(lambda, &begin.q, &positions, &mut end);
        let fraction = tick.fraction_within(&begin.q, &end);
        if fraction >= 1.0 {
            return false;
        }
        let mut near = begin.clone();
        let fraction = if tick.targets.moves() && !tick.takes_its_time() { 1.0 } else { fraction };
        near.q.iter_mut().zip(&end).for_each(|(q, end)| *q += fraction * (end - *q));
        tick_box.bounds.clip(&mut near.q);
        near.assess(robot, &aims);
        let is_nearer = near.value() < begin.value();
        if is_nearer {
            *found = TickResult { evaluations: found.evaluations + 1, iterations: found.iterations + 1, ..near };
        }
        is_nearer
    }
}
