//! A command and the fastest stop that follows it, as one motion in ticks.

use smallvec::SmallVec;

use crate::math::MAX_DOF;
use crate::math::vector::write_between;
use crate::motion::{Braking, JointState, StopCurve};
use crate::objective::Point;
use crate::obstacle::JointMotion;

/// Shortest interval that is halved (ticks).
const SHORTEST: f64 = 1e-3;

/// Motion of an arm that takes one command and then stops. Tick 0 is before the command, tick 1 at its end.
#[derive(Debug)]
pub(super) struct CommandAndStop<'a> {
    from: &'a [f64],
    command: &'a [f64],
    /// Stop of each joint and its largest acceleration (rad, m per tick^2); empty if the arm may stop at once.
    stops: SmallVec<[(StopCurve, f64); MAX_DOF]>,
    /// State of an arm with limited acceleration at tick 0.
    state: Option<&'a JointState>,
    ticks: f64,
}

impl<'a> CommandAndStop<'a> {
    /// Motion of an arm at `from` that receives `command`. `limited` holds the braking limits of the joints and their state in
    /// the last tick; `None` without acceleration limits.
    pub fn new(from: &'a [f64], command: &'a [f64], limited: Option<(&[Braking], &'a JointState)>) -> Self {
        let mut stops: SmallVec<[(StopCurve, f64); MAX_DOF]> = SmallVec::new();
        if let Some((braking, state)) = limited {
            for (j, limits) in braking.iter().enumerate() {
                let step = command[j] - from[j];
                stops.push((StopCurve::new(limits, step, step - state.step[j]), limits.acceleration));
            }
        }
        let ticks = stops.iter().map(|(stop, _)| stop.ticks()).fold(0.0, f64::max);
        Self { from, command, stops, state: limited.map(|(_, state)| state), ticks }
    }

    /// Ticks from the end of the command until the arm is at rest.
    pub fn ticks_to_stop(&self) -> f64 {
        self.ticks
    }

    /// End of the motion (ticks).
    pub fn end_tick(&self) -> f64 {
        1.0 + self.ticks
    }

    /// Displacement of joint `j` since the end of the command, after this many ticks of the stop; from -2 on, before it.
    pub fn displacement(&self, j: usize, tick: f64) -> f64 {
        let step = self.command[j] - self.from[j];
        match self.state {
            _ if tick > 0.0 => self.stops.get(j).map_or(0.0, |(stop, _)| stop.at(tick)),
            _ if tick == 0.0 => 0.0,
            Some(state) if tick < -1.0 => -step - state.step[j],
            _ => -step,
        }
    }

    /// Length of the range of joint `j`, command included.
    pub fn range(&self, j: usize) -> f64 {
        (self.command[j] - self.from[j]).abs() + self.stops.get(j).map_or(0.0, |(stop, _)| stop.range())
    }

    /// Writes the ticks of the stop at which the acceleration of a joint jumps or bends, in order.
    pub fn write_phase_ends(&self, ends: &mut Vec<usize>) {
        ends.clear();
        ends.extend(self.stops.iter().flat_map(|(stop, _)| stop.phase_ends()).map(|end| end as usize));
        ends.sort_unstable();
        ends.dedup();
    }

    /// Rest configuration.
    pub fn rest(&self) -> Point {
        (0..self.command.len()).map(|j| self.end(j)).collect()
    }

    /// Rest position of joint `j`.
    pub fn end(&self, j: usize) -> f64 {
        self.command[j] + self.stops.get(j).map_or(0.0, |(stop, _)| stop.end())
    }
}

impl JointMotion for CommandAndStop<'_> {
    fn write(&self, tick: f64, q: &mut [f64]) {
        if let Some(state) = self.state.filter(|_| tick < 0.0) {
            return write_before(self.from, state, tick, q);
        }
        if tick <= 1.0 {
            write_between(self.from, self.command, tick, q);
            return;
        }
        let (before, fraction) = (tick.floor() - 1.0, tick.fract());
        for (j, q) in q.iter_mut().enumerate() {
            let stop = &self.stops[j].0;
            let here = stop.at(before);
            *q =
                self.command[j] + if fraction == 0.0 { here } else { here + fraction * (stop.at(before + 1.0) - here) };
        }
    }

    fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]) {
        if to - from <= 1.0 {
            return;
        }
        for (j, (stop, acceleration)) in self.stops.iter().enumerate() {
            let step = self.command[j] - self.from[j];
            let before = self.state.filter(|_| from < 0.0).map_or(step, |state| state.step[j]);
            let range = stop.range() + step.abs() + if from < 0.0 { before.abs() } else { 0.0 };
            let bend = acceleration.max((step - before).abs());
            off_line[j] = (bend * (to - from).powi(2) / 8.0).min(range);
        }
    }

    fn middle(&self, from: f64, to: f64) -> Option<f64> {
        middle(from, to, self.is_spline())
    }

    fn is_spline(&self) -> bool {
        !self.stops.is_empty()
    }
}

/// Writes the configuration one or two ticks before `from`, at a tick of -1 or -2.
pub(super) fn write_before(from: &[f64], state: &JointState, tick: f64, q: &mut [f64]) {
    for (q, (from, (step, change))) in q.iter_mut().zip(from.iter().zip(state.step.iter().zip(&state.change))) {
        *q = from - step - if tick < -1.0 { step - change } else { 0.0 };
    }
}

/// Point at which to divide an interval of a motion in ticks; `None` if it is too short. Intervals of more than one tick are
/// divided at whole ticks, between which the motion is straight; those of a spline, determined by its control points, are never
/// divided within a tick.
pub(super) fn middle(from: f64, to: f64, is_spline: bool) -> Option<f64> {
    let (length, half) = (to - from, 0.5 * (to - from));
    let shortest = if is_spline { 1.0 } else { SHORTEST };
    let whole = if half >= 1.0 { half.floor() } else { 1.0 };
    (length > shortest).then_some(from + if length > 1.0 { whole } else { half })
}
