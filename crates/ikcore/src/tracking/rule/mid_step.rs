//! Model-based rule: Gauss-Newton in the box, with the Jacobian at the middle of the tick.
//!
//! A step with the Jacobian at the start of the tick leaves an error of second order. The Jacobian at the middle, extrapolated
//! from the last two ticks as (3 J_k - J_{k-1}) / 2, leaves one of third order, so that a single evaluation per tick reaches
//! micrometres. Joint velocities are not extrapolated: on a redundant arm that would sustain null-space motion. If the box or a
//! singularity keeps a step from lowering the error, Levenberg-Marquardt solves the tick; it never raises the error. A pose of
//! which one part comes first is then met in that order. Joints with weights approach a far target that stands still first: heavy
//! ones would otherwise make up for what the others cannot do in one tick.

use std::borrow::Cow;

use super::approach::Approach;
use super::soft_step::SoftStep;
use super::tick::{Tick, TickResult};
use crate::ik::RankedDescent;
use crate::math::box_step::least_damping;
use crate::math::{Columns, Frame};
use crate::objective::{Bounds, Point, TaskBlock};
use crate::robot::Robot;
use crate::solver::Stop;
use crate::task::{Assessment, First, SquaredError};

/// Largest number of model steps in a tick; they converge quadratically, so more would not help.
const MOST_STEPS: usize = 10;

/// State of the rule between ticks. Boxed, so that passing a Jacobian on copies a pointer.
#[derive(Debug, Default)]
pub(crate) struct MidStepState {
    /// Kinematics at the accepted configuration; known after the first tick.
    begin: Box<Kinematics>,
    begin_known: bool,
    /// Kinematics at the configuration before, if the arm has moved since.
    before: Box<Kinematics>,
    before_known: bool,
    here: Box<Kinematics>,
    trial: Box<Kinematics>,
    linearization: Box<TaskBlock>,
}

/// Linear model of a step: the configurations of its tip and its Jacobian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Model {
    /// Tip and Jacobian at the start of the tick.
    Begin,
    /// Tip at the start, Jacobian extrapolated to the middle of the tick.
    MidTick,
    /// Tip and Jacobian at the result of the last step.
    Here,
}

/// Tip and geometric Jacobian of a configuration.
#[derive(Debug)]
struct Kinematics {
    q: Point,
    tip: Frame,
    columns: Columns,
}

impl Default for Kinematics {
    fn default() -> Self {
        Self { q: Point::new(), tip: Frame::IDENTITY, columns: Columns::default() }
    }
}

impl Kinematics {
    /// Sets `q`; tip and Jacobian are outdated until `update`.
    fn place(&mut self, q: &[f64]) {
        self.q.clear();
        self.q.extend_from_slice(q);
    }

    fn update(&mut self, robot: &Robot) {
        self.tip = robot.tip_and_jacobian(&self.q, &mut self.columns);
    }
}

pub(super) fn advance(memory: &mut MidStepState, mut tick: Tick<'_>) -> TickResult {
    let q = tick.context.q;
    let mut found = TickResult::at(q);
    tick.bounds().clip(&mut found.q);
    if !memory.begin_known || *found.q != *q {
        // The first tick, or a start outside the limits.
        memory.begin.place(&found.q);
        memory.begin.update(tick.context.robot);
        memory.before_known = false;
        found.evaluations += 1;
    }
    found.set_tip(&memory.begin.tip, tick.target, tick.criterion);
    let value_at_rest = found.value();
    if tick.takes_its_time() && tick.ranked().is_none() && memory.follow_approach(value_at_rest, &mut found, &tick) {
        memory.hand_on(true);
        return found;
    }
    let mut moved = memory.towards_goals(&mut found, &mut tick) || memory.gauss_newton(&mut found, &tick);
    if !found.is_solved() && memory.enter_band(&mut found, &mut tick) {
        moved = true;
    } else if !found.is_solved()
        && let Some(ranked) = tick.ranked()
    {
        moved = true;
        memory.in_order(ranked, &mut found, &tick);
    } else if !found.is_solved() {
        moved = true;
        if !memory.follow_approach(value_at_rest, &mut found, &tick) {
            memory.levenberg_marquardt(&mut found, tick);
        }
    }
    memory.hand_on(moved);
    found
}

