//! Whether a straight line in joint space can be part of a path: clear of everything, at closely spaced configurations, and within all
//! constraints, at every instant; and whether joints can hold the arm all along it.

use crate::constraint::{HoldCheck, Keep, KeepSweep, Onto};
use crate::obstacle::{Edge, SampledLine};
use crate::robot::Robot;

/// Intervals in which a line is shown to be within the constraints.
const INTERVALS: usize = 64;

/// Checks lines; owns its scratch.
pub(super) struct LineCheck<'a> {
    pub clear: SampledLine<'a>,
    /// The constraints, if there are any.
    pub kept: Option<PathConstraints<'a>>,
    /// The check that joints can hold the arm, if torques are limited.
    pub held: Option<HoldCheck<'a>>,
}

/// Constraints of a path.
pub(super) struct PathConstraints<'a> {
    pub sweep: KeepSweep<'a>,
    pub onto: Onto<'a>,
    /// Whether they leave straight lines no room.
    pub is_narrow: bool,
}

impl<'a> PathConstraints<'a> {
    /// The constraints of a path of `robot` with its joints in these ranges; `None` without any.
    pub fn of(robot: &'a Robot, keeps: &'a [Keep], ranges: &[(f64, f64)]) -> Option<Self> {
        let (lower, upper): (Vec<f64>, Vec<f64>) = ranges.iter().copied().unzip();
        (!keeps.is_empty()).then(|| Self {
            sweep: KeepSweep::new(robot, keeps),
            onto: Onto::new(robot, keeps, [&lower, &upper]),
            is_narrow: keeps.iter().any(Keep::is_narrow),
        })
    }
}

impl<'a> LineCheck<'a> {
    /// Number of configurations examined for what is near, and of intervals examined for the constraints.
    pub fn examined(&self) -> usize {
        self.clear.examined() + self.kept.as_ref().map_or(0, |kept| kept.sweep.intervals())
    }

    /// Whether a line is clear and within the constraints; `from` is known to be both.
    pub fn is_clear(&mut self, from: &[f64], to: &[f64]) -> bool {
        match &self.kept {
            Some(kept) if kept.is_narrow => self.is_clear_way(from, to) && self.is_held(from, to),
            _ => self.is_kept(from, to) && self.clear.is_clear(from, to) && self.is_held(from, to),
        }
    }

    fn is_held(&mut self, from: &[f64], to: &[f64]) -> bool {
        self.held.as_mut().is_none_or(|held| held.holds_along(from, to))
    }

    fn is_kept(&mut self, from: &[f64], to: &[f64]) -> bool {
        let Some(PathConstraints { sweep, .. }) = &mut self.kept else { return true };
        sweep.holds_within(&Edge { from, to }, [0.0, 1.0], INTERVALS)
    }

    /// Moves a configuration to where the constraints hold; false if no such is near it.
    pub fn bring(&mut self, q: &mut [f64]) -> bool {
        self.kept.as_mut().is_none_or(|kept| kept.onto.bring(q))
    }
}
