//! Stream of targets: their ages, filters, and timeout.

use smallvec::smallvec;

use super::idle::Idle;
use super::repeated_targets::RepeatedTargets;
use super::target_filter::{RunningFilter, TargetFilter};
use crate::error::{Error, Result, require_finite, require_positive};
use crate::message::{Setting, message};
use crate::task::{NamedTask, Target, TargetRow, TargetSegment, Twist};

/// Longest extrapolation of a target (s), however old it is.
const LONGEST_AGE: f64 = 0.25;

/// Targets that arrive together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Arrival {
    /// Tasks of several tips, in the order of their targets; tips without a task are free. Empty for a robot with one tip.
    pub tips: Vec<NamedTask>,
    /// Target of each task.
    pub targets: TargetRow,
    /// Velocity of the target of the only tip (m/s), for rules that work with velocities.
    pub velocity: Option<[f64; 3]>,
    /// Time of measurement (s), on the clock of the session. `None` means the end of the tick.
    pub stamp: Option<f64>,
}

impl Arrival {
    /// Checks velocity and stamp of targets that arrive in a tick that ends at `time` (s).
    ///
    /// # Errors
    /// [`Error::NotFinite`] for a velocity or stamp that is not finite, [`Error::OutOfRange`] for a stamp after `time`.
    pub(super) fn check(&self, time: f64) -> Result<()> {
        if let Some(velocity) = &self.velocity {
            require_finite("velocity of the target", velocity, |i| format!("coordinate {}", ["x", "y", "z"][i]))?;
        }
        let Some(stamp) = self.stamp else { return Ok(()) };
        require_finite("stamp", &[stamp], |_| "value".into())?;
        if stamp > time * (1.0 + f64::EPSILON) {
            let expected = message![
                format!("at most {time}, the end of the tick (s) on the clock of the tracker ("),
                Setting::Clock,
                " advances by dt in each step; leave stamp out, or give the time of measurement on this clock)",
            ];
            return Err(Error::out_of_range("stamp", expected, stamp));
        }
        Ok(())
    }
}

impl From<Target> for Arrival {
    fn from(target: Target) -> Self {
        Self { targets: smallvec![target], ..Self::default() }
    }
}

impl FromIterator<(NamedTask, Target)> for Arrival {
    fn from_iter<T: IntoIterator<Item = (NamedTask, Target)>>(aims: T) -> Self {
        let (tips, targets) = aims.into_iter().unzip();
        Self { tips, targets, ..Self::default() }
    }
}

/// Targets that are ignored, as they are older than the last ones.
#[derive(Debug)]
pub(super) struct IgnoredTargets {
    pub targets: TargetRow,
    /// Why, for the message of the step.
    pub reason: Idle,
}

/// Outcome of the arrivals of a tick.
#[derive(Debug)]
pub(super) enum Taken {
    /// No targets, or the last ones again.
    Nothing,
    /// New targets, of this age (s).
    New(f64),
    Ignored(IgnoredTargets),
}

/// Targets of a session: one, or those of several tips, which arrive together.
#[derive(Debug)]
pub(super) struct TargetStream {
    filter: Option<TargetFilter>,
    /// Running filter of each target.
    filters: Vec<RunningFilter>,
    timeout: Option<f64>,
    /// Detector of repetitions, for rules that extrapolate.
    repeated: Option<RepeatedTargets>,
    last: Option<Arrival>,
    /// The last targets before filtering.
    received: TargetRow,
    /// Targets at the end of the previous tick, and their velocity.
    before: Option<(TargetRow, Option<[f64; 3]>)>,
    /// Whether they had moved in that tick.
    moved_before: bool,
    /// Times at which the last targets were measured and arrived (s).
    measured: f64,
    arrived: f64,
}

impl TargetStream {
    /// Stream without a target yet. `repeated` detects repeated targets.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a setting of the filter or a timeout that is not positive.
    pub fn new(filter: Option<TargetFilter>, timeout: Option<f64>, repeated: Option<RepeatedTargets>) -> Result<Self> {
        timeout.map_or(Ok(()), |timeout| require_positive("timeout", timeout))?;
        filter.map_or(Ok(()), |filter| filter.validate())?;
        let (filters, measured) = (vec![], f64::NEG_INFINITY);
        Ok(Self {
            filter,
            filters,
            timeout,
            repeated,
            last: None,
            received: TargetRow::new(),
            before: None,
            moved_before: false,
            measured,
            arrived: 0.0,
        })
    }

