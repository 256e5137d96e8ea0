//! Scales of the motion of a goal.

use super::braking::Braking;
use crate::objective::Point;

/// Step of a joint without a velocity limit (rad, m).
const LONGEST_STEP: f64 = 1.0;

/// Ticks that a joint without a velocity limit takes to full speed.
const TICKS_TO_FULL_SPEED: f64 = 300.0;

/// Scales of the limits of a joint, per tick.
#[derive(Debug, Clone)]
pub(crate) struct Scales {
    /// Largest steps.
    pub step: Point,
    /// Largest changes; infinite for joints without limits and for locked ones.
    pub change: Point,
    /// Smallest ratio of jerk to acceleration limit: fraction of the change that may change in a tick.
    pub jerk_fraction: f64,
    /// Mean square of the inverse of the ticks that a joint takes to full speed.
    pub quickness: f64,
}

impl Scales {
    /// The scales of joints with these largest steps. A joint without an acceleration limit gets the acceleration that its
    /// jerk limit allows up to its velocity limit.
    pub fn new(braking: &[Braking], steps: impl Iterator<Item = f64>) -> Self {
        let step: Point = steps.collect();
        let scale = |(braking, step): (&Braking, &f64)| {
            let by_jerk = (braking.jerk * step.min(LONGEST_STEP)).sqrt();
            let scale = braking.acceleration.min(by_jerk);
            if scale > 0.0 { scale } else { f64::INFINITY }
        };
        let change: Point = braking.iter().zip(&step).map(scale).collect();
        let limited = braking.iter().zip(&change).filter(|(_, change)| change.is_finite());
        let jerk_fraction = limited.map(|(braking, change)| braking.jerk / change).fold(f64::INFINITY, f64::min);
        let moving = change.iter().zip(&step).filter(|(change, step)| change.is_finite() && **step > 0.0);
        let ticks = moving.map(|(change, step)| if step.is_finite() { step / change } else { TICKS_TO_FULL_SPEED });
        let (count, sum) = ticks.fold((0.0, 0.0), |(count, sum), ticks| (count + 1.0, sum + ticks.powi(-2)));
        Self { quickness: if count > 0.0 { sum / count } else { 0.0 }, step, change, jerk_fraction }
    }
}
