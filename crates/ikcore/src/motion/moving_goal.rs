//! The goal of a pursuit: the configuration in which the arm meets its target, as a moving point.
//!
//! Each target gives a sample of the goal, with the noise of its sensor. A fading-memory filter keeps position, step and
//! change of the goal, so that a goal with constant change is followed without lag. [`GoalMemory`] chooses how many samples
//! it remembers; without noise it is one: the goal is then exactly the last sample. After a jump the filter starts anew,
//! with a growing memory.

use super::goal_gains::GoalGains;
use super::goal_memory::{Circumstances, GoalMemory, NOISELESS};
use super::goal_scales::Scales;
use super::joint_state::JointState;
use super::noise_level::{NoiseLevel, root_mean_square};
use crate::objective::Point;

/// Distance of a sample from the expected goal, in standard deviations, beyond which it is no noise.
const OUTLIER: f64 = 6.0;

/// Distance of a sample, in accelerations over one sample interval, beyond which the arm cannot follow the goal
/// smoothly.
const SUDDEN: f64 = 4.0;

/// Growth of the memory from one sample at once to this many: the motion learned before was noise.
const MISTAKEN: f64 = 2.0 * NOISELESS;

/// Samples that a parabola needs.
const PARABOLA: usize = 3;

/// Overdue intervals that the motion is extrapolated over.
const STRETCH: f64 = 2.0;

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
    /// Configuration of the goal at the end of the tick.
    q: Point,
    /// Displacement of the goal in the tick.
    step: Point,
    /// The difference of its displacement to that of the tick before.
    change: Point,
    now: f64,
    /// Time of the last sample, and when it arrived.
    last_sample: f64,
    arrived: f64,
    /// Ticks between samples.
    interval: f64,
    /// Samples since the last jump, while they are fewer than the memory; afterwards `None`.
    samples: Option<usize>,
    memory: GoalMemory,
    noise: NoiseLevel,
    /// Uncertainty of the goal in standard deviations of a sample.
    uncertainty: f64,
    /// Fraction of a surprise by which the last sample corrected the position.
    corrected: f64,
}

