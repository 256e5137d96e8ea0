//! Safety filter of commands: keeps the arm clear of everything around it, constraints within their tolerances, and pairs of tips at
//! their relative poses.
//!
//! Invariant: braking now ends in a configuration known to be clear, at which all constraints hold. Each near pair of bodies gives a
//! constraint row on the motion of the rest configuration towards the other body, and each error of a constraint one on that towards
//! its tolerance. The filter takes the command nearest to the proposed one, measured
//! by its effect on the task, that satisfies these rows and the box of the tick. The command is sent if it and the stop after
//! it are certified, between ticks too; otherwise a fraction of it is; failing that, the previously certified stop
//! continues.
//!
//! Pairs of tips at their relative poses stay there: they add equations to the rows, and the stop keeps them as well.

use std::sync::Arc;

use super::around_arm::{Around, ObstacleVelocities, Response, require_constant};
use super::constrained_step::{ConstrainedStep, Resting, StepRequest, Towards};
use super::coupled_stop::CoupledStop;
use super::kept::Kept;
use super::progress::{Admitted, ArmProgress, is_nearer};
use super::step_context::StepContext;
use crate::error::Result;
use crate::limits::Limits;
use crate::math::vector::write_within;
use crate::objective::{Bounds, Point};
use crate::obstacle::{ClearSpace, JointMotion, MOST_COMING, MOST_ROWS};
use crate::task::Aims;

/// Fractions of a command, tried in turn if the whole is not certified.
const PARTS: [f64; 2] = [0.5, 0.125];

/// Gauss-Newton steps towards the target within the rows.
const STEPS: usize = 3;

/// Trust region of the rows of a goal (rad, m).
const TRUSTED: f64 = 0.05;

/// Safety filter of one arm, with its state between ticks.
#[derive(Debug)]
pub(super) struct SafetyFilter {
    around: Option<Around>,
    kept: Option<Box<Kept>>,
    rows: ConstrainedStep,
    /// Stop after the last command of an arm that holds pairs; empty without pairs.
    stop: CoupledStop,
    /// Stop after the command under consideration.
    next_stop: CoupledStop,
    /// Obstruction that keeps the last goal from its target.
    holds_goal: Option<Holder>,
    /// Obstructions found for the command under consideration.
    in_the_way: InTheWay,
    progress: ArmProgress,
}

/// Work counters of the safety filter, for real-time budgets.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FilterWork {
    /// Intervals examined to certify motions.
    pub intervals: usize,
    /// Exchanges of constraints by steps beside rows.
    pub exchanges: usize,
}

/// Outcome of the filter for a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FilterOutcome {
    /// Whether the command was changed.
    pub changed: bool,
    /// Obstruction that caused the change, unless the pairs of tips did.
    pub held_by: Option<Holder>,
}

/// Kind of obstruction that holds an arm back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holder {
    /// An obstacle or another link.
    Body,
    /// A constraint.
    Constraint,
}

/// Obstructions found in the way of commands.
#[derive(Debug, Clone, Copy, Default)]
struct InTheWay {
    bodies: bool,
    constraints: bool,
}

impl InTheWay {
    fn any(self) -> bool {
        self.bodies || self.constraints
    }

    /// Returns the obstruction that holds the arm: a body, unless only constraints are in the way.
    fn holder(self) -> Holder {
        if self.constraints && !self.bodies { Holder::Constraint } else { Holder::Body }
    }
}

