//! Validated task, and its frame and Jacobian on a robot.

use super::assessment::Assessment;
use super::criterion::Criterion;
use super::first::First;
use super::subject::Subject;
use super::target::Target;
use super::tip_task::TaskKind;
use crate::error::{Error, Result};
use crate::math::arithmetic::NoFma;
use crate::math::box_step::ROWS;
use crate::math::so3::cross;
use crate::math::{Columns, Frame};
use crate::objective::TaskBlock;
use crate::robot::Robot;

/// Number of joints that a pose needs.
const POSE: usize = 6;

/// Validated task.
#[derive(Debug, Clone)]
pub struct CheckedTask {
    /// Frame that the target refers to.
    pub(crate) subject: Subject,
    /// Part of the target to reach. `None` means all of it.
    pub(super) kind: Option<TaskKind>,
    /// Criterion for reaching the target, with weights.
    pub(crate) criterion: Criterion,
    /// Part of a pose that comes before the other.
    pub(crate) first: Option<First>,
    /// Level among the tasks of several tips.
    pub(crate) level: u32,
    /// Tool of the task, in the frame of the moving tip.
    pub(super) tool: Option<Box<Frame>>,
    /// Weight of the residual relative to other tasks.
    pub(super) weight: f64,
    /// Whether a tracked pair of tips is held at its target once it has reached it.
    pub(crate) is_held: bool,
}

impl<T: Into<Criterion>> From<T> for CheckedTask {
    /// Task of reaching the whole target of the only tip, by this criterion.
    fn from(criterion: T) -> Self {
        Self {
            subject: Subject::Tip(0),
            kind: None,
            criterion: criterion.into(),
            first: None,
            level: 0,
            tool: None,
            weight: 1.0,
            is_held: false,
        }
    }
}

impl CheckedTask {
    /// Part that comes first where the whole of `target` cannot be met by the only tip of a robot with `dof` joints; `None` where
    /// both parts are balanced.
    pub(crate) fn comes_first(&self, target: &Target, dof: usize) -> Option<First> {
        let plain = self.criterion.region.is_none()
            && self.criterion.components.is_none_or(|components| components.weights == [1.0; ROWS]);
        match target {
            Target::Pose(_) if plain => self.first.or((dof < POSE).then_some(First::Position)),
            _ => None,
        }
    }

    /// Removes the tool, which the robot carries.
    pub(crate) fn leave_tool(&mut self) {
        self.tool = None;
    }

    /// Marks a pair of tips that is held at its target, with this weight until it has reached it.
    pub(crate) fn held(self, weight: f64) -> Self {
        Self { weight, is_held: true, ..self }
    }

    /// Assesses `frame`, the frame of the subject.
    pub(super) fn assess(&self, target: &Target, frame: &Frame) -> Assessment {
        self.weighted(target.assess_tip(frame, &self.criterion))
    }

    /// Assesses like [`assess`](Self::assess) and writes residual and Jacobian, from the geometric Jacobian of `dof` columns in
    /// `block`.
    pub(super) fn linearize(&self, target: &Target, frame: &Frame, dof: usize, block: &mut TaskBlock) -> Assessment {
        let assessment = target.linearize_tip(frame, dof, &self.criterion, block);
        block.scale = self.weight;
        if self.weight != 1.0 {
            let entries = block.columns[..dof].iter_mut().chain(std::iter::once(&mut block.residual)).flatten();
            entries.for_each(|entry| *entry *= self.weight);
        }
        self.weighted(assessment)
    }

    fn weighted(&self, mut assessment: Assessment) -> Assessment {
        assessment.score.value *= self.weight * self.weight;
        assessment
    }

    /// Reduces `target` to the part that its task uses.
    ///
    /// # Errors
    /// [`Error::WrongTarget`]; [`Error::Contradiction`] for a pose of the centre of mass.
    pub(crate) fn reduce(&self, target: &mut Target) -> Result<()> {
        if self.subject == Subject::CenterOfMass && !matches!(target, Target::Position(_)) {
            let problem = "the centre of mass has no orientation: its target is a position".into();
            return Err(Error::Contradiction { problem });
        }
        if let Some(kind) = &self.kind {
            *target = kind.target(target)?;
        }
        Ok(())
    }