impl MovingGoal {
    /// A goal that moves as the arm does that is at `q` in `state`, at `now` (in ticks), before its first sample at the time
    /// `first`.
    pub fn of_arm(q: &[f64], state: &JointState, now: f64, first: f64) -> Self {
        Self {
            q: Point::from_slice(q),
            step: Point::from_slice(&state.step),
            change: Point::from_slice(&state.change),
            now,
            last_sample: first - 1.0,
            arrived: now,
            interval: 1.0,
            samples: None,
            memory: GoalMemory::new(q.len()),
            noise: NoiseLevel::new(),
            uncertainty: 1.0,
            corrected: 1.0,
        }
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

    /// Ticks from the first sample that the goal remembers to the last; without noise, from the last but one.
    pub fn remembered(&self) -> f64 {
        let memory = self.memory.samples();
        self.samples.map_or(memory, |samples| memory.min(samples as f64)).max(1.0) * self.interval
    }

    /// Root mean square of the corrections of its position that noise causes.
    pub fn jitter(&self) -> f64 {
        self.corrected * self.noise()
    }

    /// Moves on by one tick. A goal whose sample is overdue brakes to rest.
    pub fn advance(&mut self, scales: &Scales) {
        self.now += 1.0;
        if self.now - self.arrived > STRETCH * self.interval + 1.0 {
            for ((step, change), most) in self.step.iter().zip(&mut self.change).zip(&scales.change) {
                *change = -step.signum() * step.abs().min(0.5 * most);
            }
        }
        for ((q, step), change) in self.q.iter_mut().zip(&mut self.step).zip(&self.change) {
            *step += change;
            *q += *step;
        }
    }

    /// Writes the expected configuration at `time` (in ticks).
    pub fn expected(&self, time: f64, out: &mut Point) {
        let ago = self.now - time;
        out.clear();
        let motion = self.q.iter().zip(self.step.iter().zip(&self.change));
        out.extend(motion.map(|(q, (step, change))| q - ago * (step - 0.5 * (ago - 1.0) * change)));
    }

    /// Corrects the motion by a sample; `expected` is the expected configuration at its time.
    pub fn correct(&mut self, sample: GoalSample<'_>, expected: &[f64], scales: &Scales) {
        let GoalSample { q, time } = sample;
        let interval = time - self.last_sample;
        if interval <= 0.0 {
            return;
        }
        self.noise.add(q, time, &scales.change);
        self.interval +=
            (interval - self.interval) * if self.samples.is_some_and(|samples| samples < PARABOLA) { 1.0 } else { 0.2 };
        (self.last_sample, self.arrived) = (time, self.now);
        let ahead = (self.now - time) / self.interval;
        let before = self.memory.samples();
        self.adapt_memory(sample, expected, scales);
        let memory = self.memory.samples();
        if before < NOISELESS && memory > MISTAKEN {
            return self.restart(sample);
        }
        self.samples = self.samples.map(|samples| samples + 1).filter(|n| *n < PARABOLA || (*n as f64) < memory);
        let surprise = root_mean_square(q.iter().zip(expected).map(|(q, expected)| q - expected), &scales.change);
        let noise = OUTLIER * self.noise();
        if self.samples == Some(2) {
            // Faster than the arm can follow: it has jumped again.
            let steps = q.iter().zip(expected).map(|(q, expected)| (q - expected) / self.interval);
            if surprise > noise && root_mean_square(steps, &scales.step) > 1.0 {
                return self.restart(sample);
            }
        } else if surprise > SUDDEN * self.interval.powi(2) + noise {
            // An acceleration within the memory explains that much; otherwise it is a jump.
            if surprise > (SUDDEN + 0.125 * memory.powi(2)) * self.interval.powi(2) + noise {
                return self.restart(sample);
            }
            self.forget_half();
        }
        let gains = match self.samples {
            Some(samples) => GoalGains::of_line(samples),
            None => GoalGains::of_parabola(memory, self.interval),
        };
        (self.uncertainty, self.corrected) = (gains.uncertainty(ahead), gains.position);
        self.apply(gains, interval, sample, expected);
    }

    fn adapt_memory(&mut self, sample: GoalSample<'_>, expected: &[f64], scales: &Scales) {
        let circumstances = Circumstances {
            noise: self.noise(),
            interval: self.interval,
            age: self.now - sample.time,
            jerk_fraction: scales.jerk_fraction,
            quickness: scales.quickness,
        };
        let surprise = sample.q.iter().zip(expected).map(|(q, expected)| q - expected);
        self.memory.adapt(surprise, &scales.change, &circumstances);
    }

    /// Starts a straight line through half as many samples.
    fn forget_half(&mut self) {
        let remembered = self.samples.unwrap_or(self.memory.samples().ceil() as usize);
        self.samples = Some((remembered / 2).max(2));
        self.change.fill(0.0);
    }

    fn restart(&mut self, sample: GoalSample<'_>) {
        self.q.copy_from_slice(sample.q);
        self.step.fill(0.0);
        self.change.fill(0.0);
        self.samples = Some(1);
        self.memory.restart();
    }

    fn apply(&mut self, gains: GoalGains, interval: f64, sample: GoalSample<'_>, expected: &[f64]) {
        let ago = self.now - sample.time;
        for (j, (q, expected)) in sample.q.iter().zip(expected).enumerate() {
            let surprise = q - expected;
            let (step, change) = (gains.step * surprise / interval, gains.change * surprise / interval.powi(2));
            self.q[j] += gains.position * surprise + ago * (step + 0.5 * (ago + 1.0) * change);
            self.step[j] += step + ago * change;
            self.change[j] += change;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Braking;
    use super::*;
    use crate::rng::{self, LazyRng};

    fn scales() -> Scales {
        let braking = Braking { acceleration: 2e-5, jerk: f64::INFINITY };
        Scales::new(&[braking], std::iter::once(3e-3))
    }

    fn normal(draws: &mut LazyRng) -> f64 {
        (0..12).map(|_| draws.uniform_in(-0.5, 0.5)).sum()
    }

    /// The largest error of the goal in the second half of `ticks`, when every `every`-th tick has a sample of `age`.
    fn error(path: impl Fn(f64) -> f64, noise: f64, ticks: usize, [every, age]: [usize; 2]) -> f64 {
        let (scales, mut draws, mut expected) = (scales(), rng::stream(1, 0), Point::new());
        let mut goal: Option<MovingGoal> = None;
        let mut worst = 0.0_f64;
        for tick in 1..=ticks {
            let now = tick as f64;
            if let Some(goal) = &mut goal {
                goal.advance(&scales);
            }
            if tick % every == 0 {
                let time = now - age as f64;
                let sample = GoalSample { q: &[path(time) + noise * normal(&mut draws)], time };
                let goal = goal.get_or_insert_with(|| MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), now, time));
                goal.expected(time, &mut expected);
                goal.correct(sample, &expected, &scales);
            }
            if let Some(goal) = goal.as_ref().filter(|_| tick > ticks / 2) {
                worst = worst.max((goal.q()[0] - path(now)).abs());
            }
        }
        worst
    }

    #[test]
    fn without_noise_the_goal_is_the_sample() {
        assert!(error(|time| 0.2 * (0.002 * time).sin(), 0.0, 2000, [1, 0]) < 1e-15);
    }

    #[test]
    fn noise_is_averaged() {
        let noise = 1e-3;
        let worst = error(|_| 0.4, noise, 3000, [1, 0]);
        assert!(worst < noise, "{worst}");
    }

    #[test]
    fn rare_and_late_samples_of_a_parabola_are_extrapolated() {
        let worst = error(|time| 1e-3 * time - 4e-7 * time * time, 0.0, 2000, [8, 25]);
        assert!(worst < 1e-9, "{worst}");
    }

    #[test]
    fn a_jump_is_taken_over_at_once() {
        let (scales, mut expected) = (scales(), Point::new());
        let mut goal = MovingGoal::of_arm(&[0.1], &JointState::at_rest(1), 0.0, 1.0);
        for tick in 1..40 {
            let (now, q) = (f64::from(tick), [if tick < 30 { 0.1 } else { 0.4 }]);
            goal.advance(&scales);
            goal.expected(now, &mut expected);
            goal.correct(GoalSample { q: &q, time: now }, &expected, &scales);
            assert!((goal.q()[0] - q[0]).abs() < 1e-15 && goal.step()[0].abs() < 1e-15, "tick {tick}");
        }
    }

    #[test]
    fn a_goal_without_samples_comes_to_rest() {
        let (scales, mut expected) = (scales(), Point::new());
        let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
        for tick in 1..=10 {
            let now = f64::from(tick);
            goal.advance(&scales);
            goal.expected(now, &mut expected);
            goal.correct(GoalSample { q: &[1e-3 * now], time: now }, &expected, &scales);
        }
        let mut steps = vec![];
        for _ in 0..400 {
            goal.advance(&scales);
            steps.push(goal.step()[0]);
        }
        assert!(steps[0] > 0.9e-3 && steps[399] == 0.0);
        assert!(steps.windows(2).all(|two| two[1] <= two[0] + 1e-15 && two[0] - two[1] <= 1.1e-5));
    }
}
