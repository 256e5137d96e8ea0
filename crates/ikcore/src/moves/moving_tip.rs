//! Tips that moves lead, their tasks, and the joints that move them.

use std::borrow::Cow;

use super::move_task::MoveTask;
use super::moves_options::MovesOptions;
use super::program::{JointGoal, Move, MoveKind};
use crate::error::Result;
use crate::ik::bring_near;
use crate::limits::Limits;
use crate::math::arithmetic::NoFma;
use crate::math::{Columns, Frame, Pose};
use crate::objective::{Bounds, Point};
use crate::robot::Robot;
use crate::task::{CheckedTask, NamedTask, Subject, Task, Tolerance};
use crate::timing::ConstantLimits;

/// A tip and its task at poses.
///
/// Its own joints are those that move it and no other tip: all joints for the only tip of a robot. Moves that it leads leave all others where
/// they are, and with them the other tips.
#[derive(Debug, Clone)]
pub(super) struct MovingTip<'a> {
    /// The whole robot; with the tool of the task, if it has one tip.
    robot: Cow<'a, Robot>,
    pub number: usize,
    pub task: MoveTask,
    /// The own joints of one of several tips; `None` for the only tip.
    arm: Option<OwnArm>,
}

/// The arm of one of several tips.
#[derive(Debug, Clone)]
struct OwnArm {
    /// The tip's frame, with the tool of the task.
    frame: CheckedTask,
    /// From the frame at which the own joints begin to the tip, with the tool of the task.
    robot: Robot,
    /// The own joints, as entries of q of the whole robot; empty where no joint moves the tip alone.
    joints: Vec<usize>,
}

impl<'a> MovingTip<'a> {
    /// All tips of a robot, with the tasks of `options`.
    ///
    /// # Errors
    /// Those of [`MoveTask::of`].
    pub fn all(robot: &'a Robot, options: &MovesOptions) -> Result<Vec<Self>> {
        (0..robot.tip_count()).map(|number| Self::of(robot, number, options.task_of(number))).collect()
    }

    fn of(robot: &'a Robot, number: usize, given: Option<&Task>) -> Result<Self> {
        let task = MoveTask::of(given)?;
        let with_tool = |robot: &Robot| given.map_or(Ok(None), |given| given.robot(robot));
        if robot.tip_count() == 1 {
            let robot = with_tool(robot)?.map_or(Cow::Borrowed(robot), Cow::Owned);
            return Ok(Self { robot, number, task, arm: None });
        }
        let frame = NamedTask { subject: Subject::Tip(number), task: given.copied(), tolerance: Tolerance::default() };
        let frame = frame.validated()?;
        let arm = match robot.arm(number) {
            Some(arm) => {
                let robot = with_tool(&arm.robot)?.unwrap_or_else(|| arm.robot.clone());
                OwnArm { frame, robot, joints: arm.joints.clone() }
            }
            None => OwnArm { frame, robot: robot.clone(), joints: vec![] },
        };
        Ok(Self { robot: Cow::Borrowed(robot), number, task, arm: Some(arm) })
    }

    /// The same tip with another task, which has the same tool.
    pub fn with_task(&self, task: MoveTask) -> Self {
        Self { task, ..self.clone() }
    }

    /// Number of the joints of the whole robot.
    pub fn dof(&self) -> usize {
        self.robot.dof()
    }

    /// Names of the joints of the whole robot.
    pub fn joint_names(&self) -> Vec<String> {
        self.robot.joints().iter().map(|joint| joint.name.clone()).collect()
    }

    /// Frame of the tip at a configuration.
    pub fn frame(&self, q: &[f64]) -> Frame {
        match &self.arm {
            None => self.robot.tip(q),
            Some(arm) => arm.frame.frame(&self.robot, q),
        }
    }

    /// Frame of the tip at a configuration, whose Jacobian is written.
    pub fn frame_and_jacobian(&self, q: &[f64], columns: &mut Columns) -> Frame {
        match &self.arm {
            None => self.robot.tip_and_jacobian(q, columns),
            Some(arm) => arm.frame.frame_and_jacobian(&self.robot, q, columns),
        }
    }

    /// Position of the tip at a configuration (m).
    pub fn position(&self, q: &[f64]) -> [f64; 3] {
        if self.arm.is_none() { self.robot.tip_position(q) } else { self.frame(q).origin }
    }

