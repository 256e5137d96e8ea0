//! The reachable set of an arm: for each joint, the changes of a tick after which it can still stop inside all its limits.
//!
//! Limits that vary over time: acceleration and jerk count with their smallest value from now on. A velocity must stay below
//! the smallest velocity limit until the stop ends, so falling limits are braked for. Position limits count with the
//! narrowest range within the time in which the joint gets up to its highest speed and stops again; a joint that a position
//! limit would overtake is moved out of its way.

use super::admissible::Room;
use super::braking::Braking;
use super::joint_state::JointState;
use crate::limits::{Field, Limits, Profile, TickBox};
use crate::math::MAX_DOF;

/// Fraction of the velocity, acceleration and jerk limits in use; with all of them, rounding of positions could exceed a limit.
const PLANNED: f64 = 1.0 - 1e-6;

/// Rounding of bounds that cross (rad, m; relative beyond 1).
const CROSSING: f64 = 16.0 * f64::EPSILON;

/// The reachable set of an arm.
#[derive(Debug)]
pub(crate) struct ReachableSet {
    dt: f64,
    /// Acceleration and jerk limits of each joint from now on.
    from_now_on: [Vec<Profile>; 2],
    varying: bool,
    positions_vary: bool,
    velocities_vary: bool,
    braking: [Braking; MAX_DOF],
    /// Farthest position of a joint before it has stopped; position limits beyond have no effect. Infinite if limits
    /// vary.
    farthest: [f64; MAX_DOF],
    joints: usize,
}

impl ReachableSet {
    /// The set under `limits`; `None` without acceleration and jerk limits.
    pub fn new(limits: &Limits, dt: f64) -> Option<Self> {
        let fields = [Field::Acceleration, Field::Jerk];
        if !fields.into_iter().any(|field| limits.is_finite(field)) {
            return None;
        }
        let joints = limits.dof();
        let from_now_on = fields.map(|field| {
            limits.field(field).map_or_else(
                || vec![Profile::Constant(f64::INFINITY); joints],
                |profiles| profiles.iter().map(Profile::lowest_ahead).collect(),
            )
        });
        let vary = |profiles: &[Profile]| profiles.iter().any(|profile| !matches!(profile, Profile::Constant(_)));
        let varying = from_now_on.iter().any(|profiles| vary(profiles));
        let fields_vary = |fields: &[Field]| fields.iter().any(|field| limits.field(*field).is_some_and(vary));
        let mut set = Self {
            dt,
            from_now_on,
            varying,
            positions_vary: fields_vary(&[Field::Lower, Field::Upper]),
            velocities_vary: fields_vary(&[Field::Velocity]),
            braking: [Braking { acceleration: 0.0, jerk: 0.0 }; MAX_DOF],
            farthest: [f64::INFINITY; MAX_DOF],
            joints,
        };
        set.update_braking(0.0);
        if !set.varying && !set.velocities_vary {
            for j in 0..joints {
                set.farthest[j] = set.braking[j].farthest(dt * limits.velocity_of(j).at(0.0));
            }
        }
        Some(set)
    }

    /// Braking of each joint from the last tick on.
    pub fn braking(&self) -> &[Braking] {
        &self.braking[..self.joints]
    }

    fn update_braking(&mut self, time: f64) {
        let [acceleration, jerk] = &self.from_now_on;
        for (braking, (acceleration, jerk)) in self.braking.iter_mut().zip(acceleration.iter().zip(jerk)) {
            let [acceleration, jerk] = [acceleration, jerk].map(|limit| PLANNED * limit.at(time).max(0.0));
            *braking = Braking { acceleration: acceleration * self.dt.powi(2), jerk: jerk * self.dt.powi(3) };
        }
    }

    /// Narrows `tick`, the box from position and velocity limits at `q`, to the reachable set of an arm in `state`, in the
    /// tick that begins at `time` (s). Returns false if a joint must break a limit in this tick; it then moves towards it as
    /// fast as it may.
    pub fn narrow(&mut self, q: &[f64], state: &JointState, time: f64, limits: &Limits, tick: &mut TickBox) -> bool {
        if self.varying {
            self.update_braking(time);
        }
        self.narrow_now(q, state, time, limits, tick)
    }

