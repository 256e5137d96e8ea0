//! From one end to another.

use super::cost::Cost;
use super::endpoint::Endpoint;
use super::plan::Plan;
use super::planar_arm::Elbow;
use super::{minmax, tpbso};
use crate::error::{Error, Result};
use crate::limits::Limits;
use crate::obstacle::Obstacle;
use crate::robot::Robot;
use crate::solver::{AnySolver, DerivativeFree, Monitor, Stop};
use crate::wording::words;

/// How to plan from end to end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PointToPointMethod {
    /// The ends' configurations with the smallest largest displacement, joined at the limits' pace.
    #[default]
    MinMax,
    /// Polynomials through a via point, searched by a swarm (Wang et al. 2019).
    Tpbso,
}

words!("method": PointToPointMethod { MinMax => "minmax", Tpbso => "tpbso" });

/// How to plan from end to end, and what to keep.
#[derive(Debug, Clone, Default)]
pub struct PointToPointOptions {
    /// The planner.
    pub method: PointToPointMethod,
    /// What to minimise.
    pub objective: Cost,
    /// What the robot may not touch; it may never touch itself if it has capsules.
    pub obstacles: Vec<Obstacle>,
    /// Distance to keep from obstacles and between links (m); None: 1 mm.
    pub margin: Option<f64>,
    /// Limits to keep; None keeps the robot's.
    pub limits: Option<Limits>,
    /// Which way a planar arm bends at its ends, where [`Tpbso`](PointToPointMethod::Tpbso) chooses its configuration;
    /// None: as printed.
    pub elbows: Option<[Elbow; 2]>,
    /// What searches; None: the method's own.
    pub solver: Option<AnySolver<DerivativeFree>>,
    /// Budgets; None: the method's own.
    pub stop: Option<Stop>,
    /// Seed of the random draws: the same seed, the same bits.
    pub seed: u64,
}

/// Distance that is kept where none is asked for (m).
const DEFAULT_MARGIN: f64 = 1e-3;

impl PointToPointOptions {
    /// The distance to keep (m), wherever there is something to keep it from.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a margin that is negative or not finite.
    pub(super) fn kept_margin(&self) -> Result<f64> {
        let margin = self.margin.unwrap_or(DEFAULT_MARGIN);
        if margin.is_finite() && margin >= 0.0 {
            return Ok(margin);
        }
        Err(Error::out_of_range("margin", "zero or more and finite", margin))
    }
}

/// Plans a motion of `robot` from `start` to `end`, at rest at both.
///
/// # Errors
/// Any [`Error`] for wrong input, [`Error::Unreachable`] for an end out of reach. That no plan keeps everything is a
/// status, not an error.
pub fn plan_point_to_point(
    robot: &Robot,
    start: &Endpoint,
    end: &Endpoint,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    start.check("start", robot)?;
    end.check("end", robot)?;
    options.kept_margin()?;
    match options.method {
        PointToPointMethod::MinMax => minmax::point_to_point(robot, start, end, options, monitor),
        PointToPointMethod::Tpbso => tpbso::point_to_point(robot, start, end, options, monitor),
    }
}
