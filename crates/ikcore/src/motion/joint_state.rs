//! Steps and changes of all joints at the end of a tick.

use crate::objective::Point;

/// The motion of all joints in the last tick: displacements per tick, and their change since the tick before (rad, m).
#[derive(Debug, Clone, Default)]
pub(crate) struct JointState {
    /// Displacement of each joint in the last tick.
    pub step: Point,
    /// Difference of the step to the tick before.
    pub change: Point,
}

impl JointState {
    /// The state of `n` joints at rest.
    pub fn at_rest(n: usize) -> Self {
        Self { step: Point::from_elem(0.0, n), change: Point::from_elem(0.0, n) }
    }

    /// Moves on to a tick with these displacements.
    pub fn advance(&mut self, step: impl Iterator<Item = f64>) {
        for ((kept, change), step) in self.step.iter_mut().zip(&mut self.change).zip(step) {
            *change = step - *kept;
            *kept = step;
        }
    }

    /// Writes the displacements of the first tick of the fastest stop.
    pub fn brake(&self, braking: &[super::Braking], out: &mut [f64]) {
        let states = self.step.iter().zip(&self.change).zip(braking);
        for (out, ((step, change), braking)) in out.iter_mut().zip(states) {
            *out = step + braking.first_change(*step, *change);
        }
    }

    /// Number of ticks until the fastest stop of all joints ends.
    pub fn ticks_to_stop(&self, braking: &[super::Braking]) -> f64 {
        let states = self.step.iter().zip(&self.change).zip(braking);
        states.map(|((step, change), braking)| braking.stop(*step, *change).ticks).fold(0.0, f64::max)
    }
}
