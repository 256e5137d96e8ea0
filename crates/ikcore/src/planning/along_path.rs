//! Along a given path.

use super::cost::Cost;
use super::plan::Plan;
use super::planar_arm::Elbow;
use super::{timed, tpbso};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::path::Reference;
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
    /// Which way a planar arm bends, unless `start` says it.
    pub elbow: Elbow,
    /// How far the tip may be from the path's points (m); None: the method's own.
    pub accuracy: Option<f64>,
    /// What searches; None: the method's own.
    pub solver: Option<AnySolver<DerivativeFree>>,
    /// Budgets; None: the method's own.
    pub stop: Option<Stop>,
    /// Seed of the random draws: the same seed, the same bits.
    pub seed: u64,
}

/// Plans a motion of `robot` whose tip follows the rows of `path`, in order; their times do not matter.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] for a point out of reach. That no plan keeps everything is a
/// status, not an error.
pub fn plan_along_path(
    robot: &Robot,
    path: &Reference,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    refuse_repetition(path)?;
    match options.method {
        AlongPathMethod::Timed => timed::along_path(robot, path, options, monitor),
        AlongPathMethod::Tpbso => tpbso::along_path(robot, path, options, monitor),
    }
}

/// Err where a point is the one before it again: no curve leads on from there.
fn refuse_repetition(path: &Reference) -> Result<()> {
    let repeats = |i: &usize| path.position(*i) == path.position(i - 1) && path.rotation(*i) == path.rotation(i - 1);
    match (1..path.len()).find(repeats) {
        None => Ok(()),
        Some(i) => Err(Error::InvalidPath { problem: format!("point {i} repeats point {}: leave it out", i - 1) }),
    }
}
