//! Starts for several tips: first the shared joints, then each arm by its own closed form or index, given the shared ones. Arms
//! that reached their targets in an earlier attempt keep their configuration.

use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::objective::{Bounds, Point};
use crate::rng::LazyRng;
use crate::robot::{Choice, Robot};
use crate::task::{Aims, Subject, Target};

/// Starts for several tips, with the tasks solved so far.
#[derive(Debug, Clone, Default)]
pub(super) struct TipStarts {
    attempts: usize,
    /// Last configuration that solved each task.
    solved: Vec<Option<Point>>,
    /// Task solved last.
    last: Option<usize>,
}

impl TipStarts {
    /// Records that `q` solves task number `task`.
    pub fn note(&mut self, task: usize, q: &[f64]) {
        if self.solved.len() <= task {
            self.solved.resize(task + 1, None);
        }
        self.solved[task] = Some(Point::from_slice(q));
        self.last = Some(task);
    }

    /// Writes the next start into `q`: the first with the shared joints in the middle of their ranges, later ones with random
    /// shared joints.
    pub fn propose(&mut self, robot: &Robot, aims: &Aims<'_>, bounds: &Bounds, rng: &mut LazyRng, q: &mut [f64]) {
        let attempt = self.attempts;
        self.attempts += 1;
        for (j, joint) in robot.joints().iter().enumerate() {
            let (lower, upper) = joint.sampling_range_within(bounds.lower()[j], bounds.upper()[j]);
            q[j] = if attempt == 0 { 0.5 * (lower + upper) } else { rng.uniform_in(lower, upper) };
        }
        let mut settled = self.kept(robot, aims, q);
        let mut choice = Choice { lower: bounds.lower(), upper: bounds.upper(), attempt, rng };
        for (task, target) in aims.iter() {
            if let Subject::Tip(tip) = task.subject
                && !settled[tip]
            {
                let aim = task.without_tool(&task.criterion.aim(target));
                settled[tip] = place(robot, tip, &aim, &mut choice, q);
            }
        }
        for (task, target) in aims.iter() {
            let Subject::Pair { from, of } = task.subject else { continue };
            let aim = task.without_tool(target);
            let (moved, base, seen) = match (settled[from], settled[of], &aim) {
                (true, true, _) => continue,
                (false, true, Target::Pose(seen)) => (from, of, Target::Pose(seen.inverse())),
                _ => (of, from, aim),
            };
            let placed = seen_from_base(&robot.tip_of(base, q), &seen);
            settled[moved] = place(robot, moved, &placed, &mut choice, q);
            settled[base] = true;
        }
    }

    /// Restores solved arms in `q`, and returns for each tip whether its arm is restored. With shared joints, only the arm of
    /// the task solved last is restored, in every other attempt: other arms may not reach their targets from there.
    fn kept(&self, robot: &Robot, aims: &Aims<'_>, q: &mut [f64]) -> Vec<bool> {
        let mut settled = vec![false; robot.tip_count()];
        let arms = (0..robot.tip_count()).filter_map(|tip| robot.arm(tip)).map(|arm| arm.joints.len());
        let shares_joints = arms.sum::<usize>() < robot.dof();
        if shares_joints && self.attempts.is_multiple_of(2) {
            return settled;
        }
        for (i, (task, _)) in aims.iter().enumerate() {
            let Subject::Tip(tip) = task.subject else { continue };
            let (Some(Some(known)), Some(arm)) = (self.solved.get(i), robot.arm(tip)) else { continue };
            if !shares_joints {
                arm.joints.iter().for_each(|joint| q[*joint] = known[*joint]);
                settled[tip] = true;
            } else if self.last == Some(i) {
                q.copy_from_slice(known);
                settled[tip] = true;
            }
        }
        settled
    }
}

/// Moves tip number `tip` to or near `target` by its own joints.
fn place(robot: &Robot, tip: usize, target: &Target, choice: &mut Choice<'_>, q: &mut [f64]) -> bool {
    let (Some(arm), Some(stem)) = (robot.arm(tip), robot.stem_of(tip, q)) else { return false };
    match (seen_from_base(&stem.inverse(), target), target.position()) {
        (Target::Pose(pose), _) => arm.start_at_pose(&pose, choice, q),
        (seen, Some(_)) => arm.start_at_position(&seen.position().unwrap_or_default(), choice, q),
        _ => false,
    }
}

/// Transforms a target from the frame `base` to the axes of the robot's base.
fn seen_from_base(base: &Frame, target: &Target) -> Target {
    match target {
        Target::Position(position) => Target::Position(base.transform::<NoFma>(position)),
        Target::Pose(frame) => Target::Pose(base.then::<NoFma>(frame)),
        Target::Orientation(frame) => Target::Orientation(base.then::<NoFma>(frame)),
        Target::Pointing { frame, axis } => Target::Pointing { frame: base.then::<NoFma>(frame), axis: *axis },
    }
}
