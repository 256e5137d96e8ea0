//! Tasks of the tip: the part of a pose to reach, weights and tolerances, the tool, the region.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::components::{Components, check_tolerances, check_weights};
use super::criterion::Criterion;
use super::first::First;
use super::region::Region;
use super::target::Target;
use super::tip_error::Tolerance;
use crate::error::{Error, Result, require_finite};
use crate::math::Pose;
use crate::math::box_step::ROWS;
use crate::math::vector3::direction;
use crate::robot::Robot;

/// Part of a pose to reach.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum TaskKind {
    /// Whole pose.
    Pose,
    /// Position; the orientation is free.
    Position,
    /// Orientation; the position is free.
    Orientation,
    /// Position and direction of one axis of the tip; the rotation about the axis is free.
    Pointing {
        /// Axis in the tip's own coordinates, of any length but zero.
        axis: [f64; 3],
    },
}

/// Task of the tip, or of a tool at the tip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Part of a pose to reach.
    pub kind: TaskKind,
    /// Weights and tolerances by component.
    pub components: Option<Components>,
    /// Pose of the tool in the tip frame; the tool then has to reach the target. `None` means the tip itself.
    pub tool: Option<Pose>,
    /// Region of the tip. `None` means unrestricted.
    pub region: Option<Region>,
    /// Part of a pose that comes before the other. `None` means the position for a robot with fewer than six joints, where the
    /// whole pose cannot be met, and neither for others.
    pub first: Option<First>,
    /// Level among the tasks of several tips: tasks of a lower level are met first.
    pub level: u32,
}

impl TaskKind {
    /// Name of the kind.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pose => "Pose",
            Self::Position => "Position",
            Self::Orientation => "Orientation",
            Self::Pointing { .. } => "Pointing",
        }
    }

    /// Component rows covered by each entry of weights and tolerances; the angle of a pointing task covers three.
    fn rows(&self) -> &'static [Range<usize>] {
        match self {
            Self::Pose => &[0..1, 1..2, 2..3, 3..4, 4..5, 5..6],
            Self::Position => &[0..1, 1..2, 2..3],
            Self::Orientation => &[3..4, 4..5, 5..6],
            Self::Pointing { .. } => &[0..1, 1..2, 2..3, 3..6],
        }
    }

    /// Returns the part of `wanted`, a position or a pose, that a task of this kind uses.
    ///
    /// # Errors
    /// [`Error::WrongTarget`] if `wanted` is a position and the task needs an orientation.
    pub(super) fn target(&self, wanted: &Target) -> Result<Target> {
        match (self, wanted) {
            (Self::Position, Target::Pose(frame)) => Ok(Target::Position(frame.origin)),
            (Self::Position, Target::Position(_)) | (Self::Pose, Target::Pose(_)) => Ok(*wanted),
            (Self::Orientation, Target::Pose(frame)) => Ok(Target::Orientation(*frame)),
            (Self::Pointing { axis }, Target::Pose(frame)) => {
                Ok(Target::Pointing { frame: *frame, axis: direction(axis) })
            }
            _ => Err(Error::WrongTarget { task: self.name().into() }),
        }
    }

    /// Expands one entry per component of this kind to six, with `rest` for the other components.
    fn expand(&self, what: &str, entries: &[f64], rest: f64) -> Result<[f64; ROWS]> {
        let rows = self.rows();
        if entries.len() != rows.len() {
            let meaning = match self {
                Self::Pose => "x, y, z and the rotation's three",
                Self::Position => "x, y, z",
                Self::Orientation => "the rotation's three",
                Self::Pointing { .. } => "x, y, z and the angle",
            };
            let expected = format!("{} entries ({meaning})", rows.len());
            let what = format!("{what} of task {}", self.name());
            return Err(Error::WrongLength { what: what.into(), expected, got: entries.len() });
        }
        let mut all = [rest; ROWS];
        for (rows, entry) in rows.iter().zip(entries) {
            all[rows.clone()].fill(*entry);
        }
        Ok(all)
    }
}

impl From<TaskKind> for Task {
    fn from(kind: TaskKind) -> Self {
        Self { kind, components: None, tool: None, region: None, first: None, level: 0 }
    }
}

