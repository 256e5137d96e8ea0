//! State and reachable set of an arm under acceleration or jerk limits.

use crate::error::{Error, Result};
use crate::limits::{Limits, TickBox};
use crate::motion::{Braking, JointState, ReachableSet, Scales};
use crate::objective::Point;
use crate::wording::number;

/// Rounding of the end of a stop (rad, m; relative beyond 1).
const INSIDE: f64 = 16.0 * f64::EPSILON;

/// Rounding of positions, relative to the jerk limit in a tick, that a stop of a million ticks would feel.
const COARSE: f64 = 1e-6;

/// Motion of an arm under acceleration or jerk limits.
#[derive(Debug)]
pub(super) struct LimitedState {
    reachable: ReachableSet,
    state: JointState,
    scales: Scales,
    dt: f64,
    /// Part of the acceleration limits with which the arm brakes, and the braking limits with it; `None`: all of them.
    eased: Option<(f64, Vec<Braking>)>,
}

impl LimitedState {
    /// Motion at rest; `None` without acceleration and jerk limits.
    pub fn new(limits: &Limits, dt: f64) -> Option<Self> {
        let reachable = ReachableSet::new(limits, dt)?;
        let steps = (0..limits.dof()).map(|j| dt * limits.velocity_of(j).at(0.0));
        let scales = Scales::new(reachable.braking(), steps);
        Some(Self { state: JointState::at_rest(limits.dof()), reachable, scales, dt, eased: None })
    }

    /// Braking limits of the joints.
    pub fn braking(&self) -> &[Braking] {
        match &self.eased {
            Some((part, braking)) if *part < 1.0 => braking,
            _ => self.reachable.braking(),
        }
    }

    /// Part of the acceleration limits with which the arm brakes.
    pub fn braking_part(&self) -> f64 {
        self.eased.as_ref().map_or(1.0, |(part, _)| *part)
    }

    /// Sets the part of the acceleration limits, which are constant, with which the arm brakes.
    pub fn set_braking_part(&mut self, part: f64) {
        let Self { eased, reachable, .. } = self;
        let (now, braking) = eased.get_or_insert_with(|| (1.0, reachable.braking().to_vec()));
        *now = part;
        for (braking, full) in braking.iter_mut().zip(reachable.braking()) {
            braking.acceleration = part * full.acceleration;
        }
    }

    /// Whether a joint of an arm at `q` that steps to `command` can stop inside the limits of `tick` with the braking limits in force.
    /// Those of the reachable set assume the full ones.
    pub fn stops_inside(&self, q: &[f64], command: &[f64], tick: &TickBox) -> bool {
        self.braking_part() >= 1.0
            || self.braking().iter().enumerate().all(|(j, braking)| {
                let step = command[j] - q[j];
                let change = step - self.state.step[j];
                let stop = braking.stop(step, change);
                let rounding = INSIDE * q[j].abs().max(1.0);
                let [floor, ceiling] = [tick.floor[j].min(q[j]) - rounding, tick.ceiling[j].max(q[j]) + rounding];
                change.abs() <= braking.acceleration + braking.jerk
                    && command[j] + stop.lowest >= floor
                    && command[j] + stop.highest <= ceiling
            })
    }

    /// Displacement and its change in the last tick.
    pub fn state(&self) -> &JointState {
        &self.state
    }

    /// Largest displacement per tick and its largest change.
    pub fn scales(&self) -> &Scales {
        &self.scales
    }

    /// Narrows the box of the tick that begins at `time` (s) to commands from which the arm can still stop. Returns false if a
    /// joint cannot keep its limits.
    pub fn narrow(&mut self, q: &[f64], time: f64, limits: &Limits, tick: &mut TickBox) -> bool {
        for (most, velocity) in self.scales.step.iter_mut().zip(&tick.velocity) {
            *most = velocity * self.dt;
        }
        self.reachable.narrow(q, &self.state, time, limits, tick)
    }

    /// Variant of [`narrow`](Self::narrow) for a later tick, of an arm at `q` in `state`.
    pub fn narrow_ahead(&self, q: &[f64], state: &JointState, time: f64, limits: &Limits, tick: &mut TickBox) -> bool {
        self.reachable.narrow_now(q, state, time, limits, tick)
    }

    /// Advances the state by the motion from `before` to `q`.
    pub fn advance(&mut self, before: &[f64], q: &[f64]) {
        let braking = self.braking();
        let mut steps: Point = q.iter().zip(before).map(|(q, before)| q - before).collect();
        for ((step, q), ((last, change), braking)) in
            steps.iter_mut().zip(q).zip(self.state.step.iter().zip(&self.state.change).zip(braking))
        {
            // Rounding of positions matters to small changes: a stop goes on from the step that it intended, or it would end late.
            let rounding = f64::EPSILON * q.abs();
            if rounding > COARSE * braking.jerk {
                let stopping = last + braking.first_change(*last, *change);
                if (*step - stopping).abs() <= 4.0 * rounding {
                    *step = stopping;
                }
            }
        }
        self.state.advance(steps.iter().copied());
    }

    /// Sets velocities (rad/s, m/s) and accelerations (rad/s^2, m/s^2) of an arm at `q`, at t = 0.
    ///
    /// # Errors
    /// [`Error::Contradiction`] names a joint that could not stop inside its limits; the motion is then as before.
    pub fn set(&mut self, q: &[f64], [qd, qdd]: [&[f64]; 2], limits: &Limits) -> Result<()> {
        let step = qd.iter().map(|velocity| velocity * self.dt).collect();
        let change = qdd.iter().map(|acceleration| acceleration * self.dt * self.dt).collect();
        let state = JointState { step, change };
        if let Some(j) = self.reachable.first_unstoppable(q, &state, limits) {
            let problem = format!(
                "joint '{}' at {} with velocity {} and acceleration {} cannot stop inside its limits; start slower or \
                 farther inside",
                limits.joint_name(j),
                number(q[j]),
                number(qd[j]),
                number(qdd[j])
            );
            return Err(Error::Contradiction { problem: problem.into() });
        }
        self.state = state;
        Ok(())
    }

    /// The next configuration of the fastest stop from `q`.
    pub fn stopping(&self, q: &[f64]) -> Point {
        let mut out = Point::from_elem(0.0, q.len());
        self.state.brake(self.braking(), &mut out);
        out.iter_mut().zip(q).for_each(|(out, q)| *out += q);
        out
    }

    /// Duration of the fastest stop (s).
    pub fn time_to_stop(&self) -> f64 {
        self.dt * self.state.ticks_to_stop(self.braking())
    }
}
