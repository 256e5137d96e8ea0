//! Whole turns that are left open while a path is followed: which of them fits is known at its end.

use std::ops::DerefMut;

use crate::objective::Bounds;
use crate::robot::Robot;

/// Limits of joints, and which of these can turn round once or more between them.
pub(super) struct OpenTurns<'a> {
    pub robot: &'a Robot,
    pub limits: &'a Bounds,
}

impl OpenTurns<'_> {
    /// The limits, without those of joints that can turn round once or more.
    pub fn bounds(&self) -> Bounds {
        let range = |j: usize| {
            let (lower, upper) = self.ends(j);
            let turns = self.robot.turn_period(j).is_some_and(|period| upper - lower >= period);
            if turns { (f64::NEG_INFINITY, f64::INFINITY) } else { (lower, upper) }
        };
        Bounds::from_ranges((0..self.robot.dof()).map(range))
    }

    /// Whole turns of a joint (rad) that bring what it sweeps inside its limits; `None` if there are none.
    pub fn shift(&self, j: usize, low: f64, high: f64) -> Option<f64> {
        let (lower, upper) = self.ends(j);
        if lower <= low && high <= upper {
            return Some(0.0);
        }
        let period = self.robot.turn_period(j)?;
        let turns = match [lower.is_finite(), upper.is_finite()] {
            [true, true] => ((0.5 * (lower + upper - low - high)) / period).round(),
            [true, false] => ((lower - low) / period).ceil(),
            [false, _] => ((upper - high) / period).floor(),
        };
        let shift = turns * period;
        (lower <= low + shift && high + shift <= upper).then_some(shift)
    }

    /// Shifts each joint of a sequence by whole turns into its limits; false if one winds too far.
    pub fn shift_inside<Q: DerefMut<Target = [f64]>>(&self, sequence: &mut [Q]) -> bool {
        (0..self.robot.dof()).all(|j| {
            let values = || sequence.iter().map(|q| q[j]);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            let shift = self.shift(j, low, high);
            sequence.iter_mut().for_each(|q| q[j] += shift.unwrap_or(0.0));
            shift.is_some()
        })
    }

    /// Largest difference of a joint between two configurations, but for whole turns (rad, m).
    pub fn difference(&self, one: &[f64], other: &[f64]) -> f64 {
        let of_joint = |j: usize| {
            let difference = one[j] - other[j];
            self.robot.turn_period(j).map_or(difference, |turn| difference - turn * (difference / turn).round()).abs()
        };
        (0..one.len()).map(of_joint).fold(0.0, f64::max)
    }

    fn ends(&self, j: usize) -> (f64, f64) {
        (self.limits.lower()[j], self.limits.upper()[j])
    }
}
