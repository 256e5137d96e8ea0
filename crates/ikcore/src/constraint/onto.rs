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
    tasks: KeepTasks,
    lower: Point,
    upper: Point,
    linearized: Linearization,
}

/// Constraints as tasks, whose errors are the excess over a fraction of their tolerances.
#[derive(Debug, Default)]
pub(crate) struct KeepTasks {
    tasks: Vec<CheckedTask>,
    targets: Vec<Target>,
    scratch: Linearization,
}

impl KeepTasks {
    /// The tasks of `keeps`.
    pub fn new(keeps: &[Keep]) -> Self {
        let (tasks, targets) = keeps.iter().flat_map(|keep| keep.aimed([AIMED_AT_NARROW, AIMED_AT])).unzip();
        Self { tasks, targets, scratch: Linearization::default() }
    }

    /// Appends their residuals and Jacobians at `q` (n,), for the tips of `robot`; returns the sum of squares.
    pub fn append(&mut self, robot: &Robot, q: &[f64], out: &mut Linearization) -> f64 {
        let Self { tasks, targets, scratch } = self;
        if tasks.is_empty() {
            return 0.0;
        }
        let assessment = Aims { tasks, targets }.linearize(robot, q, scratch, |_| ());
        out.more.clear();
        out.more.extend(scratch.blocks().take(tasks.len()).cloned());
        assessment.score.value
    }
}

impl<'a> Onto<'a> {
    /// A projection on where `keeps` hold, within these joint limits.
    pub fn new(robot: &'a Robot, keeps: &[Keep], [lower, upper]: [&[f64]; 2]) -> Self {
        let [lower, upper] = [lower, upper].map(Point::from_slice);
        Self { robot, tasks: KeepTasks::new(keeps), lower, upper, linearized: Linearization::default() }
    }

    /// The projection on where `tasks` reach their targets too.
    pub fn reaching(mut self, tasks: impl IntoIterator<Item = (CheckedTask, Target)>) -> Self {
        for (task, target) in tasks {
            self.tasks.tasks.push(task);
            self.tasks.targets.push(target);
        }
        self
    }

    /// Moves `q` (n,) to a configuration at which all constraints hold; false if none was found near it.
    pub fn bring(&mut self, q: &mut [f64]) -> bool {
        let Self { robot, tasks: KeepTasks { tasks, targets, .. }, lower, upper, linearized } = self;
        let aims = Aims { tasks, targets };
        let n = q.len();
        linearized.project(q, [&lower[..], &upper[..]], STEPS, |q, linearized| {
            let assessment = aims.linearize(robot, q, linearized, |_| ());
            (!assessment.score.solved).then(|| linearized.least_damping(n))
        })
    }
}
