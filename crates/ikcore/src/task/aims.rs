//! Tasks and targets of one tip or several: each tip has its own target, or a target pose relative to another tip.

use smallvec::SmallVec;

use super::assessment::Assessment;
use super::criterion::Criterion;
use super::target::Target;
use super::tip_error::{SquaredError, TipError, Tolerance};
use super::tip_task::{Task, TaskKind};
use crate::error::{Error, Result};
use crate::math::Columns;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::cross;
use crate::objective::{Linearization, Score, TaskBlock};
use crate::robot::Robot;

/// Frame that a target refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Tip of this number.
    Tip(usize),
    /// Tip `of`, relative to tip `from`.
    Pair {
        /// Number of the reference tip.
        from: usize,
        /// Number of the moving tip.
        of: usize,
    },
}

/// Task of a tip, or of a pair of tips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedTask {
    /// Frame that the target refers to.
    pub subject: Subject,
    /// Part of the target to reach. `None` means all of it.
    pub task: Option<Task>,
    /// Tolerances within which the target counts as reached.
    pub tolerance: Tolerance,
}

/// Validated task.
#[derive(Debug, Clone)]
pub struct TipCriterion {
    /// Frame that the target refers to.
    pub(crate) subject: Subject,
    /// Part of the target to reach. `None` means all of it.
    kind: Option<TaskKind>,
    /// Criterion for reaching the target, with weights.
    pub(crate) criterion: Criterion,
    /// Tool of the task, in the frame of the moving tip.
    tool: Option<Box<Frame>>,
    /// Weight of the residual relative to other tasks.
    weight: f64,
}

impl NamedTask {
    /// Task of the only tip of a robot.
    #[inline]
    pub(crate) fn of_only(task: Option<Task>, tolerance: Tolerance) -> Self {
        Self { subject: Subject::Tip(0), task, tolerance }
    }

    /// Checks the task.
    ///
    /// # Errors
    /// Errors of [`Task::validate`] and of the tolerances.
    #[inline]
    pub(crate) fn validated(&self) -> Result<TipCriterion> {
        let Self { subject, task, tolerance } = *self;
        task.map_or(Ok(()), |task| task.validate())?;
        let criterion = task.map_or(tolerance.into(), |task| task.criterion(tolerance));
        criterion.validate()?;
        let tool = task.and_then(|task| task.tool).map(|tool| Box::new(Frame::from(&tool)));
        Ok(TipCriterion { subject, kind: task.map(|task| task.kind), criterion, tool, weight: 1.0 })
    }
}

impl<T: Into<Criterion>> From<T> for TipCriterion {
    /// Task of reaching the whole target of the only tip, by this criterion.
    fn from(criterion: T) -> Self {
        Self { subject: Subject::Tip(0), kind: None, criterion: criterion.into(), tool: None, weight: 1.0 }
    }
}

impl Subject {
    /// Whether the subject is a pair of tips.
    pub(crate) fn is_pair(&self) -> bool {
        matches!(self, Self::Pair { .. })
    }
}

impl TipCriterion {
    /// Removes the tool, which the robot carries.
    pub(crate) fn leave_tool(&mut self) {
        self.tool = None;
    }

    /// Sets the weight of the residual relative to other tasks.
    pub(crate) fn weighing(self, weight: f64) -> Self {
        Self { weight, ..self }
    }

    /// Assesses `frame`, the frame of the subject.
    fn assess(&self, target: &Target, frame: &Frame) -> Assessment {
        self.weighted(target.assess_tip(frame, &self.criterion))
    }

