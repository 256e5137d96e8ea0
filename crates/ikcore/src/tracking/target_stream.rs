//! Targets as they arrive: their ages, the filter, and the timeout.

use super::repeated_targets::RepeatedTargets;
use super::target_filter::{RunningFilter, TargetFilter};
use crate::error::{Error, Result, require_finite, require_positive};
use crate::task::Target;

/// A target is extrapolated over this time (s) at most, however old it is.
const LONGEST_AGE: f64 = 0.25;

/// A target that has arrived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// The target.
    pub target: Target,
    /// Its velocity (m/s), for rules that work with velocities.
    pub velocity: Option<[f64; 3]>,
    /// When it was measured (s), on the clock of the session. `None` means at the end of the tick.
    pub stamp: Option<f64>,
}

/// The targets of a session.
#[derive(Debug)]
pub(super) struct TargetStream {
    filter: Option<RunningFilter>,
    timeout: Option<f64>,
    /// For rules that extrapolate.
    repeated: Option<RepeatedTargets>,
    /// The last target and its velocity.
    last: Option<(Target, Option<[f64; 3]>)>,
    /// Those at the end of the previous tick.
    before: Option<(Target, Option<[f64; 3]>)>,
    /// When the last target was measured, and when it arrived (s).
    measured: f64,
    arrived: f64,
}

impl TargetStream {
    /// No target yet. `repeated` says which targets are no new ones.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a setting of the filter or a timeout that is not positive.
    pub fn new(filter: Option<TargetFilter>, timeout: Option<f64>, repeated: Option<RepeatedTargets>) -> Result<Self> {
        timeout.map_or(Ok(()), |timeout| require_positive("timeout", timeout))?;
        filter.map_or(Ok(()), |filter| filter.validate())?;
        let filter = filter.map(RunningFilter::new);
        Ok(Self { filter, timeout, repeated, last: None, before: None, measured: f64::NEG_INFINITY, arrived: 0.0 })
    }

    /// The last target, filtered.
    pub fn last(&self) -> Option<&Target> {
        self.last.as_ref().map(|(target, _)| target)
    }

    /// The velocity of the last target, if known (m/s).
    pub fn velocity(&self) -> Option<[f64; 3]> {
        self.last.and_then(|(_, velocity)| velocity)
    }

    /// Target and velocity at the end of the previous tick.
    pub fn before(&self) -> Option<&(Target, Option<[f64; 3]>)> {
        self.before.as_ref()
    }

    /// Sets the target at t = 0.
    pub fn place(&mut self, target: Target, velocity: Option<[f64; 3]>) {
        self.last = Some((target, velocity));
        self.before = self.last;
    }

    /// Takes the target that arrived in the tick that ends at `time` (s). Returns its age then (s); `None` without a target
    /// or for one that was measured before the last one or repeats it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for a velocity or stamp that is not finite, [`Error::OutOfRange`] for a stamp after `time`.
    pub fn take(&mut self, arrival: Option<Arrival>, time: f64) -> Result<Option<f64>> {
        let Some(Arrival { target, velocity, stamp }) = arrival else { return Ok(None) };
        if let Some(velocity) = &velocity {
            require_finite("velocity of the target", velocity, |i| format!("coordinate {}", ["x", "y", "z"][i]))?;
        }
        let measured = stamp.unwrap_or(time);
        require_finite("stamp", &[measured], |_| "value".into())?;
        if measured > time * (1.0 + f64::EPSILON) {
            let expected = format!("at most {time}, the end of the tick (s)");
            return Err(Error::out_of_range("stamp", &expected, measured));
        }
        self.arrived = time;
        // The target of a tick that was interrupted is replaced by the next one.
        if measured < self.measured || stamp.is_some() && measured == self.measured {
            return Ok(None);
        }
        if stamp.is_none() && self.repeated.as_mut().is_some_and(|repeated| repeated.is_repetition(&target, time)) {
            return Ok(None);
        }
        let interval = measured - self.measured;
        self.measured = measured;
        let target = match &mut self.filter {
            Some(filter) if interval > 0.0 => filter.filtered(&target, interval),
            _ => target,
        };
        self.last = Some((target, velocity));
        Ok(Some((time - measured).clamp(0.0, LONGEST_AGE)))
    }

    /// Whether no target has arrived for longer than the timeout, at `time` (s).
    pub fn timed_out(&self, time: f64) -> bool {
        self.timeout.is_some_and(|timeout| time - self.arrived > timeout)
    }

    /// Ends the tick.
    pub fn accept(&mut self) {
        self.before = self.last;
    }

    /// The next target is new, even if it equals the last one.
    pub fn expect_new(&mut self) {
        if let Some(repeated) = &mut self.repeated {
            repeated.forget();
        }
    }

    /// Forgets all targets; the clock starts at zero.
    pub fn clear(&mut self) {
        (self.last, self.before, self.measured, self.arrived) = (None, None, f64::NEG_INFINITY, 0.0);
        if let Some(filter) = &mut self.filter {
            filter.clear();
        }
        self.expect_new();
    }
}
