//! Rows on the command of a tracked arm, from constraints that hold at every instant.
//!
//! Each error of a constraint limits how far the rest configuration may move towards its tolerance, as a static body does for its
//! distance in `around_arm`.

use std::sync::Arc;

use super::around_arm::{PACE, Response};
use super::step_context::StepContext;
use crate::constraint::{Keep, KeepRow, KeepScratch, KeepSweep};
use crate::math::Columns;
use crate::math::row_step::{Row, SOFTNESS};
use crate::math::vector::dot;
use crate::obstacle::{Edge, JointMotion};
use crate::robot::Robot;

/// Tolerance left over at the rest configuration, as room for the certificate: in rad or m, and at most this fraction of the tolerance.
const ROOM: [f64; 2] = [2e-4, 0.1];
/// The same for what is required instead of desired.
const LEAST_ROOM: [f64; 2] = [2e-5, 0.01];

/// Intervals examined before a motion counts as one that breaks a constraint.
const MOST_INTERVALS: usize = 120;

/// Constraints of an arm, with the rows that they impose.
#[derive(Debug)]
pub(super) struct Kept {
    /// The robot whose tips they are about: without the tool of a task.
    robot: Arc<Robot>,
    keeps: Vec<Keep>,
    columns: Box<Columns>,
    scratch: KeepScratch,
    /// Intervals that certificates have examined so far.
    intervals: usize,
}

impl Kept {
    /// Constraints of the tips of `robot`.
    pub fn new(robot: Arc<Robot>, keeps: Vec<Keep>) -> Self {
        Self { robot, keeps, columns: Box::default(), scratch: KeepScratch::default(), intervals: 0 }
    }

    /// The constraints.
    pub fn keeps(&self) -> &[Keep] {
        &self.keeps
    }

    /// The robot whose tips they are about.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The error at `q` that is nearest to its tolerance, in words.
    pub fn tightest_at(&self, q: &[f64]) -> Option<String> {
        let each = self.keeps.iter().filter_map(|keep| keep.tightest_at(&self.robot, q));
        each.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, error)| error)
    }

    /// Intervals that certificates have examined so far.
    pub fn intervals(&self) -> usize {
        self.intervals
    }

    /// Adds the rows of a command that ends in `rest`. Returns whether `command` violates one.
    pub fn add_rows(&mut self, context: &StepContext<'_>, rest: &[f64], command: &[f64], rows: &mut Vec<Row>) -> bool {
        let response = Response::new(context, rest);
        let pace = (context.dt / PACE).min(1.0);
        let first = rows.len();
        self.each_row(rest, |row| {
            let [room, least_room] = [ROOM, LEAST_ROOM].map(|room| within(&row, room));
            // A desired tolerance is restored gradually, so that it does not compete with required ones.
            let whole = room - row.left;
            let wanted = if whole > 0.0 { (pace * whole).max(least_room - row.left) } else { whole };
            rows.push(response.row(&row.slope.map(|slope| -slope), wanted));
        });
        rows[first..].iter().any(|row| dot(&row.gradient, command) < row.least)
    }

    /// Adds the rows at the rest configuration after the command `q`, where the slopes differ from those before it.
    pub fn add_rows_after(&mut self, context: &StepContext<'_>, rest: &[f64], q: &[f64], rows: &mut Vec<Row>) {
        let response = Response::new(context, rest).slope;
        self.each_row(rest, |row| {
            let least = within(&row, LEAST_ROOM) - row.left;
            let mut after = Row { gradient: row.slope, least, softness: SOFTNESS };
            after.gradient.iter_mut().zip(&response).for_each(|(entry, response)| *entry *= -response);
            after.least += dot(&after.gradient[..q.len()], q);
            rows.push(after);
        });
    }

    /// Adds the rows of a goal configuration at `q`. Returns whether `q` satisfies them.
    pub fn add_goal_rows(&mut self, q: &[f64], rows: &mut Vec<Row>) -> bool {
        let first = rows.len();
        self.each_row(q, |row| {
            // A goal keeps slightly more of its tolerance than the arm that pursues it.
            let gradient = row.slope.map(|slope| -slope);
            let least = 2.0 * within(&row, ROOM) - row.left + dot(&gradient[..q.len()], q);
            rows.push(Row { gradient, least, softness: SOFTNESS });
        });
        rows[first..].iter().all(|row| dot(&row.gradient, q) >= row.least)
    }

    /// Whether the motion until `end` (ticks) is certified. The curve of a spline before tick 0 depends on the command, too.
    pub fn certifies(&mut self, motion: &impl JointMotion, end: f64) -> bool {
        (!motion.is_spline() || self.holds_on(motion, [-1.0, 0.0])) && self.holds_on(motion, [0.0, end])
    }

    /// Whether the straight line of the joints between two configurations is certified.
    pub fn certifies_line(&mut self, from: &[f64], to: &[f64]) -> bool {
        self.holds_on(&Edge { from, to }, [0.0, 1.0])
    }

    fn holds_on(&mut self, motion: &impl JointMotion, ends: [f64; 2]) -> bool {
        let scratch = std::mem::take(&mut self.scratch);
        let mut sweep = KeepSweep::with_scratch(&self.robot, &self.keeps, scratch);
        let holds = sweep.holds_within(motion, ends, MOST_INTERVALS);
        self.intervals += sweep.intervals();
        self.scratch = sweep.into_scratch();
        holds
    }

    fn each_row(&mut self, q: &[f64], mut take: impl FnMut(KeepRow)) {
        let Self { robot, keeps, columns, .. } = self;
        keeps.iter().for_each(|keep| keep.each_row(robot, q, columns, &mut take));
    }
}

/// A distance from a tolerance: this one, or this fraction of the tolerance if that is less.
fn within(row: &KeepRow, [most, fraction]: [f64; 2]) -> f64 {
    most.min(fraction * row.room)
}
