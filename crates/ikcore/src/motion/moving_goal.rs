//! The goal of a pursuit: the configuration in which the arm meets its target, as a moving point.
//!
//! Each target gives a sample of the goal, with the noise of its sensor. A parabola is fitted to the samples, older ones with less
//! weight, so that a goal with constant acceleration is followed without lag. [`GoalMemory`] chooses how many samples count; without noise
//! three, and the goal is exactly the last sample. After a jump the fit starts anew, with a line.

use super::goal_fit::{Degree, Gains, GoalFit};
use super::goal_memory::{Circumstances, GoalMemory, NOISELESS};
use super::goal_scales::Scales;
use super::joint_state::JointState;
use super::noise_level::{NoiseLevel, root_mean_square};
use crate::objective::Point;

/// Limit of the difference between a sample and its prediction, in standard deviations: beyond it, the sample is no noise.
const OUTLIER: f64 = 6.0;

/// Limit of the same difference, in displacements of the largest acceleration since the last sample.
const SUDDEN: f64 = 4.0;

/// Growth of the memory from one sample at once to this many: the motion learned before was noise.
const MISTAKEN: f64 = 2.0 * NOISELESS;

/// Samples that a parabola needs.
const PARABOLA: usize = 3;

/// Largest gap that counts towards the interval, in intervals: in a longer one samples were lost.
const LOST: f64 = 2.0;

/// Least weight of a sample relative to the next one.
const LEAST_WEIGHT: f64 = 1e-3;

/// A sample of the goal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GoalSample<'a> {
    /// The configuration that meets the target.
    pub q: &'a [f64],
    /// Time of the sample, in ticks.
    pub time: f64,
}

/// A moving goal.
#[derive(Debug, Clone)]
pub(crate) struct MovingGoal {
    /// Position, velocity and acceleration of the fit at the last sample.
    pub(super) fitted: [Point; 3],
    pub(super) fit: GoalFit,
    /// Configuration of the goal at the end of the tick.
    pub(super) q: Point,
    /// Displacement of the goal in the tick.
    step: Point,
    /// The difference of its displacement to that of the tick before.
    change: Point,
    pub(super) now: f64,
    /// Time of the last sample, and when it arrived.
    pub(super) last_sample: f64,
    pub(super) arrived: f64,
    /// Ticks between samples.
    pub(super) interval: f64,
    /// Samples since the last jump, while they are fewer than the memory; afterwards `None`.
    samples: Option<usize>,
    memory: GoalMemory,
    pub(super) noise: NoiseLevel,
    /// Uncertainty of the goal in standard deviations of a sample.
    uncertainty: f64,
    /// Fraction of a surprise by which the last sample corrected the position.
    corrected: f64,
}

impl MovingGoal {
    /// A goal that moves as the arm does that is at `q` in `state`, at `now` (in ticks), before its first sample at the time
    /// `first`.
    pub fn of_arm(q: &[f64], state: &JointState, now: f64, first: f64) -> Self {
        let mut goal = Self {
            fitted: [q, &state.step, &state.change].map(Point::from_slice),
            fit: GoalFit::of_one_sample(),
            q: Point::from_slice(q),
            step: Point::from_slice(&state.step),
            change: Point::from_slice(&state.change),
            now,
            last_sample: now,
            arrived: now,
            interval: 1.0,
            samples: None,
            memory: GoalMemory::new(q.len()),
            noise: NoiseLevel::new(),
            uncertainty: 1.0,
            corrected: 1.0,
        };
        // A step is the velocity at the middle of its tick.
        let [_, velocity, acceleration] = &mut goal.fitted;
        velocity.iter_mut().zip(acceleration).for_each(|(velocity, acceleration)| *velocity += 0.5 * *acceleration);
        goal.last_sample = first - 1.0;
        goal.move_fit(goal.last_sample - now);
        goal
    }

    /// Configuration at the end of the tick.
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// Displacement in the tick.
    pub fn step(&self) -> &[f64] {
        &self.step
    }

    /// Difference of the displacement to that of the tick before.
    pub fn change(&self) -> &[f64] {
        &self.change
    }

    /// Standard deviation of the goal in joint `j` because of noise, up to a factor near 1, in units of its scale.
    pub fn uncertainty_of(&self, j: usize) -> f64 {
        self.noise.level_of(j) * self.uncertainty
    }

    /// Root mean square of the noise over the joints.
    pub fn noise(&self) -> f64 {
        self.noise.level()
    }

    /// Ticks over which noise is averaged; 1 without noise.
    pub fn memory(&self) -> f64 {
        self.memory.samples() * self.interval
    }

    /// Root mean square of the corrections of its position that noise causes.
    pub fn jitter(&self) -> f64 {
        self.corrected * self.noise()
    }

    /// Begins a tick.
    pub fn begin_tick(&mut self) {
        self.now += 1.0;
    }

