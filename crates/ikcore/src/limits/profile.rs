//! A limit as a function of time, with its extremes over an interval.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_finite, require_positive};
use crate::math::comparison::larger;
use crate::math::vector::between;

/// mean + amplitude sin(angular_frequency t + phase): eq. (7) of Cheng et al. (2020), its sign corrected.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sinusoid {
    /// The paper's H (rad/s).
    pub mean: f64,
    /// The paper's W (rad/s).
    pub amplitude: f64,
    /// The paper's omega (rad/s of the oscillation).
    pub angular_frequency: f64,
    /// Phase at t = 0 (rad).
    pub phase: f64,
}

impl Sinusoid {
    /// The value at `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        self.mean + self.amplitude * (self.angular_frequency * t + self.phase).sin()
    }

    /// (time, value) of its largest (`sign` 1) or smallest value (-1) over \[`from`, `to`\] (s).
    fn extreme(&self, sign: f64, from: f64, to: f64) -> (f64, f64) {
        let Self { mean, amplitude, angular_frequency, phase } = *self;
        // In units of turns, so that peaks are at integers; without divisions, because this runs in every tick.
        let quarter = 0.25 * sign * amplitude.signum();
        let turns = |t: f64| (angular_frequency * t + phase) * (1.0 / TAU) - quarter;
        let (begin, end) = (turns(from), turns(to));
        let (low, high) = if begin <= end { (begin, end) } else { (end, begin) };
        let peak = low.ceil();
        if peak <= high {
            let time = (TAU * (peak + quarter) - phase) / angular_frequency;
            return (larger(time, from).min(to), mean + sign * amplitude.abs());
        }
        // There is only one valley between two peaks, so the end nearer to its peak is the higher one.
        let low_is_higher = low - (peak - 1.0) < peak - high;
        let higher = if low_is_higher == (begin <= end) { from } else { to };
        (higher, self.at(higher))
    }
}

/// A limit of one joint over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Profile {
    /// Constant.
    Constant(f64),
    /// A sinusoid.
    Sinusoid(Sinusoid),
    /// Values `step` seconds apart from t = 0, with linear interpolation; the last one is held. Between a finite and an infinite
    /// value the finite one holds.
    Sampled {
        /// Time between values (s).
        step: f64,
        /// The values.
        values: Vec<f64>,
    },
}

impl Profile {
    /// The value at `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Sinusoid(sinusoid) => sinusoid.at(t),
            Self::Sampled { step, values } => {
                let last = values.len() - 1;
                let place = (t / step).clamp(0.0, last as f64);
                let (below, fraction) = (place as usize, place.fract());
                if fraction == 0.0 { values[below] } else { joined(values[below], values[below + 1], fraction) }
            }
        }
    }

    /// The smallest value from each time on, as a profile that never falls; between samples it may be a little lower.
    pub(crate) fn lowest_ahead(&self) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(*value),
            Self::Sinusoid(sinusoid) => Self::Constant(sinusoid.mean - sinusoid.amplitude.abs()),
            Self::Sampled { step, values } => {
                let mut values = values.clone();
                let mut smallest = f64::INFINITY;
                for value in values.iter_mut().rev() {
                    smallest = smallest.min(*value);
                    *value = smallest;
                }
                Self::Sampled { step: *step, values }
            }
        }
    }

    /// (time, value) of the smallest value over \[`from`, `to`\] (s).
    #[inline]
    pub fn smallest(&self, from: f64, to: f64) -> (f64, f64) {
        match self {
            // Fast path: most limits are constant, and a control loop calls this some twenty times a tick.
            Self::Constant(value) => (from, *value),
            _ => self.extreme(-1.0, from, to),
        }
    }

    /// (time, value) of the largest value over \[`from`, `to`\] (s).
    #[inline]
    pub fn largest(&self, from: f64, to: f64) -> (f64, f64) {
        match self {
            Self::Constant(value) => (from, *value),
            _ => self.extreme(1.0, from, to),
        }
    }

    /// (time, value) of the largest (`sign` 1) or smallest (-1) value. For samples it is at a sample or at an end of
    /// the interval.
    fn extreme(&self, sign: f64, from: f64, to: f64) -> (f64, f64) {
        match self {
            Self::Constant(value) => (from, *value),
            Self::Sinusoid(sinusoid) => sinusoid.extreme(sign, from, to),
            Self::Sampled { step, values } => {
                let first = (from / step).ceil().max(0.0) as usize;
                let last = ((to / step).floor() as usize).min(values.len() - 1);
                let samples = (first..=last).map(|i| (i as f64 * step, values[i]));
                let higher =
                    |best: (f64, f64), (t, value)| if sign * value > sign * best.1 { (t, value) } else { best };
                std::iter::once((to, self.at(to))).chain(samples).fold((from, self.at(from)), higher)
            }
        }
    }

    /// Checks that there is no NaN, and that sinusoids are finite; `what` names the profile, e.g. "velocity limit of
    /// joint 'elbow'".
    pub(super) fn validate(&self, what: &str) -> Result<()> {
        let no_number = |value: f64, place: &str| Error::out_of_range(format!("{what}{place}"), "a number", value);
        match self {
            Self::Constant(value) if value.is_nan() => Err(no_number(*value, "")),
            Self::Constant(_) => Ok(()),
            Self::Sinusoid(Sinusoid { mean, amplitude, angular_frequency, phase }) => {
                let parts = [*mean, *amplitude, *angular_frequency, *phase];
                require_finite(what, &parts, |i| ["mean", "amplitude", "angular frequency", "phase"][i].into())
            }
            Self::Sampled { values, .. } if values.is_empty() => {
                Err(Error::WrongLength { what: what.into(), expected: "at least 1 sample".into(), got: 0 })
            }
            Self::Sampled { step, values } => {
                require_positive(&format!("time between samples of the {what}"), *step)?;
                match values.iter().position(|value| value.is_nan()) {
                    Some(i) => Err(no_number(values[i], &format!(" at t = {} s", i as f64 * step))),
                    None => Ok(()),
                }
            }
        }
    }
}

