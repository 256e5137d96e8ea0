//! Other limits for a finished plan: the same path, passed at other times.

use super::collision_checks::{certify, too_near};
use super::plan::{Freed, Plan};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::message::message;
use crate::obstacle::{Clearance, ClearanceSweep};
use crate::robot::Robot;
use crate::solver::Stopwatch;
use crate::timing::{ConstantLimits, scaled, time_all};

const METHOD: &str = "retime";

impl Plan {
    /// Returns the same path as fast as these `limits` allow; `None` means those of `robot`, for which the plan was
    /// made.
    ///
    /// The timing of a plan that has [`path`](Self::path) is optimised again. Any other motion is scaled in time as a
    /// whole, so that it passes the very same configurations. Either way its clearance and accuracy remain.
    ///
    /// # Errors
    /// [`Error::Infeasible`] for a plan with violations, or for jerk limits on a motion whose acceleration jumps; errors
    /// of the limits.
    pub fn retime(&self, robot: &Robot, limits: Option<&Limits>) -> Result<Self> {
        let stopwatch = Stopwatch::start();
        let limits = ConstantLimits::for_robot(robot, limits, METHOD)?;
        if !self.violations.is_empty() {
            let problem = message!["only a plan without violations can be retimed, and this one: ", self.message()];
            return Err(Error::Infeasible { problem });
        }
        if !self.moves.is_empty() {
            let problem = "a program keeps the speeds of its moves: plan it again with these limits".into();
            return Err(Error::Infeasible { problem });
        }
        let trajectory = if self.path.is_empty() {
            scaled(&self.trajectory, &limits)?
        } else {
            limits.require_accelerations(METHOD)?;
            time_all(&self.path, &limits)?
        };
        let violations = limits.violations(&trajectory);
        if let Some(violation) = violations.first() {
            let problem = format!("the path of the plan leaves the limits: {violation}").into();
            return Err(Error::Infeasible { problem });
        }
        let cost = self.objective.of(robot, &trajectory);
        let slower = trajectory.duration() / self.trajectory.duration();
        let freed = self.freed.map(|freed| Freed { until: freed.until * slower, ..freed });
        let breaks = self.breaks.iter().map(|it| it.slower(slower)).collect();
        let mut retimed = Self { trajectory, cost, freed, breaks, elapsed: stopwatch.elapsed(), ..self.clone() };
        retimed.certify(robot, limits.limit_jerk())?;
        retimed.certify_kept(robot)?;
        retimed.name_peak(&limits);
        Ok(retimed)
    }

    /// Checks that everything holds that the plan keeps on the way.
    fn certify_kept(&mut self, robot: &Robot) -> Result<()> {
        let keeps = std::mem::take(&mut self.keeps);
        self.note_kept(robot, &keeps)?.map_or(Ok(()), |broken| {
            let problem = format!(
                "the motion would not hold what the plan keeps on the way: {broken}; plan with these limits instead"
            );
            Err(Error::Infeasible { problem: problem.into() })
        })
    }

    /// Checks that the motion keeps the margin. Timed for jerk limits, it leaves the path a little: `is_rounded`.
    fn certify(&mut self, robot: &Robot, is_rounded: bool) -> Result<()> {
        let space = self.surroundings.as_ref().map_or(Ok(None), |surroundings| surroundings.clear_space(robot))?;
        let Some(space) = space else { return Ok(()) };
        let margin = space.margin();
        if let Err(near) = certify(&mut ClearanceSweep::new(space.scene()), &self.trajectory, margin) {
            let violation = too_near(&near.contact, margin);
            let problem =
                format!("timed for jerk limits, the motion comes too near: {violation}; plan with them instead");
            return Err(Error::Infeasible { problem: problem.into() });
        }
        if is_rounded {
            // Computed on demand.
            self.clearance = Some(Clearance::at_least(margin));
        }
        Ok(())
    }
}
