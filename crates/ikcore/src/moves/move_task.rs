//! Task of the moves of a program at their poses.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Unit, Vector3};

use crate::along_path::{PathTarget, ToleranceBand};
use crate::error::{Error, Result};
use crate::math::{Frame, Pose};
use crate::task::{Components, Target, Task, TaskKind};
use crate::wording::number;

/// Angle (rad) that a motion may be off its task: smaller tolerances are refused.
pub(super) const TURN_ACCURACY: f64 = 5e-5;
/// Distance (m) that a motion may be off its task: smaller tolerances are refused.
const ACCURACY: f64 = 1e-5;

/// Number of directions about the axis of a pointing task at which configurations are sought.
const SPINS: usize = 16;

/// Part of a pose that counts, and tolerance of the tip's orientation. Its position stays on the path, whose length it measures.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct MoveTask {
    /// `None`: whole poses.
    task: Option<Task>,
    band: Option<ToleranceBand>,
}

impl MoveTask {
    /// The task of a program.
    ///
    /// # Errors
    /// [`Error::Contradiction`] for a task that leaves a part of the position free, and for what no path can keep;
    /// [`Error::OutOfRange`] for a tolerance below the accuracy of a path.
    pub fn of(task: Option<&Task>) -> Result<Self> {
        let Some(task) = task else { return Ok(Self::default()) };
        task.validate()?;
        refuse_what_no_path_keeps(task)?;
        let Some(components) = &task.components else { return Ok(Self { task: partial(task), band: None }) };
        require_tolerances(task)?;
        let band = ToleranceBand::of_orientation(components, TURN_ACCURACY);
        if task.kind == TaskKind::Pose && band.allowed().iter().all(|allowed| *allowed == 0.0) {
            return Ok(Self::default());
        }
        Ok(Self { task: Some(Task { tool: None, ..*task }), band: Some(band) })
    }

    /// Whether the tip may be off the part that counts.
    pub fn has_tolerance(&self) -> bool {
        self.band.is_some_and(|band| band.largest() > 0.0)
    }

    /// The same task without its tolerances.
    pub fn exact(&self) -> Self {
        Self { task: self.task, band: self.band.map(|band| band.at_most(0.0)) }
    }

    /// Target of the tip at `pose`.
    pub fn target(&self, pose: &Frame) -> PathTarget {
        let pose = Target::Pose(*pose);
        // The task has been checked, and a pose has all that any task uses.
        let target = self.task.and_then(|task| task.target(&pose).ok()).unwrap_or(pose);
        PathTarget { target, tolerance_band: self.band, displacement: None }
    }

    /// The angle (rad) by which the tip has to turn between two poses if it is to meet both without a tolerance.
    pub fn turn_between(&self, from: &Frame, to: &Frame) -> f64 {
        self.exact().target(to).off(from)[1]
    }

    /// Whether whole poses have to be met.
    pub fn is_whole(&self) -> bool {
        self.task.is_none()
    }

    /// The task for a search, without its tool.
    pub fn searched(&self) -> Option<Task> {
        self.task
    }

    /// Whether an arm with `dof` joints has self-motion while it meets the task at a pose.
    pub fn leaves_freedom(&self, dof: usize) -> bool {
        let kind = self.task.map_or(TaskKind::Pose, |task| task.kind);
        let of_orientation = match (kind, &self.band) {
            (TaskKind::Position, _) => 0,
            (TaskKind::Pointing { .. }, band) => {
                let is_exact = band.is_none_or(|band| band.allowed()[3] == 0.0);
                if is_exact { 2 } else { 0 }
            }
            (_, Some(band)) => band.allowed()[3..].iter().filter(|allowed| **allowed == 0.0).count(),
            (_, None) => 3,
        };
        dof > 3 + of_orientation
    }

    /// Poses that meet the task at `pose`, spread over what it leaves free about an axis; `pose` first.
    pub fn spread(&self, pose: &Pose) -> Vec<Pose> {
        let Some(axis) = self.free_axis() else { return vec![*pose] };
        let axis = Unit::new_normalize(axis);
        let turn = |i: usize| Rotation3::from_axis_angle(&axis, TAU * i as f64 / SPINS as f64);
        (0..SPINS).map(|i| if i == 0 { *pose } else { pose * turn(i) }).collect()
    }

    /// The axis of the tip about which it may spin.
    fn free_axis(&self) -> Option<Vector3<f64>> {
        if let TaskKind::Pointing { axis } = self.task?.kind {
            return Some(axis.into());
        }
        let is_free = self.band.map(|band| [3, 4, 5].map(|k| band.allowed()[k].is_infinite()))?;
        match is_free {
            [true, false, false] => Some(Vector3::x()),
            [false, true, false] => Some(Vector3::y()),
            [false, false, true] => Some(Vector3::z()),
            _ => None,
        }
    }
}

/// The task without its tool; `None` if it asks for the whole pose.
fn partial(task: &Task) -> Option<Task> {
    (task.kind != TaskKind::Pose).then_some(Task { tool: None, ..*task })
}

fn refuse_what_no_path_keeps(task: &Task) -> Result<()> {
    let leaves_position = task.kind == TaskKind::Orientation
        || task.components.is_some_and(|Components { weights, .. }| weights[..3].contains(&0.0));
    let problem = if leaves_position {
        format!(
            "the task of a program leaves the position free (task {}), but a line or an arc is a path of positions: ask for x, y and z, \
             or give joint moves to configurations",
            task.kind.name()
        )
    } else if task.region.is_some() {
        "the task of a program takes no region: the tip stays on its lines and arcs".into()
    } else if let Some(first) = task.first {
        format!(
            "the task of a program takes no order of its parts ('{first}' first): the tip stays on its lines and arcs"
        )
    } else {
        return Ok(());
    };
    Err(Error::Contradiction { problem: problem.into() })
}

/// Checks that a path can be kept to the tolerances.
fn require_tolerances(task: &Task) -> Result<()> {
    let (tolerance, weights) = (task.tolerance().unwrap_or_default(), task.weights().unwrap_or_default());
    let counts = |i: &usize| weights.get(*i).is_none_or(|weight| *weight > 0.0);
    for (i, tolerance) in tolerance.into_iter().enumerate().filter(|(i, _)| counts(i)) {
        let (least, unit) = if i < 3 { (ACCURACY, "m") } else { (TURN_ACCURACY, "rad") };
        if tolerance < least {
            let requirement = format!("at least the {} {unit} to which a path is kept", number(least));
            return Err(Error::out_of_range(format!("tolerance[{i}] of the task"), requirement, tolerance));
        }
    }
    Ok(())
}