    /// Narrows as [`narrow`](Self::narrow), with the acceleration and jerk limits of its last call.
    pub fn narrow_now(&self, q: &[f64], state: &JointState, time: f64, limits: &Limits, tick: &mut TickBox) -> bool {
        let mut feasible = true;
        for j in 0..q.len() {
            let braking = self.braking[j];
            if braking.acceleration == f64::INFINITY && braking.jerk == f64::INFINITY {
                continue;
            }
            let (step, change) = (state.step[j], state.change[j]);
            let [mut floor, mut ceiling] = [tick.floor[j], tick.ceiling[j]];
            if self.positions_vary {
                let ahead = self.dt * ticks_ahead(&braking, tick.velocity[j] * self.dt);
                [floor, ceiling] = limits.position_range(j, time, time + ahead);
            }
            let rounding = CROSSING * q[j].abs().max(1.0);
            let [below, above] = [q[j] - floor, ceiling - q[j]].map(|room| (room - rounding).max(room.min(0.0)));
            let [below, above] = [below, above].map(|room| if room > self.farthest[j] { f64::INFINITY } else { room });
            let longest = tick.velocity[j].max(0.0) * self.dt;
            let room = Room { below, above, step: PLANNED * longest };
            let slowest_until = |ticks: f64| {
                let (from, to) = (time, time + (ticks + 1.0) * self.dt);
                PLANNED * self.dt * limits.velocity_of(j).smallest(from, to).1.min(tick.velocity[j]).max(0.0)
            };
            let falling: Option<&dyn Fn(f64) -> f64> = if self.velocities_vary { Some(&slowest_until) } else { None };
            let [least, most] = braking.changes([step, change], room, falling);
            let [from, to] = [q[j] + step + least, q[j] + step + most];
            let reach = longest + rounding;
            feasible &= from >= tick.floor[j] - rounding && to <= tick.ceiling[j] + rounding;
            feasible &= from >= q[j] - reach && to <= q[j] + reach;
            let (lower, upper) = tick.bounds.parts_mut();
            (lower[j], upper[j]) = (lower[j].clamp(from, to), upper[j].clamp(from, to));
        }
        feasible
    }

    /// The first joint of an arm at `q` in `state` at t = 0 that cannot stop inside its limits.
    pub fn first_unstoppable(&self, q: &[f64], state: &JointState, limits: &Limits) -> Option<usize> {
        (0..q.len()).find(|j| {
            let (braking, step, change) = (&self.braking[*j], state.step[*j], state.change[*j]);
            let velocity = limits.velocity_of(*j);
            let stop = braking.stop(step, change);
            let time = self.dt * stop.ticks;
            let [floor, ceiling] = limits.position_range(*j, 0.0, time);
            // A start outside, taken by the gate, may stop there, but go no farther out.
            let (floor, ceiling) = (floor.min(q[*j]), ceiling.max(q[*j]));
            let rounding = CROSSING * q[*j].abs().max(1.0);
            let room =
                Room { below: q[*j] - floor, above: ceiling - q[*j], step: self.dt * velocity.smallest(0.0, time).1 };
            let fastest = braking.fastest(step, change).max(braking.fastest(-step, -change));
            change.abs() > braking.acceleration / PLANNED + rounding
                || fastest > room.step + rounding
                || !self.holds(braking, [step, change], room, rounding)
        })
    }

    /// Whether the fastest stop stays inside `room` but for rounding.
    fn holds(&self, braking: &Braking, [step, change]: [f64; 2], room: Room, rounding: f64) -> bool {
        let stop = braking.stop(step, change);
        stop.highest <= room.above + rounding
            && -stop.lowest <= room.below + rounding
            && step.abs() <= room.step + rounding
    }
}

/// Ticks to look ahead for moving position limits: those in which a joint gets up to its highest speed and stops again.
fn ticks_ahead(braking: &Braking, step: f64) -> f64 {
    let ticks = braking.stop(step, 0.0).ticks;
    if ticks.is_finite() { 2.0 * ticks } else { 0.0 }
}
