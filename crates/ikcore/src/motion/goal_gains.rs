//! Gains by which a sample corrects the motion of a goal.

/// Corrections of position, step and change per sample interval by an unexpected difference.
#[derive(Debug, Clone, Copy)]
pub(super) struct GoalGains {
    pub position: f64,
    pub step: f64,
    pub change: f64,
}

impl GoalGains {
    /// Gains of the straight line of least squares through this many samples.
    pub fn of_line(samples: usize) -> Self {
        let n = samples as f64;
        let both = n * (n + 1.0);
        Self { position: 2.0 * (2.0 * n - 1.0) / both, step: 6.0 / both, change: 0.0 }
    }

    /// Gains of the parabola that remembers this many samples, `interval` ticks apart: three poles at 1 - 1/m for a
    /// memory of m.
    pub fn of_parabola(memory: f64, interval: f64) -> Self {
        let (theta, forgotten) = (1.0 - 1.0 / memory, 1.0 / memory);
        // A change adds this fraction of itself to the displacement of an interval.
        let fraction = 0.5 * (interval + 1.0) / interval;
        Self {
            position: 1.0 - theta.powi(3),
            step: forgotten.powi(2) * (2.0 + theta - fraction * forgotten),
            change: forgotten.powi(3),
        }
    }

    /// Uncertainty of a goal that is extrapolated over `ahead` intervals, in standard deviations of a sample, up to a factor
    /// near 1: that of its position, and of step and change, which are as much smaller as their gains.
    pub fn uncertainty(&self, ahead: f64) -> f64 {
        let (step, change) = (self.step.sqrt(), self.change.cbrt().powi(2));
        self.position.sqrt() * (1.0 + ahead * (step + 0.5 * ahead * change))
    }
}