    /// Corrects the motion by a sample, if one has arrived in the tick, and moves on to its end.
    pub fn end_tick(&mut self, sample: Option<GoalSample<'_>>, scales: &Scales) {
        if let Some(sample) = sample.filter(|sample| sample.time > self.last_sample) {
            self.take(sample, scales);
        }
        for j in 0..self.q.len() {
            let [q, change] = self.at(j, self.now, scales);
            self.step[j] = q - self.at(j, self.now - 1.0, scales)[0];
            (self.q[j], self.change[j]) = (q, change);
        }
    }

    pub(super) fn degree(&self) -> Degree {
        if self.samples.is_some() { Degree::Line } else { Degree::Parabola }
    }

    /// Corrects the motion by a sample.
    fn take(&mut self, sample: GoalSample<'_>, scales: &Scales) {
        let GoalSample { q, time } = sample;
        let gap = time - self.last_sample;
        self.noise.add(q, time, &scales.change);
        let young = self.samples.is_some_and(|samples| samples < PARABOLA);
        let interval = if self.interval > 1.0 { gap.min(LOST * self.interval) } else { gap };
        self.interval += if young { interval - self.interval } else { 0.2 * (interval - self.interval) };
        self.move_fit(gap);
        (self.last_sample, self.arrived) = (time, self.now);
        let before = self.memory.samples();
        self.adapt_memory(sample, scales);
        let memory = self.memory.samples();
        if before < NOISELESS && memory > MISTAKEN {
            return self.restart(sample);
        }
        self.samples = self.samples.map(|samples| samples + 1).filter(|n| *n < PARABOLA || (*n as f64) < memory);
        let discount = match self.degree() {
            Degree::Line => 1.0,
            Degree::Parabola => {
                let (discount, intervals) = ((1.0 - 1.0 / memory).max(LEAST_WEIGHT), gap / self.interval);
                if intervals == 1.0 { discount } else { discount.powf(intervals) }
            }
        };
        self.fit.add(gap, discount);
        self.fit.expect(self.noise(), scales);
        let surprise = root_mean_square(q.iter().zip(&self.fitted[0]).map(|(q, fitted)| q - fitted), &scales.change);
        let noise = OUTLIER * self.noise();
        let longest = gap.max(self.interval);
        if self.samples == Some(2) {
            // Faster than the arm can follow: it has jumped again.
            let steps = q.iter().zip(&self.fitted[0]).map(|(q, fitted)| (q - fitted) / gap);
            if surprise > noise && root_mean_square(steps, &scales.step) > 1.0 {
                return self.restart(sample);
            }
        } else if surprise > SUDDEN * longest.powi(2) + noise {
            // An acceleration within the memory explains that much; otherwise it is a jump.
            if surprise > (SUDDEN + 0.125 * memory.powi(2)) * longest.powi(2) + noise {
                return self.restart(sample);
            }
            self.forget_half();
        }
        let gains = self.fit.gains(self.degree());
        self.apply(gains, sample);
        self.uncertainty = self.fit.deviation(self.now - time, self.degree());
        self.corrected = gains.position;
    }

    /// Moves the fit on by `gap` ticks.
    fn move_fit(&mut self, gap: f64) {
        let [q, velocity, acceleration] = &mut self.fitted;
        for ((q, velocity), acceleration) in q.iter_mut().zip(velocity).zip(acceleration) {
            *q += gap * (*velocity + 0.5 * gap * *acceleration);
            *velocity += gap * *acceleration;
        }
    }

    fn adapt_memory(&mut self, sample: GoalSample<'_>, scales: &Scales) {
        let circumstances = Circumstances {
            noise: self.noise(),
            interval: self.interval,
            age: self.now - sample.time,
            jerk_fraction: scales.jerk_fraction,
            quickness: scales.quickness,
        };
        let surprise = sample.q.iter().zip(&self.fitted[0]).map(|(q, fitted)| q - fitted);
        self.memory.adapt(surprise, &scales.change, &circumstances);
    }

    /// Starts a straight line through half as many samples.
    fn forget_half(&mut self) {
        let remembered = self.samples.unwrap_or(self.memory.samples().ceil() as usize);
        self.samples = Some((remembered / 2).max(2));
        self.fitted[2].fill(0.0);
        self.fit.forget_half();
    }

    fn restart(&mut self, sample: GoalSample<'_>) {
        self.fitted[0].copy_from_slice(sample.q);
        self.fitted[1].fill(0.0);
        self.fitted[2].fill(0.0);
        self.fit = GoalFit::of_one_sample();
        self.samples = Some(1);
        self.memory.restart();
    }

    fn apply(&mut self, gains: Gains, sample: GoalSample<'_>) {
        let [fitted, velocity, acceleration] = &mut self.fitted;
        for (j, q) in sample.q.iter().enumerate() {
            let surprise = q - fitted[j];
            fitted[j] += gains.position * surprise;
            velocity[j] += gains.velocity * surprise;
            acceleration[j] += gains.acceleration * surprise;
        }
    }
}
