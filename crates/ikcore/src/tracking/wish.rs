//! What a command is found from.

use super::limited_motion::LimitedMotion;
use super::tick_aim::TickAim;
use crate::limits::{LimitAt, Limits, TickBox};
use crate::robot::Robot;

/// The circumstances of a tick.
pub(super) struct Wish<'a> {
    pub robot: &'a Robot,
    pub q: &'a [f64],
    /// The box of the tick.
    pub tick_box: &'a TickBox,
    pub limits: &'a Limits,
    pub limit_at: LimitAt,
    /// Under acceleration or jerk limits.
    pub limited: Option<&'a LimitedMotion>,
    /// None before the first target.
    pub aim: Option<TickAim<'a>>,
    /// Root of the squared error at `q` to the target of the last tick; None before the first.
    pub error_after: Option<f64>,
    /// Start of the tick, and its length (s).
    pub time: f64,
    pub dt: f64,
}

impl Wish<'_> {
    /// Root of the squared error at `q`; None before the first target.
    pub fn error(&self) -> Option<f64> {
        self.aim.as_ref().map(|aim| aim.assess(self.robot, self.q).score.value.sqrt())
    }

    /// The lower ends of the box.
    pub fn lower(&self) -> &[f64] {
        self.tick_box.bounds.lower()
    }

    /// The upper ends of the box.
    pub fn upper(&self) -> &[f64] {
        self.tick_box.bounds.upper()
    }
}
