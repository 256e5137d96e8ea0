//! Control loop: an arm, the rule that proposes its commands, and the safety filter that decides on them.
//!
//! | file | what |
//! |---|---|
//! | `tick_command` | the command of a tick, and its status |
//! | `session_changes` | changes between ticks |
//! | `session_reads` | what can be read between ticks |

mod session_changes;
mod session_reads;
mod tick_command;

use std::sync::Arc;

use super::away::Way;
use super::idle::Idle;
use super::kept::Kept;
use super::rule::{RunningRule, TickResult, TickRule};
use super::safety_filter::SafetyFilter;
use super::settling::Settling;
use super::step::Step;
use super::target_stream::{Arrival, IgnoredTargets, Taken};
use super::tip_pace::TipPace;
use super::torque_pace::{OtherLimits, TorquePace};
use super::track_options::TrackOptions;
use super::tracked_arm::TrackedArm;
use super::way_back::{EndOfTick, Next, OpenLines, WayBack};
use crate::constraint::{Keep, refuse_broken};
use crate::error::{Error, Result, require_positive};
use crate::kinematics::ReachShortfall;
use crate::message::{Message, Setting};
use crate::objective::Bounds;
use crate::obstacle::Surroundings;
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{Assessment, CheckedTask, Goals, Target};

