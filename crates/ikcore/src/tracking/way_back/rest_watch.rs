//! Detects an arm whose error has ceased to fall.
//!
//! Noise of a target changes the error from tick to tick. An error counts only if it is well above these changes, so that a
//! noisy target that the arm meets on average does not look out of its reach.

/// Error of an arm that is near its target (m, rad).
pub(super) const NEAR: f64 = 1e-3;

/// Time without progress after which the error has ceased to fall (s).
const PATIENCE: f64 = 0.3;
/// Relative decrease that counts as progress.
const PROGRESS: f64 = 0.1;

/// Smallest error, in changes of a tick, that noise does not explain. The length of an error changes less than its direction.
const ABOVE_NOISE: f64 = 3.0;

/// Watches an error, tick by tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct RestWatch {
    /// Time without progress after which the error has ceased to fall (s).
    patience: f64,
    /// Error at the beginning; `None` before the first.
    began: Option<f64>,
    waited: f64,
    last: f64,
    lowest: f64,
    largest_change: f64,
}

impl RestWatch {
    /// Watch of an arm that takes `patience_factor` times as long as a quick one.
    pub fn new(patience_factor: f64) -> Self {
        let patience = PATIENCE * patience_factor;
        Self { patience, began: None, waited: 0.0, last: 0.0, lowest: 0.0, largest_change: 0.0 }
    }

    /// Begins anew with the next error.
    #[inline]
    pub fn restart(&mut self) {
        self.began = None;
    }

    /// Ends a tick of `dt` (s) with this error. Returns whether it has ceased to fall; the watch then begins anew.
    #[inline]
    pub fn has_ceased(&mut self, error: f64, dt: f64) -> bool {
        if error <= 0.0 {
            self.began = None;
            return false;
        }
        // Noise near the target says nothing about an arm that leaves it.
        let crosses = (error <= NEAR) != (self.last <= NEAR);
        match self.began {
            Some(began) if error > (1.0 - PROGRESS) * began && !crosses => {}
            _ => {
                self.begin(error);
                return false;
            }
        }
        self.largest_change = self.largest_change.max((error - self.last).abs());
        (self.last, self.lowest) = (error, self.lowest.min(error));
        self.waited += dt;
        if self.waited < self.patience {
            return false;
        }
        let is_noise = self.lowest <= ABOVE_NOISE * self.largest_change;
        self.begin(error);
        !is_noise
    }

    fn begin(&mut self, error: f64) {
        (self.began, self.waited, self.last) = (Some(error), 0.0, error);
        (self.lowest, self.largest_change) = (error, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ceases(errors: impl Iterator<Item = f64>) -> bool {
        let mut watch = RestWatch::new(1.0);
        errors.take(200).any(|error| watch.has_ceased(error, 0.01))
    }

    #[test]
    fn an_error_that_stays_or_creeps_has_ceased_to_fall() {
        assert!(ceases(std::iter::repeat(0.2)));
        assert!(ceases(std::iter::repeat(1e-5)));
        assert!(ceases((0..).map(|tick| 0.2 * 0.999_f64.powi(tick))));
        assert!(ceases((0..).map(|tick| 0.2 + 1e-3 * f64::from(tick % 2))));
    }

    #[test]
    fn a_falling_error_and_noise_have_not() {
        assert!(!ceases((0..).map(|tick| 0.2 * 0.99_f64.powi(tick))));
        assert!(!ceases((0..).map(|tick| 0.005 + 0.004 * f64::from(tick % 2))));
        assert!(!ceases(std::iter::repeat(0.0)));
    }

    #[test]
    fn a_jump_of_the_target_begins_a_new_wait() {
        let mut watch = RestWatch::new(1.0);
        let mut first = None;
        for tick in 0..100 {
            let error = if tick < 20 { 0.1 } else { 0.3 };
            if watch.has_ceased(error, 0.01) && first.is_none() {
                first = Some(tick);
            }
        }
        assert_eq!(first, Some(60));
    }
}
