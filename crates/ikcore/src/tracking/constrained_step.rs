//! Constrained steps in a box: towards the target or nearest to the start, in task space or in joint space.

use smallvec::SmallVec;

use crate::math::MAX_DOF;
use crate::math::block_step::TaskRows;
use crate::math::box_step::ROWS;
use crate::math::row_step::{Row, RowSolver, RowStep, SOFTNESS};
use crate::math::vector::{dot, squared_size};
use crate::objective::{Linearization, Point, TaskBlock};
use crate::robot::Robot;
use crate::task::Aims;

/// Damping of joint motion, relative to the squared norm of the Jacobian.
const DAMPING: f64 = 1e-5;

/// Weight of the separating rows relative to the task.
const URGENT: f64 = 10.0;

/// Newton steps onto the poses of pairs; they converge quadratically.
const HOLDING_STEPS: usize = 5;

/// Largest error of a held pair (m, rad).
const HELD: f64 = 1e-10;

/// Largest number of rows of a pair.
const ROWS_OF_PAIR: usize = ROWS;

/// Solver of constrained steps, with its constraints and scratch.
#[derive(Debug, Default)]
pub(super) struct ConstrainedStep {
    /// Inequalities.
    pub rows: Vec<Row>,
    /// Inequalities that separate overlapping bodies, which one step may not achieve; the first six join the tasks.
    pub wanted: Vec<Row>,
    wanted_columns: Vec<[f64; ROWS]>,
    /// Equations that hold pairs of tips at their relative poses.
    held: Vec<Row>,
    solver: RowSolver,
    linearization: Box<Linearization>,
}

/// Reference point of a step: the point of the feasible set nearest to it is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Towards {
    /// The target.
    Target,
    /// Start of the step, by the effect on the task.
    Start,
    /// Start of the step, by joint displacements: an arm with limited acceleration would otherwise keep redundant joints
    /// moving.
    Joints,
}

/// Request for a step of a robot in a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepRequest<'a> {
    pub robot: &'a Robot,
    /// Tasks and targets: pairs of tips are held, other targets weigh joint motions. Empty: the first tip weighs them.
    pub aims: Aims<'a>,
    /// Lower and upper ends of the box.
    pub ends: [&'a [f64]; 2],
    pub towards: Towards,
}

/// Rest configuration after a `command`, and its derivative with respect to the command, joint by joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct Resting<'a> {
    pub rest: &'a [f64],
    pub slope: &'a [f64],
    pub command: &'a [f64],
}

impl ConstrainedStep {
    /// Solver with scratch for `n` joints and this many rows.
    pub fn with_room(n: usize, rows: usize) -> Self {
        Self {
            rows: Vec::with_capacity(rows),
            wanted: Vec::with_capacity(rows),
            wanted_columns: Vec::with_capacity(n),
            solver: RowSolver::with_room(n, rows + 2 * ROWS_OF_PAIR),
            ..Self::default()
        }
    }

    /// Exchanges of constraints so far.
    pub fn exchanges(&self) -> usize {
        self.solver.exchanges()
    }

    /// Whether an arm at `q` has to move: to separate overlapping bodies, or to evade moving ones, whose rows are softer.
    pub fn ask_to_move(&self, q: &[f64]) -> bool {
        let gives_way = |row: &Row| row.softness > SOFTNESS && dot(&row.gradient, q) < row.least;
        !self.wanted.is_empty() || self.rows.iter().any(gives_way)
    }

    /// Writes the point reached by the step from `start` into `out`.
    pub fn write(&mut self, step: &StepRequest<'_>, start: &[f64], out: &mut [f64]) {
        self.linearize(step, start);
        self.write_linearized(step, start, out);
    }

    /// Writes the command that moves the rest configuration by a step into `out`.
    pub fn write_resting(&mut self, step: &StepRequest<'_>, resting: &Resting<'_>, out: &mut [f64]) {
        self.linearize(step, resting.rest);
        for block in self.linearization.blocks_mut() {
            for (column, slope) in block.columns.iter_mut().zip(resting.slope) {
                column.iter_mut().for_each(|entry| *entry *= slope);
            }
        }
        self.write_linearized(step, resting.command, out);
    }

