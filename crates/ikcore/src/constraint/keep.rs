//! Constraint at every instant of a motion: the error of a task to its target stays within the task's tolerance.

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::drift::SeenRates;
use super::gauge::{Gauge, Seen};
use crate::error::{Error, Result};
use crate::math::arithmetic::NoFma;
use crate::math::{Columns, Frame, MAX_DOF, STACK_DOF};
use crate::robot::Robot;
use crate::task::{CheckedTask, NamedTask, Subject, Target};

/// A task whose error to a fixed target stays within its tolerance.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Given", into = "Given")]
pub struct Keep {
    given: Given,
    task: CheckedTask,
    /// The part of the target that the task uses.
    target: Target,
    pub(super) gauges: Vec<Gauge>,
    /// Number of entries of the task.
    entries: usize,
}

/// An error, linearised at a configuration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KeepRow {
    /// Remaining tolerance (rad, m); negative beyond it.
    pub left: f64,
    /// Width of the band in which it is kept (rad, m): its tolerance.
    pub room: f64,
    /// Derivative of the error by the joints.
    pub slope: [f64; MAX_DOF],
}

/// A task and its target, as the caller gives them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Given {
    task: NamedTask,
    target: Target,
}

impl TryFrom<Given> for Keep {
    type Error = Error;

    fn try_from(Given { task, target }: Given) -> Result<Self> {
        Self::new(&task, &target)
    }
}

impl From<Keep> for Given {
    fn from(keep: Keep) -> Self {
        keep.given
    }
}

impl PartialEq for Keep {
    fn eq(&self, other: &Self) -> bool {
        self.given == other.given
    }
}

impl Keep {
    /// A task and its target, for a tip, or for one tip seen from another.
    ///
    /// # Errors
    /// Those of the task and its target; [`Error::Contradiction`] for a task without a finite tolerance, with a level, or of the centre
    /// of mass.
    pub fn new(named: &NamedTask, target: &Target) -> Result<Self> {
        if named.subject == Subject::CenterOfMass {
            let problem = "a tip or a pair of tips is kept along the way, not the centre of mass".into();
            return Err(Error::Contradiction { problem });
        }
        let given = Given { task: *named, target: *target };
        let (task, mut target) = (named.validated()?, *target);
        if task.level != 0 {
            let problem = format!(
                "what is kept comes before all targets, at every instant: leave out the level of its task, {}",
                task.level
            );
            return Err(Error::Contradiction { problem: problem.into() });
        }
        target.validate()?;
        task.reduce(&mut target)?;
        let gauges = Gauge::all(&target, &task.criterion);
        if gauges.is_empty() {
            let problem =
                "nothing would be kept: all tolerances of the task are infinite, or all its weights zero".into();
            return Err(Error::Contradiction { problem });
        }
        let entries = match (&target, &task.criterion.components) {
            (Target::Position(_), None) | (Target::Orientation(_), None) => 1,
            (_, None) => 2,
            (Target::Position(_), Some(_)) | (Target::Orientation(_), Some(_)) => 3,
            (Target::Pointing { .. }, Some(_)) => 4,
            (Target::Pose(_), Some(_)) => 6,
        };
        Ok(Self { given, task, target, gauges, entries })
    }

    /// The task, for a tip or for one tip seen from another.
    pub fn task(&self) -> &NamedTask {
        &self.given.task
    }

    /// The target, as it was given.
    pub fn target(&self) -> &Target {
        &self.given.target
    }

    /// Checks that the robot has the tips that it names.
    ///
    /// # Errors
    /// [`Error::Contradiction`].
    pub fn require_tips(&self, robot: &Robot) -> Result<()> {
        let last = match self.task.subject {
            Subject::Tip(of) => of,
            Subject::Pair { from, of } => from.max(of),
            Subject::CenterOfMass => 0,
        };
        if last < robot.tip_count() {
            return Ok(());
        }
        let problem = format!("something is to be kept for tip number {last}, but the robot has {}", robot.tip_count());
        Err(Error::Contradiction { problem: problem.into() })
    }