    /// Last targets, filtered; empty before the first.
    pub fn last(&self) -> &[Target] {
        self.last.as_ref().map_or(&[], |arrival| &arrival.targets)
    }

    /// Motion of the first target to its `end` during the last tick, of `dt` (s). Without a previous tick, the target is
    /// assumed to have moved with its velocity or, if that is unknown, to have stood still.
    pub fn motion(&self, end: Target, dt: f64) -> TargetSegment {
        let before = self.before.as_ref().and_then(|(targets, velocity)| Some((*targets.first()?, *velocity)));
        match (before, self.last.as_ref().and_then(|arrival| arrival.velocity)) {
            (Some((begin, before)), velocity) => {
                let velocities = before.zip(velocity).map(|(before, velocity)| [before, velocity]);
                TargetSegment { begin, end, velocities, dt }
            }
            (None, None) => TargetSegment { begin: end, end, velocities: None, dt },
            (None, Some(linear)) => {
                let begin = end.moved(&Twist { linear, angular: [0.0; 3] }, -dt);
                TargetSegment { begin, end, velocities: Some([linear; 2]), dt }
            }
        }
    }

    /// Whether a target has moved since the previous tick.
    pub fn moves(&self) -> bool {
        let both = self.before.as_ref().zip(self.last.as_ref());
        both.is_none_or(|((before, _), last)| *before != last.targets)
    }

    /// Whether the targets stand still, or have jumped there from rest: there is time to reach them.
    pub fn stand(&self) -> bool {
        self.before.is_none() || !self.moves() || !self.moved_before
    }

    /// Sets the targets at t = 0.
    pub fn place(&mut self, arrival: Arrival) {
        self.last = Some(arrival);
        self.keep_as_before();
    }

    /// Takes the [checked](Arrival::check) targets that arrived in the tick that ends at `time` (s).
    pub fn take(&mut self, mut arrival: Option<Arrival>, time: f64) -> Taken {
        let Some(Arrival { targets, stamp, .. }) = arrival.as_mut() else { return Taken::Nothing };
        let stamp = *stamp;
        let measured = stamp.unwrap_or(time);
        self.arrived = time;
        // Targets of an interrupted tick are replaced by the next ones.
        if measured < self.measured || stamp.is_some() && measured == self.measured {
            let repeats = measured == self.measured && self.received == *targets;
            if repeats {
                return Taken::Nothing;
            }
            let reason = Idle::Outdated { stamp: measured, last: self.measured };
            return Taken::Ignored(IgnoredTargets { targets: std::mem::take(targets), reason });
        }
        if stamp.is_none() && self.repeated.as_mut().is_some_and(|repeated| repeated.is_repetition(targets, time)) {
            return Taken::Nothing;
        }
        let interval = measured - self.measured;
        self.measured = measured;
        self.received.clone_from(targets);
        if let Some(filter) = self.filter.filter(|_| interval > 0.0) {
            self.filters.resize_with(targets.len(), || RunningFilter::new(filter));
            for (target, filter) in targets.iter_mut().zip(&mut self.filters) {
                *target = filter.filtered(target, interval);
            }
        }
        self.last = arrival;
        Taken::New((time - measured).clamp(0.0, LONGEST_AGE))
    }

    /// The timeout (s), if no target has arrived for longer at `time` (s).
    pub fn timed_out(&self, time: f64) -> Option<f64> {
        self.timeout.filter(|timeout| time - self.arrived > *timeout)
    }

    /// Ends the tick.
    pub fn accept(&mut self) {
        self.moved_before = self.before.is_some() && self.moves();
        self.keep_as_before();
    }

    fn keep_as_before(&mut self) {
        self.before = self.last.as_ref().map(|last| (TargetRow::from_slice(&last.targets), last.velocity));
    }

    /// Discards targets and filters, because the next targets belong to other tasks.
    pub fn begin_anew(&mut self) {
        (self.last, self.before, self.moved_before) = (None, None, false);
        self.filters.clear();
        self.expect_new();
    }

    /// Treats the next target as new, even if it equals the last one.
    pub fn expect_new(&mut self) {
        if let Some(repeated) = &mut self.repeated {
            repeated.forget();
        }
    }

    /// Forgets all targets, and restarts the clock at zero.
    pub fn clear(&mut self) {
        (self.measured, self.arrived) = (f64::NEG_INFINITY, 0.0);
        self.begin_anew();
    }
}
