//! The goal of a pursuit: the configuration in which the arm meets its target, as a moving point.
//!
//! Each target gives a sample of the goal, with the noise of its sensor. A parabola is fitted to the samples, older ones with less
//! weight, so that a goal with constant acceleration is followed without lag. [`GoalMemory`] chooses how many samples count; without noise
//! three, and the goal is exactly the last sample. After a jump the fit starts anew, with a line.
//!
//! Between samples the goal moves on along the fit. If the next sample is late, it keeps its velocity for a while, at first as far as
//! that is no noise, and then brakes to rest; the fit itself does not change until a sample comes.

use super::goal_fit::{Degree, Gains, GoalFit};
use super::goal_memory::{Circumstances, GoalMemory, NOISELESS};
use super::goal_scales::Scales;
use super::joint_state::JointState;
use super::noise_level::{NoiseLevel, root_mean_square};
use crate::math::vector::largest_difference;
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

/// Least number of intervals without a sample for which the goal keeps its velocity.
const MOVES_ON: f64 = 2.0;

/// Longest time without a sample for which the goal keeps its velocity (ticks), for joints that are slow to reach full speed.
const LONGEST: f64 = 300.0;

/// Distance (rad, m) from the last sample at which a goal without samples has moved on.
const MOVED_ON: f64 = 0.02;

