//! Progress of an arm held by obstacles towards its target.
//!
//! Commands near obstacles are found tick by tick, and two that undo each other would alternate for ever. An arm that obstacles
//! hold and that has come no nearer for a while therefore takes only commands that move its rest configuration nearer to the
//! target, by a fraction of the distance moved: the error at rest falls with each command. If even this fails for a time, the
//! arm stops. A target counts as new if its own motion, not that of the arm, has changed the error.

use super::step_context::StepContext;
use crate::limits::{Field, Limits};
use crate::math::vector::distance;
use crate::objective::Point;

/// Relative decrease of the error that counts as progress.
const NEARER: f64 = 0.02;
/// Smallest decrease of the error that counts as progress (m).
const LEAST: f64 = 2e-4;
/// Time for progress (s).
const PATIENCE: f64 = 0.3;

/// Relative decrease that counts while every command has to bring the rest configuration nearer.
const MUCH_NEARER: f64 = 0.2;
/// Time for it (s).
const LAST_PATIENCE: f64 = 0.5;

/// Time of a turn by 1 rad from rest to rest (s) beyond which an arm gets proportionally more time.
const QUICK_TURN: f64 = 2.5;
/// Largest factor on the time that an arm gets.
const MOST_PATIENT: f64 = 20.0;

/// Relative change of the error by which a target counts as new.
const NEW: f64 = 0.05;

/// Time for which an arm counts as held after obstacles last changed a command (s).
const HELD_FOR: f64 = 0.3;

/// Least decrease of the error per unit of motion of the rest configuration (m/rad).
const SLOPE: f64 = 0.02;

/// Commands admitted in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Admitted {
    /// All commands of the rule.
    #[default]
    All,
    /// Commands that bring the rest configuration nearer to the target.
    Approaching,
    /// Commands of the stop.
    Stopping,
}

/// Progress of an arm towards its target, which may move. Errors are square roots of the squared ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArmProgress {
    /// Time factor of this arm relative to a quick one.
    patience_factor: f64,
    admitted: Admitted,
    /// Error before the last command, to the target of that tick; `None` before the first.
    before: Option<f64>,
    /// Decrease of the error by commands since the arm last came nearer.
    progress_made: f64,
    /// Increase of the error by motion of the target since then.
    target_change: f64,
    /// Time elapsed since then (s).
    time_waited: f64,
    /// Time since obstacles last held the arm (s); `None` if they do not hold it.
    held_ago: Option<f64>,
    /// Whether obstacles were replaced since the arm began to come nearer.
    replaced: bool,
}

impl ArmProgress {
    /// Initial progress of an arm with these limits.
    pub fn new(limits: &Limits) -> Self {
        Self {
            patience_factor: patience_factor(limits),
            admitted: Admitted::All,
            before: None,
            progress_made: 0.0,
            target_change: 0.0,
            time_waited: 0.0,
            held_ago: None,
            replaced: false,
        }
    }

    /// Forgets all progress.
    pub fn restart(&mut self) {
        (self.before, self.held_ago) = (None, None);
        self.begin(Admitted::All);
    }

    /// Begins a tick of `dt` (s), with the errors after the last command: `after` to its own target, `now` to the new one.
    pub fn begin_tick(&mut self, [after, now]: [f64; 2], dt: f64) {
        let before = self.before.replace(now);
        self.progress_made += before.map_or(f64::INFINITY, |before| before - after);
        self.target_change += now - after;
        self.time_waited += dt / self.patience_factor;
        self.held_ago = self.held_ago.map(|ago| ago + dt).filter(|ago| *ago <= HELD_FOR);
        if self.held_ago.is_none() {
            self.admitted = Admitted::All;
        }
        let is_new = !(self.target_change.abs() <= NEW * after);
        match self.admitted {
            _ if is_new => self.begin(Admitted::All),
            Admitted::All if self.progress_made > (NEARER * after).max(LEAST) => self.begin(Admitted::All),
            Admitted::All if self.time_waited >= PATIENCE && self.held_ago.is_some() => {
                self.begin(Admitted::Approaching);
                self.replaced = false;
            }
            Admitted::Approaching if self.progress_made > MUCH_NEARER * after => self.begin(Admitted::Approaching),
            Admitted::Approaching if self.time_waited >= LAST_PATIENCE => self.begin(Admitted::Stopping),
            Admitted::All | Admitted::Approaching | Admitted::Stopping => {}
        }
    }

    fn begin(&mut self, admitted: Admitted) {
        (self.admitted, self.progress_made, self.target_change, self.time_waited) = (admitted, 0.0, 0.0, 0.0);
    }

    /// Records that obstacles were replaced.
    pub fn note_replaced(&mut self) {
        self.replaced = true;
    }

    /// Whether an unrestricted command has to bring the arm nearer to end the held state. This prevents two commands that undo
    /// each other from alternating; after a change of obstacles, the way may lead away from the target at first.
    pub fn is_freed_nearer(&self) -> bool {
        !self.replaced
    }

    /// Records that obstacles hold the arm.
    pub fn note_held(&mut self) {
        self.held_ago = Some(0.0);
    }

    /// Commands admitted in this tick.
    pub fn admitted(&self) -> Admitted {
        self.admitted
    }
}

/// Times as long as a quick arm that an arm with these limits takes.
pub(super) fn patience_factor(limits: &Limits) -> f64 {
    (time_of_turn(limits) / QUICK_TURN).clamp(1.0, MOST_PATIENT)
}

/// Approximate time in which the median joint turns by 1 rad (m) from rest to rest (s); locked joints do not count.
fn time_of_turn(limits: &Limits) -> f64 {
    let time = |j: usize| time_of_way(1.0, limits, j, 0.0);
    let mut times: Point = (0..limits.dof()).map(time).filter(|time| time.is_finite()).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}

/// Time in which joint `j` moves by `way` (rad, m) from rest to rest (s), at most, under its limits at `time` (s).
pub(super) fn time_of_way(way: f64, limits: &Limits, j: usize, time: f64) -> f64 {
    let limit = |field: Field| limits.field(field).map_or(f64::INFINITY, |profiles| profiles[j].at(time)).max(0.0);
    let [velocity, acceleration, jerk] = [Field::Velocity, Field::Acceleration, Field::Jerk].map(limit);
    way / velocity + 2.0 * (way / acceleration).sqrt() + (32.0 * way / jerk).cbrt()
}

/// Whether resting at `to` instead of `from` lowers the error by a fraction of the distance between them.
pub(super) fn is_nearer(context: &StepContext<'_>, from: &[f64], to: &[f64]) -> bool {
    let [before, after] = [from, to].map(|q| context.aims.assess(context.robot, q).score);
    let falls = before.value.sqrt() - after.value.sqrt();
    !context.aims.is_empty() && (after.solved || falls > SLOPE * distance(from, to))
}
