//! Other limits for a finished plan: the same path, passed at other times.

use super::collision_checks::{TimedMotion, too_near};
use super::motion_limits::MotionLimits;
use super::plan::{Freed, Plan};
use super::time_optimal::{TimingLimits, time_all};
use super::within_limits::within_limits;
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::obstacle::Sweep;
use crate::robot::Robot;
use crate::solver::Stopwatch;
use crate::trajectory::Trajectory;
use crate::wording::{number, time};

const METHOD: &str = "retime";

/// Slower than necessary by this factor, so that rounding violates no limit.
const CAUTION: f64 = 1.0 + 1e-12;

/// Jumps of an acceleration at a knot that count as rounding, relative to the largest acceleration of the joint.
const ROUNDING: f64 = 1e-6;

impl Plan {
    /// The same path as fast as these `limits` allow; `None` means those of `robot`, for which the plan was made.
    ///
    /// The timing of a plan that has [`path`](Self::path) is optimised again. Any other motion is scaled in time as a
    /// whole, so that it passes the very same configurations. Either way its clearance and accuracy remain.
    ///
    /// # Errors
    /// [`Error::Infeasible`] for a plan with violations, or for jerk limits on a motion whose acceleration jumps; errors
    /// of the limits.
    pub fn retime(&self, robot: &Robot, limits: Option<&Limits>) -> Result<Self> {
        let stopwatch = Stopwatch::start();
        let limits_of_all = limits.cloned().unwrap_or_else(|| Limits::of(robot));
        let limits = MotionLimits::new(robot, Some(&limits_of_all), METHOD)?;
        if !self.violations.is_empty() {
            let problem = format!("only a plan without violations can be retimed, and this one: {}", self.message());
            return Err(Error::Infeasible { problem });
        }
        let trajectory = if self.path.is_empty() {
            scaled(&self.trajectory, &limits)?
        } else {
            time_all(&self.path, &TimingLimits::new(&limits_of_all, METHOD)?)?
        };
        let violations = limits.violations(&trajectory);
        if let Some(violation) = violations.first() {
            let problem = format!("the path of the plan leaves the limits: {violation}");
            return Err(Error::Infeasible { problem });
        }
        let cost = self.objective.of(robot, &trajectory);
        let slower = trajectory.duration() / self.trajectory.duration();
        let freed = self.freed.map(|freed| Freed { until: freed.until * slower, ..freed });
        let mut retimed = Self { trajectory, cost, freed, elapsed: stopwatch.elapsed(), ..self.clone() };
        retimed.certify(robot, limits.limit_jerk())?;
        retimed.name_peak(&limits);
        Ok(retimed)
    }

    /// Checks that the motion keeps the margin. `smoothed` for jerk limits, it leaves the path a little.
    fn certify(&mut self, robot: &Robot, smoothed: bool) -> Result<()> {
        let space = self.surroundings.as_ref().map_or(Ok(None), |surroundings| surroundings.clear_space(robot))?;
        let Some(space) = space else { return Ok(()) };
        let (scene, margin) = (space.scene(), space.margin());
        let (motion, whole) = (TimedMotion::new(&self.trajectory), [0.0, self.trajectory.duration()]);
        let mut sweep = Sweep::new(scene);
        if let Err(near) = sweep.check(&motion, whole, margin) {
            let violation = too_near(&near.contact, margin);
            let problem =
                format!("smoothed for jerk limits, the motion comes too near: {violation}; plan with them instead");
            return Err(Error::Infeasible { problem });
        }
        if smoothed {
            // Found when it is asked for.
            (self.clearance, self.nearest) = (Some(margin), None);
        }
        Ok(())
    }
}

/// The motion, faster or slower by one factor, as fast as the limits on velocity, acceleration and jerk allow.
pub(super) fn scaled(motion: &Trajectory, limits: &MotionLimits) -> Result<Trajectory> {
    if limits.limit_jerk() {
        refuse_jumps(motion, limits)?;
    }
    let largest = |reached: Vec<f64>, limits: &[f64]| {
        reached.iter().zip(limits).map(|(reached, limit)| reached / limit).fold(0.0, f64::max)
    };
    let factor = largest(motion.max_velocity(), &limits.velocity)
        .max(largest(motion.max_acceleration(), &limits.acceleration).sqrt())
        .max(largest(motion.max_jerk(), &limits.jerk).cbrt());
    if factor == 0.0 {
        return Err(Error::NoPace { joint: limits.joint_name(0).into() });
    }
    within_limits(motion.slowed(factor * CAUTION)?, [&limits.velocity, &limits.acceleration, &limits.jerk])
}

/// Checks that the acceleration does not jump, neither at a knot nor from or to rest.
fn refuse_jumps(motion: &Trajectory, limits: &MotionLimits) -> Result<()> {
    let (n, largest, steepest) = (limits.dof(), motion.max_acceleration(), motion.max_jerk());
    let [mut before, mut after, mut at_end] = [(); 3].map(|()| vec![0.0; n]);
    for (i, &t) in motion.knots().iter().enumerate() {
        after.fill(0.0);
        if i + 1 < motion.knots().len() {
            motion.end_accelerations(i, &mut after, &mut at_end);
        }
        // The end of a short segment late in a motion is rounded with its time.
        let rounding = |j: usize| ROUNDING * largest[j] + 4.0 * f64::EPSILON * t * steepest[j];
        let jump = |j: &usize| (after[*j] - before[*j]).abs() > rounding(*j).max(f64::MIN_POSITIVE);
        let limited = (0..n).filter(|j| limits.jerk[*j].is_finite());
        if let Some(j) = limited.filter(|j| largest[*j] > 0.0).find(jump) {
            let (joint, t) = (limits.joint_name(j), time(t));
            let (from, to) = (number(before[j]), number(after[j]));
            let problem = format!(
                "the acceleration of joint '{joint}' jumps from {from} to {to} at t = {t} s, which no jerk limit allows: \
                 plan with limits=Limits(jerk=...) instead"
            );
            return Err(Error::Infeasible { problem });
        }
        std::mem::swap(&mut before, &mut at_end);
    }
    Ok(())
}
