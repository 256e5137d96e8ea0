//! Whether an arm that obstacles hold still comes nearer to its target.
//!
//! Commands beside obstacles are found tick by tick, and two that undo each other would alternate for ever. An arm that obstacles hold and
//! that has come no nearer for a while therefore takes only commands after which its place of rest is nearer to the target, by a share of
//! how far that place moves: the error at rest falls with each of them. Where even that leads nowhere soon, the arm comes to rest.
//! The target counts as a new one where its motion, not that of the arm, has changed the error.

use super::wish::Wish;
use crate::math::vector::distance;

/// An arm comes nearer if its error falls by this fraction, and no less than this (m), within this time (s).
const NEARER: f64 = 0.01;
const LEAST: f64 = 2e-4;
const PATIENCE: f64 = 0.3;

/// Likewise if each command has to bring the place of rest nearer.
const MUCH_NEARER: f64 = 0.2;
const LAST_PATIENCE: f64 = 1.0;

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
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Progress {
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
}

impl Progress {
    /// Begins a tick of `dt` (s). The error is `after` the last command to its target, and `now` to the new one.
    pub fn begin_tick(&mut self, [after, now]: [f64; 2], dt: f64) {
        let before = self.before.replace(now);
        self.gained += before.map_or(f64::INFINITY, |before| before - after);
        self.news += now - after;
        self.waited += dt;
        self.held_ago = self.held_ago.map(|ago| ago + dt).filter(|ago| *ago <= HELD_FOR);
        if self.held_ago.is_none() {
            self.pace = Pace::Free;
        }
        let is_new = !(self.news.abs() <= NEW * after);
        match self.pace {
            _ if is_new => self.begin(Pace::Free),
            Pace::Free if self.gained > (NEARER * after).max(LEAST) => self.begin(Pace::Free),
            Pace::Free if self.waited >= PATIENCE && self.held_ago.is_some() => self.begin(Pace::Nearer),
            Pace::Nearer if self.gained > MUCH_NEARER * after => self.begin(Pace::Nearer),
            Pace::Nearer if self.waited >= LAST_PATIENCE => self.begin(Pace::Rest),
            Pace::Free | Pace::Nearer | Pace::Rest => {}
        }
    }

    fn begin(&mut self, pace: Pace) {
        (self.pace, self.gained, self.news, self.waited) = (pace, 0.0, 0.0, 0.0);
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

/// Whether an arm comes nearer to its target by resting at `to` instead of `from`, by a share of the way between them.
pub(super) fn is_nearer(wish: &Wish<'_>, from: &[f64], to: &[f64]) -> bool {
    wish.aim.as_ref().is_some_and(|aim| {
        let [before, after] = [from, to].map(|q| aim.assess(wish.robot, q).score);
        after.solved || before.value.sqrt() - after.value.sqrt() > SLOPE * distance(from, to)
    })
}
