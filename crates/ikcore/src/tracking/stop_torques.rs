//! Certificate of the joint torques of a command and of the stop after it, at every tick.
//!
//! At a tick the velocity of a joint is its step over the tick, and its acceleration the change of its steps, both from the commands. Between
//! ticks at which the deceleration of a joint jumps or bends, torques are within a remainder (`Rest`) of the parabolas through three of their
//! values; ticks in between are examined only where that does not suffice, down to every one.

use super::command_and_stop::CommandAndStop;
use super::step_context::StepContext;
use crate::constraint::{BendScratch, HOLD_AND_SQUARE, JointTorques, Rest, TIGHT, TorquePoint, control_points};
use crate::error::Result;
use crate::limits::Limits;
use crate::math::majorant::Majorant;
use crate::message::Message;
use crate::objective::Point;
use crate::robot::Robot;

/// Part of a torque limit that a milder stop would use.
const MILD: f64 = 0.97;

/// Fraction of a torque limit above which the gradient of a torque counts.
const CLOSE: f64 = 0.8;

/// Maximum fraction of a torque limit that holds an arm at rest: with all of it, the arm could never move away again.
const LEFT_TO_MOVE: f64 = 0.995;

/// Fraction of the remaining torque that a command may use where little remains.
const NEARLY_ALL: f64 = 0.95;

/// Fraction of a torque limit allowed on top of a holding torque beyond the limit: without it, the arm could not begin to move.
const TO_MOVE: f64 = 0.02;

/// Certificate; owns its scratch.
#[derive(Debug)]
pub(super) struct StopTorques {
    torques: JointTorques,
    /// Largest torques (N m, N) of a command and the stop after it: the limits, unless the arm cannot be held where it is.
    allowed: Point,
    /// Upper bound of the holding torque after the stop, as a fraction of the limit, while the arm leaves a configuration that it cannot hold.
    leaving: Option<f64>,
    point: TorquePoint,
    bend: BendScratch,
    /// Distances from parabolas over an interval of one tick to either side.
    rests: Vec<Rest>,
    ends: Vec<usize>,
    /// Gradients (n, n) of the torques that hold the arm.
    gradients: Vec<f64>,
    /// Torques without friction at the last tick beyond a limit.
    beyond: Point,
}

/// A torque beyond its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Overload {
    /// Ticks after the command.
    pub tick: usize,
    pub joint: usize,
    /// Torque, and its limit (N m, N).
    pub torque: f64,
    pub limit: f64,
    /// Whether all joints are at rest there.
    pub is_at_rest: bool,
    /// Part of the accelerations at which all torques would be within their limits; 0 if they never are.
    pub easing: f64,
}

/// Torques without friction, and velocities, at a tick.
#[derive(Debug)]
struct TickTorques {
    torques: Point,
    rates: Point,
}

/// A command and the stop after it, in ticks of this length (s).
#[derive(Debug, Clone, Copy)]
struct StoppedMotion<'a> {
    ticks: &'a CommandAndStop<'a>,
    command: &'a [f64],
    dt: f64,
    /// Whether decelerations bend between the ticks at which they jump.
    bends: bool,
}

impl StopTorques {
    /// Certificate of the torque limits of `robot` in the call `method`; `None` without any.
    ///
    /// # Errors
    /// Those of [`Robot::dynamics`], and [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for a base that floats.
    pub fn new(method: &Message, robot: &Robot, limits: &Limits) -> Result<Option<Self>> {
        let Some(torques) = JointTorques::new(robot, limits.torque(), method.clone())? else { return Ok(None) };
        let (n, point, bend) = (torques.dof(), torques.point(), torques.bend_scratch());
        let (rests, ends, beyond) = (vec![[0.0; 3]; n], Vec::with_capacity(3 * n), Point::from_elem(0.0, n));
        let gradients = vec![0.0; n * n];
        let allowed = Point::from_slice(torques.limits());
        Ok(Some(Self { torques, allowed, leaving: None, point, bend, rests, ends, gradients, beyond }))
    }

    /// Allows higher torques to an arm that cannot be held at `q` nor at `rest`: those that hold it at either, and a little more to move,
    /// until [`allow_limits`](Self::allow_limits). After a command and its stop, the arm has to be easier to hold than at `rest`.
    pub fn allow_holding(&mut self, q: &[f64], rest: &[f64]) {
        for held_at in [q, rest] {
            let held = self.held_at(held_at);
            self.leaving = Some(self.share(&held));
            for (j, limit) in
                self.torques.limits().iter().enumerate().filter(|(j, limit)| held.torques[*j].abs() > **limit)
            {
                let to_move = TO_MOVE * limit + self.torques.friction(j).dry;
                self.allowed[j] = self.allowed[j].max(held.torques[j].abs() + to_move);
            }
        }
    }

