//! Tasks of several tips in the order of their levels: those of a lower level are met first.
//!
//! A pose of which one part comes first is two tasks: the order of its parts is a level inside its own.

use smallvec::SmallVec;

use super::aims::Aims;
use super::checked_task::CheckedTask;
use super::components::Components;
use super::first::First;
use super::subject::Subject;
use super::target::Target;
use crate::math::box_step::ROWS;
use crate::robot::Robot;

/// Tasks and targets, sorted by level.
#[derive(Debug, Clone, Default)]
pub struct Levels {
    tasks: Vec<CheckedTask>,
    targets: Vec<Target>,
    /// Number of tasks up to the end of each level.
    ends: SmallVec<[usize; 4]>,
}

/// Key of a task in the order: its level, and the place of its part of a pose.
type OrderKey = (u32, u8);

impl Levels {
    /// Levels of the tasks of several tips. Tolerances that are wide enough are what a level aims at.
    pub fn of(aims: &Aims<'_>) -> Self {
        let mut placed: SmallVec<[(OrderKey, CheckedTask, Target); 8]> = SmallVec::new();
        for (task, target) in aims.iter() {
            let mut task = task.clone();
            if task.criterion.has_band() {
                task.criterion = task.criterion.beyond_tolerance();
            }
            match (task.first, target) {
                (Some(first), Target::Pose(_)) => {
                    let rotation = first == First::Orientation;
                    placed.push(((task.level, 0), half(&task, rotation), *target));
                    placed.push(((task.level, 1), half(&task, !rotation), *target));
                }
                _ => placed.push(((task.level, 0), task, *target)),
            }
        }
        placed.sort_by_key(|(place, ..)| *place);
        let mut levels = Self::default();
        for (i, (place, task, target)) in placed.iter().enumerate() {
            if i > 0 && *place != placed[i - 1].0 {
                levels.ends.push(i);
            }
            levels.tasks.push(task.clone());
            levels.targets.push(*target);
        }
        levels.ends.push(placed.len());
        levels
    }

    /// Number of levels.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Tasks of level number `k`, counted from the lowest.
    pub fn aims(&self, k: usize) -> Aims<'_> {
        let range = if k == 0 { 0 } else { self.ends[k - 1] }..self.ends[k];
        Aims { tasks: &self.tasks[range.clone()], targets: &self.targets[range] }
    }

    /// Iterates over the tasks of each level, the lowest first.
    pub fn iter(&self) -> impl Iterator<Item = Aims<'_>> {
        (0..self.len()).map(|k| self.aims(k))
    }

    /// Whether the lowest level is met at `q`.
    pub fn lowest_is_met(&self, robot: &Robot, q: &[f64]) -> bool {
        self.aims(0).assess(robot, q).score.solved
    }

    /// Which levels are met at `q`, and which are not, by the errors of each tip.
    pub fn in_words(&self, robot: &Robot, q: &[f64]) -> String {
        let names: SmallVec<[&str; 8]> = robot.tips().collect();
        let name = |subject: Subject| subject.in_words(&names);
        let level = |aims: Aims<'_>| {
            let errors = aims.errors(robot, q);
            let each = aims.tasks.iter().zip(&errors).map(|(task, error)| (name(task.subject), error));
            let number = aims.tasks[0].level;
            if aims.assess(robot, q).score.solved {
                let met = each.map(|(name, error)| format!("{name} to {error}"));
                format!("level {number} met: {}", met.collect::<Vec<_>>().join(", "))
            } else {
                let missed = each.map(|(name, error)| format!("{name} {error} away"));
                format!("level {number} not met, the nearest found is {}", missed.collect::<Vec<_>>().join(", "))
            }
        };
        self.iter().map(level).collect::<Vec<_>>().join("; ")
    }
}

/// The task of one half of a pose: the rotation, or the position.
fn half(task: &CheckedTask, rotation: bool) -> CheckedTask {
    let mut half = task.clone();
    let weights: [f64; ROWS] = std::array::from_fn(|k| if (k >= 3) == rotation { 1.0 } else { 0.0 });
    let tolerance = task.criterion.components.and_then(|components| components.tolerance);
    (half.first, half.criterion.components) = (None, Some(Components { weights, tolerance }));
    half
}
