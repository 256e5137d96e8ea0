//! What a caller asks of the tip, apart from where: the kind of task, its components, the tool that it is for.

use super::{Components, Target};
use crate::error::{Error, Result, require_finite};
use crate::math::Pose;
use crate::math::so3::norm;
use crate::robot::Robot;

/// Which part of a pose matters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// All of it.
    Pose,
    /// The position; the orientation is left free.
    Position,
    /// The orientation; the position is left free.
    Orientation,
    /// The position, and the direction of one axis of the tip; the spin about it is left free.
    Pointing {
        /// In the tip's own coordinates, of any length but zero.
        axis: [f64; 3],
    },
}

/// A task of the tip, or of a tool at the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Task {
    /// Which part of a pose matters.
    pub kind: Kind,
    /// Weights and tolerances by component.
    pub components: Option<Components>,
    /// From the tip to what is to reach the target; None: the tip itself.
    pub tool: Option<Pose>,
}

impl Kind {
    /// The name as Python shows it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pose => "Pose",
            Self::Position => "Position",
            Self::Orientation => "Orientation",
            Self::Pointing { .. } => "Pointing",
        }
    }
}

impl From<Kind> for Task {
    fn from(kind: Kind) -> Self {
        Self { kind, components: None, tool: None }
    }
}

impl Task {
    /// Checks axis, weights, tolerances and tool.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OutOfRange`] names the entry.
    pub fn validate(&self) -> Result<()> {
        if let Kind::Pointing { axis } = &self.kind {
            require_finite("axis", axis, |i| format!("entry {i}"))?;
            if norm(axis) == 0.0 {
                return Err(Error::out_of_range("the length of axis", "positive", 0.0));
            }
        }
        self.components.as_ref().map_or(Ok(()), Components::validate)
    }

    /// What of `wanted`, a position or a pose, this task asks for.
    ///
    /// # Errors
    /// [`Error::WrongTarget`] for a position where the task needs an orientation too.
    pub fn target(&self, wanted: &Target) -> Result<Target> {
        match (&self.kind, wanted) {
            (Kind::Position, Target::Pose(frame)) => Ok(Target::Position(frame.origin)),
            (Kind::Position, Target::Position(_)) | (Kind::Pose, Target::Pose(_)) => Ok(*wanted),
            (Kind::Orientation, Target::Pose(frame)) => Ok(Target::Orientation(*frame)),
            (Kind::Pointing { axis }, Target::Pose(frame)) => {
                let length = norm(axis);
                Ok(Target::Pointing { frame: *frame, axis: axis.map(|entry| entry / length) })
            }
            _ => Err(Error::WrongTarget { task: self.kind.name().into() }),
        }
    }

    /// `robot` with this task's tool at its tip.
    ///
    /// # Errors
    /// As [`Robot::with_tool`].
    pub fn robot(&self, robot: &Robot) -> Result<Option<Robot>> {
        self.tool.map(|tool| robot.with_tool(robot.tool() * tool)).transpose()
    }
}