/// Standard deviations of suspected noise at which half of a velocity is trusted without samples.
const DOUBTED: f64 = 3.0;

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
    fitted: [Point; 3],
    fit: GoalFit,
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

    /// Whether the goal has moved on since the last sample although the next one is overdue.
    pub fn has_outlived_samples(&self) -> bool {
        self.now > self.arrived + self.interval + 1.0 && largest_difference(&self.q, &self.fitted[0]) > MOVED_ON
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

    /// Writes the expected configuration at `time` (in ticks).
    pub fn expected(&self, time: f64, scales: &Scales, out: &mut Point) {
        out.clear();
        out.extend((0..self.q.len()).map(|j| self.at(j, time, scales)[0]));
    }

    /// Position and acceleration of joint `j` at `time`: on the fit until the next sample is overdue, then on with the velocity, in the end
    /// braking.
    #[inline]
    fn at(&self, j: usize, time: f64, scales: &Scales) -> [f64; 2] {
        let [q, velocity, acceleration] = &self.fitted;
        let motion @ [q, velocity, acceleration] = [q[j], velocity[j], acceleration[j]];
        let t = time - self.last_sample;
        let on_fit = self.arrived - self.last_sample + self.interval + 1.0;
        if t <= on_fit {
            return [q + t * (velocity + 0.5 * t * acceleration), acceleration];
        }
        self.overdue_at(j, motion, [t, on_fit], scales)
    }

    /// Position and acceleration of joint `j` with this motion at the last sample, `t` ticks later, more than `on_fit`.
    #[cold]
    fn overdue_at(
        &self,
        j: usize,
        [q, velocity, acceleration]: [f64; 3],
        [t, on_fit]: [f64; 2],
        scales: &Scales,
    ) -> [f64; 2] {
        let q = q + on_fit * (velocity + 0.5 * on_fit * acceleration);
        let velocity = self.trusted(j, velocity + on_fit * acceleration, scales);
        let (t, even) = (t - on_fit, self.time_to_move_on(scales) - self.interval);
        if t <= even {
            return [q + t * velocity, 0.0];
        }
        let (q, t) = (q + even * velocity, t - even);
        let deceleration = 0.5 * scales.change[j];
        let stop = velocity.abs() / deceleration;
        let change = -velocity.signum() * deceleration;
        if t < stop { [q + t * (velocity + 0.5 * t * change), change] } else { [q + 0.5 * stop * velocity, 0.0] }
    }

    /// Velocity with which joint `j` moves on where no sample comes. While the noise is unknown, it is reduced by the weight of a Wiener
    /// filter, v^2 / (v^2 + noise^2).
    fn trusted(&self, j: usize, velocity: f64, scales: &Scales) -> f64 {
        let suspected = self.noise.suspected_of(j);
        if suspected == 0.0 {
            return velocity;
        }
        let overdue = self.arrived - self.last_sample + self.interval;
        let noise = DOUBTED * self.fit.deviation_of_velocity(overdue, self.degree()) * suspected * scales.change[j];
        if noise > 0.0 { velocity * (1.0 + (noise / velocity).powi(2)).recip() } else { velocity }
    }

    /// Ticks after the last sample for which the goal keeps its velocity: as long as the arm takes to full speed. An arm that stopped at
    /// once would lose more than the target moves during the gap. As long as the noise is unknown, the velocity may be noise.
    fn time_to_move_on(&self, scales: &Scales) -> f64 {
        let to_full_speed = if self.noise.is_known() { scales.quickness.sqrt().recip().min(LONGEST) } else { 0.0 };
        to_full_speed.max(MOVES_ON * self.interval)
    }

    /// Writes the configuration before the samples that the goal remembers: at the last one without noise. It is never before the samples
    /// themselves, where a parabola would turn back.
    pub fn remembered_from(&self, scales: &Scales, out: &mut Point) {
        // The samples of a line count alike: the first is twice as old as their mean.
        let factor = if self.degree() == Degree::Line { 2.0 } else { 1.0 };
        self.expected(self.last_sample - factor * self.fit.mean_age(), scales, out);
    }

    fn degree(&self) -> Degree {
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

    /// Moves `goal` on by a tick, in which this sample may arrive.
    fn tick(goal: &mut MovingGoal, sample: Option<f64>, scales: &Scales) {
        goal.begin_tick();
        let time = goal.now;
        goal.end_tick(sample.as_ref().map(|q| GoalSample { q: std::slice::from_ref(q), time }), scales);
    }

    /// The largest error of the goal in the second half of `ticks`, when every `every`-th tick has a sample of `age`.
    fn error(path: impl Fn(f64) -> f64, noise: f64, ticks: usize, [every, age]: [usize; 2]) -> f64 {
        let (scales, mut draws) = (scales(), rng::stream(1, 0));
        let mut goal: Option<MovingGoal> = None;
        let mut worst = 0.0_f64;
        for tick in 1..=ticks {
            let now = tick as f64;
            if let Some(goal) = &mut goal {
                goal.begin_tick();
            }
            let time = now - age as f64;
            let value = (tick % every == 0).then(|| path(time) + noise * normal(&mut draws));
            if value.is_some() {
                goal.get_or_insert_with(|| MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), now, time));
            }
            if let Some(goal) = &mut goal {
                goal.end_tick(value.as_ref().map(|q| GoalSample { q: std::slice::from_ref(q), time }), &scales);
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

    /// The largest error of the goal and the longest way of `path` between two samples, `kept` of which come, one in three ticks.
    fn error_with_losses(path: impl Fn(f64) -> f64, noise: f64, kept: impl Fn(usize) -> bool) -> [f64; 2] {
        let (scales, mut draws) = (scales(), rng::stream(2, 0));
        let mut goal = MovingGoal::of_arm(&[path(0.0)], &JointState::at_rest(1), 0.0, 1.0);
        let (mut worst, mut longest, mut last) = (0.0_f64, 0.0_f64, 0.0);
        for i in 1..=3000 {
            let now = i as f64;
            let value = path(now) + noise * normal(&mut draws);
            let comes = i % 3 == 0 && (i < 300 || kept(i / 3));
            tick(&mut goal, comes.then_some(value), &scales);
            last = if comes { now } else { last };
            if i > 300 {
                worst = worst.max((goal.q()[0] - path(now)).abs());
                longest = longest.max((path(last) - path(now)).abs());
            }
        }
        [worst, longest]
    }

    #[test]
    fn the_velocity_of_a_parabola_is_exact_whatever_samples_are_lost() {
        let path = |time: f64| 1e-3 * time - 1e-7 * time * time;
        let scales = scales();
        let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
        for i in 1..600 {
            let now = f64::from(i);
            let comes = i < 30 || i * i % 11 < 3 || i % 23 == 0;
            tick(&mut goal, comes.then(|| path(now)), &scales);
            if comes {
                let error = goal.step()[0] - (path(now) - path(now - 1.0));
                assert!(i < 10 || error.abs() < 1e-12, "{error} in tick {i}");
            }
        }
    }

    #[test]
    fn lost_samples_hardly_lengthen_the_interval_and_a_slower_rate_does() {
        let scales = scales();
        let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
        let mut sampled = |every: usize, ticks: usize| {
            (1..=ticks).for_each(|i| tick(&mut goal, (i % every == 0).then_some(0.1), &scales));
            goal.interval
        };
        assert_eq!(sampled(3, 60), 3.0);
        let after_gap = sampled(30, 30);
        assert!((3.0..=3.6).contains(&after_gap), "{after_gap}");
        let slower = sampled(30, 900);
        assert!((slower - 30.0).abs() < 1.0, "{slower}");
    }

    #[test]
    fn lost_samples_of_a_noisy_goal_cost_no_more_than_the_gap() {
        let path = |time: f64| 0.2 * (0.008 * time).sin();
        for noise in [0.0, 1e-3, 4e-3] {
            let [without, _] = error_with_losses(path, noise, |_| true);
            for burst in [1, 3, 10] {
                let [worst, gap] = error_with_losses(path, noise, |sample| sample / burst % 4 != 0);
                assert!(worst < 1.1 * (without + gap), "{worst} with losses of {burst}, {without} without, gap {gap}");
            }
        }
    }

    #[test]
    fn what_came_before_the_remembered_samples_is_among_them_also_after_a_gap() {
        let path = |time: f64| 1e-6 * time * time;
        let scales = scales();
        let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
        let (mut samples, mut before) = (vec![], Point::new());
        for i in 1..=400 {
            let now = f64::from(i);
            // A gap of ten intervals lets the mean interval grow.
            let comes = i % 8 == 0 && !(200..280).contains(&i);
            tick(&mut goal, comes.then(|| path(now)), &scales);
            if comes {
                samples.push(path(now));
                goal.remembered_from(&scales, &mut before);
                let oldest = samples[samples.len().saturating_sub(3)];
                assert!(i < 24 || (oldest..=path(now)).contains(&before[0]), "{} in tick {i}", before[0]);
            }
        }
    }

    #[test]
    fn a_goal_whose_noise_is_not_known_yet_does_not_run_away_in_a_gap() {
        let (noise, mut squares) = (0.01, 0.0_f64);
        for seed in 0..200 {
            let mut worst = 0.0_f64;
            let (scales, mut draws) = (scales(), rng::stream(seed, 0));
            let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
            for i in 1..=400 {
                let comes = i % 10 == 0 && i <= 80;
                tick(&mut goal, comes.then(|| noise * normal(&mut draws)), &scales);
                worst = worst.max(goal.q()[0].abs());
            }
            squares += worst * worst / 200.0;
        }
        assert!(squares.sqrt() < 5.0 * noise, "{}", squares.sqrt());
    }

    #[test]
    fn a_jump_is_taken_over_at_once() {
        let scales = scales();
        let mut goal = MovingGoal::of_arm(&[0.1], &JointState::at_rest(1), 0.0, 1.0);
        for i in 1..40 {
            let q = if i < 30 { 0.1 } else { 0.4 };
            tick(&mut goal, Some(q), &scales);
            assert!((goal.q()[0] - q).abs() < 1e-15 && goal.step()[0].abs() < 1e-15, "tick {i}");
        }
    }

    #[test]
    fn a_goal_without_samples_comes_to_rest() {
        let scales = scales();
        let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
        for i in 1..=10 {
            tick(&mut goal, Some(1e-3 * f64::from(i)), &scales);
        }
        let mut steps = vec![];
        for _ in 0..400 {
            tick(&mut goal, None, &scales);
            steps.push(goal.step()[0]);
        }
        assert!(steps[0] > 0.9e-3 && steps[399] == 0.0);
        assert!(steps.windows(2).all(|two| two[1] <= two[0] + 1e-15 && two[0] - two[1] <= 1.1e-5));
    }
}
