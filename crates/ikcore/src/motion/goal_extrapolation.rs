//! Extrapolation of a moving goal between its samples, and where they fail to come.
//!
//! Between samples the goal moves on along the fit. If the next sample is late, it keeps its velocity for a while, at first as far as
//! that is no noise, and then brakes to rest; the fit itself does not change until a sample comes.

use super::goal_fit::Degree;
use super::goal_scales::Scales;
use super::moving_goal::MovingGoal;
use crate::math::vector::largest_difference;
use crate::objective::Point;

/// Least number of intervals without a sample for which the goal keeps its velocity.
const MOVES_ON: f64 = 2.0;

/// Longest time without a sample for which the goal keeps its velocity (ticks), for joints that are slow to reach full speed.
const LONGEST: f64 = 300.0;

/// Distance (rad, m) from the last sample at which a goal without samples has moved on.
const MOVED_ON: f64 = 0.02;

/// Standard deviations of suspected noise at which half of a velocity is trusted without samples.
const DOUBTED: f64 = 3.0;

impl MovingGoal {
    /// Whether the goal has moved on since the last sample although the next one is overdue.
    pub fn has_outlived_samples(&self) -> bool {
        self.now > self.arrived + self.interval + 1.0 && largest_difference(&self.q, &self.fitted[0]) > MOVED_ON
    }

    /// Writes the expected configuration at `time` (in ticks).
    pub fn expected(&self, time: f64, scales: &Scales, out: &mut Point) {
        out.clear();
        out.extend((0..self.q.len()).map(|j| self.at(j, time, scales)[0]));
    }

    /// Writes the configuration before the samples that the goal remembers: at the last one without noise. It is never before the samples
    /// themselves, where a parabola would turn back.
    pub fn remembered_from(&self, scales: &Scales, out: &mut Point) {
        // The samples of a line count alike: the first is twice as old as their mean.
        let factor = if self.degree() == Degree::Line { 2.0 } else { 1.0 };
        self.expected(self.last_sample - factor * self.fit.mean_age(), scales, out);
    }

    /// Position and acceleration of joint `j` at `time`: on the fit until the next sample is overdue, then on with the velocity, in the end
    /// braking.
    #[inline]
    pub(super) fn at(&self, j: usize, time: f64, scales: &Scales) -> [f64; 2] {
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
}
