//! A command and the fastest stop that follows it, as one motion in ticks.

use smallvec::SmallVec;

use crate::math::MAX_DOF;
use crate::motion::{Braking, JointState, StopCurve};
use crate::obstacle::TickedMotion;

/// A cubic B-spline passes a commanded position at a sixth of its second difference.
const SPLINE: f64 = 1.0 / 6.0;

/// The motion of an arm that takes one command and then stops. Tick 0 is before the command, tick 1 at its end.
#[derive(Debug)]
pub(super) struct StopMotion<'a> {
    from: &'a [f64],
    command: &'a [f64],
    /// The stop of each joint and its largest acceleration (rad, m per tick^2); empty if the arm may stop at once.
    stops: SmallVec<[(StopCurve, f64); MAX_DOF]>,
    ticks: f64,
}

impl<'a> StopMotion<'a> {
    /// Of an arm at `from` that is given `command`. `limited`: how its joints may brake, and their motion in the last tick.
    pub fn new(from: &'a [f64], command: &'a [f64], limited: Option<(&[Braking], &JointState)>) -> Self {
        let mut stops: SmallVec<[(StopCurve, f64); MAX_DOF]> = SmallVec::new();
        if let Some((braking, state)) = limited {
            for (j, limits) in braking.iter().enumerate() {
                let step = command[j] - from[j];
                stops.push((StopCurve::new(limits, step, step - state.step[j]), limits.acceleration));
            }
        }
        let ticks = stops.iter().map(|(stop, _)| stop.ticks()).fold(0.0, f64::max);
        Self { from, command, stops, ticks }
    }

    /// Ticks from the end of the command until the arm is at rest.
    pub fn ticks_to_stop(&self) -> f64 {
        self.ticks
    }

    /// Where joint `j` comes to rest.
    pub fn end(&self, j: usize) -> f64 {
        self.command[j] + self.stops.get(j).map_or(0.0, |(stop, _)| stop.end())
    }
}

impl TickedMotion for StopMotion<'_> {
    fn ticks(&self) -> f64 {
        1.0 + self.ticks
    }

    fn write(&self, tick: f64, q: &mut [f64]) {
        if tick <= 1.0 {
            for (q, (from, command)) in q.iter_mut().zip(self.from.iter().zip(self.command)) {
                *q = from + tick * (command - from);
            }
            return;
        }
        let (before, share) = (tick.floor() - 1.0, tick.fract());
        for (j, q) in q.iter_mut().enumerate() {
            let stop = &self.stops[j].0;
            let here = stop.at(before);
            *q = self.command[j] + if share == 0.0 { here } else { here + share * (stop.at(before + 1.0) - here) };
        }
    }

    fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]) {
        // Between two ticks the motion is straight, but for the spline.
        let ticks = if to - from <= 1.0 { 0.0 } else { to - from };
        for (j, (stop, acceleration)) in self.stops.iter().enumerate() {
            let range = stop.range() + (self.command[j] - self.from[j]).abs();
            let spline = SPLINE * acceleration.min(range);
            off_line[j] = (acceleration * ticks * ticks / 8.0).min(range) + spline;
        }
    }
}
