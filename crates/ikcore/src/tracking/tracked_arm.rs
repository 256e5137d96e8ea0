//! State of a tracked arm: its accepted configuration, clock, limits and targets.

use std::sync::Arc;

use super::current_tasks::CurrentTasks;
use super::limited_state::LimitedState;
use super::outside_start::OutsideStart;
use super::repeated_targets::RepeatedTargets;
use super::rule::TickResult;
use super::step_context::StepContext;
use super::target_stream::TargetStream;
use super::track_options::TrackOptions;
use crate::error::Result;
use crate::ik::given_up;
use crate::limits::{AdmittedStart, Field, LimitAt, Limits, StartSlack, TickBox};
use crate::message::Message;
use crate::objective::Point;
use crate::robot::Robot;
use crate::solver::Status;
use crate::task::{Aims, Levels};

/// Speed below which a joint rests (rad/s, m/s).
const REST: f64 = 1e-4;

/// Tracked arm in motion, tick by tick.
#[derive(Debug)]
pub(super) struct TrackedArm {
    pub robot: Arc<Robot>,
    /// The robot as given, without the tool of a task.
    pub given: Robot,
    pub limits: Limits,
    /// Names the joints that limits of zero lock.
    pub lock: Option<Arc<Message>>,
    pub limit_at: LimitAt,
    pub tick_box: TickBox,
    /// State and reachable set under acceleration or jerk limits.
    pub limited: Option<LimitedState>,
    pub tasks: CurrentTasks,
    pub targets: TargetStream,
    pub dt: f64,
    pub ticks: usize,
    pub q: Point,
    /// Joints that began outside their limits, until all are inside.
    pub outside: Option<Box<OutsideStart>>,
    start_slack: StartSlack,
    /// Configuration at the start of the last tick.
    pub before: Point,
    /// Squared error accepted in the previous tick, which a random search must beat.
    pub last_value: Option<f64>,
}

impl TrackedArm {
    /// Arm at rest at `start` (n,) at t = 0, with ticks of `dt` (s), for the call `method`.
    ///
    /// # Errors
    /// Errors of wrong tasks, limits or settings of targets, and of a start outside limits or region.
    pub fn new(method: &Message, robot: &Robot, start: &[f64], dt: f64, options: &TrackOptions) -> Result<Self> {
        let (tasks, limits) = (CurrentTasks::new(robot, options)?, options.limits_for(robot, method)?);
        limits.validate(dt, 0)?;
        let limited = LimitedState::new(&limits, dt);
        let repeated = options.rule.extrapolates(limited.is_some()).then(|| RepeatedTargets::new(dt));
        let targets = TargetStream::new(options.target_filter, options.timeout, repeated)?;
        if tasks.region().is_some() {
            require_room_to_stop(&limits)?;
        }
        robot.check("start_q", start)?;
        let AdmittedStart { q, outside } = limits.admit_start(Some(robot), "start_q", start, &options.start_slack)?;
        let robot_as_given = robot.clone();
        let robot = Arc::new(options.task.map_or(Ok(None), |task| task.robot(robot))?.unwrap_or_else(|| robot.clone()));
        let weights = options.weights_for(&robot, limited.is_some())?;
        let arm = Self {
            given: robot_as_given,
            robot,
            tick_box: TickBox::around(&q, &limits).weighted(weights),
            limited,
            lock: limits.lock().map(Arc::new),
            limits,
            limit_at: options.limit_at,
            tasks,
            targets,
            dt,
            ticks: 0,
            outside: OutsideStart::new(outside),
            start_slack: options.start_slack.clone(),
            q: Point::from_slice(&q),
            before: Point::from_slice(&q),
            last_value: None,
        };
        arm.require_in_region("start_q", &q)?;
        Ok(arm)
    }

    /// Whether all joints rest if they move to `q` in this tick.
    pub fn rests_at(&self, q: &[f64]) -> bool {
        q.iter().zip(&self.q).all(|(to, from)| (to - from).abs() <= REST * self.dt)
    }

