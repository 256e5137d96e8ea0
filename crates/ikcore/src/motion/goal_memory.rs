//! Memory of a noisy goal: the number of samples to average.
//!
//! At rest, it is large enough to keep the accelerations and jerks caused by noise small. A goal that moves in a way
//! that such an average cannot follow is met late, always on the same side: then fewer.

use super::noise_level::root_mean_square;
use crate::objective::Point;

/// Standard deviation of the acceleration that noise may cause, as a fraction of the acceleration limit: this times the
/// cube root of the noise relative to the way in which a joint gets to full speed. The cube root is how the shaking of
/// time-optimal control grows.
const SHAKE: f64 = 0.023;

/// Standard deviation of the jerk that the noise of single samples may cause, in the same form.
const JERK_SHAKE: f64 = 0.12;

/// Gain of noise when a goal is followed with a memory of m samples: this over m^2.5 in the acceleration, over m^3.5 in
/// the jerk.
const AMPLIFIED: f64 = 5.0;

/// Smallest cube root: that of rounding, which is no noise to average.
const SMALLEST_ROOT: f64 = 1e-4;

/// Smallest memory (samples) that averages; below it single samples are followed.
pub(super) const NOISELESS: f64 = 2.0;

/// Mean surprise that counts as a delay, as a multiple of that of a goal that is followed well.
const DELAYED: f64 = 2.4;

/// Factor on the memory per sample, with a delay.
const SHRINKS: f64 = 0.9;
/// Factor on the memory per sample, without a delay.
const GROWS: f64 = 1.03;

/// Smallest fraction of the memory at rest.
const SHORTEST: f64 = 0.15;

/// Requirements on a memory.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circumstances {
    /// Root mean square of the noise, in changes.
    pub noise: f64,
    /// Ticks between samples, and from the sample to the end of the tick.
    pub interval: f64,
    pub age: f64,
    /// Fraction of the largest change that may change in a tick.
    pub jerk_fraction: f64,
    /// Mean square of the inverse of the ticks that a joint takes to full speed.
    pub quickness: f64,
}

/// A memory.
#[derive(Debug, Clone)]
pub(super) struct GoalMemory {
    /// Samples to remember.
    samples: f64,
    /// Samples to remember at rest.
    at_rest: f64,
    /// Mean surprise over the memory, in changes.
    drift: Point,
}

impl GoalMemory {
    pub fn new(n: usize) -> Self {
        Self { samples: 1.0, at_rest: 1.0, drift: Point::from_elem(0.0, n) }
    }

    /// Samples to remember; 1 without noise.
    pub fn samples(&self) -> f64 {
        self.samples
    }

    /// Adapts to a sample that differs by `surprise` from the expected one; infinite `scales` count as zeros.
    pub fn adapt(&mut self, surprise: impl Iterator<Item = f64>, scales: &[f64], circumstances: &Circumstances) {
        self.at_rest = circumstances.memory_at_rest();
        if self.at_rest <= NOISELESS || self.samples < NOISELESS {
            self.samples = self.at_rest;
            return;
        }
        let fraction = 2.0 / (self.samples + 1.0);
        self.drift.iter_mut().zip(surprise).for_each(|(drift, surprise)| *drift += fraction * (surprise - *drift));
        let usual = circumstances.noise * (fraction / (2.0 - fraction)).sqrt();
        let delayed = root_mean_square(self.drift.iter().copied(), scales) > DELAYED * usual;
        let shortest = NOISELESS.max(SHORTEST * self.at_rest);
        self.samples = (self.samples * if delayed { SHRINKS } else { GROWS }).clamp(shortest, self.at_rest);
    }

    /// Starts with the memory at rest.
    pub fn restart(&mut self) {
        self.samples = self.at_rest;
        self.drift.fill(0.0);
    }
}

impl Circumstances {
    /// Returns the number of samples to remember so that noise takes a small fraction of the limits.
    fn memory_at_rest(&self) -> f64 {
        let Self { noise, interval, age, jerk_fraction, quickness } = *self;
        let allowed = (noise * quickness).cbrt().clamp(SMALLEST_ROOT, 1.0);
        let seen = AMPLIFIED * noise * (1.0 + age / interval) / interval.powi(2);
        if seen == 0.0 {
            return 1.0;
        }
        let power = |ratio: f64, exponent: f64| if ratio > 1.0 { ratio.powf(exponent) } else { 1.0 };
        let for_acceleration = power(seen / (SHAKE * allowed), 0.4);
        let for_jerk = power(seen / (JERK_SHAKE * allowed * jerk_fraction * interval), 2.0 / 7.0);
        for_acceleration.max(for_jerk)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The memory after `count` samples with this surprise.
    fn memory(surprise: impl Fn(usize) -> f64, count: usize) -> f64 {
        let circumstances =
            Circumstances { noise: 10.0, interval: 1.0, age: 0.0, jerk_fraction: f64::INFINITY, quickness: 4e-5 };
        let mut memory = GoalMemory::new(1);
        for i in 0..count {
            memory.adapt(std::iter::once(surprise(i)), &[1.0], &circumstances);
        }
        memory.samples()
    }

    #[test]
    fn a_delay_shortens_the_memory() {
        let long = memory(|i| if i % 2 == 0 { 10.0 } else { -10.0 }, 100);
        assert!(long > 15.0, "{long}");
        assert!((memory(|_| 10.0, 100) / long - SHORTEST).abs() < 1e-12);
        let recovered = memory(|i| if i < 100 { 10.0 } else { 10.0 * f64::from(i as i32 % 2 * 2 - 1) }, 300);
        assert!((recovered / long - 1.0).abs() < 1e-12);
    }

    #[test]
    fn without_noise_one_sample_is_remembered() {
        let circumstances = Circumstances { noise: 0.0, interval: 1.0, age: 0.0, jerk_fraction: 0.1, quickness: 0.0 };
        assert_eq!(circumstances.memory_at_rest(), 1.0);
    }
}
