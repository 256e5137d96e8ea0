//! What holds along a finished motion.

use super::collision_checks::{TimedMotion, configuration_at};
use super::plan::{Kept, Plan};
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
    /// Notes what of `keeps` holds along the whole motion. Where one is broken, the plan has not succeeded.
    ///
    /// # Errors
    /// None in practice: the joints are those of the robot.
    pub(crate) fn note_kept(&mut self, robot: &Robot, keeps: &[Keep]) -> Result<()> {
        if keeps.is_empty() {
            return Ok(());
        }
        let broken = broken_along(robot, keeps, &self.trajectory)?;
        let holds = broken.is_none();
        let largest = KeepSweep::new(robot, keeps)
            .largest(&TimedMotion::new(&self.trajectory), [0.0, self.trajectory.duration()]);
        let kept = |(keep, largest): (&Keep, Vec<f64>)| {
            let largest = if holds { keep.at_most_tolerances(largest) } else { largest };
            Kept { keep: keep.clone(), largest }
        };
        self.kept = keeps.iter().zip(largest).map(kept).collect();
        self.violations.extend(broken);
        if self.status == Status::Solved && !self.violations.is_empty() {
            self.status = Status::Stalled;
        }
        Ok(())
    }
}
