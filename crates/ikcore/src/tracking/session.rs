//! Control loop: an arm, the rule that proposes its commands, and the safety filter that decides on them.

use std::sync::Arc;

use super::around_arm::ObstacleVelocities;
use super::away::Way;
use super::idle::Idle;
use super::kept::Kept;
use super::limited_state::LimitedState;
use super::record::Accepted;
use super::rule::{RunningRule, Tick, TickResult, TickRule};
use super::safety_filter::{FilterOutcome, FilterWork, Holder, SafetyFilter};
use super::settling::Settling;
use super::step::Step;
use super::step_context::StepContext;
use super::target_stream::Arrival;
use super::tip_pace::TipPace;
use super::torque_pace::{OtherLimits, TorquePace};
use super::track_options::TrackOptions;
use super::tracked_arm::TrackedArm;
use super::way_back::{EndOfTick, Next, OpenLines, WayBack};
use crate::constraint::{Keep, refuse_broken};
use crate::error::{Error, Result, require_positive};
use crate::kinematics::ReachShortfall;
use crate::limits::{JointOutside, Limits};
use crate::math::vector::write_within;
use crate::message::{Message, Setting};
use crate::objective::{Bounds, Point, Score};
use crate::obstacle::{ClearSpace, Obstacles, Surroundings};
use crate::problem::Problem;
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{Aims, Assessment, Goals, Target, TipError};