    /// Assesses like [`assess`](Self::assess) and writes residual and Jacobian, from the geometric Jacobian of `dof` columns in
    /// `block`.
    fn linearize(&self, target: &Target, frame: &Frame, dof: usize, block: &mut TaskBlock) -> Assessment {
        let assessment = target.linearize_tip(frame, dof, &self.criterion, block);
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
    /// [`Error::WrongTarget`].
    pub(crate) fn reduce(&self, target: &mut Target) -> Result<()> {
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
    fn frame(&self, robot: &Robot, q: &[f64]) -> Frame {
        let tip = |tip: usize| robot.tip_of(tip, q);
        let at_tool = |frame: Frame| self.tool.as_ref().map_or(frame, |tool| frame.then::<NoFma>(tool));
        match self.subject {
            Subject::Tip(of) => at_tool(tip(of)),
            Subject::Pair { from, of } => tip(from).inverse().then::<NoFma>(&at_tool(tip(of))),
        }
    }

    /// Frame of the subject at `q`, and its geometric Jacobian.
    fn frame_and_jacobian(&self, robot: &Robot, q: &[f64], columns: &mut Columns) -> Frame {
        let (Subject::Tip(of) | Subject::Pair { of, .. }) = self.subject;
        let mut frame = robot.tip_and_jacobian_of(of, q, columns);
        if let Some(tool) = &self.tool {
            let moved = frame.then::<NoFma>(tool);
            let lever = std::array::from_fn(|k| moved.origin[k] - frame.origin[k]);
            columns[..q.len()].iter_mut().for_each(|column| add_moment(column, &lever, 1.0));
            frame = moved;
        }
        match self.subject {
            Subject::Tip(_) => frame,
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

/// Tasks and their targets, in the same order.
#[derive(Debug, Clone, Copy, Default)]
pub struct Aims<'a> {
    /// Tasks; one for a robot with one tip.
    pub tasks: &'a [TipCriterion],
    /// Target of each task.
    pub targets: &'a [Target],
}

impl<'a> Aims<'a> {
    /// Task and target of the only tip.
    pub fn of_one(task: &'a TipCriterion, target: &'a Target) -> Self {
        Self { tasks: std::slice::from_ref(task), targets: std::slice::from_ref(target) }
    }

    /// Target and criterion of the only tip; `None` for a `robot` with several.
    #[inline]
    pub(crate) fn only(&self, robot: &Robot) -> Option<(&'a Target, &'a Criterion)> {
        match (self.tasks, self.targets) {
            ([task], [target]) if robot.tip_count() == 1 => Some((target, &task.criterion)),
            _ => None,
        }
    }

    /// Whether there are no targets.
    pub(crate) fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Iterates over tasks with their targets.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&'a TipCriterion, &'a Target)> + use<'a> {
        self.tasks.iter().zip(self.targets)
    }

    /// Assesses `q`: the sum of the values, solved if all tasks are solved, with the largest errors.
    pub(crate) fn assess(&self, robot: &Robot, q: &[f64]) -> Assessment {
        let assess = |(task, target): (&TipCriterion, &Target)| task.assess(target, &task.frame(robot, q));
        self.iter().map(assess).fold(nothing_asked(), together)
    }

    /// Assesses `q` and writes residuals and Jacobians. Calls `solved` with the number of each solved task of several tips.
    #[inline]
    pub(crate) fn linearize(
        &self,
        robot: &Robot,
        q: &[f64],
        out: &mut Linearization,
        solved: impl FnMut(usize),
    ) -> Assessment {
        match self.only(robot) {
            Some((target, criterion)) => target.linearize(robot, q, criterion, &mut out.first),
            None => self.linearize_several(robot, q, out, solved),
        }
    }

    // Kept out of line: inlining would slow down the case of one tip.
    #[cold]
    #[inline(never)]
    fn linearize_several(
        &self,
        robot: &Robot,
        q: &[f64],
        out: &mut Linearization,
        mut solved: impl FnMut(usize),
    ) -> Assessment {
        out.more.resize_with(self.tasks.len().saturating_sub(1), TaskBlock::default);
        let mut all = nothing_asked();
        for (number, ((task, target), block)) in self.iter().zip(out.blocks_mut()).enumerate() {
            let frame = task.frame_and_jacobian(robot, q, &mut block.columns);
            let one = task.linearize(target, &frame, q.len(), block);
            if one.score.solved {
                solved(number);
            }
            all = together(all, one);
        }
        all
    }

    /// Calls `keep` with the position (m) of each task's frame at `q`.
    pub(crate) fn positions(&self, robot: &Robot, q: &[f64], mut keep: impl FnMut([f64; 3])) {
        self.tasks.iter().for_each(|task| keep(task.frame(robot, q).origin));
    }

    /// Whether any task is for a pair of tips.
    pub(crate) fn has_pairs(&self) -> bool {
        self.tasks.iter().any(|task| task.subject.is_pair())
    }

    /// Whether all pairs of tips are at their relative poses at `q`; true without pairs.
    pub(crate) fn pairs_are_held(&self, robot: &Robot, q: &[f64]) -> bool {
        let mut pairs = self.iter().filter(|(task, _)| task.subject.is_pair());
        pairs.all(|(task, target)| task.assess(target, &task.frame(robot, q)).score.solved)
    }

    /// Calls `keep` with the residual of each task at `q`, and returns the assessment.
    pub(crate) fn residuals(&self, robot: &Robot, q: &[f64], mut keep: impl FnMut([f64; 6])) -> Assessment {
        let mut block = TaskBlock::default();
        let residual = |(task, target): (&TipCriterion, &Target)| {
            let assessment = task.linearize(target, &task.frame(robot, q), 0, &mut block);
            keep(block.residual);
            assessment
        };
        self.iter().map(residual).fold(nothing_asked(), together)
    }

    /// Errors of each task at `q`.
    pub(crate) fn errors(&self, robot: &Robot, q: &[f64]) -> SmallVec<[TipError; 4]> {
        let error = |(task, target): (&TipCriterion, &Target)| {
            TipError::from(target.assess_tip(&task.frame(robot, q), &task.criterion).error)
        };
        self.iter().map(error).collect()
    }

    /// Checks that targets of two tips agree with the target of their pair.
    ///
    /// # Errors
    /// [`Error::Contradiction`].
    pub(crate) fn require_consistent(&self, robot: &Robot) -> Result<()> {
        let pose_of = |tip: usize| {
            self.iter().find_map(|(task, target)| match (task.subject, task.without_tool(target)) {
                (Subject::Tip(of), Target::Pose(frame)) if of == tip && task.criterion.fixes_pose(target) => {
                    Some(frame)
                }
                _ => None,
            })
        };
        for (task, target) in self.iter() {
            let Subject::Pair { from, of } = task.subject else { continue };
            let (Some(base), Some(frame)) = (pose_of(from), pose_of(of)) else { continue };
            let at_tool = task.tool.as_ref().map_or(frame, |tool| frame.then::<NoFma>(tool));
            let seen = base.inverse().then::<NoFma>(&at_tool);
            let Assessment { score, error } = target.assess_tip(&seen, &task.criterion);
            if !score.solved {
                let names: Vec<&str> = robot.tips().collect();
                let (from, of) = (names[from], names[of]);
                let problem = format!(
                    "the targets of '{from}' and '{of}' contradict that of ('{from}', '{of}'), from which they are {} away: leave one out",
                    TipError::from(error)
                );
                return Err(Error::Contradiction { problem });
            }
        }
        Ok(())
    }
}

fn nothing_asked() -> Assessment {
    let error = SquaredError { position: None, rotation: None };
    Assessment { score: Score { value: 0.0, solved: true }, error }
}

/// Combines two assessments into one.
fn together(one: Assessment, other: Assessment) -> Assessment {
    let larger = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => Some(if a > b { a } else { b }),
        (a, b) => a.or(b),
    };
    let score = Score { value: one.score.value + other.score.value, solved: one.score.solved && other.score.solved };
    let (one, other) = (one.error, other.error);
    let error =
        SquaredError { position: larger(one.position, other.position), rotation: larger(one.rotation, other.rotation) };
    Assessment { score, error }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::UrdfOptions;
    use crate::math::pose;
    use crate::task::{Region, TaskKind};

    /// Robot with a rotating chest and two arms of three joints.
    fn robot() -> Robot {
        let mut urdf = String::from(r#"<robot name="pair"><link name="floor"/><link name="chest"/>"#);
        let mut joint = |name: &str, [parent, child]: [&str; 2], [xyz, axis]: [&str; 2], kind: &str| {
            urdf += &format!(
                r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="0.1 0.2 0.3"/>
                <axis xyz="{axis}"/></joint>"#
            );
        };
        joint("yaw", ["floor", "chest"], ["0 0 1", "0 0 1"], "continuous");
        for side in ["a", "b"] {
            let link = |i: usize| format!("{side}{i}");
            joint(
                &link(1),
                ["chest", &link(1)],
                [if side == "a" { "0 0.3 0" } else { "0 -0.3 0.1" }, "1 0 0"],
                "continuous",
            );
            joint(&link(2), [&link(1), &link(2)], ["0.3 0 0.1", "0 1 0"], "prismatic");
            joint(&link(3), [&link(2), &link(3)], ["0.2 0.1 0", "0.6 0 0.8"], "continuous");
        }
        for side in ["a", "b"] {
            (1..4).for_each(|i| urdf += &format!(r#"<link name="{side}{i}"/>"#));
        }
        let tips = vec!["a3".into(), "b3".into()];
        Robot::from_urdf_with(&(urdf + "</robot>"), &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap()
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let robot = robot();
        let q = [0.3, -0.4, 0.2, 0.9, 1.3, -0.1, 0.5];
        let tool = Some(pose::from_rpy([0.1, -0.4, 0.2], [0.05, 0.0, 0.15]));
        let region = Region::new([-0.1, f64::NEG_INFINITY, 0.0], [0.2, 0.5, f64::INFINITY]).unwrap();
        let weights = [1.0, 0.0, 2.0, 1.0, 0.5, 0.0];
        let kinds = [
            Task { tool, ..TaskKind::Pose.into() },
            Task::new(TaskKind::Pose, Some(&weights), None, tool).unwrap(),
            TaskKind::Position.into(),
            TaskKind::Orientation.into(),
            TaskKind::Pointing { axis: [0.0, 0.6, 0.8] }.into(),
            Task::from(TaskKind::Pose).within(region).unwrap(),
        ];
        let wanted = Target::from(&pose::from_rpy([0.3, 0.2, -0.4], [0.3, 0.1, 0.8]));
        for kind in kinds {
            let subjects = [Subject::Tip(0), Subject::Pair { from: 1, of: 0 }, Subject::Pair { from: 0, of: 1 }];
            let tolerance = Tolerance::default();
            let task = |subject| NamedTask { subject, task: Some(kind), tolerance }.validated().unwrap();
            let tasks = subjects.map(|subject| task(subject).weighing(if subject.is_pair() { 3.0 } else { 1.0 }));
            let mut targets = [wanted; 3];
            tasks.iter().zip(&mut targets).for_each(|(task, target)| task.reduce(target).unwrap());
            let aims = Aims { tasks: &tasks, targets: &targets };
            let linearized = |q: &[f64]| {
                let mut out = Linearization::default();
                let assessment = aims.linearize(&robot, q, &mut out, |_| ());
                assert!((assessment.score.value - aims.assess(&robot, q).score.value).abs() < 1e-12, "{kind:?}");
                out
            };
            let here = linearized(&q);
            let h = 1e-6;
            for j in 0..q.len() {
                let moved =
                    |by: f64| linearized(&std::array::from_fn::<f64, 7, _>(|k| if k == j { q[k] + by } else { q[k] }));
                let (ahead, behind) = (moved(h), moved(-h));
                for (i, block) in here.blocks().enumerate() {
                    let residual = |of: &Linearization| of.blocks().nth(i).unwrap().residual;
                    for row in 0..6 {
                        let difference = (residual(&ahead)[row] - residual(&behind)[row]) / (2.0 * h);
                        let error = (difference - block.columns[j][row]).abs();
                        assert!(error < 3e-8, "{kind:?}, task {i}, row {row}, joint {j}: off by {error:.1e}");
                    }
                }
            }
        }
    }
}
