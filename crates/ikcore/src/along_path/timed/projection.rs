//! Projection of a configuration onto a target of the path.

use crate::along_path::tip_path::{Borders, PathTarget};
use crate::constraint::{Keep, KeepTasks};
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Linearization};
use crate::robot::Robot;

/// Number of steps after which the projection must converge: it does so quadratically, but linearly where the arm is
/// singular.
const STEPS: usize = 12;

/// Maximum number of steps.
const MOST_STEPS: usize = 60;

/// Largest factor on the squared error of a step that converges.
const CONVERGING: f64 = 0.5;

/// Squared distance at which the projection ends (m^2, rad^2), far below the accuracy of limits and paths.
const MET: f64 = 1e-16;

/// Squared distance at which a target counts as met if no step leads nearer: that of `solve`.
const AS_NEAR_AS_SOLVES: f64 = 1e-12;

/// Largest distance of a configuration from the middle of its neighbours, relative to their distance.
const STRAY: f64 = 0.3;
/// Absolute part of that distance (rad, m).
const STRAY_ANYWAY: f64 = 0.02;

/// Damping relative to squared error, as in the library's Levenberg-Marquardt.
const DAMPING: f64 = 0.05;

/// Fraction of the accuracy of a path by which [`Projection::approach`] may leave the tip off it.
pub(crate) const NEAR_ENOUGH: f64 = 0.25;

/// Maximum number of steps of an approach.
const APPROACH_STEPS: usize = 6;
/// Minimum damping of an approach: directions with singular values below its root (0.02) hardly move.
const APPROACH_DAMPING: f64 = 5e-4;

/// Projection of configurations onto targets of a path, within a box.
pub(crate) struct Projection<'a> {
    pub robot: &'a Robot,
    pub bounds: Bounds,
    linearization: Linearization,
    keeps: PathKeeps<'a>,
    kept: KeepTasks,
}

/// Constraints at every instant of the motion, of the tip of a robot without the tool of its task.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathKeeps<'a> {
    pub robot: &'a Robot,
    pub keeps: &'a [Keep],
}

impl PathKeeps<'_> {
    /// The error that is beyond its tolerance at `q`, in words; `None` where everything holds.
    pub(crate) fn broken_at(&self, q: &[f64]) -> Option<String> {
        self.keeps.iter().find_map(|keep| keep.broken_at(self.robot, q))
    }

    /// Whether everything holds at `q`.
    pub(crate) fn hold(&self, q: &[f64]) -> bool {
        self.keeps.iter().all(|keep| keep.holds(self.robot, q))
    }
}

impl<'a> Projection<'a> {
    /// Projection within the limits of `robot`, to where everything that is to be kept holds too.
    pub(crate) fn new(robot: &'a Robot, keeps: PathKeeps<'a>) -> Self {
        let bounds = Bounds::from_ranges(robot.joints().iter().map(|joint| (joint.lower, joint.upper)));
        Self { robot, bounds, linearization: Linearization::default(), keeps, kept: KeepTasks::new(keeps.keeps) }
    }

    /// Moves `q` onto the target, to a nearby solution. Returns the remaining error (m, rad); 0 if the target is met.
    pub(crate) fn project(&mut self, target: &PathTarget, q: &mut [f64]) -> f64 {
        let (mut value, mut step) = (f64::INFINITY, 0);
        let mut borders = Borders::default();
        self.linearization.project(q, self.bounds.ends(), MOST_STEPS + 1, |q, at| {
            let before = value;
            value = target.linearize(self.robot, q, &mut borders, at) + self.kept.append(self.keeps.robot, q, at);
            step += 1;
            let goes_on = step <= STEPS || step <= MOST_STEPS && value < CONVERGING * before;
            (!(value <= MET) && goes_on).then_some(DAMPING * value)
        });
        if value <= AS_NEAR_AS_SOLVES { 0.0 } else { value.sqrt() }
    }

    /// Moves `q` near the target: by little where the arm is singular, at the expense of the tip. Returns whether the
    /// error is at most `within` (m, rad).
    pub(crate) fn approach(&mut self, target: &PathTarget, q: &mut [f64], within: f64) -> bool {
        let mut borders = Borders::default();
        self.linearization.project(q, self.bounds.ends(), APPROACH_STEPS, |q, at| {
            let value = target.linearize(self.robot, q, &mut borders, at) + self.kept.append(self.keeps.robot, q, at);
            (!(value.sqrt() <= within)).then(|| APPROACH_DAMPING.max(DAMPING * value))
        })
    }
}

/// Whether `between`, on the path, is too far from the middle of two configurations that are this far `apart` (rad, m) for the arm to
/// move through it from one to the other.
pub(crate) fn strays(between: &[f64], middle: &[f64], apart: f64) -> bool {
    largest_difference(between, middle) > STRAY * apart + STRAY_ANYWAY
}