    /// Writes the point reached by the step from `start`, already linearized, into `out`.
    fn write_linearized(&mut self, step: &StepRequest<'_>, start: &[f64], out: &mut [f64]) {
        let n = start.len();
        let short = self.set_wanted_columns(start);
        let StepRequest { aims, ends: [lower, upper], towards, .. } = *step;
        self.held.clear();
        self.hold_pairs(&aims, start);
        let is_pair = |i: usize| aims.tasks.get(i).is_some_and(|task| task.is_held);
        let counts = |i: usize| towards != Towards::Joints && !is_pair(i);
        let blocks = self.linearization.blocks().enumerate().filter(|(i, _)| counts(*i));
        let tasks = blocks.map(|(_, TaskBlock { columns, residual, scale })| match towards {
            Towards::Target => TaskRows { columns, residual, scale: *scale },
            Towards::Start | Towards::Joints => TaskRows { columns, residual: &[0.0; ROWS], scale: *scale },
        });
        let mut tasks: SmallVec<[TaskRows<'_>; 5]> = tasks.collect();
        if !self.wanted.is_empty() {
            tasks.push(TaskRows { columns: &self.wanted_columns, residual: &short, scale: URGENT });
        }
        let size: f64 = tasks.iter().map(|task| squared_size(&task.columns[..n])).sum();
        let lambda = if tasks.is_empty() { 1.0 } else { (DAMPING * size).max(f64::MIN_POSITIVE.sqrt()) };
        let step = RowStep { tasks: &tasks, lambda, start, lower, upper, rows: &self.rows, held: &self.held };
        self.solver.write(&step, out);
    }

    /// Sets the columns of the wanted rows, as a task; returns their shortfall at `start`.
    fn set_wanted_columns(&mut self, start: &[f64]) -> [f64; ROWS] {
        let mut short = [0.0; ROWS];
        self.wanted_columns.clear();
        self.wanted_columns.resize(start.len(), [0.0; ROWS]);
        for (k, row) in self.wanted.iter().take(ROWS).enumerate() {
            short[k] = URGENT * (dot(&row.gradient, start) - row.least).min(0.0);
            let columns = self.wanted_columns.iter_mut().zip(&row.gradient);
            columns.for_each(|(column, entry)| column[k] = URGENT * entry);
        }
        short
    }

    /// Projects `q` onto the relative poses of all pairs, moving it as little as possible. Returns whether the pairs are held
    /// there.
    pub fn hold(&mut self, step: &StepRequest<'_>, q: &mut Point) -> bool {
        let aims = &step.aims;
        let step = StepRequest { towards: Towards::Joints, ..*step };
        for _ in 0..HOLDING_STEPS {
            let start = q.clone();
            self.linearize(&step, &start);
            if self.missed(aims) <= HELD {
                return true;
            }
            self.write_linearized(&step, &start, q);
        }
        aims.pairs_are_held(step.robot, q)
    }

    /// Largest error of the pairs at the linearization.
    fn missed(&self, aims: &Aims<'_>) -> f64 {
        let blocks = self.linearization.blocks().zip(aims.tasks).filter(|(_, task)| task.is_held);
        blocks.map(|(block, _)| dot(&block.residual, &block.residual)).fold(0.0, f64::max).sqrt()
    }

    /// Computes residuals and Jacobians at `start`.
    fn linearize(&mut self, step: &StepRequest<'_>, start: &[f64]) {
        if !step.aims.is_empty() {
            step.aims.linearize(step.robot, start, &mut self.linearization, |_| ());
            return;
        }
        self.linearization.more.clear();
        self.linearization.first.residual = [0.0; ROWS];
        step.robot.tip_and_jacobian(start, &mut self.linearization.first.columns);
    }

    /// Adds the equations of all pairs: r + J (x - start) = 0.
    fn hold_pairs(&mut self, aims: &Aims<'_>, start: &[f64]) {
        for (block, task) in self.linearization.blocks().zip(aims.tasks) {
            for k in (0..ROWS).filter(|_| task.is_held) {
                let mut gradient = [0.0; MAX_DOF];
                let columns = block.columns[..start.len()].iter();
                gradient.iter_mut().zip(columns).for_each(|(entry, column)| *entry = column[k]);
                if gradient != [0.0; MAX_DOF] {
                    let least = dot(&gradient[..start.len()], start) - block.residual[k];
                    self.held.push(Row { gradient, least, softness: SOFTNESS });
                }
            }
        }
    }
}