impl Task {
    /// Task with weights and tolerances (m, rad), one entry per component of its kind: six for a pose, three for a position or
    /// an orientation, and x, y, z and the angle for pointing. `None` means weights of one, and the tolerances of the call.
    ///
    /// # Errors
    /// [`Error::WrongLength`]; as [`validate`](Self::validate).
    pub fn new(kind: TaskKind, weights: Option<&[f64]>, tolerance: Option<&[f64]>, tool: Option<Pose>) -> Result<Self> {
        weights.map_or(Ok(()), check_weights)?;
        tolerance.map_or(Ok(()), check_tolerances)?;
        let ones = vec![1.0; kind.rows().len()];
        let components = match (weights, tolerance) {
            (None, None) => None,
            (weights, tolerance) => Some(Components {
                weights: kind.expand("weights", weights.unwrap_or(&ones), 0.0)?,
                tolerance: tolerance.map(|entries| kind.expand("tolerance", entries, f64::INFINITY)).transpose()?,
            }),
        };
        let task = Self { kind, components, tool, region: None, first: None, level: 0 };
        task.validate().map(|()| task)
    }

    /// Restricts the tip to `region`.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn within(self, region: Region) -> Result<Self> {
        let task = Self { region: Some(region), ..self };
        task.validate().map(|()| task)
    }

    /// Puts one part of a pose before the other.
    ///
    /// # Errors
    /// As [`validate`](Self::validate); [`Error::Contradiction`] for a task that is no whole pose.
    pub fn with_first(self, first: First) -> Result<Self> {
        let task = Self { first: Some(first), ..self };
        task.validate().map(|()| task)
    }

    /// Sets the level among the tasks of several tips.
    pub fn at_level(self, level: u32) -> Self {
        Self { level, ..self }
    }

    /// Criterion for targets of this task.
    pub(crate) fn criterion(&self, tolerance: Tolerance) -> Criterion {
        Criterion { components: self.components, region: self.region, ..tolerance.into() }
    }

    /// Weights, one for each component of the kind; `None` if they are all one by default.
    pub fn weights(&self) -> Option<Vec<f64>> {
        self.components.map(|components| self.contract(&components.weights))
    }

    /// Tolerances (m, rad), one for each component of the kind.
    pub fn tolerance(&self) -> Option<Vec<f64>> {
        self.components.and_then(|components| components.tolerance).map(|tolerance| self.contract(&tolerance))
    }

    fn contract(&self, all: &[f64; ROWS]) -> Vec<f64> {
        self.kind.rows().iter().map(|rows| all[rows.start]).collect()
    }

    /// Checks axis, weights, tolerances and tool.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OutOfRange`] names the entry; [`Error::Contradiction`] for a region combined
    /// with weights that leave some, but not all, of x, y and z of a pose free: the region is aligned with the base,
    /// the weights with the target; and for an order of the parts of a task that has one part, weights or a region.
    pub fn validate(&self) -> Result<()> {
        if let TaskKind::Pointing { axis } = &self.kind {
            require_finite("axis", axis, |i| format!("entry {i}"))?;
            if axis.iter().all(|entry| *entry == 0.0) {
                return Err(Error::out_of_range("the length of axis", "positive", 0.0));
            }
        }
        self.check_order()?;
        let Some(components) = &self.components else { return Ok(()) };
        components.validate()?;
        let free = components.weights[..3].iter().filter(|weight| **weight == 0.0).count();
        if self.region.is_some()
            && matches!(self.kind, TaskKind::Pose | TaskKind::Pointing { .. })
            && (1..3).contains(&free)
        {
            return Err(Error::Contradiction {
                problem: "region keeps x, y and z of the base, but weights free some of x, y and z of the target: \
                          free all three or none, or take task Position, whose axes are the base's"
                    .into(),
            });
        }
        Ok(())
    }

    /// Checks that an order is for a pose whose parts nothing else balances.
    fn check_order(&self) -> Result<()> {
        let Some(first) = self.first else { return Ok(()) };
        let problem = match (self.kind, self.components) {
            (TaskKind::Pose, Some(components)) if components.weights != [1.0; ROWS] => {
                "an order of position and orientation takes no weights, which balance them: leave one out".into()
            }
            (TaskKind::Pose, _) if self.region.is_some() => {
                "an order of position and orientation takes no region: leave one out".into()
            }
            (TaskKind::Pose, _) => return Ok(()),
            (other, _) => format!(
                "task {} has no order of position and orientation ('{first}' first): take task Pose",
                other.name()
            ),
        };
        Err(Error::Contradiction { problem: problem.into() })
    }

    /// Returns the part of `wanted`, a position or a pose, that this task uses.
    ///
    /// # Errors
    /// [`Error::WrongTarget`] if `wanted` is a position and the task needs an orientation.
    pub fn target(&self, wanted: &Target) -> Result<Target> {
        self.kind.target(wanted)
    }

    /// Adds the tool of this task to the tip of `robot`; `None` without a tool.
    ///
    /// # Errors
    /// As [`Robot::with_tool`].
    pub fn robot(&self, robot: &Robot) -> Result<Option<Robot>> {
        self.tool.map(|tool| robot.with_tool(robot.tool() * tool)).transpose()
    }
}
