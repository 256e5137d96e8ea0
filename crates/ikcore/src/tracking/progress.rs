//! Progress of an arm held by obstacles towards its target.
//!
//! Commands beside obstacles are found tick by tick, and two that undo each other would alternate for ever. An arm that obstacles hold and
//! that has come no nearer for a while therefore takes only commands after which its place of rest is nearer to the target, by a fraction of
//! how far that place moves: the error at rest falls with each of them. Where even that leads nowhere soon, the arm comes to rest.
//! The target counts as a new one where its motion, not that of the arm, has changed the error.

use super::step_context::StepContext;
use crate::limits::{Field, Limits};
use crate::math::vector::distance;
use crate::objective::Point;

/// An arm comes nearer if its error falls by this fraction, and no less than this (m), within this time (s).
const NEARER: f64 = 0.02;
const LEAST: f64 = 2e-4;
const PATIENCE: f64 = 0.3;

/// Likewise if each command has to bring the place of rest nearer.
const MUCH_NEARER: f64 = 0.2;
const LAST_PATIENCE: f64 = 0.5;

/// Slow arms get more time: in proportion to a turn by 1 rad from rest to rest beyond this (s), up to a factor.
const QUICK_TURN: f64 = 2.5;
const MOST_PATIENT: f64 = 20.0;

/// A target that changes the error by this fraction is a new one.
const NEW: f64 = 0.05;

/// Obstacles hold an arm for this long (s) after they have last changed a command.
const HELD_FOR: f64 = 0.3;

/// Least decrease of the error for each unit by which the place of rest moves (m/rad).
const SLOPE: f64 = 0.02;

/// Which commands an arm takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Pace {
    /// Those that its rule wants.
    #[default]
    Free,
    /// Those that bring the place of rest nearer to the target.
    Nearer,
    /// Those of its stop.
    Rest,
}

/// The progress of an arm towards its target, which may move. Errors are roots of squared ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArmProgress {
    /// By how much more time than a quick arm this one gets.
    slower: f64,
    pace: Pace,
    /// Error before the last command, to the target of that tick; `None` before the first.
    before: Option<f64>,
    /// By how much commands have lowered the error since the arm last came nearer.
    gained: f64,
    /// By how much the motion of the target has raised it.
    news: f64,
    /// Time since then (s).
    waited: f64,
    /// Time since obstacles last held the arm (s); `None` if they do not hold it.
    held_ago: Option<f64>,
    /// Whether obstacles were given anew since the arm began to come nearer.
    replaced: bool,
}

impl ArmProgress {
    /// Of an arm with these limits.
    pub fn new(limits: &Limits) -> Self {
        let slower = (time_of_turn(limits) / QUICK_TURN).clamp(1.0, MOST_PATIENT);
        Self {
            slower,
            pace: Pace::Free,
            before: None,
            gained: 0.0,
            news: 0.0,
            waited: 0.0,
            held_ago: None,
            replaced: false,
        }
    }

    /// Forgets what the arm gained.
    pub fn restart(&mut self) {
        (self.before, self.held_ago) = (None, None);
        self.begin(Pace::Free);
    }

    /// Begins a tick of `dt` (s). The error is `after` the last command to its target, and `now` to the new one.
    pub fn begin_tick(&mut self, [after, now]: [f64; 2], dt: f64) {
        let before = self.before.replace(now);
        self.gained += before.map_or(f64::INFINITY, |before| before - after);
        self.news += now - after;
        self.waited += dt / self.slower;
        self.held_ago = self.held_ago.map(|ago| ago + dt).filter(|ago| *ago <= HELD_FOR);
        if self.held_ago.is_none() {
            self.pace = Pace::Free;
        }
        let is_new = !(self.news.abs() <= NEW * after);
        match self.pace {
            _ if is_new => self.begin(Pace::Free),
            Pace::Free if self.gained > (NEARER * after).max(LEAST) => self.begin(Pace::Free),
            Pace::Free if self.waited >= PATIENCE && self.held_ago.is_some() => {
                self.begin(Pace::Nearer);
                self.replaced = false;
            }
            Pace::Nearer if self.gained > MUCH_NEARER * after => self.begin(Pace::Nearer),
            Pace::Nearer if self.waited >= LAST_PATIENCE => self.begin(Pace::Rest),
            Pace::Free | Pace::Nearer | Pace::Rest => {}
        }
    }

    fn begin(&mut self, pace: Pace) {
        (self.pace, self.gained, self.news, self.waited) = (pace, 0.0, 0.0, 0.0);
    }

    /// Obstacles are given anew.
    pub fn note_replaced(&mut self) {
        self.replaced = true;
    }

    /// Whether a command that nothing holds back must bring an arm nearer to set it free. Otherwise, of two that undo each other, one
    /// would; where obstacles have changed, the way may lead away from the target at first.
    pub fn is_freed_nearer(&self) -> bool {
        !self.replaced
    }

    /// Obstacles hold the arm.
    pub fn note_held(&mut self) {
        self.held_ago = Some(0.0);
    }

    /// Which commands the arm takes in this tick.
    pub fn pace(&self) -> Pace {
        self.pace
    }
}

/// About the time in which the middle one of the joints turns by 1 rad (m) from rest to rest (s); locked joints do not count.
fn time_of_turn(limits: &Limits) -> f64 {
    let limit = |field: Field, j: usize| limits.field(field).map_or(f64::INFINITY, |profiles| profiles[j].at(0.0));
    let time = |j: usize| {
        let [velocity, acceleration, jerk] =
            [Field::Velocity, Field::Acceleration, Field::Jerk].map(|field| limit(field, j).max(0.0));
        1.0 / velocity + 2.0 * (1.0 / acceleration).sqrt() + (32.0 / jerk).cbrt()
    };
    let mut times: Point = (0..limits.dof()).map(time).filter(|time| time.is_finite()).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}

/// Whether an arm comes nearer to its target by resting at `to` instead of `from`, by a fraction of the way between them.
pub(super) fn is_nearer(context: &StepContext<'_>, from: &[f64], to: &[f64]) -> bool {
    let [before, after] = [from, to].map(|q| context.aims.assess(context.robot, q).score);
    let falls = before.value.sqrt() - after.value.sqrt();
    !context.aims.is_empty() && (after.solved || falls > SLOPE * distance(from, to))
}