    /// Allows torques up to the limits alone.
    pub fn allow_limits(&mut self) {
        self.allowed.copy_from_slice(self.torques.limits());
        self.leaving = None;
    }

    /// Returns the joint farthest beyond its limit when holding the arm at `q`, if any.
    pub fn too_heavy(&mut self, q: &[f64]) -> Option<Overload> {
        let held = self.held_at(q);
        self.overload(&held, 0, 1.0 + TIGHT)
    }

    /// The torques that hold the arm at rest at `q`.
    fn held_at(&mut self, q: &[f64]) -> TickTorques {
        let hold = CommandAndStop::new(q, q, None);
        self.node(&StoppedMotion { ticks: &hold, command: q, dt: 1.0, bends: false }, 0)
    }

    /// Checks the command `q` and the stop after it. Returns the largest used part of a limit in the stop.
    ///
    /// # Errors
    /// The first torque found beyond its limit.
    pub fn check(&mut self, context: &StepContext<'_>, q: &[f64]) -> std::result::Result<f64, Overload> {
        let stop = context.stop_after(q);
        let bends = context.limited.is_some_and(|limited| limited.braking().iter().any(|b| b.jerk < f64::INFINITY));
        let motion = StoppedMotion { ticks: &stop, command: q, dt: context.dt, bends };
        self.within(&motion, 0)?;
        let last = (stop.ticks_to_stop() as usize).saturating_add(1);
        let at_rest = self.within(&motion, last)?;
        let mut largest = self.share(&at_rest);
        if self.strains_more(context, largest) {
            self.beyond.copy_from_slice(&at_rest.torques);
            return Err(self.overload(&at_rest, last, 0.0).expect("no torque is below zero"));
        }
        stop.write_phase_ends(&mut self.ends);
        let mut first = 1;
        let mut is_bounded = false;
        for k in 0..self.ends.len() {
            let last = self.ends[k];
            if last < first {
                continue;
            }
            let start = self.within(&motion, first)?;
            largest = largest.max(self.share(&start));
            if last > first {
                if last > first + 1 && !is_bounded {
                    self.bound(context, &motion);
                    is_bounded = true;
                }
                let end = self.within(&motion, last)?;
                largest = largest.max(self.share(&end));
                self.within_all(&motion, [first, last], [&start, &end])?;
            }
            first = last + 1;
        }
        Ok(largest)
    }

    /// Whether holding the arm with this part of a limit leaves too little to move it, and takes more than where the fastest stop ends now.
    fn strains_more(&mut self, context: &StepContext<'_>, part: f64) -> bool {
        match self.leaving {
            Some(most) => part >= most,
            None if part <= LEFT_TO_MOVE => false,
            None => {
                let brake = context.braking();
                let held = self.held_at(&context.stop_after(&brake).rest());
                part > self.share(&held) + TIGHT
            }
        }
    }

    /// Largest torque relative to its limit, in the command `q` and at the ends of the phases of the stop after it.
    pub fn largest(&mut self, context: &StepContext<'_>, q: &[f64]) -> f64 {
        let stop = context.stop_after(q);
        let motion = StoppedMotion { ticks: &stop, command: q, dt: context.dt, bends: false };
        stop.write_phase_ends(&mut self.ends);
        let ends = std::mem::take(&mut self.ends);
        let ticks = [0].into_iter().chain(ends.iter().flat_map(|end| [*end, *end + 1]));
        let largest = ticks.map(|tick| self.share_at(&motion, tick)).fold(0.0, f64::max);
        self.ends = ends;
        largest
    }

    fn share_at(&mut self, motion: &StoppedMotion<'_>, tick: usize) -> f64 {
        let node = self.node(motion, tick);
        self.share(&node)
    }

