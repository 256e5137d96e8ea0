//! All joints from one state to another in the same time.

use crate::error::Result;
use crate::math::one_joint::{JointProfile, MotionState, Rates, Transfer};
use crate::trajectory::{Trajectory, polynomial};

/// The profiles of all joints, of one duration.
#[derive(Debug, Clone)]
pub(crate) struct Synchronised {
    profiles: Vec<JointProfile>,
    duration: f64,
}

/// Relative difference below which durations count as equal.
const EQUAL: f64 = 1e-12;

impl Synchronised {
    /// Returns the fastest motion of all joints together; `None` if there is none.
    ///
    /// A joint may be unable to take just a little longer than its shortest time, since it would have to turn back; so the
    /// duration is raised until it is possible for every joint.
    pub(crate) fn fastest(transfers: &[Transfer]) -> Option<Self> {
        let mut duration = 0.0_f64;
        loop {
            let next = transfers.iter().fold(duration, |least, transfer| transfer.duration(least).max(least));
            let settled = next <= duration * (1.0 + EQUAL);
            duration = next;
            if settled {
                break;
            }
        }
        if duration.is_infinite() {
            return None;
        }
        Some(Self::of(transfers, duration))
    }

    /// A motion of this duration (s); `None` if it is not possible for every joint.
    pub(crate) fn lasting(transfers: &[Transfer], duration: f64) -> Option<Self> {
        let is_possible = |transfer: &Transfer| transfer.duration(duration) <= duration * (1.0 + EQUAL);
        transfers.iter().all(is_possible).then(|| Self::of(transfers, duration))
    }

    fn of(transfers: &[Transfer], duration: f64) -> Self {
        Self { profiles: transfers.iter().map(|transfer| transfer.motion(duration)).collect(), duration }
    }

    /// The stop of each joint as quickly as it can, from `from`; `None` if one cannot stop.
    pub(crate) fn stop(from: &[MotionState], rates: &[Rates]) -> Option<Self> {
        let stop = |(from, rates): (&MotionState, &Rates)| match *from {
            MotionState { v: 0.0, a: 0.0, .. } => Some(JointProfile::still(*from)),
            from => Transfer::to_velocity(from, MotionState::rest(from.q), rates),
        };
        let profiles = from.iter().zip(rates).map(stop).collect::<Option<Vec<_>>>()?;
        let duration = profiles.iter().map(|profile| profile.duration).fold(0.0, f64::max);
        let profiles = profiles.into_iter().map(|profile| profile.extended_to(duration)).collect();
        Some(Self { profiles, duration })
    }

    /// Duration (s).
    pub(crate) fn duration(&self) -> f64 {
        self.duration
    }

    /// The lowest and the highest position of each joint.
    pub(crate) fn ranges(&self) -> impl Iterator<Item = (f64, f64)> {
        self.profiles.iter().map(JointProfile::range)
    }

    /// The motion of joints of these names, as a trajectory with the knots of all profiles.
    ///
    /// # Errors
    /// None for a positive duration.
    pub(crate) fn trajectory(&self, joints: Vec<String>) -> Result<Trajectory> {
        let starts = |profile: &JointProfile| profile.segments.iter().map(|segment| segment.time).collect::<Vec<f64>>();
        let mut knots: Vec<f64> = self.profiles.iter().flat_map(starts).collect();
        knots.sort_unstable_by(f64::total_cmp);
        knots.push(self.duration);
        let mut coefficients = Vec::with_capacity((knots.len() - 1) * joints.len());
        for ends in knots.windows(2) {
            for profile in &self.profiles {
                let segment = profile.segment_at(0.5 * (ends[0] + ends[1]));
                let state = segment.state.after(segment.jerk, ends[0] - segment.time);
                coefficients.push(polynomial([state.q, state.v, 0.5 * state.a, segment.jerk / 6.0]));
            }
        }
        Trajectory::from_phases(joints, knots, coefficients)
    }
}
