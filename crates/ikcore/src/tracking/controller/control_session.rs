//! Control session of a model-free controller, for an arm that the caller moves: clock, limits, and the alternation of commands
//! and measurements.

use super::control_tick::{ControlTick, RunningController, TickProgress};
use super::controller_choice::Controller;
use crate::error::{Error, Result, require_finite, require_positive};
use crate::limits::{AdmittedStart, Field, JointOutside, LimitAt, Limits, StartSlack, TickBox, TipField};
use crate::math::MAX_DOF;
use crate::objective::Point;
use crate::rng::{self, LazyRng};
use crate::solver::Status;
use crate::task::Tolerance;
use crate::tracking::record::Accepted;
use crate::tracking::step::Step;
use crate::tracking::tip_pose::TipPose;

/// Advice about limits that need a model of the arm.
const NO_MODEL: &str = "follow the path with a robot, because a controller knows nothing of the arm";

/// Control session of a model-free controller. [`command`](Self::command) returns the next command for the arm,
/// [`observe`](Self::observe) takes the position measured there. A tick ends when the controller needs no further measurement.
///
/// The first command is the start itself: it only measures the tip there, and time does not advance.
#[derive(Debug)]
pub struct ControlSession {
    running: Box<dyn RunningController>,
    limits: Limits,
    start_outside: Vec<JointOutside>,
    tolerance: Tolerance,
    dt: f64,
    ticks: usize,
    /// Configuration accepted at the start of the tick: the centre of its box.
    q: Point,
    /// Configuration accepted at the start of the previous tick.
    before: Point,
    tick_box: TickBox,
    inside_limits: bool,
    stage: Stage,
    /// Target of the last command. The first target decides whether all are positions or poses.
    target: TipPose,
    /// Error at the end of the previous tick: the length of the residual (m, rad).
    last_error: f64,
    /// Measurements since the tick began.
    measurements: usize,
    rng: LazyRng,
}

/// Stage of a tick: whether a command or a measurement comes next.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    /// Before the first measurement.
    Start,
    /// At the start of a tick.
    Ready,
    /// Within a tick.
    Within,
    /// Between a command and its measurement.
    Sent { first: bool },
}

impl ControlSession {
    /// A session at rest at `start` (n,) at t = 0, with ticks of `dt` (s). `tolerance` is the error band.
    ///
    /// # Errors
    /// Any [`Error`] for wrong input: options, a start outside its limits, limits that no controller supports.
    pub fn new(
        controller: &Controller,
        start: &[f64],
        dt: f64,
        limits: Limits,
        tolerance: Tolerance,
        seed: u64,
    ) -> Result<Self> {
        Self::begun_by("session", controller, start, dt, limits, (tolerance, seed))
    }

