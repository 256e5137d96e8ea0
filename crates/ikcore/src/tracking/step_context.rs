//! Inputs of one tracking step.

use super::command_and_stop::CommandAndStop;
use super::constrained_step::{StepRequest, Towards};
use super::limited_state::LimitedState;
use crate::limits::{LimitAt, Limits, TickBox};
use crate::objective::{Bounds, Point};
use crate::robot::Robot;
use crate::task::Aims;

/// State of an arm at the start of a tick, its targets, and the limits of its next command.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepContext<'a> {
    pub robot: &'a Robot,
    /// The accepted configuration.
    pub q: &'a [f64],
    /// Tasks and targets; empty before the first target.
    pub aims: Aims<'a>,
    /// Box of the next command, and the limits that define it.
    pub tick_box: &'a TickBox,
    pub limits: &'a Limits,
    pub limit_at: LimitAt,
    /// Steps, changes and limits of an arm under acceleration or jerk limits.
    pub limited: Option<&'a LimitedState>,
    /// Squared error accepted in the previous tick, if any.
    pub last_value: Option<f64>,
    /// Start of the tick, and its length (s).
    pub time: f64,
    pub dt: f64,
}

impl<'a> StepContext<'a> {
    /// Square roots of the squared errors at `q`: to the targets of the last tick, and to the new ones.
    pub fn errors(&self) -> Option<[f64; 2]> {
        let after = self.last_value.filter(|value| value.is_finite() && !self.aims.is_empty())?;
        Some([after, self.aims.assess(self.robot, self.q).score.value].map(f64::sqrt))
    }

    /// Lower and upper ends of the box.
    pub fn ends(&self) -> [&'a [f64]; 2] {
        self.tick_box.bounds.ends()
    }

    /// Position limits of the tick, with the weights of the joints.
    pub fn positions(&self) -> Bounds {
        let range = |j: usize| self.limits.position_range(j, self.time, self.time + self.dt).into();
        Bounds::from_ranges((0..self.q.len()).map(range)).weighted(self.tick_box.bounds.weights().cloned())
    }

    /// Request for a step in the box.
    pub fn request(&self, towards: Towards) -> StepRequest<'a> {
        StepRequest { robot: self.robot, aims: self.aims, ends: self.ends(), towards }
    }

    /// First command of the fastest stop.
    pub fn braking(&self) -> Point {
        let mut brake = self.limited.map_or_else(|| Point::from_slice(self.q), |limited| limited.stopping(self.q));
        self.tick_box.bounds.clip(&mut brake);
        brake
    }

    /// Motion that takes the command `q` and then stops.
    pub fn stop_after<'m>(&self, q: &'m [f64]) -> CommandAndStop<'m>
    where
        'a: 'm,
    {
        CommandAndStop::new(self.q, q, self.limited.map(|limited| (limited.braking(), limited.state())))
    }
}