impl SafetyFilter {
    /// Filter of an arm with these limits, in `space` if collisions are to be avoided, with the constraints `kept`.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push the arm into an
    /// obstacle, or out of a tolerance.
    pub fn new(space: Option<ClearSpace<'static>>, kept: Option<Kept>, limits: &Limits) -> Result<Self> {
        if kept.is_some() {
            let remedy = "limits that vary can carry the arm out of its tolerances; give numbers";
            require_constant(limits, "tracking with constraints", remedy)?;
        }
        Ok(Self {
            kept: kept.map(Box::new),
            around: space.map(|space| Around::new(space, ObstacleVelocities::default(), limits)).transpose()?,
            rows: ConstrainedStep::with_room(limits.dof(), 2 * MOST_ROWS + MOST_COMING),
            stop: CoupledStop::default(),
            next_stop: CoupledStop::default(),
            holds_goal: None,
            in_the_way: InTheWay::default(),
            progress: ArmProgress::new(limits),
        })
    }

    /// Clear space of the arm.
    pub fn space(&self) -> Option<&Arc<ClearSpace<'static>>> {
        self.around.as_ref().map(|around| &around.space)
    }

    /// Whether an obstacle moves.
    pub fn sees_motion(&self) -> bool {
        self.around.as_ref().is_some_and(|around| around.obstacles.fastest() > 0.0)
    }

    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub fn velocities(&self) -> &[[f64; 3]] {
        self.around.as_ref().map_or(&[], |around| &around.obstacles.velocities)
    }

    /// Replaces the surroundings: `space` with the obstacles at their current poses, and their motion.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn replace(
        &mut self,
        space: Option<ClearSpace<'static>>,
        obstacles: ObstacleVelocities,
        limits: &Limits,
    ) -> Result<()> {
        self.progress.note_replaced();
        match (space, &mut self.around) {
            (Some(space), Some(around)) => {
                (around.space, around.obstacles, around.since) = (Arc::new(space), obstacles, 0.0);
            }
            (Some(space), none) => *none = Some(Around::new(space, obstacles, limits)?),
            (None, around) => (*around, self.holds_goal) = (None, None),
        }
        Ok(())
    }

    /// Work so far.
    pub fn work(&self) -> FilterWork {
        let [around, kept] =
            [self.around.as_ref().map(Around::intervals), self.kept.as_ref().map(|kept| kept.intervals())];
        let intervals = around.unwrap_or(0) + kept.unwrap_or(0);
        FilterWork { intervals, exchanges: self.rows.exchanges() }
    }

    /// Forgets the stop, because the arm has moved elsewhere.
    pub fn forget(&mut self) {
        self.stop.clear();
        self.progress.restart();
    }

    /// Advances the stop after the last command by one tick of `dt` (s). Returns its next configuration if pairs are held;
    /// otherwise each joint stops as fast as it may.
    pub fn stop_on(&mut self, dt: f64) -> Option<Point> {
        self.progress.restart();
        if let Some(around) = &mut self.around {
            around.since += dt;
        }
        let next = self.stop.next().cloned();
        self.stop.pass();
        next
    }

    /// Ticks until an arm that holds pairs is at rest if it stops now; `None` without pairs.
    pub fn ticks_to_stop(&self) -> Option<f64> {
        self.stop.rest().map(|_| self.stop.ticks_to_stop())
    }

    /// Changes the command `q` of the rule to one that keeps the arm clear and holds pairs of tips. Pairs that cannot be held
    /// yet are ordinary tasks until they reach their relative pose. A `settled` arm stops, unless it has to move.
    pub fn filter(&mut self, context: &StepContext<'_>, settled: bool, q: &mut Point) -> FilterOutcome {
        let wanted = q.clone();
        match context.errors() {
            Some(errors) => self.progress.begin_tick(errors, context.dt),
            None => self.progress.restart(),
        }
        let held = if context.aims.has_pairs() { self.filter_with_pairs(context, settled, q) } else { None };
        let is_held = held.unwrap_or_else(|| {
            self.stop.clear();
            q.copy_from_slice(&wanted);
            self.filter_one_by_one(context, settled, q)
        });
        if let Some(around) = &mut self.around {
            around.since += context.dt;
        }
        if is_held || self.holds_goal.is_some() {
            self.progress.note_held();
        }
        FilterOutcome { changed: *q != wanted, held_by: is_held.then(|| self.holder()) }
    }

    /// Returns the obstruction that holds the arm back. For an arm that rests because it came no nearer, it is that of its goal.
    fn holder(&self) -> Holder {
        if self.in_the_way.any() {
            return self.in_the_way.holder();
        }
        self.holds_goal.unwrap_or(if self.around.is_some() { Holder::Body } else { Holder::Constraint })
    }

    /// Changes the command `q` to one that keeps the arm clear and all constraints, for joints that stop one by one. Returns whether
    /// something held it back.
    fn filter_one_by_one(&mut self, context: &StepContext<'_>, settled: bool, q: &mut Point) -> bool {
        if self.around.is_none() && self.kept.is_none() {
            return false;
        }
        let brake = context.braking();
        let stop = context.stop_after(&brake);
        let rest = stop.rest();
        let wanted = q.clone();
        let blocked = self.set_rows(context, (&rest, stop.ticks_to_stop()), &wanted);
        let admitted = self.admitted(settled, &brake);
        self.move_into_rows(context, (admitted, blocked), [&rest, &brake], q);
        let nearer_than = (admitted != Admitted::All).then_some(&rest);
        let allowed = admitted != Admitted::Stopping
            && (self.allows(context, nearer_than, q) || {
                self.correct(context, q);
                self.allows(context, nearer_than, q)
            });
        let best = q.clone();
        let mut parts = PARTS.into_iter().filter(|_| admitted != Admitted::Stopping);
        let allowed = allowed
            || parts.any(|part| {
                write_within(&brake, &best, part, q);
                self.allows(context, nearer_than, q)
            });
        if !allowed {
            q.copy_from_slice(&brake);
        }
        if admitted == Admitted::All {
            return *q != wanted;
        }
        // An arm that is only settled is held by obstacles if these forbid what the rule proposes, nearer or not.
        let is_held = self.progress.admitted() != Admitted::All;
        let nearer_than = (is_held && self.progress.is_freed_nearer()).then_some(&rest);
        blocked || !self.allows(context, nearer_than, &wanted)
    }

    /// Changes the command `q` to one that holds the pairs and keeps the arm clear and all constraints. Returns whether more than the
    /// pairs changed it; `None` if they cannot be held.
    fn filter_with_pairs(&mut self, context: &StepContext<'_>, settled: bool, q: &mut Point) -> Option<bool> {
        let mut brake = self.stop.next().cloned().unwrap_or_else(|| context.braking());
        context.tick_box.bounds.clip(&mut brake);
        let rest = self.stop.rest().cloned().unwrap_or_else(|| brake.clone());
        let wanted = q.clone();
        let mut blocked = self.set_rows(context, (&rest, self.stop.ticks_to_stop()), &wanted);
        let admitted = self.admitted(settled, &brake);
        self.move_into_rows(context, (admitted, blocked), [&rest, &brake], q);
        let best = q.clone();
        for part in [1.0].into_iter().chain(PARTS).filter(|_| admitted != Admitted::Stopping) {
            write_within(&brake, &best, part, q);
            if !(self.rows.hold(&context.request(Towards::Start), q) && self.finds_stop(context, q)) {
                continue;
            }
            let (stop, dt) = (&self.next_stop, context.dt);
            if admitted == Admitted::Approaching && !stop.rest().is_some_and(|to| is_nearer(context, &rest, to)) {
                continue;
            }
            let end = 1.0 + stop.ticks_to_stop();
            if certifies((&mut self.around, &mut self.kept), (stop, end), dt, &mut self.in_the_way) {
                std::mem::swap(&mut self.stop, &mut self.next_stop);
                return Some(blocked);
            }
            blocked = true;
        }
        if !context.aims.pairs_are_held(context.robot, &brake) {
            return None;
        }
        q.copy_from_slice(&brake);
        self.stop.pass();
        Some(blocked)
    }

    /// Decides which commands are admitted; `brake` is the braking command. An arm that is too near to a body or has to evade
    /// moves in any case.
    fn admitted(&mut self, settled: bool, brake: &[f64]) -> Admitted {
        if self.rows.ask_to_move(brake) || self.around.as_ref().is_some_and(Around::is_too_near) {
            self.progress.restart();
        } else if settled {
            return Admitted::Stopping;
        }
        self.progress.admitted()
    }

    /// Moves the command `q` into the rows: to the nearest command, or to the one after which the arm rests nearest to the
    /// target. Braking by `brake` would end at `rest`.
    fn move_into_rows(
        &mut self,
        context: &StepContext<'_>,
        (admitted, blocked): (Admitted, bool),
        [rest, brake]: [&[f64]; 2],
        q: &mut Point,
    ) {
        match admitted {
            Admitted::All if blocked => self.step_into_rows(context, q),
            Admitted::All | Admitted::Stopping => {}
            Admitted::Approaching => {
                let slope = Response::new(context, rest).slope;
                let resting = Resting { rest, slope: &slope, command: brake };
                self.rows.write_resting(&context.request(Towards::Target), &resting, q);
            }
        }
    }

    /// Finds the stop after the command `q`. The rows of the command do not apply to it.
    fn finds_stop(&mut self, context: &StepContext<'_>, q: &[f64]) -> bool {
        let Self { rows, next_stop, .. } = self;
        let [near, wanted] = [&mut rows.rows, &mut rows.wanted].map(std::mem::take);
        let found = next_stop.find(context, q, rows);
        (rows.rows, rows.wanted) = (near, wanted);
        found
    }

    /// Whether the command `q` and the stop after it are certified clear and, if `rest` is given, end nearer to the target than
    /// `rest`.
    fn allows(&mut self, context: &StepContext<'_>, rest: Option<&Point>, q: &[f64]) -> bool {
        let motion = context.stop_after(q);
        let comes_nearer = |rest: &Point| is_nearer(context, rest, &motion.rest());
        let all = (&mut self.around, &mut self.kept);
        rest.is_none_or(comes_nearer) && certifies(all, (&motion, motion.end_tick()), context.dt, &mut self.in_the_way)
    }

    /// Whether the command `q` and the stop after it are certified.
    pub fn allows_command(&mut self, context: &StepContext<'_>, q: &[f64]) -> bool {
        self.allows(context, None, q)
    }

    /// Corrects the command `q` by the rows at the rest configuration after it.
    fn correct(&mut self, context: &StepContext<'_>, q: &mut Point) {
        let stop = context.stop_after(q);
        let rest = stop.rest();
        self.rows.rows.clear();
        if let Some(around) = &mut self.around {
            around.set_rows_after(context, (&rest, stop.ticks_to_stop()), q, &mut self.rows.rows);
        }
        if let Some(kept) = &mut self.kept {
            kept.add_rows_after(context, &rest, q, &mut self.rows.rows);
        }
        let start = q.clone();
        // Distances are measured by the effect on the tip itself, whatever the task.
        let aims = if context.robot.tip_count() > 1 { context.aims } else { Aims::default() };
        // Evasion is corrected in joint space, because free joints could otherwise leap farther than any certificate allows.
        let gives_way = self.around.as_ref().is_some_and(|around| around.obstacles.fastest() > 0.0);
        let towards = if gives_way { Towards::Joints } else { Towards::Start };
        self.rows.write(&StepRequest { aims, ..context.request(towards) }, &start, q);
    }

    /// Moves `sample`, a configuration that meets a target, to one that also keeps the margin and all constraints, by Gauss-Newton
    /// steps within the rows from `from`. Returns whether it had to.
    pub fn clear_goal(&mut self, context: &StepContext<'_>, from: &[f64], sample: &mut Point) -> bool {
        self.rows.wanted.clear();
        let in_the_way = self.set_goal_rows(sample);
        self.holds_goal = in_the_way.any().then(|| in_the_way.holder());
        if self.holds_goal.is_none() {
            return false;
        }
        let positions = context.positions();
        sample.copy_from_slice(from);
        positions.clip(sample);
        for _ in 0..STEPS {
            self.set_goal_rows(sample);
            let start = sample.clone();
            let ends = start.iter().zip(positions.lower().iter().zip(positions.upper()));
            let near = ends.map(|(q, (lower, upper))| ((q - TRUSTED).max(*lower), (q + TRUSTED).min(*upper)));
            let near = Bounds::from_ranges(near);
            self.rows.write(&StepRequest { ends: near.ends(), ..context.request(Towards::Target) }, &start, sample);
        }
        true
    }

    /// Sets the rows of a goal at `q`. Returns its obstructions.
    fn set_goal_rows(&mut self, q: &[f64]) -> InTheWay {
        let Self { around, kept, rows, .. } = self;
        rows.rows.clear();
        let bodies = around.as_mut().is_some_and(|around| !around.set_goal_rows(q, &mut rows.rows));
        let constraints = kept.as_mut().is_some_and(|kept| !kept.add_goal_rows(q, &mut rows.rows));
        InTheWay { bodies, constraints }
    }

    /// Whether the straight line of the joints between two configurations is certified.
    pub fn certifies_line(&mut self, from: &[f64], to: &[f64]) -> bool {
        self.around.as_mut().is_none_or(|around| around.certifies_line(from, to))
            && self.kept.as_mut().is_none_or(|kept| kept.certifies_line(from, to))
    }

    /// Obstruction that keeps the last goal from its target.
    pub fn holds_goal(&self) -> Option<Holder> {
        self.holds_goal
    }

    /// The constraints.
    pub fn kept(&self) -> Option<&Kept> {
        self.kept.as_deref()
    }

    /// Sets the rows of the command. Returns whether `command` violates a row.
    fn set_rows(&mut self, context: &StepContext<'_>, (rest, stop_ticks): (&[f64], f64), command: &[f64]) -> bool {
        let Self { around, kept, rows, in_the_way, .. } = self;
        rows.rows.clear();
        rows.wanted.clear();
        let bodies = around.as_mut().is_some_and(|around| {
            around.find_near(context, rest);
            around.set_rows(context, (rest, stop_ticks), command, rows)
        });
        let constraints = kept.as_mut().is_some_and(|kept| kept.add_rows(context, rest, command, &mut rows.rows));
        *in_the_way = InTheWay { bodies, constraints };
        in_the_way.any()
    }

    /// Moves `q` to the command that satisfies the rows and disturbs the task least.
    fn step_into_rows(&mut self, context: &StepContext<'_>, q: &mut Point) {
        // Under acceleration limits the proposed command is only on the way to the target. A far target must not compete with
        // the separation of overlapping bodies.
        let at_once = context.limited.is_none() && self.rows.wanted.is_empty();
        let (towards, steps) = if at_once { (Towards::Target, STEPS) } else { (Towards::Start, 1) };
        for _ in 0..steps {
            let start = q.clone();
            self.rows.write(&context.request(towards), &start, q);
        }
    }
}

/// Whether bodies and constraints certify a motion until its end (ticks of `dt`); notes which does not.
fn certifies(
    (around, kept): (&mut Option<Around>, &mut Option<Box<Kept>>),
    (motion, end): (&impl JointMotion, f64),
    dt: f64,
    in_the_way: &mut InTheWay,
) -> bool {
    // Constraints first: they cost less.
    if kept.as_mut().is_some_and(|kept| !kept.certifies(motion, end)) {
        in_the_way.constraints = true;
        return false;
    }
    let is_clear = around.as_mut().is_none_or(|around| around.certifies(motion, end, dt));
    in_the_way.bodies |= !is_clear;
    is_clear
}
