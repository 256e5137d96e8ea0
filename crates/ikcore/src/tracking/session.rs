//! One control loop: the accepted configuration, the clock, the box of the tick and the rule that runs in it.

use std::sync::Arc;

use super::around_arm::ObstacleMotion;
use super::limited_motion::LimitedMotion;
use super::record::Accepted;
use super::repeated_targets::RepeatedTargets;
use super::rule::{RunningRule, Tick, TickResult, TickRule};
use super::safety_filter::{Kept, SafetyFilter};
use super::step::Step;
use super::step_context::StepContext;
use super::target_stream::{Arrival, TargetStream};
use super::tip_tasks::TipTasks;
use super::track_options::TrackOptions;
use crate::error::{Error, Result, require_positive};
use crate::kinematics::ReachShortfall;
use crate::limits::{Field, LimitAt, Limits, TickBox};
use crate::math::vector::between;
use crate::objective::{Bounds, Point, Score};
use crate::obstacle::{ClearSpace, NearestContact, Obstacles, Surroundings};
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{Aims, Assessment, Goals, Region, Target, TipError};

/// Bisections of a tick that would leave the region; they find the admissible fraction to one thousandth.
const BISECTIONS: usize = 10;

/// The context of the next tick of a session; a macro, because a method would borrow the whole session.
macro_rules! context {
    ($session:ident) => {
        StepContext {
            robot: &$session.robot,
            q: &$session.q,
            aims: $session.tasks.with($session.targets.last()),
            tick_box: &$session.tick_box,
            limits: &$session.limits,
            limit_at: $session.limit_at,
            limited: $session.limited.as_ref(),
            last_value: $session.last_value,
            time: $session.ticks as f64 * $session.dt,
            dt: $session.dt,
        }
    };
}

/// A tracker in progress.
#[derive(Debug)]
pub struct Session {
    robot: Arc<Robot>,
    limits: Limits,
    limit_at: LimitAt,
    rule: TickRule,
    running: RunningRule,
    tasks: TipTasks,
    goals: Goals,
    dt: f64,
    ticks: usize,
    q: Point,
    /// Configuration at the start of the last tick.
    before: Point,
    /// The value accepted in the previous tick, which a random search must beat.
    last_value: Option<f64>,
    targets: TargetStream,
    tick_box: TickBox,
    /// Under acceleration or jerk limits.
    limited: Option<LimitedMotion>,
    surroundings: Surroundings,
    /// Where something is to be kept clear of, or pairs of tips may be held.
    safety: Option<Box<SafetyFilter>>,
    /// The arm brakes until a target arrives.
    stopping: bool,
    seed: u64,
    rng: LazyRng,
}

impl Session {
    /// A session at rest at `start` (n,) at t = 0, with ticks of `dt` (s).
    ///
    /// # Errors
    /// Any [`Error`](crate::Error) for wrong input: a start outside its limits, limits that this tracker does not
    /// support, a time step that is not positive.
    pub fn new(robot: &Robot, start: &[f64], dt: f64, options: &TrackOptions) -> Result<Self> {
        let several_tips = robot.tip_count() > 1;
        options.require_tips(robot)?;
        let limits = options.limits_for(robot);
        require_positive("dt", dt)?;
        options.rule.validate()?;
        options.rule.validate_for(robot, dt)?;
        let tasks = TipTasks::new(robot, options)?;
        options.check_goals(robot)?;
        limits.require_for(robot)?;
        limits.validate(dt, 0)?;
        let limited = LimitedMotion::new(&limits, dt);
        let running = options.rule.start(limited.is_some(), several_tips);
        let repeated = running.extrapolates().then(|| RepeatedTargets::new(dt));
        let targets = TargetStream::new(options.target_filter, options.timeout, repeated)?;
        if tasks.region().is_some() {
            require_room_to_stop(&limits)?;
        }
        robot.check("start", start)?;
        let robot = Arc::new(options.task.map_or(Ok(None), |task| task.robot(robot))?.unwrap_or_else(|| robot.clone()));
        require_inside(&robot, &limits, tasks.region(), "start", start)?;
        // If limits vary over time, goals use the joint ranges at the start.
        let ranges = Bounds::from_ranges((0..start.len()).map(|j| limits.position_range(j, 0.0, 0.0).into()));
        let goals = Goals::new(&options.goals, &robot, &ranges);
        let surroundings = options.surroundings.clone();
        let space = clear_space(&surroundings, &robot)?;
        let filters = several_tips || space.is_some();
        let safety = if filters { Some(Box::new(SafetyFilter::new(space, &limits)?)) } else { None };
        Ok(Self {
            safety,
            tasks,
            surroundings,
            robot,
            tick_box: TickBox::around(start, &limits),
            running,
            limited,
            limits,
            limit_at: options.limit_at,
            rule: options.rule.clone(),
            goals,
            dt,
            ticks: 0,
            q: Point::from_slice(start),
            before: Point::from_slice(start),
            last_value: None,
            targets,
            stopping: false,
            seed: options.seed,
            rng: rng::stream(options.seed, 0),
        })
    }