    /// [`new`](Self::new) for the call `method`, which messages name.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(in crate::tracking) fn begun_by(
        method: &str,
        controller: &Controller,
        start: &[f64],
        dt: f64,
        limits: Limits,
        (tolerance, seed): (Tolerance, u64),
    ) -> Result<Self> {
        require_positive("dt", dt)?;
        require_positive("position_tolerance", tolerance.position)?;
        require_positive("rotation_tolerance", tolerance.rotation)?;
        if start.is_empty() || start.len() > MAX_DOF {
            let expected = format!("1 to {MAX_DOF} joints");
            return Err(Error::WrongLength { what: "start_q".into(), expected, got: start.len() });
        }
        require_finite("start_q", start, |j| format!("joint {j}"))?;
        controller.validate(start.len())?;
        limits.validate(dt, 0)?;
        let remedy = "a controller keeps position and velocity limits; leave it out";
        limits.require_none(&[Field::Acceleration, Field::Jerk], method, remedy)?;
        limits.refuse_tips(&TipField::ALL, method, NO_MODEL)?;
        limits.refuse_torque(method, NO_MODEL)?;
        let AdmittedStart { q, outside } = limits.admit_start(None, "start_q", start, &StartSlack::default())?;
        let start = &q[..];
        Ok(Self {
            running: controller.start(start, dt, tolerance),
            tick_box: TickBox::around(start, &limits),
            limits,
            start_outside: outside,
            tolerance,
            dt,
            ticks: 0,
            q: start.into(),
            before: start.into(),
            inside_limits: true,
            stage: Stage::Start,
            target: TipPose::UNKNOWN,
            last_error: f64::INFINITY,
            measurements: 0,
            rng: rng::stream(seed, 0),
        })
    }

    /// Accepted configuration (n,).
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// Velocity of the last tick (n,) (rad/s, m/s).
    pub fn qd(&self) -> Point {
        self.q.iter().zip(&self.before).map(|(q, before)| (q - before) / self.dt).collect()
    }

    /// Time of the accepted configuration (s).
    pub fn time(&self) -> f64 {
        self.ticks as f64 * self.dt
    }

    /// Time step (s).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Joints that began outside their position limits.
    pub fn start_outside(&self) -> &[JointOutside] {
        &self.start_outside
    }

    /// Limits in force.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Velocity limits of the last tick (n,) (rad/s, m/s).
    pub fn velocity_limit(&self) -> &[f64] {
        &self.tick_box.velocity
    }

    /// Command (n,) at which the position of the last tick was measured.
    pub fn measured_command(&self) -> &[f64] {
        self.running.measured().0
    }

    /// Returns the next command (n,) towards `target`, a position (m) or a pose, at the end of the tick. The command is within
    /// the limits, and within the range that the velocity limits allow from the configuration accepted at the start of the
    /// tick.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for the target, [`Error::Contradiction`] for a pose after positions or a position after poses,
    /// [`Error::OutOfTurn`] if a measurement is due.
    pub fn command(&mut self, target: &TipPose) -> Result<&[f64]> {
        target.require_finite("target")?;
        let first = match self.stage {
            Stage::Sent { .. } => {
                let remedy = "the last command is not answered yet; call observe(position) first".into();
                return Err(Error::OutOfTurn { call: "command".into(), remedy });
            }
            Stage::Start => true,
            _ if target.is_oriented() != self.target.is_oriented() => {
                let problem = format!("target: expected {}, as before, got {}", self.target.kind(), target.kind());
                return Err(Error::Contradiction { problem: problem.into() });
            }
            Stage::Ready => {
                let ends = [self.time(), (self.ticks + 1) as f64 * self.dt];
                self.inside_limits = self.limits.narrow(&self.q, ends, self.dt, LimitAt::Interval, &mut self.tick_box);
                false
            }
            Stage::Within => false,
        };
        self.target.clone_from(target);
        if !first {
            let tick = ControlTick { target: &self.target, bounds: &self.tick_box.bounds };
            self.running.choose_command(tick, &mut self.rng);
        }
        self.stage = Stage::Sent { first };
        Ok(self.running.sent())
    }

    /// Takes the position (m) or the pose measured at the last command. Returns the result of the tick, or `None` if the
    /// tick continues. If the target is a position, the orientation of a pose is ignored.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for the measurement, [`Error::Contradiction`] for a position if the target is a pose,
    /// [`Error::OutOfTurn`] if no measurement is due.
    pub fn observe(&mut self, tip: &TipPose) -> Result<Option<Step>> {
        let Stage::Sent { first } = self.stage else {
            let remedy = "there is no command to answer; call command(target) first".into();
            return Err(Error::OutOfTurn { call: "observe".into(), remedy });
        };
        tip.require_finite("position")?;
        let Some(tip) = tip.as_asked_by(&self.target) else {
            let problem = "position: expected a pose (4, 4), like the target, got a position (3,)".into();
            return Err(Error::Contradiction { problem });
        };
        self.measurements += 1;
        if first {
            self.running.begin(&self.target, &tip);
        } else {
            let tick = ControlTick { target: &self.target, bounds: &self.tick_box.bounds };
            if self.running.observe(tick, &tip) == TickProgress::GoOn {
                self.stage = Stage::Within;
                return Ok(None);
            }
            self.before.copy_from_slice(&self.q);
            self.q.copy_from_slice(self.running.accepted());
            self.ticks += 1;
        }
        Ok(Some(self.end_tick()))
    }

    #[inline]
    fn end_tick(&mut self) -> Step {
        let tip = self.running.measured().1;
        let (error, distance, position) = (tip.error(&self.target), tip.distance(&self.target), tip.position());
        let status = match distance {
            _ if error.within(&self.tolerance) => Status::Solved,
            distance if distance < self.last_error => Status::Improved,
            _ => Status::Capped,
        };
        let evaluations = std::mem::take(&mut self.measurements);
        (self.stage, self.last_error) = (Stage::Ready, distance);
        Step {
            status,
            error,
            position: *position,
            evaluations,
            iterations: evaluations,
            inside_limits: self.inside_limits,
            away: None,
            idle: None,
            interrupted: false,
        }
    }

    /// Configuration and box of the last tick.
    pub(in crate::tracking) fn accepted(&self) -> Accepted<'_> {
        Accepted { q: &self.q, tick_box: &self.tick_box, clearance: f64::NAN, measured: None }
    }

    /// Returns the largest excess (rad, m) of the last command over a limit, its joint and the joint's command; `None` without
    /// excess. The box of the tick is within the limits, unless the limits cannot be kept.
    pub(in crate::tracking) fn excess(&self) -> Option<(f64, usize, f64)> {
        let TickBox { bounds, velocity, floor, ceiling, .. } = &self.tick_box;
        let sent = self.running.sent();
        if self.inside_limits && bounds.contains(sent) {
            return None;
        }
        let excesses = sent.iter().zip(&self.q).enumerate().map(|(j, (sent, q))| {
            let too_far = (sent - q).abs() - velocity[j] * self.dt;
            // A joint that began outside is led inside.
            let led = if self.start_outside.is_empty() { None } else { Some(*q) };
            let (floor, ceiling) =
                (led.map_or(floor[j], |q| floor[j].min(q)), led.map_or(ceiling[j], |q| ceiling[j].max(q)));
            (too_far.max(floor - sent).max(sent - ceiling), j, *sent)
        });
        excesses.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}
