//! Configurations moved to where constraints hold.

use super::keep::Keep;
use crate::objective::{Linearization, Point};
use crate::robot::Robot;
use crate::task::{Aims, CheckedTask, Target};

/// Fraction of the tolerances that is aimed at, so that ways between configurations have room.
const AIMED_AT: f64 = 0.8;

/// The same where tolerances are so narrow that ways are curves through such configurations: they are smooth on the target itself.
const AIMED_AT_NARROW: f64 = 1e-3;

/// Gauss-Newton steps.
const STEPS: usize = 12;

/// Moves configurations to where constraints hold; owns its scratch.
#[derive(Debug)]
pub(crate) struct Onto<'a> {
    robot: &'a Robot,
    tasks: Vec<CheckedTask>,
    targets: Vec<Target>,
    lower: Point,
    upper: Point,
    linearized: Linearization,
}

impl<'a> Onto<'a> {
    /// A projection on where `keeps` hold, within these joint limits.
    pub fn new(robot: &'a Robot, keeps: &[Keep], [lower, upper]: [&[f64]; 2]) -> Self {
        let aimed = |keep: &Keep| {
            let (mut task, target) = keep.narrowed(if keep.is_narrow() { AIMED_AT_NARROW } else { AIMED_AT });
            task.criterion = task.criterion.beyond_tolerance();
            (task, target)
        };
        let (tasks, targets) = keeps.iter().map(aimed).unzip();
        let [lower, upper] = [lower, upper].map(Point::from_slice);
        Self { robot, tasks, targets, lower, upper, linearized: Linearization::default() }
    }

    /// The projection on where `tasks` reach their targets too.
    pub fn reaching(mut self, tasks: impl IntoIterator<Item = (CheckedTask, Target)>) -> Self {
        for (task, target) in tasks {
            self.tasks.push(task);
            self.targets.push(target);
        }
        self
    }

    /// Moves `q` (n,) to a configuration at which all constraints hold; false if none was found near it.
    pub fn bring(&mut self, q: &mut [f64]) -> bool {
        let Self { robot, tasks, targets, lower, upper, linearized } = self;
        let aims = Aims { tasks, targets };
        let n = q.len();
        linearized.project(q, [&lower[..], &upper[..]], STEPS, |q, linearized| {
            let assessment = aims.linearize(robot, q, linearized, |_| ());
            (!assessment.score.solved).then(|| linearized.least_damping(n))
        })
    }
}