    /// Calls `take` for each joint that holds the arm at rest at `q` with most of its limit: its index, how far its torque is beyond a part of
    /// the limit, and the gradient (n,) of its size.
    pub fn each_hold(&mut self, q: &[f64], mut take: impl FnMut(usize, f64, &[f64])) {
        let n = q.len();
        let Self { torques, point, gradients, .. } = self;
        let mut hold = Point::from_elem(0.0, n);
        point.q.copy_from_slice(q);
        torques.write_hold_and_gradients(point, &mut hold, gradients);
        for (j, limit) in torques.limits().iter().enumerate() {
            if hold[j].abs() > CLOSE * limit {
                let gradient = &mut gradients[j * n..(j + 1) * n];
                gradient.iter_mut().for_each(|slope| *slope *= hold[j].signum());
                take(j, hold[j].abs() - MILD * limit, gradient);
            }
        }
    }

    /// Whether holding the arm after the command `q` and its stop takes nearly all of a torque limit.
    pub fn strains_after(&mut self, context: &StepContext<'_>, q: &[f64]) -> bool {
        let held = self.held_at(&context.stop_after(q).rest());
        self.share(&held) > MILD
    }

    /// Writes the gradient (n,) of half the sum of squares of the holding torques at `q` beyond a part of their limits, relative to these.
    pub fn write_strain_gradient(&mut self, q: &[f64], sum: &mut [f64]) {
        sum.fill(0.0);
        let limits = Point::from_slice(self.torques.limits());
        self.each_hold(q, |joint, beyond, gradient| {
            let weight = beyond.max(0.0) / (limits[joint] * limits[joint]);
            sum.iter_mut().zip(gradient).for_each(|(sum, slope)| *sum += weight * slope);
        });
    }

    /// Part of the way from the command `brake` to the one with the torques last found beyond a limit, `tick` ticks after it, on which all
    /// are within their limits, by the line between the torques of both.
    pub fn part_within(&mut self, context: &StepContext<'_>, brake: &[f64], tick: usize) -> f64 {
        let stop = context.stop_after(brake);
        let motion = StoppedMotion { ticks: &stop, command: brake, dt: context.dt, bends: false };
        let node = self.node(&motion, tick);
        let beyond = std::mem::take(&mut self.beyond);
        let part = self.part_between(&node.torques, &beyond, &node.rates);
        self.beyond = beyond;
        part
    }

    /// The torques at a tick, which are within their limits.
    fn within(&mut self, motion: &StoppedMotion<'_>, tick: usize) -> std::result::Result<TickTorques, Overload> {
        let node = self.node(motion, tick);
        let is_within = |j: usize| self.torque(&node, j).abs() <= (1.0 - TIGHT) * self.allowed[j];
        if (0..self.allowed.len()).all(is_within) {
            return Ok(node);
        }

        let mut hold = Point::from_elem(0.0, node.torques.len());
        self.point.second.fill(0.0);
        self.torques.write_torques(&mut self.point, &mut hold);
        let easing = self.part_between(&hold, &node.torques, &node.rates);
        self.beyond.copy_from_slice(&node.torques);
        let overload = self.overload(&node, tick, 1.0 - TIGHT).expect("what is allowed is at least the limit");
        Err(Overload { easing, ..overload })
    }

    /// Checks the ticks between two, which are within the limits.
    fn within_all(
        &mut self,
        motion: &StoppedMotion<'_>,
        [first, last]: [usize; 2],
        [start, end]: [&TickTorques; 2],
    ) -> std::result::Result<(), Overload> {
        if last - first < 2 {
            return Ok(());
        }
        let middle = first + (last - first) / 2;
        let node = self.within(motion, middle)?;
        if (last - first).is_multiple_of(2) && self.is_bounded(motion, [start, &node, end], (middle - first) as f64) {
            return Ok(());
        }
        self.within_all(motion, [first, middle], [start, &node])?;
        self.within_all(motion, [middle, last], [&node, end])
    }

    /// Whether torques over an interval of `half` ticks to either side of its middle are within their limits.
    fn is_bounded(&self, motion: &StoppedMotion<'_>, [start, middle, end]: [&TickTorques; 3], half: f64) -> bool {
        let cubed = half.powi(3);
        self.allowed.iter().enumerate().all(|(j, limit)| {
            let torques = control_points([start.torques[j], middle.torques[j], end.torques[j]]);
            let most = torques.into_iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
            let [of_hold, of_motion, _] = self.rests[j];
            let rest = cubed * (of_motion / (motion.dt * motion.dt) + of_hold);
            let rates = control_points([start.rates[j], middle.rates[j], end.rates[j]]);
            // A deceleration that bends is a parabola too.
            let fastest = rates.into_iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
            let friction = self.torques.friction(j);
            let drag = friction.damping * fastest + if fastest > 0.0 { friction.dry } else { 0.0 };
            most + rest + drag <= limit * (1.0 - TIGHT)
        })
    }