    /// Whether it has joints of its own.
    pub fn is_movable(&self) -> bool {
        self.arm.as_ref().is_none_or(|arm| !arm.joints.is_empty())
    }

    /// Whether its joints can move while it meets a pose.
    pub fn is_redundant(&self) -> bool {
        self.task.leaves_freedom(self.arm.as_ref().map_or(self.robot.dof(), |arm| arm.joints.len()))
    }

    /// The configuration `q` with its own joints at the whole turns nearest to `reference`.
    pub fn near(&self, q: &[f64], bounds: &Bounds, reference: &[f64]) -> Point {
        let mut near = Point::from_slice(q);
        bring_near(&self.robot, bounds, reference, &mut near);
        self.whole(&self.own(&near), q)
    }

    /// The period (rad) of a joint of its own that may be turned by whole turns; `None` for all other joints.
    pub fn turn_period(&self, joint: usize) -> Option<f64> {
        if self.owns(joint) { self.robot.turn_period(joint) } else { None }
    }

    /// Whether a joint is its own.
    pub fn owns(&self, joint: usize) -> bool {
        self.arm.as_ref().is_none_or(|arm| arm.joints.contains(&joint))
    }

    /// The box with all joints but its own held at `q`.
    pub fn with_others_at(&self, q: &[f64], mut bounds: Bounds) -> Bounds {
        if let Some(arm) = &self.arm {
            for joint in (0..q.len()).filter(|joint| !arm.joints.contains(joint)) {
                bounds.hold(joint, q[joint]);
            }
        }
        bounds
    }

    /// The limits `given`, or the robot's, with the positions of `limits`, and all joints but its own held at `q`.
    ///
    /// # Errors
    /// None in practice.
    pub fn limits_with_others_at(&self, q: &[f64], given: Option<&Limits>, limits: &ConstantLimits) -> Result<Limits> {
        let given = given.cloned().unwrap_or_else(|| Limits::of(&self.robot));
        let ranges = limits.lower.iter().copied().zip(limits.upper.iter().copied());
        let held = self.with_others_at(q, Bounds::from_ranges(ranges));
        given.with_positions(held.lower(), held.upper())
    }

    /// The robot that configurations of this tip are solved with.
    pub fn solved(&self) -> &Robot {
        self.arm.as_ref().map_or(&self.robot, |arm| &arm.robot)
    }

    /// The position limits of that robot.
    ///
    /// # Errors
    /// None in practice.
    pub fn solved_limits(&self, limits: &ConstantLimits) -> Result<Limits> {
        Limits::of(self.solved()).with_positions(&self.own(&limits.lower), &self.own(&limits.upper))
    }

    /// The entries of its own joints.
    pub fn own(&self, q: &[f64]) -> Point {
        match &self.arm {
            None => q.into(),
            Some(arm) => arm.joints.iter().map(|joint| q[*joint]).collect(),
        }
    }

    /// The configuration of the whole robot with these entries of its own joints, and all others as in `q`.
    pub fn whole(&self, own: &[f64], q: &[f64]) -> Point {
        let Some(arm) = &self.arm else { return own.into() };
        let mut whole = Point::from_slice(q);
        arm.joints.iter().zip(own).for_each(|(joint, own)| whole[*joint] = *own);
        whole
    }

    /// The pose in the base of the robot that configurations are solved with, where the whole robot is at `q`.
    pub fn seen(&self, pose: &Pose, q: &[f64]) -> Pose {
        match self.robot.stem_of(self.number, q) {
            None => *pose,
            Some(stem) => stem.inverse().then::<NoFma>(&Frame::from(pose)).into(),
        }
    }
}

/// The tips that a move leads: the one that it names, or all of them for a joint move to a configuration.
pub(super) fn led_by<'t, 'a>(tips: &'t [MovingTip<'a>], each: &Move) -> &'t [MovingTip<'a>] {
    let named = each.tip.as_deref().and_then(|name| tips.first()?.robot.tip_number(name).ok());
    match (&each.kind, named) {
        (MoveKind::Joints(JointGoal::Configuration(_)) | MoveKind::Wait(_), _) | (_, None) => tips,
        (_, Some(number)) => &tips[number..=number],
    }
}