/// Bisections of a tick that would leave the region; they find the admissible fraction to one thousandth.
const BISECTIONS: usize = 10;

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

    /// Accepted configuration (n,).
    pub fn q(&self) -> &[f64] {
        &self.arm.q
    }

    /// Velocity of the last tick (n,) (rad/s, m/s); zero before the first.
    pub fn qd(&self) -> Point {
        self.arm.q.iter().zip(&self.arm.before).map(|(q, before)| (q - before) / self.arm.dt).collect()
    }

    /// Time of the accepted configuration (s).
    pub fn time(&self) -> f64 {
        self.arm.time()
    }

    /// Limits in force.
    pub fn limits(&self) -> &Limits {
        &self.arm.limits
    }

    /// Names the joints that cannot move because of limits of zero, with the remedy; `None` without such limits.
    pub fn lock(&self) -> Option<&Arc<Message>> {
        self.arm.lock.as_ref()
    }

    /// Joints that began outside their position limits; empty once all are inside.
    pub fn start_outside(&self) -> &[JointOutside] {
        self.arm.outside.as_ref().map_or(&[], |outside| &outside.joints)
    }

    /// Time step (s).
    pub fn dt(&self) -> f64 {
        self.arm.dt
    }

    /// Velocity limits of the last tick (n,) (rad/s, m/s).
    pub fn velocity_limit(&self) -> &[f64] {
        &self.arm.tick_box.velocity
    }

    /// Errors of each target of several tips; empty before targets arrive, and for one tip.
    pub fn tip_errors(&self) -> Vec<TipError> {
        if self.arm.has_one_tip() { vec![] } else { self.arm.aims().errors(&self.arm.robot, &self.arm.q).to_vec() }
    }

    /// Which levels of the targets are met, and which are not, by tip; `None` for targets without an order.
    pub fn levels_in_words(&self) -> Option<String> {
        Some(self.arm.levels()?.in_words(&self.arm.robot, &self.arm.q))
    }

    /// Positions (m) of the tips that have targets, in the order of the targets; for pairs, in the frame of the first tip.
    pub(super) fn tip_positions(&self) -> Vec<[f64; 3]> {
        let mut positions = vec![];
        self.arm.aims().positions(&self.arm.robot, &self.arm.q, |position| positions.push(position));
        positions
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

    /// Configuration and box of the last tick.
    pub(super) fn accepted(&self) -> Accepted<'_> {
        let clearance = self.space().map(|space| space.clearance(&self.arm.q));
        let nearest = clearance.as_ref().and_then(|clearance| clearance.nearest.as_ref());
        Accepted {
            q: &self.arm.q,
            tick_box: &self.arm.tick_box,
            measured: nearest.and_then(|nearest| nearest.contact.measured()),
            clearance: clearance.map_or(f64::NAN, |clearance| clearance.distance),
        }
    }

    /// The tracked robot.
    pub fn robot(&self) -> &Robot {
        &self.arm.robot
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
        arrival.as_mut().map_or(Ok(()), |arrival| self.read(arrival))?;
        let to = self.arm.next_time();
        let sampled_ago = self.arm.targets.take(arrival, to)?.map(|ago| ago / self.arm.dt);
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
        let TickResult { position, evaluations, iterations, interrupted, .. } = found;
        let (error, inside_limits) = (found.assessment.error.into(), within && can_stop);
        let idle = self.idle();
        Ok(Step { status, error, position, evaluations, iterations, inside_limits, away, idle, interrupted })
    }

    /// Checks an arrival, and reduces its targets to the parts that their tasks use. New tasks restart targets and rule.
    fn read(&mut self, arrival: &mut Arrival) -> Result<()> {
        self.check_stamp(arrival.stamp)?;
        let asked = std::mem::take(&mut arrival.tips);
        if self.arm.tasks.read(&self.arm.robot, &asked, &mut arrival.targets)? {
            self.arm.targets.begin_anew();
            self.follow_from_here();
            self.arm.last_value = None;
        }
        let unkept = match (&self.pace, &self.torques) {
            (Some(_), _) => "limits of tips",
            (_, Some(_)) => "torque limits",
            _ => return Ok(()),
        };
        if self.arm.tasks.with(&arrival.targets).has_pairs() {
            let problem = format!(
                "{unkept} are not kept while one tip is held in the frame of another: leave one of the two out"
            );
            return Err(Error::Contradiction { problem: problem.into() });
        }
        Ok(())
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

    fn run_rule(&mut self, sampled_ago: Option<f64>, monitor: &mut dyn Monitor) -> TickResult {
        let (context, targets) = (self.arm.context(), &self.arm.targets);
        let Some((task, target)) = context.aims.iter().next() else { return TickResult::at(context.q) };
        let (criterion, goals, rng) = (&task.criterion, &mut self.goals, &mut self.rng);
        let most_evaluations = self.way_back.as_ref().map_or(usize::MAX, |way_back| way_back.left_to_rule());
        let tick = Tick { context, target, criterion, goals, targets, most_evaluations, sampled_ago, rng, monitor };
        self.running.advance(tick, self.safety.as_deref_mut())
    }

    /// Moves by one tick of the stop that was certified with the last command.
    fn brake(&mut self) -> TickResult {
        let mut found = TickResult::at(&self.arm.q);
        let held =
            self.safety.as_mut().filter(|_| self.stopping.is_some()).and_then(|safety| safety.stop_on(self.arm.dt));
        let fastest = || self.arm.limited.as_ref().map(|limited| limited.stopping(&self.arm.q));
        if let Some(next) = held.or_else(fastest) {
            found.q = next;
        }
        self.arm.tick_box.bounds.clip(&mut found.q);
        self.arm.assess(&mut found);
        found
    }

    fn status(&self, found: &TickResult, held: Option<Holder>) -> Status {
        let Score { value, solved } = found.assessment.score;
        match self.arm.last_value {
            _ if !self.is_clear(&found.q) => Status::InCollision,
            _ if self.torques.as_ref().is_some_and(|torques| !torques.is_certified()) => Status::HeldByTorque,
            _ if solved && self.arm.is_blocked_by_region() => Status::HeldInRegion,
            _ if solved => Status::Solved,
            _ if let Some(holder) = held.or(self.holds_goal()) => match holder {
                Holder::Body => Status::HeldByObstacle,
                Holder::Constraint => Status::HeldByConstraint,
            },
            Some(last) if self.torques.as_ref().is_some_and(|torques| torques.holds(last, value, self.arm.dt)) => {
                Status::HeldByTorque
            }
            _ if let Some(status) = self.arm.given_up(found) => status,
            Some(last) if value >= last => Status::Capped,
            // Other rules may take steps as short as these.
            _ if self.way_back.is_some() && self.arm.rests_at(&found.q) => Status::Capped,
            _ => Status::Improved,
        }
    }

    /// What keeps the goal from its target; nothing while the arm stops.
    fn holds_goal(&self) -> Option<Holder> {
        self.safety.as_ref().filter(|_| self.stopping.is_none()).and_then(|safety| safety.holds_goal())
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

    /// Changes the command `found` by the rule to one that keeps the arm clear and all constraints, and holds pairs of tips or, for a
    /// `settled` arm, to the braking one. Returns what caused the change, if it was not the pairs.
    fn filter(&mut self, settled: bool, found: &mut TickResult) -> Option<Holder> {
        let Some(safety) = &mut self.safety else {
            if settled {
                found.q = self.arm.context().braking();
                self.note_changed(found);
            }
            return None;
        };
        let context = self.arm.context();
        // On a way back the distance from the target shows no progress: the targets do not judge the commands.
        let is_returning = self.way_back.as_ref().is_some_and(|way_back| way_back.is_returning());
        let context = if is_returning { StepContext { aims: Aims::default(), ..context } } else { context };
        let FilterOutcome { changed, held_by } = safety.filter(&context, settled, &mut found.q);
        if changed {
            self.note_changed(found);
        }
        held_by
    }

    /// Changes the command `found` to one that keeps the limits of tips.
    fn keep_pace(&mut self, found: &mut TickResult) {
        let Some(pace) = self.pace.as_mut().filter(|_| !found.interrupted && self.stopping.is_none()) else { return };
        if pace.keep(&self.arm.context(), self.safety.as_deref_mut(), &mut found.q) {
            self.note_changed(found);
        }
    }

    /// Changes the command `found` to one that keeps the torque limits. An arm that stops goes on with its stop, unless masses have changed.
    fn keep_torques(&mut self, settled: bool, found: &mut TickResult) {
        let Some(torques) = &mut self.torques else { return };
        if found.interrupted || self.stopping.is_some() && torques.goes_on_with_stop(&self.arm, &found.q) {
            return;
        }
        let others = OtherLimits { safety: self.safety.as_deref_mut(), pace: self.pace.as_deref_mut() };
        if torques.keep(&mut self.arm, others, settled, &mut found.q) {
            self.note_changed(found);
        }
    }

    /// Assesses a command that is not the one of the rule.
    fn note_changed(&mut self, found: &mut TickResult) {
        self.arm.assess(found);
        if self.arm.limited.is_none() {
            self.running.forget();
        }
    }

    /// Whether all bodies keep the margin at `q`; true if collisions are not checked.
    fn is_clear(&self, q: &[f64]) -> bool {
        self.space().is_none_or(|space| space.holds(q))
    }

    /// Clear space of the arm, if collisions are avoided.
    pub fn space(&self) -> Option<&Arc<ClearSpace<'static>>> {
        self.safety.as_ref().and_then(|safety| safety.space())
    }

    /// Work of the safety filter since it began, with the first obstacles or pairs of tips; zero without either.
    pub fn filter_work(&self) -> FilterWork {
        self.safety.as_ref().map_or_else(FilterWork::default, |safety| safety.work())
    }

    /// What is kept at every instant.
    pub fn keeps(&self) -> &[Keep] {
        self.safety.as_ref().and_then(|safety| safety.kept()).map_or(&[], Kept::keeps)
    }

    /// The constraint nearest to its tolerance, in words; `None` if nothing is kept.
    pub fn tightest(&self) -> Option<String> {
        self.safety.as_ref()?.kept()?.tightest_at(&self.arm.q)
    }

    /// Whether torques are limited.
    pub(super) fn limits_torque(&self) -> bool {
        self.torques.is_some()
    }

    /// The torque limit that holds the arm back, in words; `None` if none does.
    pub fn held_by_torque(&self) -> Option<String> {
        self.torques.as_ref()?.held_in_words(&self.arm.given)
    }

    /// Exchanges the masses: `robot` is the one of the session with other masses, payloads or gravity. The next command and its stop are checked
    /// with the new ones.
    ///
    /// # Errors
    /// [`Error::Contradiction`] for a robot that differs in anything else, [`Error::NoDynamics`] for one without masses where torques are
    /// limited; the session is then as before.
    pub fn set_robot(&mut self, robot: &Robot) -> Result<()> {
        if *robot == self.arm.given {
            return Ok(());
        }
        robot.require_masses_alone_differ(&self.arm.given)?;
        if let Some(torques) = &mut self.torques {
            torques.carry(robot, &self.arm.limits)?;
        }
        self.arm.robot = Arc::new(self.arm.robot.with_masses_of(robot));
        self.arm.given = robot.clone();
        self.settling.iter_mut().for_each(Settling::restart);
        Ok(())
    }

    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub fn obstacle_velocities(&self) -> &[[f64; 3]] {
        self.safety.as_ref().map_or(&[], |safety| safety.velocities())
    }

    /// Obstacles, margin and choice of self-collision.
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// Replaces the obstacles by these, at their current poses, with their `velocities` (m/s); an empty list means all at rest,
    /// `None` no obstacles. The margin and the choice of self-collision stay.
    ///
    /// # Errors
    /// As [`new`](Self::new); the session is then as before.
    pub fn set_obstacles(&mut self, obstacles: Option<Obstacles>, velocities: Vec<[f64; 3]>) -> Result<()> {
        let rest = velocities.is_empty() && self.obstacle_velocities().is_empty();
        if rest && obstacles == self.surroundings.obstacles {
            return Ok(()); // A loop that gives the same in every tick frees no arm.
        }
        let motion = ObstacleVelocities::new(velocities, obstacles.as_ref().map_or(0, |all| all.len()))?;
        let surroundings = Surroundings { obstacles, ..self.surroundings.clone() };
        // A margin given before is kept for obstacles that may come later.
        let space =
            if surroundings.apply_to(&self.arm.robot) { surroundings.clear_space(&self.arm.robot)? } else { None };
        if space.is_some() || !self.arm.has_one_tip() || !self.keeps().is_empty() {
            let safety = match self.safety.take() {
                Some(safety) => self.safety.insert(safety),
                None => self.safety.insert(Box::new(SafetyFilter::new(None, None, &self.arm.limits)?)),
            };
            safety.replace(space, motion, &self.arm.limits)?;
        } else {
            self.safety = None;
        }
        self.surroundings = surroundings;
        if let Some(way_back) = &mut self.way_back {
            way_back.note_replaced();
        }
        self.settling.iter_mut().for_each(Settling::restart);
        Ok(())
    }

    /// Stops as fast as the limits allow, from the next tick on until a target arrives. Held pairs of tips stay held; the arm
    /// does not evade approaching obstacles, neither while braking nor afterwards. Returns the duration of the stop (s): 0 for
    /// an arm without acceleration limits.
    pub fn stop(&mut self) -> f64 {
        self.begin_stopping(Idle::Stopped);
        let held = self.safety.as_ref().and_then(|safety| safety.ticks_to_stop());
        let fastest = || self.arm.limited.as_ref().map_or(0.0, LimitedState::time_to_stop);
        held.map_or_else(fastest, |ticks| self.arm.dt * ticks)
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

    /// Shortens a tick that would take the tip out of its region. The tick starts inside the region and the box is
    /// convex, so any fraction of the tick ends in the box.
    fn keep_in_region(&mut self, found: &mut TickResult) {
        let region = self.arm.tasks.region().filter(|region| !region.contains(&found.position));
        let Some(region) = region.filter(|_| !self.arm.targets.last().is_empty()) else { return };
        let (mut kept, mut past) = (0.0, 1.0);
        let end = found.q.clone();
        for _ in 0..BISECTIONS {
            let fraction = 0.5 * (kept + past);
            write_within(&self.arm.q, &end, fraction, &mut found.q);
            let inside = region.contains(&self.arm.robot.tip_position(&found.q));
            (kept, past) = if inside { (fraction, past) } else { (kept, fraction) };
        }
        write_within(&self.arm.q, &end, kept, &mut found.q);
        found.assess(&self.arm.robot, &self.arm.aims());
        found.evaluations += BISECTIONS + 1;
        self.running.forget();
    }

    /// Restarts the rule.
    fn start_rule(&mut self) {
        self.running = self.rule.start(self.arm.limited.is_some(), !self.arm.has_one_tip());
    }

    /// Resets the session to `q` (n,) at t = 0, with velocities `qd` (n,) (rad/s, m/s) and accelerations `qdd` (n,) (rad/s^2,
    /// m/s^2); `None` means zero. Both are differences of commands in the last tick.
    ///
    /// # Errors
    /// As [`new`](Self::new) for a start; [`Error::Contradiction`](crate::Error::Contradiction) for an arm that could not
    /// stop inside its limits.
    pub fn reset(&mut self, q: &[f64], qd: Option<&[f64]>, qdd: Option<&[f64]>) -> Result<()> {
        if let Some(kept) = self.safety.as_ref().and_then(|safety| safety.kept()) {
            refuse_broken("q", kept.keeps(), kept.robot(), q)?;
        }
        if let Some(torques) = self.torques.as_mut().filter(|_| q.len() == self.arm.q.len()) {
            torques.require_held("q", q, &self.arm.given)?;
        }
        self.arm.reset(q, [qd, qdd])?;
        self.arm.set_braking_part(1.0);
        self.torques.iter_mut().for_each(|torques| torques.restart());
        self.stopping = None;
        if let Some(way_back) = &mut self.way_back {
            way_back.restart();
        }
        self.settling.iter_mut().for_each(Settling::restart);
        self.start_rule();
        if let Some(safety) = &mut self.safety {
            safety.forget();
        }
        self.rng = rng::stream(self.seed, 0).prepared();
        Ok(())
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
