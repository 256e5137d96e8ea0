//! Along a given path.

use super::cost::Cost;
use super::motion_limits::MotionLimits;
use super::plan::Plan;
use super::planar_arm::Elbow;
use super::tip_path::TipPath;
use super::{timed, tpbso};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::robot::Robot;
use crate::solver::{AnySolver, DerivativeFree, Monitor, Stop};
use crate::wording::words;

/// How to plan along a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AlongPathMethod {
    /// Redundancy and the fastest timing found together.
    #[default]
    Timed,
    /// Redundancy by a swarm, uniform time, splines through part of the points (Wang et al. 2019).
    Tpbso,
}

words!("method": AlongPathMethod { Timed => "timed", Tpbso => "tpbso" });

/// How to plan along a path, and what to keep.
#[derive(Debug, Clone, Default)]
pub struct AlongPathOptions {
    /// The planner.
    pub method: AlongPathMethod,
    /// What to minimise.
    pub objective: Cost,
    /// Configuration to start from (n,); None: the planner's choice.
    pub start: Option<Vec<f64>>,
    /// Limits to keep; None keeps the robot's.
    pub limits: Option<Limits>,
    /// Which way a planar arm bends, for the published method, unless `start` says it; None: as printed.
    pub elbow: Option<Elbow>,
    /// How far the tip may be from the path (m), and how far turned from it (rad); None: the method's own.
    pub accuracy: Option<f64>,
    /// What searches; None: the method's own.
    pub solver: Option<AnySolver<DerivativeFree>>,
    /// Budgets; None: the method's own.
    pub stop: Option<Stop>,
    /// Seed of the random draws: the same seed, the same bits.
    pub seed: u64,
}

impl AlongPathOptions {
    /// The configuration to start from, within the limits; None: the planner's choice.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::OutsideLimits`].
    pub(super) fn start_within(&self, robot: &Robot, limits: &MotionLimits) -> Result<Option<&[f64]>> {
        let Some(q) = &self.start else { return Ok(None) };
        robot.check("start_q", q)?;
        robot.require_within("start_q", q, &limits.lower, &limits.upper)?;
        Ok(Some(q))
    }
}

/// Plans a motion of `robot` whose tip follows `path`.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] for a place out of
/// reach. That no plan keeps everything is a status, not an error.
pub fn plan_along_path(
    robot: &Robot,
    tip_path: &TipPath,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    if options.objective == Cost::TipTravel {
        return Err(Error::unknown_option("objective along a path", "tip_travel", &["time", "joint_travel"]));
    }
    match options.method {
        AlongPathMethod::Timed => timed::along_path(robot, tip_path, options, monitor),
        AlongPathMethod::Tpbso => tpbso::along_path(robot, tip_path, options, monitor),
    }
}