    /// Inputs of the next step.
    pub fn context(&self) -> StepContext<'_> {
        StepContext {
            robot: &self.robot,
            q: &self.q,
            aims: self.aims(),
            tick_box: &self.tick_box,
            limits: &self.limits,
            limit_at: self.limit_at,
            limited: self.limited.as_ref(),
            last_value: self.last_value,
            time: self.time(),
            dt: self.dt,
        }
    }

    /// Tasks and targets; empty before the first target.
    pub fn aims(&self) -> Aims<'_> {
        self.tasks.with(self.targets.last())
    }

    /// Whether the robot has one tip.
    pub fn has_one_tip(&self) -> bool {
        self.robot.tip_count() == 1
    }

    /// Time of the accepted configuration (s).
    pub fn time(&self) -> f64 {
        self.ticks as f64 * self.dt
    }

    /// End of the next tick (s).
    pub fn next_time(&self) -> f64 {
        (self.ticks + 1) as f64 * self.dt
    }

    /// Part of the acceleration limits with which the arm brakes.
    pub fn braking_part(&self) -> f64 {
        self.limited.as_ref().map_or(1.0, LimitedState::braking_part)
    }

    /// Sets that part.
    pub fn set_braking_part(&mut self, part: f64) {
        self.limited.iter_mut().for_each(|limited| limited.set_braking_part(part));
    }

    /// Sets the box of the next tick by the limits on position and velocity. Returns whether all joints can be inside.
    pub fn narrow(&mut self) -> bool {
        let tick = [self.time(), self.next_time()];
        self.limits.narrow(&self.q, tick, self.dt, self.limit_at, &mut self.tick_box)
    }

    /// Narrows the box to commands from which the arm can still stop. Returns whether there are any.
    pub fn narrow_to_stop(&mut self) -> bool {
        let time = self.time();
        let Self { limited, limits, q, tick_box, .. } = self;
        limited.as_mut().is_none_or(|limited| limited.narrow(q, time, limits, tick_box))
    }

    /// Widens the box of a tick of an arm that began outside its limits to the command that brakes: obstacles may be in its way inside.
    pub fn allow_braking(&mut self) {
        if self.outside.is_none() {
            return;
        }
        let brake = self.limited.as_ref().map_or_else(|| self.q.clone(), |limited| limited.stopping(&self.q));
        let (lower, upper) = self.tick_box.bounds.parts_mut();
        for (j, brake) in brake.iter().enumerate() {
            (lower[j], upper[j]) = (lower[j].min(*brake), upper[j].max(*brake));
        }
    }

    /// Whether the region keeps the only tip from its target.
    pub fn is_blocked_by_region(&self) -> bool {
        let only = self.aims().only(&self.robot);
        only.is_some_and(|(target, criterion)| criterion.blocked_by_region(target).is_some())
    }

    /// Levels of the targets of several tips, if they have an order.
    pub fn levels(&self) -> Option<Levels> {
        let aims = self.aims();
        aims.has_levels(&self.robot).then(|| Levels::of(&aims))
    }

    /// Status of `found`, beyond the tolerances, if the part of the only target that comes first is met, or the lowest level of several.
    pub fn given_up(&self, found: &TickResult) -> Option<Status> {
        if let Some(levels) = self.levels() {
            return levels.lowest_is_met(&self.robot, &found.q).then_some(Status::LevelGivenUp);
        }
        let (task, target) = self.aims().iter().next().filter(|_| self.has_one_tip())?;
        given_up(task, target, self.robot.dof(), &found.assessment.error)
    }

    /// Assesses the result `found`, with one evaluation.
    pub fn assess(&self, found: &mut TickResult) {
        found.evaluations += 1;
        match self.targets.last() {
            [] => found.position = self.robot.tip_position(&found.q),
            _ => found.assess(&self.robot, &self.aims()),
        }
    }

    /// Ends the tick at `q`.
    pub fn accept(&mut self, q: &[f64], value: f64) {
        if self.outside.is_some() && OutsideStart::has_returned([&self.tick_box.floor, &self.tick_box.ceiling], q) {
            self.outside = None;
        }
        if let Some(limited) = &mut self.limited {
            limited.advance(&self.q, q);
        }
        self.before.copy_from_slice(&self.q);
        self.q.copy_from_slice(q);
        (self.last_value, self.ticks) = (Some(value), self.ticks + 1);
        self.targets.accept();
    }

    /// Restarts at `q` and t = 0, with these velocities (rad/s, m/s) and accelerations (rad/s^2, m/s^2); `None` means at rest.
    ///
    /// # Errors
    /// As for the start of [`new`](Self::new), and for an arm that could not stop inside its limits; the arm is then as before.
    pub fn reset(&mut self, q: &[f64], [qd, qdd]: [Option<&[f64]>; 2]) -> Result<()> {
        self.robot.check("q", q)?;
        let AdmittedStart { q, outside } = self.limits.admit_start(Some(&self.robot), "q", q, &self.start_slack)?;
        let q = &q[..];
        self.require_in_region("q", q)?;
        let zero = Point::from_elem(0.0, q.len());
        let (qd, qdd) = (qd.unwrap_or(&zero), qdd.unwrap_or(&zero));
        self.robot.check("qd", qd)?;
        self.robot.check("qdd", qdd)?;
        if let Some(limited) = &mut self.limited {
            limited.set(q, [qd, qdd], &self.limits)?;
        }
        self.outside = OutsideStart::new(outside);
        self.q.copy_from_slice(q);
        self.before = q.iter().zip(qd).map(|(q, qd)| q - self.dt * qd).collect();
        (self.ticks, self.last_value) = (0, None);
        self.targets.clear();
        Ok(())
    }

    /// Checks that the tip is in the region at `q`; `what` names it in the error.
    fn require_in_region(&self, what: &str, q: &[f64]) -> Result<()> {
        let region = self.tasks.region();
        region.map_or(Ok(()), |region| region.require_inside(what, &self.robot.tip_position(q)))
    }
}

/// Checks that the arm can stop at any time, without which it cannot be kept in a region.
fn require_room_to_stop(limits: &Limits) -> Result<()> {
    let method = "a task with a region";
    let remedy = "an arm that may not stop at once can be carried out of it; leave one of the two out";
    limits.require_none(&[Field::Acceleration, Field::Jerk], method, remedy)?;
    let remedy = "limits that move can push the arm out of it; give numbers, or leave region out";
    [Field::Lower, Field::Upper].into_iter().try_for_each(|field| limits.constants(field, method, remedy).map(|_| ()))
}