impl MidStepState {
    /// Drops the kinematics of the last tick, because the arm is not where it ended.
    pub(crate) fn forget(&mut self) {
        (self.begin_known, self.before_known) = (false, false);
    }

    /// Takes one step along the negative gradient of the goals, as far as the target leaves the joints free, then model steps
    /// until the tip is in the band. Returns whether it arrives; if not, `found` keeps its configuration.
    fn towards_goals(&mut self, found: &mut TickResult, tick: &mut Tick<'_>) -> bool {
        let Some(preferred) = tick.preferred(&found.q) else { return false };
        let mut trial = found.clone();
        self.step(&mut trial, tick, self.first_model(), tick.bounds(), Some(&preferred));
        let assessment = tick.target.assess_tip(&self.trial.tip, tick.criterion);
        self.accept_trial(&mut trial, assessment);
        while !trial.is_solved()
            && trial.iterations < MOST_STEPS
            && self.lowers(&mut trial, tick, Model::Here, tick.bounds())
        {}
        found.evaluations = trial.evaluations;
        if trial.is_solved() {
            *found = trial;
        }
        found.is_solved() && found.iterations > 0
    }

    /// Takes model steps while they lower the error. Returns whether the arm moved.
    fn gauss_newton(&mut self, found: &mut TickResult, tick: &Tick<'_>) -> bool {
        let mut moved = false;
        let mut model = self.first_model();
        let mut bounds = Cow::Borrowed(tick.bounds());
        // At least one step: an arm that waits until it is out of its band would move in jerks.
        while found.iterations == 0 || (found.iterations < MOST_STEPS && !found.is_solved()) {
            model = match (self.lowers(found, tick, model, &bounds), model) {
                (true, _) => Model::Here,
                (false, Model::MidTick) => Model::Begin,
                // All joints together may reach a target that weights have left to few.
                (false, _) if bounds.weights().is_some() => {
                    bounds = Cow::Owned(bounds.into_owned().weighted(None));
                    model
                }
                (false, Model::Begin | Model::Here) => break,
            };
            moved |= model == Model::Here;
        }
        moved
    }

    /// Best model available at the start of a tick.
    fn first_model(&self) -> Model {
        if self.before_known { Model::MidTick } else { Model::Begin }
    }

    /// Takes one step from `found` and keeps it if it lowers the error. Returns whether it does.
    fn lowers(&mut self, found: &mut TickResult, tick: &Tick<'_>, model: Model, bounds: &Bounds) -> bool {
        self.step(found, tick, model, bounds, None);
        let assessment = tick.target.assess_tip(&self.trial.tip, tick.criterion);
        let lower = assessment.score.value < found.value();
        if lower {
            self.accept_trial(found, assessment);
        }
        lower
    }

    /// Moves `found` to the assessed trial.
    fn accept_trial(&mut self, found: &mut TickResult, assessment: Assessment) {
        std::mem::swap(&mut self.here, &mut self.trial);
        found.q.copy_from_slice(&self.here.q);
        (found.assessment, found.position) = (assessment, self.here.tip.origin);
    }

    /// Sets the trial to the configuration that meets the target by the `model`, with the free joints as near as
    /// possible to `preferred`.
    fn step(
        &mut self,
        found: &mut TickResult,
        tick: &Tick<'_>,
        model: Model,
        bounds: &Bounds,
        preferred: Option<&[f64]>,
    ) {
        let n = found.q.len();
        let current = match model {
            Model::Here => &self.here,
            Model::Begin | Model::MidTick => &self.begin,
        };
        self.linearization.columns.fit(n);
        let columns = &mut self.linearization.columns[..n];
        match model {
            Model::MidTick => at_middle(&current.columns, &self.before.columns, columns),
            Model::Begin | Model::Here => columns.copy_from_slice(&current.columns[..n]),
        }
        tick.target.linearize_tip(&current.tip, n, tick.criterion, &mut self.linearization);
        let model = &*self.linearization;
        let lambda = least_damping(&model.columns[..n]);
        self.trial.q.resize(n, 0.0);
        let step = SoftStep { model, columns: &current.columns[..n], lambda, from: &found.q, preferred };
        step.write(bounds, &mut self.trial.q);
        self.trial.update(tick.context.robot);
        found.evaluations += 1;
        found.iterations += 1;
    }