/// The value at `fraction` of the way from one sample to the next. Next to a sample without a limit the finite one holds up
/// to it, because no straight line leads to infinity.
fn joined(before: f64, after: f64, fraction: f64) -> f64 {
    match (before.is_finite(), after.is_finite()) {
        (true, true) => between(before, after, fraction),
        (false, true) => after,
        (_, false) => before,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn dense_minimum(profile: &Profile, from: f64, to: f64) -> f64 {
        (0..=20_000).map(|i| profile.at(from + (to - from) * f64::from(i) / 20_000.0)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn infinite_samples_lift_the_limit_at_their_times_only() {
        let open = Profile::Sampled { step: 0.5, values: vec![f64::INFINITY; 3] };
        assert_eq!(
            (open.at(0.2), open.at(0.5), open.smallest(0.1, 0.4).1),
            (f64::INFINITY, f64::INFINITY, f64::INFINITY)
        );
        let opening = Profile::Sampled { step: 0.5, values: vec![1.0, 2.0, f64::INFINITY, f64::INFINITY, 3.0] };
        assert_eq!([0.25, 0.75, 1.0, 1.25, 1.75].map(|t| opening.at(t)), [1.5, 2.0, f64::INFINITY, f64::INFINITY, 3.0]);
        assert_eq!(opening.smallest(0.6, 0.9).1, 2.0);
    }

    proptest! {
        #[test]
        fn smallest_of_a_sinusoid_is_that_of_dense_sampling(
            mean in -1.0..1.0, amplitude in -1.0..1.0, angular_frequency in -9.0..9.0, phase in -7.0..7.0,
            from in 0.0..5.0, length in 0.0..3.0,
        ) {
            let profile = Profile::Sinusoid(Sinusoid { mean, amplitude, angular_frequency, phase });
            let (time, value) = profile.smallest(from, from + length);
            let dense = dense_minimum(&profile, from, from + length);
            prop_assert!(value <= dense + 1e-12 && dense - value < 1e-5, "{value} {dense}");
            let mirrored = Profile::Sinusoid(Sinusoid { mean: -mean, amplitude: -amplitude, angular_frequency, phase });
            prop_assert!((mirrored.largest(from, from + length).1 + value).abs() < 1e-12);
            prop_assert!((from..=from + length).contains(&time));
            prop_assert!((profile.at(time) - value).abs() < 1e-9);
        }

        #[test]
        fn samples_are_joined_by_straight_lines(values in prop::collection::vec(0.0..1.0, 2..8), from in 0.0..1.0, length in 0.0..1.0) {
            let profile = Profile::Sampled { step: 0.25, values: values.clone() };
            let (_, value) = profile.smallest(from, from + length);
            let dense = dense_minimum(&profile, from, from + length);
            prop_assert!(value <= dense + 1e-12 && dense - value < 1e-3);
            prop_assert_eq!(profile.at(0.25), values[1]);
            prop_assert_eq!(profile.at(99.0), values[values.len() - 1]);
        }
    }
}
