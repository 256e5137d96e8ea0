//! The noise of a sequence of samples.
//!
//! A smooth motion is nearly a parabola over four samples and even more nearly a cubic over five, so the difference between
//! a sample and the polynomial through those before it is noise. For noise both differences say the same; for a motion that
//! is less smooth than expected one of them is smaller. The medians over a window ignore jumps.

use crate::objective::Point;

/// Number of samples that determine a parabola.
const PARABOLA: usize = 3;
/// Number of samples that determine a cubic.
const CUBIC: usize = 4;

/// Window of the medians. A jump spoils four differences to the parabola, which is less than half.
const WINDOW: usize = 9;

/// Median of the absolute value of a normal variable with standard deviation 1.
const MEDIAN_OF_NORMAL: f64 = 0.6745;

/// Ratio of a median to the level from which on it is the new level; smaller medians are averaged.
const RISE: f64 = 3.0;

/// Samples over which the level is averaged.
const AVERAGED: f64 = 50.0;

/// A running estimate of the standard deviation of noise.
#[derive(Debug, Clone)]
pub(super) struct NoiseLevel {
    /// The last samples and their times, oldest first in a ring.
    samples: [Point; CUBIC],
    times: [f64; CUBIC],
    count: usize,
    /// Differences to parabolas and cubics in the window; zero until it is full, so that a jump at the start is not taken
    /// for noise.
    differences: [[f64; WINDOW]; 2],
    level: f64,
    /// Fraction of the squared differences in each entry.
    fractions: Point,
}

impl NoiseLevel {
    pub fn new() -> Self {
        let samples = std::array::from_fn(|_| Point::new());
        Self {
            samples,
            times: [0.0; CUBIC],
            count: 0,
            differences: [[0.0; WINDOW]; 2],
            level: 0.0,
            fractions: Point::new(),
        }
    }

    /// Root mean square over the entries of the standard deviation of the noise, in the scales of `add`.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Whether there have been enough samples.
    pub fn is_known(&self) -> bool {
        self.count >= CUBIC + WINDOW
    }

    /// Standard deviation of the noise of entry `j`; 0 before the first sample.
    pub fn level_of(&self, j: usize) -> f64 {
        self.fractions.get(j).map_or(0.0, |fraction| self.level * (self.fractions.len() as f64 * fraction).sqrt())
    }

    /// Standard deviation that the noise of entry `j` may have while it is unknown: the mean of the differences so far. 0 once it is known.
    pub fn suspected_of(&self, j: usize) -> f64 {
        if self.is_known() || self.count <= CUBIC {
            return 0.0;
        }
        let seen = [PARABOLA, CUBIC].map(|first| (self.count - first).min(WINDOW) as f64);
        let mean = |kind: usize| self.differences[kind].iter().sum::<f64>() / seen[kind];
        let fraction = self.fractions.get(j).copied().unwrap_or_default();
        mean(0).min(mean(1)) * (self.fractions.len() as f64 * fraction).sqrt()
    }

    /// Adds a sample at `time`; entries are measured in units of `scales`.
    pub fn add(&mut self, sample: &[f64], time: f64, scales: &[f64]) {
        let count = self.count;
        let slot = |ago: usize| (count + CUBIC - ago) % CUBIC;
        let latest: [usize; CUBIC] = std::array::from_fn(|i| slot(i + 1));
        if count >= PARABOLA {
            self.differences[0][count % WINDOW] = self.difference::<PARABOLA>(sample, time, scales, &latest);
        }
        if count >= CUBIC {
            self.differences[1][count % WINDOW] = self.difference::<CUBIC>(sample, time, scales, &latest);
            self.update();
        }
        if count == 0 {
            self.fractions = Point::from_elem(1.0 / sample.len() as f64, sample.len());
        }
        let oldest = slot(CUBIC);
        self.samples[oldest].clear();
        self.samples[oldest].extend_from_slice(sample);
        self.times[oldest] = time;
        self.count += 1;
    }

    /// Root mean square over the entries of the difference to the polynomial through the `latest` N samples, divided by its
    /// standard deviation for noise of unit size.
    fn difference<const N: usize>(&mut self, sample: &[f64], time: f64, scales: &[f64], latest: &[usize]) -> f64 {
        let times: [f64; N] = std::array::from_fn(|i| self.times[latest[i]]);
        let weights: [f64; N] = std::array::from_fn(|i| {
            (0..N).filter(|k| *k != i).map(|k| (time - times[k]) / (times[i] - times[k])).product()
        });
        let variance = 1.0 + weights.iter().map(|weight| weight * weight).sum::<f64>();
        let samples: [&[f64]; N] = std::array::from_fn(|i| &self.samples[latest[i]][..]);
        let square = |j: usize| -> f64 {
            let extrapolated: f64 = samples.iter().zip(weights).map(|(sample, weight)| weight * sample[j]).sum();
            if scales[j].is_finite() { ((sample[j] - extrapolated) / scales[j]).powi(2) } else { 0.0 }
        };
        let mut squares = Point::new();
        squares.extend((0..sample.len()).map(square));
        let sum: f64 = squares.iter().sum();
        if sum > 0.0 {
            for (fraction, square) in self.fractions.iter_mut().zip(&squares) {
                *fraction += (square / sum - *fraction) / AVERAGED;
            }
        }
        (sum / (sample.len() as f64 * variance)).sqrt()
    }

    fn update(&mut self) {
        let median = |mut sorted: [f64; WINDOW]| *sorted.select_nth_unstable_by(WINDOW / 2, f64::total_cmp).1;
        let median = self.differences.map(median).into_iter().fold(f64::INFINITY, f64::min) / MEDIAN_OF_NORMAL;
        self.level = if median > RISE * self.level { median } else { self.level + (median - self.level) / AVERAGED };
    }
}

/// Root mean square of the entries in units of their scales; infinite scales count as zeros.
pub(super) fn root_mean_square(entries: impl Iterator<Item = f64>, scales: &[f64]) -> f64 {
    let sum: f64 = entries.zip(scales).map(|(entry, scale)| (entry / scale).powi(2)).sum();
    (sum / scales.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    fn level(noise: f64, path: impl Fn(f64) -> f64) -> f64 {
        let (mut level, mut draws) = (NoiseLevel::new(), rng::stream(3, 0));
        for i in 0..400 {
            let time = f64::from(i);
            // A sum of uniform draws has nearly a normal distribution.
            let normal: f64 = (0..12).map(|_| draws.uniform_in(-0.5, 0.5)).sum();
            level.add(&[path(time) + noise * normal, 2.0 * path(time)], time, &[1.0, 1.0]);
        }
        level.level_of(0)
    }

    #[test]
    fn noise_is_measured_on_a_moving_path() {
        for noise in [1e-5, 1e-2] {
            let measured = level(noise, |time| 0.3 * (0.02 * time).sin());
            assert!((0.7..1.4).contains(&(measured / noise)), "{measured} {noise}");
        }
    }

    #[test]
    fn a_motion_of_few_samples_a_turn_is_hardly_noise() {
        // Its third difference is 7e-5.
        assert!(level(0.0, |time| 0.01 * (0.2 * time).sin()) < 5e-6);
    }

    #[test]
    fn a_jump_is_no_noise() {
        assert!(level(0.0, |time| if time < 200.0 { 0.0 } else { 0.5 }) < 1e-15);
        assert!(level(0.0, |time| if time < 2.0 { 0.0 } else { 0.5 }) < 1e-15);
    }
}