    /// Moves towards a far target. Returns false if the target is near, or if the tick would not bring the arm nearer.
    fn follow_approach(&mut self, value_at_rest: f64, found: &mut TickResult, tick: &Tick<'_>) -> bool {
        let q = tick.context.q;
        let mut near = Point::from_slice(q);
        tick.bounds().clip(&mut near);
        let approach = Approach::new(&near, &self.begin.tip, &self.begin.columns, tick);
        if !approach.is_far() {
            return false;
        }
        self.trial.place(q);
        approach.advance(&mut self.trial.q, tick);
        self.trial.update(tick.context.robot);
        let assessment = tick.target.assess_tip(&self.trial.tip, tick.criterion);
        let nearer = assessment.score.value < value_at_rest;
        if nearer {
            self.accept_trial(found, assessment);
            found.evaluations += 1;
            found.iterations += 1;
        }
        nearer
    }

    /// Moves within the tolerances, where the tick does not allow to meet the target itself.
    fn enter_band(&mut self, found: &mut TickResult, tick: &mut Tick<'_>) -> bool {
        let bounds = tick.bounds().clone();
        if !tick.descend_into_band(found, &bounds) {
            return false;
        }
        self.here.place(&found.q);
        self.here.update(tick.context.robot);
        found.set_tip(&self.here.tip, tick.target, tick.criterion);
        true
    }

    /// Meets the part of the target that comes first, as far as the tick allows, and lowers the error of the other. Where it is far,
    /// all joints move in proportion, if that lowers the error of the first part.
    fn in_order(&mut self, (pose, first): (Frame, First), found: &mut TickResult, tick: &Tick<'_>) {
        let first_error = |error: &SquaredError| match first {
            First::Position => error.position.unwrap_or(0.0),
            First::Orientation => error.rotation.unwrap_or(0.0),
        };
        found.q.copy_from_slice(&self.begin.q);
        found.set_tip(&self.begin.tip, tick.target, tick.criterion);
        let at_rest = first_error(&found.assessment.error);
        let mut descent = RankedDescent::new(tick.context.robot, &pose, first, tick.bounds());
        let reached = descent.descend(&found.q);
        found.evaluations += descent.evaluations;
        found.iterations += descent.evaluations;
        if !reached.is_met() {
            let mut near = found.clone();
            if self.follow_approach(f64::INFINITY, &mut near, tick) && first_error(&near.assessment.error) < at_rest {
                *found = near;
                return;
            }
        }
        self.here.place(&reached.q);
        self.here.update(tick.context.robot);
        found.q.copy_from_slice(&reached.q);
        found.set_tip(&self.here.tip, tick.target, tick.criterion);
        found.evaluations += 1;
    }

    /// Lowers the error as far as possible where model steps fail.
    fn levenberg_marquardt(&mut self, found: &mut TickResult, mut tick: Tick<'_>) {
        let context = tick.context;
        tick.descend(found, &context.tick_box.bounds, Stop::default());
        self.here.place(&found.q);
        self.here.update(context.robot);
        found.set_tip(&self.here.tip, tick.target, tick.criterion);
        found.evaluations += 1;
    }

    /// Hands the kinematics at the end of this tick to the start of the next.
    fn hand_on(&mut self, moved: bool) {
        if moved {
            std::mem::swap(&mut self.before, &mut self.begin);
            std::mem::swap(&mut self.begin, &mut self.here);
        }
        (self.begin_known, self.before_known) = (true, moved);
    }
}

/// Extrapolates the Jacobian to the middle of the tick: (3 J_k - J_{k-1}) / 2.
fn at_middle(now: &Columns, before: &Columns, middle: &mut [[f64; 6]]) {
    for (middle, (now, before)) in middle.iter_mut().zip(now.iter().zip(&**before)) {
        (0..6).for_each(|k| middle[k] = now[k] + 0.5 * (now[k] - before[k]));
    }
}