    /// Whether straight lines in joint space cannot keep it: its tolerances leave them no room.
    pub(crate) fn is_narrow(&self) -> bool {
        self.gauges.iter().any(|gauge| gauge.is_of_task() && gauge.tolerance < NARROW)
    }

    /// Largest error of each entry of the task at `q` (n,) (m, rad); NaN for entries that are free. A task without weights or tolerances
    /// of its own has one entry for its position and one for its rotation.
    pub fn errors(&self, robot: &Robot, q: &[f64]) -> Vec<f64> {
        let seen = self.seen(&self.frame(robot, q));
        self.by_entry(self.gauges.iter().map(|gauge| gauge.value(&seen)))
    }

    /// Whether it holds at `q` (n,).
    pub(crate) fn holds(&self, robot: &Robot, q: &[f64]) -> bool {
        let seen = self.seen(&self.frame(robot, q));
        self.gauges.iter().all(|gauge| gauge.value(&seen) <= gauge.most())
    }

    /// The error that is farthest beyond its tolerance at `q` (n,), in words; `None` where all hold.
    pub(crate) fn broken_at(&self, robot: &Robot, q: &[f64]) -> Option<String> {
        let seen = self.seen(&self.frame(robot, q));
        let excess = |gauge: &&Gauge| gauge.value(&seen) - gauge.tolerance;
        let broken = self.gauges.iter().filter(|gauge| gauge.value(&seen) > gauge.most());
        broken
            .max_by(|one, other| excess(one).total_cmp(&excess(other)))
            .map(|gauge| gauge.in_words(gauge.value(&seen)))
    }

    /// Returns the remaining tolerance of the error at `q` (n,) nearest to its own, as a fraction, or for a region as a distance (m), and the
    /// error in words.
    pub(crate) fn tightest_at(&self, robot: &Robot, q: &[f64]) -> Option<(f64, String)> {
        let seen = self.seen(&self.frame(robot, q));
        let left = |gauge: &&Gauge| {
            let left = gauge.tolerance - gauge.value(&seen);
            if gauge.is_of_task() { left / gauge.tolerance.max(f64::MIN_POSITIVE) } else { left }
        };
        let tightest = self.gauges.iter().min_by(|one, other| left(one).total_cmp(&left(other)))?;
        Some((left(&tightest), tightest.in_words(tightest.value(&seen))))
    }

    /// The error that is farthest beyond its tolerance at `q` (n,), or nearest to it, its value there and its tolerance, and the unit.
    pub(crate) fn worst_at(&self, robot: &Robot, q: &[f64]) -> (String, [f64; 2], &'static str) {
        let seen = self.seen(&self.frame(robot, q));
        let excess = |gauge: &&Gauge| gauge.value(&seen) - gauge.tolerance;
        let worst = self.gauges.iter().max_by(|one, other| excess(one).total_cmp(&excess(other)));
        worst
            .map_or_else(Default::default, |gauge| (gauge.named(), [gauge.value(&seen), gauge.tolerance], gauge.unit()))
    }

    /// Calls `take` with each of its errors at `q` (n,), linearised there. `columns` is scratch.
    pub(crate) fn each_row(&self, robot: &Robot, q: &[f64], columns: &mut Columns, mut take: impl FnMut(KeepRow)) {
        let frame = self.task.frame_and_jacobian(robot, q, columns);
        let seen = self.seen(&frame);
        let mut drifts: SmallVec<[SeenRates; STACK_DOF]> = SmallVec::new();
        drifts.extend(columns[..q.len()].iter().map(|column| SeenRates::of(&self.target, &frame, column)));
        for gauge in &self.gauges {
            let mut slope = [0.0; MAX_DOF];
            slope.iter_mut().zip(&drifts).for_each(|(slope, drift)| *slope = gauge.slope(&seen, drift));
            let room = if gauge.is_of_task() { gauge.tolerance } else { f64::INFINITY };
            take(KeepRow { left: gauge.tolerance - gauge.value(&seen), room, slope });
        }
    }