    /// Target of the tip itself, given a target of its tool.
    pub(crate) fn without_tool(&self, target: &Target) -> Target {
        match (&self.tool, target) {
            (Some(tool), Target::Pose(frame)) => Target::Pose(frame.then::<NoFma>(&tool.inverse())),
            _ => *target,
        }
    }

    /// Frame of the subject at `q`.
    pub(crate) fn frame(&self, robot: &Robot, q: &[f64]) -> Frame {
        match self.subject {
            Subject::CenterOfMass => robot.frame_at_center_of_mass(q, &mut []),
            _ => self.frame_of(|tip| robot.tip_of(tip, q)),
        }
    }

    /// Frame of the subject, a tip or a pair, with each tip at the frame that `tip` returns.
    pub(crate) fn frame_of(&self, tip: impl Fn(usize) -> Frame) -> Frame {
        let at_tool = |frame: Frame| self.tool.as_ref().map_or(frame, |tool| frame.then::<NoFma>(tool));
        match self.subject {
            Subject::Tip(of) => at_tool(tip(of)),
            Subject::Pair { from, of } => tip(from).inverse().then::<NoFma>(&at_tool(tip(of))),
            Subject::CenterOfMass => Frame::IDENTITY,
        }
    }

    /// Frame of the subject at `q`, and its geometric Jacobian.
    pub(crate) fn frame_and_jacobian(&self, robot: &Robot, q: &[f64], columns: &mut Columns) -> Frame {
        let (Subject::Tip(of) | Subject::Pair { of, .. }) = self.subject else {
            return robot.center_of_mass_and_jacobian(q, columns);
        };
        let mut frame = robot.tip_and_jacobian_of(of, q, columns);
        if let Some(tool) = &self.tool {
            let moved = frame.then::<NoFma>(tool);
            let lever = std::array::from_fn(|k| moved.origin[k] - frame.origin[k]);
            columns[..q.len()].iter_mut().for_each(|column| add_moment(column, &lever, 1.0));
            frame = moved;
        }
        match self.subject {
            Subject::Tip(_) | Subject::CenterOfMass => frame,
            Subject::Pair { from, .. } => {
                let mut own = Columns::default();
                let base = robot.tip_and_jacobian_of(from, q, &mut own);
                seen_from(&base, &mut own[..q.len()], &frame, &mut columns[..q.len()]);
                base.inverse().then::<NoFma>(&frame)
            }
        }
    }
}

/// Adds to the linear rows of a column, times `factor`, the velocity of a point at `lever` due to its angular rows.
fn add_moment(column: &mut [f64; 6], lever: &[f64; 3], factor: f64) {
    let moment = cross(&[column[3], column[4], column[5]], lever);
    (0..3).for_each(|k| column[k] += factor * moment[k]);
}

/// Transforms `columns`, the Jacobian of `frame`, to the Jacobian relative to `base`, whose Jacobian is `own`: with p the
/// vector between the frames, v = R'(v_frame - v_base - w_base x p) and w = R'(w_frame - w_base).
fn seen_from(base: &Frame, own: &mut [[f64; 6]], frame: &Frame, columns: &mut [[f64; 6]]) {
    let lever = std::array::from_fn(|k| frame.origin[k] - base.origin[k]);
    for (column, own) in columns.iter_mut().zip(own) {
        add_moment(own, &lever, 1.0);
        let relative: [f64; 6] = std::array::from_fn(|k| column[k] - own[k]);
        let along = |half: usize| base.axes.map(|axis| (0..3).map(|k| axis[k] * relative[3 * half + k]).sum::<f64>());
        column[..3].copy_from_slice(&along(0));
        column[3..].copy_from_slice(&along(1));
    }
}