/// Tracking session of one arm.
#[derive(Debug)]
pub struct Session {
    arm: TrackedArm,
    rule: TickRule,
    running: RunningRule,
    goals: Goals,
    surroundings: Surroundings,
    /// Safety filter, present if collisions are to be avoided, something is to be kept or pairs of tips may be held.
    safety: Option<Box<SafetyFilter>>,
    /// Limits of tips.
    pace: Option<Box<TipPace>>,
    /// Torque limits.
    torques: Option<Box<TorquePace>>,
    /// Way back of an arm that comes no nearer to its target; `None` for other rules, and tasks with a region.
    way_back: Option<Box<WayBack>>,
    /// Rest of an arm that comes no nearer; `None` where there is no way back.
    settling: Option<Settling>,
    /// Why the arm brakes until a target arrives, if it does.
    stopping: Option<Idle>,
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
        Self::begun_by(&Setting::Session.into(), robot, start, dt, options)
    }

    /// [`new`](Self::new) for the call `method`, which messages name.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(super) fn begun_by(
        method: &Message,
        robot: &Robot,
        start: &[f64],
        dt: f64,
        options: &TrackOptions,
    ) -> Result<Self> {
        options.require_tips(robot)?;
        require_positive("dt", dt)?;
        options.rule.validate()?;
        options.rule.validate_for(robot, dt)?;
        options.check_goals(robot)?;
        let mut arm = TrackedArm::new(method, robot, start, dt, options)?;
        // If limits vary over time, goals use the joint ranges at the start.
        let ranges = Bounds::from_ranges((0..start.len()).map(|j| arm.limits.position_range(j, 0.0, 0.0).into()));
        let goals = Goals::new(&options.goals, &arm.robot, &ranges);
        let surroundings = options.surroundings.clone();
        let space = surroundings.clear_space(&arm.robot)?;
        let kept = kept_by(&options.keeps, robot, &arm)?;
        let filters = !arm.has_one_tip() || space.is_some() || kept.is_some();
        let safety = if filters { Some(Box::new(SafetyFilter::new(space, kept, &arm.limits)?)) } else { None };
        let pace = TipPace::new(method, robot, &arm.limits)?;
        let mut torques = TorquePace::new(method, robot, &arm.limits)?;
        if let Some(torques) = &mut torques {
            torques.require_held("start_q", &arm.q, robot)?;
            arm.set_braking_part(1.0); // prepares the limits of milder stops
        }
        let running = options.rule.start(arm.limited.is_some(), !arm.has_one_tip());
        let (rule, seed, rng) = (options.rule.clone(), options.seed, rng::stream(options.seed, 0).prepared());
        let way_back = (rule.is_own() && arm.tasks.region().is_none()).then(|| {
            arm.robot.solves_at_once(); // prepares the closed form
            Box::new(WayBack::new(&arm.limits, options.recover))
        });
        let settling = way_back.is_some().then(|| Settling::new(&arm.limits));
        let stopping = None;
        Ok(Self {
            arm,
            rule,
            running,
            goals,
            surroundings,
            safety,
            pace,
            torques,
            way_back,
            settling,
            stopping,
            seed,
            rng,
        })
    }

    /// Distance by which the targets of `arrival` are provably out of reach within `bounds`.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub(super) fn reach_shortfall(&mut self, mut arrival: Arrival, bounds: &Bounds) -> Result<Option<ReachShortfall>> {
        self.read(&mut arrival)?;
        let TrackedArm { robot, tasks, .. } = &self.arm;
        Ok(Problem::new(robot, tasks.with(&arrival.targets)).reach_shortfall(bounds))
    }

    /// Evaluates the start without moving; its error to the targets is the value that the first tick must beat.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn begin(&mut self, mut arrival: Arrival) -> Result<Step> {
        self.read(&mut arrival)?;
        self.arm.targets.place(arrival);
        Ok(self.beginning())
    }

    /// Assesses the start as a step.
    fn beginning(&mut self) -> Step {
        let Assessment { score, error } = self.arm.aims().assess(&self.arm.robot, &self.arm.q);
        self.arm.last_value = Some(score.value);
        let status = match score.solved {
            true if self.arm.is_blocked_by_region() => Status::HeldInRegion,
            true => Status::Solved,
            false => Status::Improved,
        };
        let status = if self.is_clear(&self.arm.q) { status } else { Status::InCollision };
        let (position, error) = (self.arm.robot.tip_position(&self.arm.q), error.into());
        let (evaluations, iterations) = (1, 0);
        Step {
            status,
            error,
            position,
            evaluations,
            iterations,
            inside_limits: true,
            away: None,
            idle: None,
            interrupted: false,
        }
    }

    /// Moves by one tick towards `target` of the only tip, inside the limits. Time advances whether or not the target is
    /// reached.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) for a target that is not finite,
    /// [`Error::WrongTarget`](crate::Error::WrongTarget) if the target lacks a component that the task needs. The session
    /// has not moved then.
    pub fn step(&mut self, target: &Target, monitor: &mut dyn Monitor) -> Result<Step> {
        self.advance(Some(Arrival::from(*target)), monitor)
    }

    /// Moves by one tick, with the targets that have arrived since the last tick, if any; tips without a target are free.
    /// Without a new target, the model-based rule under acceleration or jerk limits follows the extrapolated motion of the last
    /// targets for a short time; other rules go on towards the last targets. After the timeout the arm brakes. Pairs of tips at
    /// their relative pose are held there, with priority over all other targets.
    ///
    /// # Errors
    /// As [`step`](Self::step), [`Error::OutOfRange`](crate::Error::OutOfRange) for a stamp after the end of the tick,
    /// [`Error::Contradiction`](crate::Error::Contradiction) for a stamp that the rule cannot use or for targets that contradict each
    /// other.
    pub fn advance(&mut self, mut arrival: Option<Arrival>, monitor: &mut dyn Monitor) -> Result<Step> {
        let to = self.arm.next_time();
        if let Some(arrival) = &mut arrival {
            arrival.check(to)?;
            self.read(arrival)?;
        }
        let (sampled_ago, ignored) = match self.arm.targets.take(arrival, to) {
            Taken::Nothing => (None, None),
            Taken::New(ago) => (Some(ago / self.arm.dt), None),
            Taken::Ignored(ignored) => (None, Some(ignored)),
        };
        self.update_stopping(sampled_ago.is_some(), to);
        let (within, can_stop) = (self.arm.narrow(), self.arm.narrow_to_stop());
        let settled = self.is_settled();
        let mut found = if self.idle().is_some() {
            self.arm.allow_braking();
            self.brake()
        } else {
            // The rule leads a joint that is outside its limits inside; the filter may hold it where it is.
            let found = self.run_rule(sampled_ago, monitor);
            self.arm.allow_braking();
            found
        };
        let held = if found.interrupted || self.stopping.is_some() { None } else { self.filter(settled, &mut found) };
        self.keep_pace(&mut found);
        self.keep_torques(settled, &mut found);
        self.keep_in_region(&mut found);
        let status = self.status(&found, held);
        if !found.interrupted {
            self.watch_for_rest(&found, status);
            self.arm.accept(&found.q, found.assessment.score.value);
            self.look_for_way_back(&mut found, monitor);
        }
        let away = self.way_back.as_ref().and_then(|way_back| way_back.away());
        let status = if status == Status::Improved && away.is_some_and(|away| away.way != Way::Taken) {
            if self.torques.as_ref().is_some_and(|torques| torques.holds_lately()) {
                Status::HeldByTorque
            } else {
                Status::Capped
            }
        } else {
            status
        };
        let status = if self.misses(ignored.as_ref(), status, &found.q) { Status::Capped } else { status };
        let TickResult { position, evaluations, iterations, interrupted, .. } = found;
        let (error, inside_limits) = (found.assessment.error.into(), within && can_stop);
        let ceased = || (status != Status::Solved && self.running.has_outlived_targets()).then_some(Idle::Ceased);
        let idle = ignored.map(|ignored| ignored.reason).or(self.idle()).or_else(ceased);
        Ok(Step { status, error, position, evaluations, iterations, inside_limits, away, idle, interrupted })
    }

    /// Whether a tick at `q` that meets the last targets misses those that it ignored.
    fn misses(&self, ignored: Option<&IgnoredTargets>, status: Status, q: &[f64]) -> bool {
        let TrackedArm { robot, tasks, .. } = &self.arm;
        status == Status::Solved
            && ignored.is_some_and(|ignored| !tasks.with(&ignored.targets).assess(robot, q).score.solved)
    }

    /// Checks an arrival, and reduces its targets to the parts that their tasks use. New tasks restart targets and rule; an arrival
    /// that is refused changes nothing.
    fn read(&mut self, arrival: &mut Arrival) -> Result<()> {
        self.check_stamp(arrival.stamp)?;
        let asked = std::mem::take(&mut arrival.tips);
        let Some(tasks) = self.arm.tasks.read(&self.arm.robot, &asked, &mut arrival.targets)? else { return Ok(()) };
        self.check_pairs(&tasks)?;
        self.arm.tasks.replace(asked, tasks);
        self.arm.targets.begin_anew();
        self.follow_from_here();
        self.arm.last_value = None;
        Ok(())
    }

    /// Checks that all limits are kept while tips are held in the frames of others.
    fn check_pairs(&self, tasks: &[CheckedTask]) -> Result<()> {
        let unkept = match (&self.pace, &self.torques) {
            (Some(_), _) => "limits of tips",
            (_, Some(_)) => "torque limits",
            _ => return Ok(()),
        };
        if !tasks.iter().any(|task| task.is_held) {
            return Ok(());
        }
        let problem =
            format!("{unkept} are not kept while one tip is held in the frame of another: leave one of the two out");
        Err(Error::Contradiction { problem: problem.into() })
    }

    /// Checks that the rule can use the stamp, if there is one.
    fn check_stamp(&self, stamp: Option<f64>) -> Result<()> {
        if stamp.is_some() && !self.rule.extrapolates(self.arm.limited.is_some()) {
            let problem = "a stamp is used by the library's own rule under acceleration or jerk limits; give such limits, or \
                           leave stamp out";
            return Err(Error::Contradiction { problem: problem.into() });
        }
        Ok(())
    }

    /// Begins to brake after the timeout, and ends braking when a target arrives.
    fn update_stopping(&mut self, arrived: bool, time: f64) {
        if arrived {
            self.stopping = None;
        } else if let (Some(timeout), None) = (self.arm.targets.timed_out(time), self.stopping) {
            self.begin_stopping(Idle::TimedOut(timeout));
        }
    }

    /// Why no target leads the arm, if none does.
    fn idle(&self) -> Option<Idle> {
        let has_none = self.arm.targets.last().is_empty() && self.stopping != Some(Idle::Stopped);
        if has_none { Some(Idle::NoTarget) } else { self.stopping }
    }

    fn begin_stopping(&mut self, why: Idle) {
        self.stopping = Some(why);
        self.follow_from_here();
        self.arm.targets.expect_new();
        if let Some(torques) = &mut self.torques {
            self.arm.narrow();
            self.arm.narrow_to_stop();
            let others = OtherLimits { safety: self.safety.as_deref_mut(), pace: self.pace.as_deref_mut() };
            torques.choose_stop(&mut self.arm, others);
        }
    }

    /// Follows the target from where the arm is, without a way back.
    fn follow_from_here(&mut self) {
        match &mut self.way_back {
            Some(way_back) if way_back.is_returning() => {
                way_back.restart();
                self.start_rule();
            }
            _ => self.running.forget(),
        }
    }

    /// Ends a tick for the way back, and turns the arm towards it or back to the target.
    #[inline]
    fn look_for_way_back(&mut self, found: &mut TickResult, monitor: &mut dyn Monitor) {
        let Some(way_back) = self.way_back.as_mut().filter(|_| self.stopping.is_none()) else { return };
        // Without targets the arm rests where their motion has led it, and does not go back to the last of them.
        if self.running.has_outlived_targets() && !way_back.is_returning() {
            return;
        }
        let (context, score, goal) = (self.arm.context(), found.assessment.score, self.running.goal());
        let end = EndOfTick { context, score, before: &self.arm.before, goal, rng: &mut self.rng, monitor };
        let lines = OpenLines { safety: self.safety.as_deref_mut(), torques: self.torques.as_deref_mut() };
        let next = way_back.end_tick(end, lines);
        found.evaluations += way_back.evaluations();
        match next {
            Next::Continue => {}
            Next::HeadFor(q) => self.running.head_for(&q),
            Next::Arrived if self.arm.limited.is_some() => {}
            Next::Arrived | Next::Follow => self.start_rule(),
        }
    }

    /// Whether the arm stays at rest because it comes no nearer to its targets.
    fn is_settled(&mut self) -> bool {
        let moves = self.stopping.is_some() || self.way_back.as_ref().is_some_and(|way_back| way_back.is_returning());
        match &mut self.settling {
            Some(settling) if !moves => settling.begin_tick(self.arm.targets.last()),
            Some(settling) => {
                settling.restart();
                false
            }
            None => false,
        }
    }

    /// Ends a tick for the rest of an arm that comes no nearer. Obstacles that move may yet free it.
    fn watch_for_rest(&mut self, found: &TickResult, status: Status) {
        let Some(settling) = &mut self.settling else { return };
        if self.safety.as_ref().is_some_and(|safety| safety.sees_motion()) {
            settling.restart();
            return;
        }
        let is_held = match status {
            Status::HeldByObstacle | Status::HeldByConstraint | Status::HeldByTorque => true,
            Status::Solved => self.goals.is_empty(),
            _ => self.way_back.as_ref().is_some_and(|way_back| way_back.away().is_some()),
        };
        settling.end_tick(&found.assessment, is_held, self.arm.rests_at(&found.q), self.arm.dt);
    }

    /// Moves by one tick to `q`, which the caller guarantees to be inside the limits, bypassing the rule. The rule restarts
    /// from there.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub(super) fn drive(&mut self, q: &[f64], mut arrival: Arrival) -> Result<Step> {
        self.read(&mut arrival)?;
        let inside_limits = self.arm.narrow();
        self.arm.targets.place(arrival);
        let Assessment { score, error } = Problem::new(&self.arm.robot, self.arm.aims()).assess(q);
        let status = match self.arm.last_value {
            _ if score.solved => Status::Solved,
            Some(last) if score.value >= last => Status::Capped,
            _ => Status::Improved,
        };
        self.arm.accept(q, score.value);
        self.start_rule();
        let (position, error) = (self.arm.robot.tip_position(q), error.into());
        let (evaluations, iterations) = (1, 0);
        Ok(Step {
            status,
            error,
            position,
            evaluations,
            iterations,
            inside_limits,
            away: None,
            idle: None,
            interrupted: false,
        })
    }

    /// Restarts the rule.
    fn start_rule(&mut self) {
        self.running = self.rule.start(self.arm.limited.is_some(), !self.arm.has_one_tip());
    }
}

/// The constraints `keeps` of an arm, which hold where it starts; `None` without any.
///
/// # Errors
/// [`Error::Contradiction`] for a start that breaks a constraint.
fn kept_by(keeps: &[Keep], robot: &Robot, arm: &TrackedArm) -> Result<Option<Kept>> {
    if keeps.is_empty() {
        return Ok(None);
    }
    refuse_broken("start_q", keeps, robot, &arm.q)?;
    Ok(Some(Kept::new(Arc::new(robot.clone()), keeps.to_vec())))
}
