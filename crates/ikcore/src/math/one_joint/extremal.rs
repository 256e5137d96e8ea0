//! Extremal motions of one joint.

use super::acceleration_limited::AccelerationLimited;
use super::jerk_limited::JerkLimited;
use super::motion_state::{MotionState, Rates};
use super::phases::{Durations, Phases, Possible};

/// Motion between two states that maximises the displacement in a given duration, regardless of the final position.
#[derive(Debug, Clone, Copy)]
pub(super) enum Extremal {
    Jerk(JerkLimited),
    Acceleration(AccelerationLimited),
}

impl Extremal {
    pub(super) fn new(from: MotionState, to: MotionState, rates: Rates) -> Self {
        if rates.jerk.is_finite() {
            Self::Jerk(JerkLimited::new(from, to, rates))
        } else {
            Self::Acceleration(AccelerationLimited::new(from, to, rates))
        }
    }

    /// Returns the phases for a possible duration `t` (s).
    pub(super) fn phases(&self, t: f64) -> Phases {
        match self {
            Self::Jerk(extremal) => extremal.phases(t),
            Self::Acceleration(extremal) => extremal.phases(t),
        }
    }

    /// Returns the displacement in a possible duration `t` (s).
    pub(super) fn displacement(&self, t: f64) -> f64 {
        match self {
            Self::Jerk(extremal) => extremal.displacement(t),
            Self::Acceleration(extremal) => extremal.phases(t).displacement(),
        }
    }

    /// Returns intervals of possible durations (s), at most four, in order; the last is unbounded.
    pub(super) fn possible(&self) -> Possible {
        let mut found = Possible::new();
        match self {
            Self::Jerk(extremal) => extremal.possible(&mut found),
            Self::Acceleration(extremal) => extremal.possible(&mut found),
        }
        found
    }

    /// Returns durations (s) between which the displacement is monotone, as far as it is not known to rise.
    pub(super) fn critical_durations(&self) -> Durations {
        let mut found = Durations::new();
        match self {
            Self::Jerk(extremal) => extremal.critical_durations(&mut found),
            Self::Acceleration(extremal) => extremal.critical_durations(&mut found),
        }
        found
    }

    /// Whether every motion longer than `t` (s) goes farther.
    pub(super) fn rises_from(&self, t: f64) -> bool {
        match self {
            Self::Jerk(extremal) => extremal.rises_from(t),
            Self::Acceleration(extremal) => extremal.rises_from(t),
        }
    }

    /// Returns the shortest duration (s) in which the motion reaches the velocity limit; infinite without a limit.
    pub(super) fn full_speed_duration(&self) -> f64 {
        match self {
            Self::Jerk(extremal) => extremal.full_speed_duration(),
            Self::Acceleration(extremal) => extremal.full_speed_duration(),
        }
    }
}