    /// The accepted configuration (n,).
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// The velocity of the last tick (n,) (rad/s, m/s); zero before the first.
    pub fn qd(&self) -> Point {
        self.q.iter().zip(&self.before).map(|(q, before)| (q - before) / self.dt).collect()
    }

    /// Time of the accepted configuration (s).
    pub fn time(&self) -> f64 {
        self.ticks as f64 * self.dt
    }

    /// The limits in force.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The time step (s).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// The velocity limits of the last tick (n,) (rad/s, m/s).
    pub fn velocity_limit(&self) -> &[f64] {
        &self.tick_box.velocity
    }

    /// Tasks and targets; empty before the first target.
    fn aims(&self) -> Aims<'_> {
        self.tasks.with(self.targets.last())
    }

    /// Errors of each target of several tips, once these have arrived.
    pub fn tip_errors(&self) -> Vec<TipError> {
        if self.has_one_tip() { vec![] } else { self.aims().errors(&self.robot, &self.q).to_vec() }
    }

    /// Positions (m) of the tips that have targets, in the order of these; of pairs as seen from the first tip.
    pub(super) fn tip_positions(&self) -> Vec<[f64; 3]> {
        let mut positions = vec![];
        self.aims().positions(&self.robot, &self.q, |position| positions.push(position));
        positions
    }

    fn has_one_tip(&self) -> bool {
        self.robot.tip_count() == 1
    }

    /// Returns how far the targets of `arrival` are provably out of reach within `bounds`.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub(super) fn reach_shortfall(&mut self, arrival: Arrival, bounds: &Bounds) -> Result<Option<ReachShortfall>> {
        let targets = &self.read(arrival)?.targets;
        Ok(Problem::new(&self.robot, self.tasks.with(targets)).reach_shortfall(bounds))
    }

    /// Configuration and box of the last tick.
    pub(super) fn accepted(&self) -> Accepted<'_> {
        let nearest = self.space().map(|space| space.nearest(&self.q));
        let distance =
            |nearest: Option<NearestContact>| nearest.map_or(f64::INFINITY, |nearest| nearest.contact.distance);
        Accepted { q: &self.q, tick_box: &self.tick_box, clearance: nearest.map_or(f64::NAN, distance) }
    }

    /// The tracked robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Evaluates the start without moving; its error to the targets is the value that the first tick must beat.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn begin(&mut self, arrival: Arrival) -> Result<Step> {
        let arrival = self.read(arrival)?;
        self.targets.place(arrival);
        Ok(self.beginning())
    }

    /// The start as a step.
    fn beginning(&mut self) -> Step {
        let Assessment { score, error } = self.aims().assess(&self.robot, &self.q);
        self.last_value = Some(score.value);
        let status = match score.solved {
            true if self.is_blocked_by_region() => Status::HeldInRegion,
            true => Status::Solved,
            false => Status::Improved,
        };
        let status = if self.is_clear(&self.q) { status } else { Status::InCollision };
        let (position, error) = (self.robot.tip_position(&self.q), error.into());
        Step { status, error, position, evaluations: 1, iterations: 0, inside_limits: true, interrupted: false }
    }

    /// Whether the region keeps the only tip from its target.
    fn is_blocked_by_region(&self) -> bool {
        let only = self.aims().only(&self.robot);
        only.is_some_and(|(target, criterion)| criterion.blocked_by_region(target).is_some())
    }

    /// Moves by one tick towards `target` of the only tip, inside the limits. Time advances whether or not the target is reached.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) for a target that is not finite,
    /// [`Error::WrongTarget`](crate::Error::WrongTarget) if the target lacks a component that the task needs. The session
    /// has not moved then.
    pub fn step(&mut self, target: &Target, monitor: &mut dyn Monitor) -> Result<Step> {
        self.advance(Some(Arrival::from(*target)), monitor)
    }

    /// Moves by one tick, with the targets that have arrived since the last tick, if any; tips without one are free. Without a new target
    /// the arm follows the extrapolated motion of the last ones for a short time, under acceleration or jerk limits and with the
    /// model-based rule; otherwise it goes on towards the last target. After the timeout it brakes. Pairs of tips that are where they are
    /// to be are held there, before anything else.
    ///
    /// # Errors
    /// As [`step`](Self::step), [`Error::OutOfRange`](crate::Error::OutOfRange) for a stamp after the end of the tick,
    /// [`Error::Contradiction`](crate::Error::Contradiction) for a stamp that the rule cannot use or for targets that contradict each
    /// other.
    pub fn advance(&mut self, arrival: Option<Arrival>, monitor: &mut dyn Monitor) -> Result<Step> {
        let arrival = arrival.map(|arrival| self.read(arrival)).transpose()?;
        let (from, to) = (self.time(), (self.ticks + 1) as f64 * self.dt);
        let sampled_ago = self.targets.take(arrival, to)?.map(|ago| ago / self.dt);
        self.update_stopping(sampled_ago.is_some(), to);
        let within = self.limits.narrow(&self.q, [from, to], self.dt, self.limit_at, &mut self.tick_box);
        let (q, tick_box) = (&self.q, &mut self.tick_box);
        let can_stop = self.limited.as_mut().is_none_or(|limited| limited.narrow(q, from, &self.limits, tick_box));
        let mut found = if self.stopping || self.targets.last().is_empty() {
            self.brake()
        } else {
            self.run_rule(sampled_ago, monitor)
        };
        let held = !found.interrupted && !self.stopping && self.keep(&mut found);
        self.keep_in_region(&mut found);
        let status = self.status(&found, held);
        if !found.interrupted {
            self.accept(&found.q, found.assessment.score.value);
        }
        let TickResult { position, evaluations, iterations, interrupted, .. } = found;
        let (error, inside_limits) = (found.assessment.error.into(), within && can_stop);
        Ok(Step { status, error, position, evaluations, iterations, inside_limits, interrupted })
    }

    /// Checks an arrival, and reduces its targets to the parts that their tasks use. Other tasks than before begin anew.
    fn read(&mut self, arrival: Arrival) -> Result<Arrival> {
        let Arrival { tips, mut targets, velocity, stamp } = arrival;
        self.check_stamp(stamp)?;
        if self.tasks.read(&self.robot, &tips, &mut targets)? {
            self.targets.begin_anew();
            self.running.forget();
            self.last_value = None;
        }
        Ok(Arrival { tips: vec![], targets, velocity, stamp })
    }

    /// Err for a stamp that the rule cannot use.
    fn check_stamp(&self, stamp: Option<f64>) -> Result<()> {
        if stamp.is_some() && !self.running.extrapolates() {
            let problem = "a stamp is used by the library's own rule under acceleration or jerk limits; give such limits, or \
                           leave stamp out";
            return Err(Error::Contradiction { problem: problem.into() });
        }
        Ok(())
    }

    /// The arm brakes after the timeout, and moves on when a target arrives.
    fn update_stopping(&mut self, arrived: bool, time: f64) {
        if arrived {
            self.stopping = false;
        } else if self.targets.timed_out(time) && !self.stopping {
            self.begin_stopping();
        }
    }

    fn begin_stopping(&mut self) {
        self.stopping = true;
        self.running.forget();
        self.targets.expect_new();
    }

    fn run_rule(&mut self, sampled_ago: Option<f64>, monitor: &mut dyn Monitor) -> TickResult {
        let (context, targets) = (context!(self), &self.targets);
        let Some((task, target)) = context.aims.iter().next() else { return TickResult::at(&self.q) };
        let (criterion, goals, rng) = (&task.criterion, &mut self.goals, &mut self.rng);
        let tick = Tick { context, target, criterion, goals, targets, sampled_ago, rng, monitor };
        self.running.advance(tick, self.safety.as_deref_mut())
    }

    /// Moves by one tick of the stop that was certified with the last command.
    fn brake(&mut self) -> TickResult {
        let mut found = TickResult::at(&self.q);
        let held = self.safety.as_mut().filter(|_| self.stopping).and_then(|safety| safety.stop_on(self.dt));
        let fastest = || self.limited.as_ref().map(|limited| limited.stopping(&self.q));
        if let Some(next) = held.or_else(fastest) {
            found.q = next;
        }
        self.tick_box.bounds.clip(&mut found.q);
        self.assess(&mut found);
        found
    }

    /// Assesses what has been found, with one evaluation.
    fn assess(&self, found: &mut TickResult) {
        found.evaluations += 1;
        match self.targets.last() {
            [] => found.position = self.robot.tip_position(&found.q),
            _ => found.assess(&self.robot, &self.aims()),
        }
    }

    fn status(&self, found: &TickResult, held: bool) -> Status {
        let Score { value, solved } = found.assessment.score;
        match self.last_value {
            _ if !self.is_clear(&found.q) => Status::InCollision,
            _ if solved && self.is_blocked_by_region() => Status::HeldInRegion,
            _ if solved => Status::Solved,
            _ if held || self.goal_is_held() => Status::HeldByObstacle,
            Some(last) if value >= last => Status::Capped,
            _ => Status::Improved,
        }
    }

    /// Whether obstacles keep the goal of an arm that does not stop from its target.
    fn goal_is_held(&self) -> bool {
        !self.stopping && self.safety.as_ref().is_some_and(|safety| safety.goal_is_held())
    }

    /// Changes what the rule has `found` to a command that keeps the arm clear and pairs of tips held. Returns whether it had to, because
    /// of what is around the arm.
    fn keep(&mut self, found: &mut TickResult) -> bool {
        let Some(safety) = &mut self.safety else { return false };
        let Kept { changed, by_obstacles } = safety.keep(&context!(self), &mut found.q);
        if changed {
            self.assess(found);
            if self.limited.is_none() {
                self.running.forget();
            }
        }
        by_obstacles
    }

    /// Whether everything keeps the margin at `q`; true if nothing is to be kept clear of.
    fn is_clear(&self, q: &[f64]) -> bool {
        self.space().is_none_or(|space| space.holds(q))
    }

    /// What the arm keeps clear of, if anything.
    pub fn space(&self) -> Option<&Arc<ClearSpace<'static>>> {
        self.safety.as_ref().and_then(|safety| safety.space())
    }

    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub fn obstacle_velocities(&self) -> &[[f64; 3]] {
        self.safety.as_ref().map_or(&[], |safety| safety.velocities())
    }

    /// What is around the arm.
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// Replaces the obstacles by these, where they are now, with their `velocities` (m/s); empty: all are at rest. `None`: none.
    /// The margin and the choice about the robot's own links stay.
    ///
    /// # Errors
    /// As [`new`](Self::new); the session is then as before.
    pub fn set_obstacles(&mut self, obstacles: Option<Obstacles>, velocities: Vec<[f64; 3]>) -> Result<()> {
        let motion = ObstacleMotion::new(velocities, obstacles.as_ref().map_or(0, |all| all.len()))?;
        let surroundings = Surroundings { obstacles, ..self.surroundings.clone() };
        // A margin given before is kept for obstacles that may come later.
        let space = if surroundings.is_given() { clear_space(&surroundings, &self.robot)? } else { None };
        if space.is_some() || !self.has_one_tip() {
            let safety = match self.safety.take() {
                Some(safety) => self.safety.insert(safety),
                None => self.safety.insert(Box::new(SafetyFilter::new(None, &self.limits)?)),
            };
            safety.replace(space, motion, &self.limits)?;
        } else {
            self.safety = None;
        }
        self.surroundings = surroundings;
        Ok(())
    }

    fn accept(&mut self, q: &[f64], value: f64) {
        if let Some(limited) = &mut self.limited {
            limited.advance(&self.q, q);
        }
        self.before.copy_from_slice(&self.q);
        self.q.copy_from_slice(q);
        (self.last_value, self.ticks) = (Some(value), self.ticks + 1);
        self.targets.accept();
    }

    /// Stops as fast as the limits allow, from the next tick on until a target arrives; pairs of tips that are held stay held. Nothing
    /// else is wished: the arm does not give way to what comes near, and stands afterwards. Returns how long the stop takes (s): 0 for
    /// an arm that may stop at once.
    pub fn stop(&mut self) -> f64 {
        self.begin_stopping();
        let held = self.safety.as_ref().and_then(|safety| safety.ticks_to_stop());
        let fastest = || self.limited.as_ref().map_or(0.0, LimitedMotion::time_to_stop);
        held.map_or_else(fastest, |ticks| self.dt * ticks)
    }

    /// Moves by one tick to `q`, which the caller has found inside the limits, instead of asking the rule. The rule starts
    /// anew from there.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub(super) fn drive(&mut self, q: &[f64], arrival: Arrival) -> Result<Step> {
        let arrival = self.read(arrival)?;
        let (from, to) = (self.time(), (self.ticks + 1) as f64 * self.dt);
        let inside_limits = self.limits.narrow(&self.q, [from, to], self.dt, self.limit_at, &mut self.tick_box);
        self.targets.place(arrival);
        let Assessment { score, error } = Problem::new(&self.robot, self.aims()).assess(q);
        let status = match self.last_value {
            _ if score.solved => Status::Solved,
            Some(last) if score.value >= last => Status::Capped,
            _ => Status::Improved,
        };
        self.accept(q, score.value);
        self.start_rule();
        let (position, error) = (self.robot.tip_position(q), error.into());
        Ok(Step { status, error, position, evaluations: 1, iterations: 0, inside_limits, interrupted: false })
    }

    /// Shortens a tick that would take the tip out of its region. The tick starts inside the region and the box is
    /// convex, so any fraction of the tick ends in the box.
    fn keep_in_region(&mut self, found: &mut TickResult) {
        let Some(region) = self.tasks.region().filter(|region| !region.contains(&found.position)) else { return };
        let (mut kept, mut past) = (0.0, 1.0);
        let end = found.q.clone();
        for _ in 0..BISECTIONS {
            let share = 0.5 * (kept + past);
            between(&self.q, &end, share, &mut found.q);
            let inside = region.contains(&self.robot.tip_position(&found.q));
            (kept, past) = if inside { (share, past) } else { (kept, share) };
        }
        between(&self.q, &end, kept, &mut found.q);
        found.assess(&self.robot, &self.aims());
        found.evaluations += BISECTIONS + 1;
        self.running.forget();
    }

    /// The rule starts anew.
    fn start_rule(&mut self) {
        self.running = self.rule.start(self.limited.is_some(), !self.has_one_tip());
    }

    /// Resets the session to `q` (n,) at t = 0, at rest.
    ///
    /// # Errors
    /// As [`new`](Self::new) for a start.
    pub fn reset(&mut self, q: &[f64]) -> Result<()> {
        self.reset_moving(q, None, None)
    }

    /// Resets the session to `q` (n,) at t = 0, with velocities `qd` (n,) (rad/s, m/s) and accelerations `qdd` (n,) (rad/s^2,
    /// m/s^2); `None` means zero. Both are those of the last tick: differences of its commands.
    ///
    /// # Errors
    /// As [`new`](Self::new) for a start; [`Error::Contradiction`](crate::Error::Contradiction) for an arm that could not
    /// stop inside its limits.
    pub fn reset_moving(&mut self, q: &[f64], qd: Option<&[f64]>, qdd: Option<&[f64]>) -> Result<()> {
        self.robot.check("q", q)?;
        require_inside(&self.robot, &self.limits, self.tasks.region(), "q", q)?;
        let zero = Point::from_elem(0.0, q.len());
        let (qd, qdd) = (qd.unwrap_or(&zero), qdd.unwrap_or(&zero));
        self.robot.check("qd", qd)?;
        self.robot.check("qdd", qdd)?;
        if let Some(limited) = &mut self.limited {
            limited.set(q, [qd, qdd], &self.limits)?;
        }
        self.q.copy_from_slice(q);
        self.before = q.iter().zip(qd).map(|(q, qd)| q - self.dt * qd).collect();
        (self.ticks, self.last_value, self.stopping) = (0, None, false);
        self.start_rule();
        self.targets.clear();
        if let Some(safety) = &mut self.safety {
            safety.forget();
        }
        self.rng = rng::stream(self.seed, 0);
        Ok(())
    }
}

/// The space to stay in, if anything is to be kept clear of.
fn clear_space(surroundings: &Surroundings, robot: &Arc<Robot>) -> Result<Option<ClearSpace<'static>>> {
    Ok(surroundings.clear_space(robot)?.map(|space| space.with_shared(robot)))
}

/// Checks that `q` is within the position limits and that its tip is in the region; `what` names it in the error.
fn require_inside(robot: &Robot, limits: &Limits, region: Option<&Region>, what: &str, q: &[f64]) -> Result<()> {
    limits.require_inside(what, 0.0, q)?;
    region.map_or(Ok(()), |region| region.require_inside(what, &robot.tip_position(q)))
}

/// Checks that the arm can stop at any time, without which it cannot be kept in a region.
fn require_room_to_stop(limits: &Limits) -> Result<()> {
    let method = "a task with a region";
    let remedy = "an arm that may not stop at once can be carried out of it; leave one of the two out";
    limits.require_none(&[Field::Acceleration, Field::Jerk], method, remedy)?;
    let remedy = "limits that move can push the arm out of it; give numbers, or leave region out";
    [Field::Lower, Field::Upper].into_iter().try_for_each(|field| limits.constants(field, method, remedy).map(|_| ()))
}
