//! The motion between the commands of a tracker, by basis functions of its own.

use ikcore::limits::Field;
use ikcore::tracking::Session;

/// Configurations that are looked at in each tick.
const SAMPLES: u32 = 8;

/// The curve that the drives execute: the uniform cubic B-spline of the commands under acceleration or jerk limits, otherwise straight
/// lines from one to the next.
pub struct ExecutedCurve {
    commands: [Vec<f64>; 4],
    /// Ticks since the start.
    ticks: f64,
    is_spline: bool,
}

impl ExecutedCurve {
    /// Of an arm at rest, before its first command.
    pub fn of(session: &Session) -> Self {
        let is_spline = [Field::Acceleration, Field::Jerk].iter().any(|field| session.limits().field(*field).is_some());
        Self { commands: std::array::from_fn(|_| session.q().to_vec()), ticks: 0.0, is_spline }
    }

    /// Times (ticks) and configurations of the last tick that `command` completes: of a spline it is the one before.
    pub fn after(&mut self, command: &[f64]) -> impl Iterator<Item = (f64, Vec<f64>)> {
        self.sampled_after(command, SAMPLES)
    }

    /// [`after`](Self::after) at this many times.
    pub fn sampled_after(&mut self, command: &[f64], samples: u32) -> impl Iterator<Item = (f64, Vec<f64>)> {
        self.commands.rotate_left(1);
        self.commands[3] = command.to_vec();
        self.ticks += 1.0;
        let begin = self.ticks - if self.is_spline { 2.0 } else { 1.0 };
        (1..=samples).map(move |i| {
            let s = f64::from(i) / f64::from(samples);
            let weights = if self.is_spline { cubic_basis(s) } else { [0.0, 0.0, 1.0 - s, s] };
            let at = |j: usize| (0..4).map(|k| weights[k] * self.commands[k][j]).sum();
            (begin + s, (0..command.len()).map(at).collect())
        })
    }
}

/// The basis functions of a uniform cubic B-spline at fraction `s` of a segment.
fn cubic_basis(s: f64) -> [f64; 4] {
    let r = 1.0 - s;
    [r.powi(3), 3.0 * s.powi(3) - 6.0 * s.powi(2) + 4.0, 3.0 * r.powi(3) - 6.0 * r.powi(2) + 4.0, s.powi(3)]
        .map(|b| b / 6.0)
}
