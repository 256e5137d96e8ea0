//! Weighted least squares of a line or a parabola through samples at any times, one sample after another.
//!
//! Of the samples it keeps moments alone: the sums of w s^k, k = 0 to 4, over their times s before the last sample and their weights w.
//! A missing sample is a longer interval and nothing else: the fit after it is that of the samples that came.

use super::goal_scales::Scales;

/// Least factor by which a sample may discount those before it: with less, rounding would decide about the acceleration.
const LEAST_DISCOUNT: f64 = 1e-6;

/// Moments of the samples, at the time of the last one.
#[derive(Debug, Clone, Copy)]
pub(super) struct GoalFit {
    moments: [f64; 5],
    /// Inverse variances of velocity and acceleration before any sample, in variances of a sample.
    prior: [f64; 2],
}

/// The polynomial that is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Degree {
    Line,
    Parabola,
}

/// Corrections of position, velocity and acceleration by a sample that is 1 above its prediction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gains {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

impl GoalFit {
    /// The fit of a single sample.
    pub fn of_one_sample() -> Self {
        Self { moments: [1.0, 0.0, 0.0, 0.0, 0.0], prior: [0.0; 2] }
    }

    /// Expects velocities and accelerations of goals that an arm can follow, for noise of this size.
    pub fn expect(&mut self, noise: f64, scales: &Scales) {
        self.prior = [noise * noise * scales.quickness, noise * noise];
    }

    /// Adds a sample, `gap` ticks after the last one. Those before are discounted.
    pub fn add(&mut self, gap: f64, discount: f64) {
        let [m0, m1, m2, m3, m4] = self.moments.map(|moment| moment * discount.max(LEAST_DISCOUNT));
        let h = -gap;
        self.moments = [
            1.0 + m0,
            m1 + h * m0,
            m2 + h * (2.0 * m1 + h * m0),
            m3 + h * (3.0 * m2 + h * (3.0 * m1 + h * m0)),
            m4 + h * (4.0 * m3 + h * (6.0 * m2 + h * (4.0 * m1 + h * m0))),
        ];
    }

    /// Halves the weights of all samples but the last.
    pub fn forget_half(&mut self) {
        self.moments[0] -= 1.0;
        self.moments = self.moments.map(|moment| 0.5 * moment);
        self.moments[0] += 1.0;
    }

    /// Weighted mean of the times from the samples to the last one (ticks).
    pub fn mean_age(&self) -> f64 {
        -self.moments[1] / self.moments[0]
    }

    /// The gains of the last sample.
    pub fn gains(&self, degree: Degree) -> Gains {
        let [position, velocity, acceleration] = self.solve([1.0, 0.0, 0.0], degree);
        Gains { position, velocity, acceleration }
    }

    /// Standard deviation of the fit `ahead` ticks after the last sample, in those of a sample.
    pub fn deviation(&self, ahead: f64, degree: Degree) -> f64 {
        let row = [1.0, ahead, 0.5 * ahead * ahead];
        let solution = self.solve(row, degree);
        row.iter().zip(solution).map(|(row, x)| row * x).sum::<f64>().max(0.0).sqrt()
    }

    /// Standard deviation of the velocity `ahead` ticks after the last sample, in those of a sample (1/tick).
    pub fn deviation_of_velocity(&self, ahead: f64, degree: Degree) -> f64 {
        let [_, velocity, acceleration] = self.solve([0.0, 1.0, ahead], degree);
        (velocity + ahead * acceleration).max(0.0).sqrt()
    }

    /// Solves the normal equations of the samples; a coefficient that they leave open is zero.
    fn solve(&self, right: [f64; 3], degree: Degree) -> [f64; 3] {
        let [m0, m1, m2, m3, m4] = self.moments;
        // L D L^T of [[m0, m1, m2 / 2], [m1, m2, m3 / 2], [m2 / 2, m3 / 2, m4 / 4]].
        let (l1, l2) = (m1 / m0, 0.5 * m2 / m0);
        let [velocity, acceleration] = self.prior;
        let d1 = velocity + (m2 - l1 * m1);
        if d1 <= f64::EPSILON * m2 {
            return [right[0] / m0, 0.0, 0.0];
        }
        let y1 = right[1] - l1 * right[0];
        let l3 = 0.5 * (m3 - l1 * m2) / d1;
        let d2 = acceleration + 0.25 * m4 - l2 * 0.5 * m2 - l3 * l3 * d1;
        let third = degree == Degree::Parabola && d2 > f64::EPSILON * m4;
        let x2 = if third { (right[2] - l2 * right[0] - l3 * y1) / d2 } else { 0.0 };
        let x1 = y1 / d1 - l3 * x2;
        [right[0] / m0 - l1 * x1 - l2 * x2, x1, x2]
    }
}