    /// Errors, none larger than its tolerance: they are known to be within.
    pub(crate) fn at_most_tolerances(&self, mut errors: Vec<f64>) -> Vec<f64> {
        for gauge in self.gauges.iter().filter(|gauge| gauge.is_of_task()) {
            errors[gauge.entry] = errors[gauge.entry].min(gauge.tolerance);
        }
        errors
    }

    /// Spreads the values of all gauges over the entries of the task.
    pub(super) fn by_entry(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut entries = vec![f64::NAN; self.entries];
        let of_task = self.gauges.iter().zip(values).filter(|(gauge, _)| gauge.is_of_task());
        of_task.for_each(|(gauge, value)| entries[gauge.entry] = value);
        entries
    }

    /// The task and its target, aimed at the fraction `wide` of its tolerances where the error is larger.
    ///
    /// An entry with a narrow tolerance is aimed at the target itself, to within `narrow` of it: of errors that come and go within a narrow
    /// band, those outside would push the others out again. Narrow and wide entries of one task are two tasks.
    pub(super) fn aimed(&self, [narrow, wide]: [f64; 2]) -> Vec<(CheckedTask, Target)> {
        let part = |is_narrow: bool, keeps_entry: &dyn Fn(f64) -> bool| {
            let mut task = self.task.clone();
            if let Some(components) = &mut task.criterion.components
                && let Some(tolerance) = &mut components.tolerance
            {
                for (weight, tolerance) in components.weights.iter_mut().zip(tolerance) {
                    if !keeps_entry(*tolerance) {
                        (*weight, *tolerance) = (0.0, f64::INFINITY);
                    }
                }
            }
            task.criterion.narrow(if is_narrow { narrow } else { wide });
            task.criterion = if is_narrow { task.criterion.exact() } else { task.criterion.beyond_tolerance() };
            (task, self.target)
        };
        if !self.is_narrow() {
            return vec![part(false, &|_| true)];
        }
        let has_wide = self.gauges.iter().any(|gauge| !gauge.is_of_task() || gauge.tolerance >= NARROW);
        let tolerances = self.task.criterion.components.and_then(|components| components.tolerance);
        let split = has_wide && (tolerances.is_some() || self.task.criterion.region.is_some());
        let wide = split.then(|| part(false, &|tolerance| tolerance >= NARROW));
        std::iter::once(part(true, &|tolerance| tolerance < NARROW)).chain(wide).collect()
    }

    pub(super) fn subject(&self) -> &Subject {
        &self.task.subject
    }

    /// Frame of the subject at `q`.
    pub(super) fn frame(&self, robot: &Robot, q: &[f64]) -> Frame {
        self.task.frame(robot, q)
    }

    /// Frame of the subject, and its origin in the base (m), with the moving elements of `robot` at `frames`.
    pub(super) fn place(&self, robot: &Robot, frames: &[Frame]) -> (Frame, [f64; 3]) {
        let tip = |tip: usize| robot.tip_among(tip, frames);
        let frame = self.task.frame_of(tip);
        let origin = match self.task.subject {
            Subject::Tip(_) | Subject::CenterOfMass => frame.origin,
            Subject::Pair { from, .. } => tip(from).transform::<NoFma>(&frame.origin),
        };
        (frame, origin)
    }

    /// The subject at `frame`, as the target sees it.
    pub(super) fn seen(&self, frame: &Frame) -> Seen {
        Seen::from(&self.target, frame)
    }
}

/// Checks that all constraints hold at a configuration; `what` names it in the error.
///
/// # Errors
/// [`Error::Contradiction`] with the error and its tolerance.
pub(crate) fn refuse_broken(what: &str, keeps: &[Keep], robot: &Robot, q: &[f64]) -> Result<()> {
    match keeps.iter().find_map(|keep| keep.broken_at(robot, q)) {
        None => Ok(()),
        Some(broken) => {
            let problem = format!("{what}: what is to be kept on the way does not hold there: {broken}");
            Err(Error::Contradiction { problem: problem.into() })
        }
    }
}

/// Tolerance (m, rad) below which straight lines in joint space cannot keep it.
const NARROW: f64 = 5e-3;