    /// Writes the remainders of a stop.
    fn bound(&mut self, context: &StepContext<'_>, motion: &StoppedMotion<'_>) {
        let Self { torques, bend, rests, .. } = self;
        let Some(limited) = context.limited else { return };
        let rate = |j: usize| {
            let braking = &limited.braking()[j];
            let step = -motion.ticks.displacement(j, -1.0);
            let change = step - limited.state().step[j];
            let bend = if motion.bends { braking.jerk } else { 0.0 };
            // Derivatives differ from differences over a tick by what the next derivative adds in it.
            let steepest = braking.acceleration.max(change.abs()) + bend;
            let fastest = braking.fastest(step, change).max(braking.fastest(-step, -change)).max(step.abs());
            Majorant::of([fastest + steepest, steepest, 0.5 * bend])
        };
        let farthest = |j: usize| motion.command[j].abs() + motion.ticks.range(j);
        torques.rests::<HOLD_AND_SQUARE>(rate, farthest, bend, rests);
    }

    /// The torques and velocities at a tick after the command.
    fn node(&mut self, motion: &StoppedMotion<'_>, tick: usize) -> TickTorques {
        let (at, dt) = (&mut self.point, motion.dt);
        let mut node =
            TickTorques { torques: Point::from_slice(motion.command), rates: Point::from_slice(motion.command) };
        for (j, command) in motion.command.iter().enumerate() {
            let [before, last, now] = [2.0, 1.0, 0.0].map(|ago| motion.ticks.displacement(j, tick as f64 - ago));
            let (step, step_before) = (now - last, last - before);
            (at.q[j], at.first[j], at.second[j]) = (command + now, step / dt, (step - step_before) / (dt * dt));
            node.rates[j] = at.first[j];
        }
        self.torques.write_torques(at, &mut node.torques);
        node
    }

    /// The torque farthest beyond this part of its limit.
    fn overload(&self, node: &TickTorques, tick: usize, part: f64) -> Option<Overload> {
        let each = self.torques.limits().iter().enumerate();
        let beyond = each.map(|(joint, limit)| (joint, self.torque(node, joint), *limit));
        let (joint, torque, limit) = beyond
            // NaN, the sum of infinite torques, is beyond any limit.
            .filter(|(_, torque, limit)| !(torque.abs() <= part * limit))
            .max_by(|one, other| (one.1.abs() / one.2).total_cmp(&(other.1.abs() / other.2)))?;
        let is_at_rest = node.rates.iter().all(|rate| *rate == 0.0);
        Some(Overload { tick, joint, torque, limit, is_at_rest, easing: 0.0 })
    }

    /// The torque of a joint, with friction where it does not help.
    fn torque(&self, node: &TickTorques, joint: usize) -> f64 {
        let torque = node.torques[joint];
        let with_friction = torque + self.drag(node.rates[joint], joint);
        if with_friction.abs() > torque.abs() { with_friction } else { torque }
    }

    /// Friction of a joint that moves; one at rest has none.
    fn drag(&self, rate: f64, joint: usize) -> f64 {
        let friction = self.torques.friction(joint);
        friction.damping * rate + if rate == 0.0 { 0.0 } else { friction.dry.copysign(rate) }
    }

    /// The largest part of a limit that is in use.
    fn share(&self, node: &TickTorques) -> f64 {
        let each = self.torques.limits().iter().enumerate();
        each.map(|(joint, limit)| self.torque(node, joint).abs() / limit).fold(0.0, f64::max)
    }

    /// Part of the way from torques `from` to torques `to` on which all leave room to their limits, with the friction at these velocities.
    fn part_between(&self, from: &[f64], to: &[f64], rates: &[f64]) -> f64 {
        let mut part = 1.0_f64;
        for (j, limit) in self.allowed.iter().enumerate().filter(|(_, limit)| limit.is_finite()) {
            for side in [-1.0, 1.0] {
                let growth = side * (to[j] - from[j]);
                let all = limit - side * from[j] - (side * self.drag(rates[j], j)).max(0.0);
                // Nearly all of a small remainder may be used, so that an arm held with most of a limit can still move.
                let room = (all - (1.0 - MILD) * limit).max(NEARLY_ALL * all);
                if growth > room {
                    part = part.min((room / growth).max(0.0));
                }
            }
        }
        part
    }
}
