//! The noise of a sequence of samples.
//!
//! A smooth motion is a parabola over four samples, so the difference between a sample and the parabola through the three
//! before it is noise. The median over a window ignores jumps.

use crate::objective::Point;

/// Samples that a parabola needs.
const BEFORE: usize = 3;

/// Window of the median. A jump spoils four differences, which is less than half.
const WINDOW: usize = 9;

/// Median of the absolute value of a normal variable with standard deviation 1.
const MEDIAN_OF_NORMAL: f64 = 0.6745;

/// A median above this multiple of the level is a new level; smaller ones are averaged.
const RISE: f64 = 3.0;

/// Samples over which the level is averaged.
const AVERAGED: f64 = 50.0;

/// A running estimate of the standard deviation of noise.
#[derive(Debug, Clone)]
pub(super) struct NoiseLevel {
    /// The last samples and their times, oldest first in a ring.
    samples: [Point; BEFORE],
    times: [f64; BEFORE],
    count: usize,
    /// Differences in the window; zero until it is full, so that a jump at the start is not taken for noise.
    differences: [f64; WINDOW],
    level: f64,
    /// Fraction of the squared differences in each entry.
    shares: Point,
}

impl NoiseLevel {
    pub fn new() -> Self {
        let samples = std::array::from_fn(|_| Point::new());
        Self { samples, times: [0.0; BEFORE], count: 0, differences: [0.0; WINDOW], level: 0.0, shares: Point::new() }
    }

    /// Root mean square over the entries of the standard deviation of the noise, in the scales of `add`.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Standard deviation of the noise of entry `j`; 0 before the first sample.
    pub fn level_of(&self, j: usize) -> f64 {
        self.shares.get(j).map_or(0.0, |share| self.level * (self.shares.len() as f64 * share).sqrt())
    }

    /// Adds a sample at `time`; entries are measured in units of `scales`.
    pub fn add(&mut self, sample: &[f64], time: f64, scales: &[f64]) {
        let count = self.count;
        let slot = |ago: usize| (count + BEFORE - ago) % BEFORE;
        if count >= BEFORE {
            let slots = [slot(3), slot(2), slot(1)];
            let difference = self.difference(sample, time, scales, slots);
            self.differences[count % WINDOW] = difference;
            self.update();
        }
        if count == 0 {
            self.shares = Point::from_elem(1.0 / sample.len() as f64, sample.len());
        }
        let oldest = slot(3);
        self.samples[oldest].clear();
        self.samples[oldest].extend_from_slice(sample);
        self.times[oldest] = time;
        self.count += 1;
    }

    /// Root mean square over the entries of the difference to the parabola, divided by its standard deviation for noise of
    /// unit size.
    fn difference(&mut self, sample: &[f64], time: f64, scales: &[f64], slots: [usize; BEFORE]) -> f64 {
        let times = slots.map(|slot| self.times[slot]);
        let weights: [f64; BEFORE] = std::array::from_fn(|i| {
            (0..BEFORE).filter(|k| *k != i).map(|k| (time - times[k]) / (times[i] - times[k])).product()
        });
        let variance = 1.0 + weights.iter().map(|weight| weight * weight).sum::<f64>();
        let square = |j: usize| -> f64 {
            let extrapolated: f64 =
                slots.iter().zip(weights).map(|(slot, weight)| weight * self.samples[*slot][j]).sum();
            if scales[j].is_finite() { ((sample[j] - extrapolated) / scales[j]).powi(2) } else { 0.0 }
        };
        let squares: Point = (0..sample.len()).map(square).collect();
        let sum: f64 = squares.iter().sum();
        if sum > 0.0 {
            for (share, square) in self.shares.iter_mut().zip(&squares) {
                *share += (square / sum - *share) / AVERAGED;
            }
        }
        (sum / (sample.len() as f64 * variance)).sqrt()
    }

    fn update(&mut self) {
        let mut sorted = self.differences;
        let (_, median, _) = sorted.select_nth_unstable_by(WINDOW / 2, f64::total_cmp);
        let median = *median / MEDIAN_OF_NORMAL;
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
    fn a_jump_is_no_noise() {
        assert!(level(0.0, |time| if time < 200.0 { 0.0 } else { 0.5 }) < 1e-15);
        assert!(level(0.0, |time| if time < 2.0 { 0.0 } else { 0.5 }) < 1e-15);
    }
}
