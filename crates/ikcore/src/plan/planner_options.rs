//! Options of the planners: method, objective, limits and budget.

use std::str::FromStr;

use super::cost::Cost;
use super::straight_line::StraightLine;
use super::tpbso_options::Tpbso;
use crate::constraint::Keep;
use crate::error::{Error, Result};
use crate::limits::{AdmittedStart, Limits, StartSlack};
use crate::message::Setting;
use crate::obstacle::Surroundings;
use crate::robot::Robot;
use crate::solver::{AnySolver, DerivativeFree, Stop};
use crate::task::Task;
use crate::timing::ConstantLimits;
use crate::wording::words;

/// Methods of point-to-point planning.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum PointToPointMethod {
    /// Configurations of both ends with the smallest maximum displacement, joined as fast as the limits allow.
    #[default]
    MinMax,
    /// Polynomials through a via point, found by a swarm.
    Tpbso(Tpbso),
}

impl PointToPointMethod {
    /// The method in messages.
    pub(crate) fn named(&self) -> Setting {
        match self {
            Self::MinMax => Setting::Method("minmax"),
            Self::Tpbso(_) => Setting::Method("tpbso"),
        }
    }
}

impl From<Tpbso> for PointToPointMethod {
    fn from(options: Tpbso) -> Self {
        Self::Tpbso(options)
    }
}

impl FromStr for PointToPointMethod {
    type Err = Error;

    /// Reads "minmax" or "tpbso", each with its defaults.
    fn from_str(name: &str) -> Result<Self> {
        match name {
            "minmax" => Ok(Self::MinMax),
            "tpbso" => Ok(Tpbso::default().into()),
            _ => Err(Error::unknown_option("method", name, &["minmax", "tpbso"])),
        }
    }
}

/// Methods of planning along a path.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum AlongPathMethod {
    /// Redundancy and fastest timing in one search.
    #[default]
    Timed,
    /// Redundancy found by a swarm, uniform time, splines through every second point.
    Tpbso(Tpbso),
}

impl AlongPathMethod {
    /// The method in messages.
    pub(crate) fn named(&self) -> Setting {
        match self {
            Self::Timed => Setting::Method("timed"),
            Self::Tpbso(_) => Setting::Method("tpbso"),
        }
    }
}

impl From<Tpbso> for AlongPathMethod {
    fn from(options: Tpbso) -> Self {
        Self::Tpbso(options)
    }
}

impl FromStr for AlongPathMethod {
    type Err = Error;

    /// Reads "timed" or "tpbso", each with its defaults.
    fn from_str(name: &str) -> Result<Self> {
        match name {
            "timed" => Ok(Self::Timed),
            "tpbso" => Ok(Tpbso::default().into()),
            _ => Err(Error::unknown_option("method", name, &["timed", "tpbso"])),
        }
    }
}

/// Whole turns at which joints that turn without limits come to an end configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EndTurns {
    /// Those nearest to the start: the short way round. Among obstacles, the other way if the short one is blocked.
    #[default]
    Nearest,
    /// Those of the given configuration.
    AsGiven,
}

words!("end_turns": EndTurns { Nearest => "nearest", AsGiven => "as_given" });

/// Options of [`plan_point_to_point`](crate::planning::plan_point_to_point).
#[derive(Debug, Clone, Default)]
pub struct PointToPointOptions {
    /// Distance beyond a position limit in which a start configuration is taken and led inside.
    pub start_slack: StartSlack,
    /// Whole turns of an end configuration.
    pub end_turns: EndTurns,
    /// Velocity at the start (n,) (rad/s, m/s), which must then be a configuration. `None` begins at rest.
    pub start_velocity: Option<Vec<f64>>,
    /// A straight line of the tip before the end.
    pub approach: Option<StraightLine>,
    /// A straight line of the tip after the start.
    pub retreat: Option<StraightLine>,
    /// Whether a start that is nearer to something than the margin moves out first.
    pub free_start: bool,
    /// The part of the targets that matters; the rest is left to the planner. `None` means all of it.
    pub task: Option<Task>,
    /// Constraints at every instant of the motion.
    pub keeps: Vec<Keep>,
    /// The planner.
    pub method: PointToPointMethod,
    /// Quantity to minimise.
    pub objective: Cost,
    /// Surroundings that the motion keeps clear of. Unless `self_collision` says otherwise, links must not touch each other where the robot has
    /// bodies.
    pub surroundings: Surroundings,
    /// Limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Budget of the search. `None` means the method's own.
    pub stop: Option<Stop>,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

/// Options of [`plan_along_path`](crate::planning::plan_along_path).
#[derive(Debug, Clone, Default)]
pub struct AlongPathOptions {
    /// The planner.
    pub method: AlongPathMethod,
    /// Quantity to minimise.
    pub objective: Cost,
    /// The part of the poses that matters; the rest is left to the planner. `None` means all of it.
    pub task: Option<Task>,
    /// Constraints at every instant of the motion.
    pub keeps: Vec<Keep>,
    /// Surroundings that the motion keeps clear of. By default nothing is checked.
    pub surroundings: Surroundings,
    /// Start configuration (n,). `None` leaves it to the planner.
    pub start: Option<Vec<f64>>,
    /// Distance beyond a position limit in which the start is taken and led inside.
    pub start_slack: StartSlack,
    /// Limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Allowed distance of the tip from the path (m) and angle from its orientation (rad). `None` means the method's
    /// own.
    pub accuracy: Option<f64>,
    /// Whether the tool may leave the path where it cannot be followed, as few times as possible, and go on.
    pub breaks: bool,
    /// The solver of [`AlongPathMethod::Timed`]. `None` means differential evolution. [`Tpbso`] has its own.
    pub solver: Option<AnySolver<DerivativeFree>>,
    /// Budget of the search. `None` means the method's own.
    pub stop: Option<Stop>,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

impl PointToPointOptions {
    /// Whether the motion has pieces besides the way from start to end.
    pub(crate) fn has_pieces(&self) -> bool {
        self.approach.is_some() || self.retreat.is_some() || self.free_start
    }
}

impl AlongPathOptions {
    /// Returns the given start, as taken by the gate; `None` if the planner chooses it.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::OutsideLimits`].
    pub(crate) fn admitted_start(&self, robot: &Robot, limits: &ConstantLimits) -> Result<Option<AdmittedStart>> {
        let Some(q) = &self.start else { return Ok(None) };
        robot.check("start_q", q)?;
        limits.position_limits(robot)?.admit_start(Some(robot), "start_q", q, &self.start_slack).map(Some)
    }
}
