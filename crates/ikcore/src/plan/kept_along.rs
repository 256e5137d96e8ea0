//! Errors of constraints along a finished motion.

use super::collision_checks::{TimedMotion, configuration_at};
use super::plan::Plan;
use crate::constraint::{Keep, KeepSweep};
use crate::error::Result;
use crate::robot::Robot;
use crate::solver::Status;
use crate::timing::Violation;
use crate::trajectory::Trajectory;

/// Certifies that all of `keeps` hold along a motion; the violation where one does not.
///
/// # Errors
/// None in practice: the joints are those of the robot.
pub(crate) fn broken_along(robot: &Robot, keeps: &[Keep], motion: &Trajectory) -> Result<Option<Violation>> {
    if keeps.is_empty() {
        return Ok(None);
    }
    let checked = KeepSweep::new(robot, keeps).check(&TimedMotion::new(motion), [0.0, motion.duration()]);
    let Err(broken) = checked else { return Ok(None) };
    let (what, [value, bound], unit) = keeps[broken.keep].worst_at(robot, &configuration_at(motion, broken.at)?);
    Ok(Some(Violation { what, value, bound, unit: unit.into() }))
}

impl Plan {
    /// Certifies that `keeps` hold along the whole motion, unless that was done. Adds the violation where one is broken, and returns it in
    /// words: then the plan has not succeeded, whoever asks.
    ///
    /// # Errors
    /// None in practice: the joints are those of the robot.
    pub(crate) fn note_kept(&mut self, robot: &Robot, keeps: &[Keep]) -> Result<Option<String>> {
        if keeps.is_empty() || !self.keeps.is_empty() {
            return Ok(None);
        }
        self.keeps = keeps.to_vec();
        if !self.violations.is_empty() {
            return Ok(None);
        }
        let Some(violation) = broken_along(robot, keeps, &self.trajectory)? else { return Ok(None) };
        let said = violation.to_string();
        self.violations.push(violation);
        if self.status == Status::Solved {
            self.status = Status::Stalled;
        }
        Ok(Some(said))
    }

    /// Bounds of the largest error of each entry of each task that is [kept](Self::keeps) (m, rad); NaN for entries that are free.
    /// `robot` is the robot of the plan.
    pub fn kept(&self, robot: &Robot) -> Vec<Vec<f64>> {
        let whole = [0.0, self.trajectory.duration()];
        let largest = KeepSweep::new(robot, &self.keeps).largest(&TimedMotion::new(&self.trajectory), whole);
        let holds = self.violations.is_empty();
        let known = |(keep, largest): (&Keep, Vec<f64>)| if holds { keep.at_most_tolerances(largest) } else { largest };
        self.keeps.iter().zip(largest).map(known).collect()
    }
}
