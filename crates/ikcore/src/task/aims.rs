//! Tasks and targets of one tip or several: each tip has its own target, or a target pose relative to another tip.

use smallvec::SmallVec;

use super::assessment::Assessment;
use super::checked_task::CheckedTask;
use super::criterion::Criterion;
use super::subject::Subject;
use super::target::Target;
use super::tip_error::{SquaredError, TipError};
use crate::error::{Error, Result};
use crate::math::arithmetic::NoFma;
use crate::objective::{Linearization, Score, TaskBlock};
use crate::robot::Robot;

/// Tasks and their targets, in the same order.
#[derive(Debug, Clone, Copy, Default)]
pub struct Aims<'a> {
    /// Tasks; one for a robot with one tip.
    pub tasks: &'a [CheckedTask],
    /// Target of each task.
    pub targets: &'a [Target],
}

impl<'a> Aims<'a> {
    /// Task and target of the only tip.
    pub fn of_one(task: &'a CheckedTask, target: &'a Target) -> Self {
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
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&'a CheckedTask, &'a Target)> + use<'a> {
        self.tasks.iter().zip(self.targets)
    }

    /// Assesses `q`: the sum of the values, solved if all tasks are solved, with the largest errors.
    pub(crate) fn assess(&self, robot: &Robot, q: &[f64]) -> Assessment {
        let assess = |(task, target): (&CheckedTask, &Target)| task.assess(target, &task.frame(robot, q));
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

    /// Whether targets of several tips of `robot` have an order.
    pub(crate) fn has_levels(&self, robot: &Robot) -> bool {
        let differs = |task: &CheckedTask| task.first.is_some() || task.level != self.tasks[0].level;
        robot.tip_count() > 1 && self.tasks.iter().any(differs)
    }

    /// Whether any task is for a pair of tips that is held.
    pub(crate) fn has_pairs(&self) -> bool {
        self.tasks.iter().any(|task| task.is_held)
    }

    /// Whether all pairs of tips that are held are at their relative poses at `q`; true without any.
    pub(crate) fn pairs_are_held(&self, robot: &Robot, q: &[f64]) -> bool {
        let mut pairs = self.iter().filter(|(task, _)| task.is_held);
        pairs.all(|(task, target)| task.assess(target, &task.frame(robot, q)).score.solved)
    }

    /// Calls `keep` with the residual of each task at `q`, and returns the assessment.
    pub(crate) fn residuals(&self, robot: &Robot, q: &[f64], mut keep: impl FnMut([f64; 6])) -> Assessment {
        let mut block = TaskBlock::default();
        let residual = |(task, target): (&CheckedTask, &Target)| {
            let assessment = task.linearize(target, &task.frame(robot, q), 0, &mut block);
            keep(block.residual);
            assessment
        };
        self.iter().map(residual).fold(nothing_asked(), together)
    }

    /// Errors of each task at `q`.
    pub(crate) fn errors(&self, robot: &Robot, q: &[f64]) -> SmallVec<[TipError; 4]> {
        let error = |(task, target): (&CheckedTask, &Target)| {
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
                return Err(Error::Contradiction { problem: problem.into() });
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
    use crate::dynamics::Inertia;
    use crate::load::UrdfOptions;
    use crate::math::pose;
    use crate::task::{NamedTask, Region, Task, TaskKind, Tolerance};

    /// Robot with a rotating chest and two arms of three joints.
    fn robot() -> Robot {
        let mut urdf = String::from(r#"<robot name="pair"><link name="floor"/><link name="chest"/>"#);
        let mut joint = |name: &str, [parent, child]: [&str; 2], [xyz, axis]: [&str; 2], kind: &str| {
            urdf += &format!(
                r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="0.1 0.2 0.3"/>
                <axis xyz="{axis}"/><limit velocity="1"/></joint>"#
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

    /// The robot with an inertia of each link; those of arm b are heavier.
    fn with_masses(robot: &Robot) -> Robot {
        let links: Vec<String> = robot.all_link_names().map(str::to_owned).collect();
        let inertia = |link: &String| Inertia {
            mass: if link.starts_with('b') { 2.5 } else { 1.0 },
            center: [0.1, -0.2, 0.05],
            matrix: [[0.02, 0.0, 0.0], [0.0, 0.03, 0.0], [0.0, 0.0, 0.04]],
        };
        robot.with_inertias(links.iter().map(|link| (link.as_str(), inertia(link)))).unwrap()
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let robot = with_masses(&robot());
        let q = [0.3, -0.4, 0.2, 0.9, 1.3, -0.1, 0.5];
        let tool = Some(pose::from_rpy([0.1, -0.4, 0.2], [0.05, 0.0, 0.15]));
        let region = Region::new([-0.1, f64::NEG_INFINITY, 0.0], [0.2, 0.5, f64::INFINITY]).unwrap();
        let weights = [1.0, 0.0, 2.0, 1.0, 0.5, 0.0];
        let kinds = [
            Task { tool, ..TaskKind::Pose.into() },
            Task::new(TaskKind::Pose, Some(&weights), None, tool).unwrap(),
            TaskKind::Position.into(),
            Task::new(TaskKind::Position, Some(&[1.0, 0.5, 0.0]), None, None).unwrap(),
            TaskKind::Orientation.into(),
            TaskKind::Pointing { axis: [0.0, 0.6, 0.8] }.into(),
            Task::from(TaskKind::Pose).within(region).unwrap(),
        ];
        let wanted = Target::from(&pose::from_rpy([0.3, 0.2, -0.4], [0.3, 0.1, 0.8]));
        for kind in kinds {
            let is_position = kind.kind == TaskKind::Position;
            let fourth = if is_position { Subject::CenterOfMass } else { Subject::Tip(1) };
            let subjects =
                [Subject::Tip(0), Subject::Pair { from: 1, of: 0 }, Subject::Pair { from: 0, of: 1 }, fourth];
            let tolerance = Tolerance::default();
            let task = |subject| NamedTask { subject, task: Some(kind), tolerance }.validated().unwrap();
            let tasks = subjects.map(|subject| if subject.is_pair() { task(subject).held(3.0) } else { task(subject) });
            let mut targets = [wanted; 4];
            if is_position {
                targets[3] = Target::Position([0.1, 0.2, 0.9]);
            }
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
