//! Sums of squares as objectives: residuals and Jacobians, in one block of six rows per task.

use smallvec::SmallVec;

use super::evaluation::{Objective, Score};
use super::gradient::Gradient;
use crate::math::block_step::{BlockStep, TaskRows};
use crate::math::box_step::{BoxStep, LEAST_DAMPING, ROWS};
use crate::math::vector::squared_size;
use crate::math::{Columns, MAX_DOF, StepBox};

/// Residual r and Jacobian dr/dx of one task at a point.
#[derive(Debug, Clone)]
pub struct TaskBlock {
    /// Weighted residual, actual minus target; rows that a task does not use are zero.
    pub residual: [f64; ROWS],
    /// Columns of the weighted Jacobian, one per entry of x; the first `dimension` are in use.
    pub columns: Columns,
    /// Factor that both contain, by which the task counts against others.
    pub scale: f64,
}

/// Residuals and Jacobians of all tasks at a point; most objectives have one task.
#[derive(Debug, Clone, Default)]
pub struct Linearization {
    /// Block of the first task.
    pub first: TaskBlock,
    /// Blocks of further tasks.
    pub more: Vec<TaskBlock>,
}

/// Weighted residual of each task.
pub type TaskResiduals = SmallVec<[[f64; ROWS]; 1]>;

/// Objective that is a sum of squares, six for each task.
pub trait Residual: Objective {
    /// Writes the weighted residuals at `x`, actual minus target, and returns the score; rows that a task does not use are zero.
    fn residual(&mut self, x: &[f64], out: &mut TaskResiduals) -> Score;
}

/// Sum of squares with a Jacobian.
pub trait LeastSquares: Residual {
    /// Writes residuals and Jacobians at `x` in one pass, and returns the score.
    fn linearize(&mut self, x: &[f64], out: &mut Linearization) -> Score;
}

impl Linearization {
    /// Iterates over the blocks of all tasks.
    pub fn blocks(&self) -> impl Iterator<Item = &TaskBlock> + Clone {
        std::iter::once(&self.first).chain(&self.more)
    }

    /// Iterates over the blocks of all tasks, writable.
    pub fn blocks_mut(&mut self) -> impl Iterator<Item = &mut TaskBlock> {
        std::iter::once(&mut self.first).chain(&mut self.more)
    }

    /// Writes J'r, the gradient of r'r / 2, into `gradient`, which has one entry per entry of x.
    pub fn gradient(&self, gradient: &mut [f64]) {
        gradient.fill(0.0);
        self.blocks().for_each(|block| block.add_gradient(gradient));
    }

    /// Writes the [bounded step](BoxStep) from `x` in a box into `out`, by the joints that cost least.
    #[inline]
    pub fn write_step<'b>(&self, lambda: f64, x: &[f64], within: impl Into<StepBox<'b>>, out: &mut [f64]) {
        if self.more.is_empty() {
            self.first.write_step(lambda, x, within, out);
        } else {
            self.write_step_of_several(lambda, x, within.into(), out);
        }
    }

    #[cold]
    #[inline(never)]
    fn write_step_of_several(&self, lambda: f64, x: &[f64], within: StepBox<'_>, out: &mut [f64]) {
        write_by_weights(&self.rows(), lambda, x, within, out);
    }

    /// Writes the point in a box that (nearly) solves r + J (out - x) = 0 and is nearest to `preferred`, which must be in the box.
    pub fn write_step_near<'b>(
        &self,
        preferred: &[f64],
        lambda: f64,
        x: &[f64],
        within: impl Into<StepBox<'b>>,
        out: &mut [f64],
    ) {
        if self.more.is_empty() {
            self.first.write_step_near(preferred, lambda, x, within, out);
        } else {
            write_near_by_weights(&self.rows(), preferred, lambda, x, within.into(), out);
        }
    }

    /// Moves `q` onto a task by Gauss-Newton: up to `most` bounded steps. `next` linearizes the task at a point and returns the
    /// damping of the step from there, `None` to end. Returns whether it ended so.
    pub fn project<'b>(
        &mut self,
        q: &mut [f64],
        within: impl Into<StepBox<'b>>,
        most: usize,
        mut next: impl FnMut(&[f64], &mut Self) -> Option<f64>,
    ) -> bool {
        let within = within.into();
        let mut from = [0.0; MAX_DOF];
        let from = &mut from[..q.len()];
        for _ in 0..most {
            let Some(lambda) = next(q, self) else { return true };
            from.copy_from_slice(q);
            self.write_step(lambda, from, within, q);
        }
        false
    }

    /// Smallest damping that keeps a singular system of `n` unknowns solvable; it has no effect otherwise.
    pub fn least_damping(&self, n: usize) -> f64 {
        LEAST_DAMPING * self.blocks().map(|block| squared_size(&block.columns[..n])).sum::<f64>()
    }

    #[cold]
    fn rows(&self) -> SmallVec<[TaskRows<'_>; 4]> {
        self.blocks().map(TaskBlock::rows).collect()
    }
}

impl Default for TaskBlock {
    fn default() -> Self {
        Self { residual: [0.0; ROWS], columns: Columns::default(), scale: 1.0 }
    }
}

impl TaskBlock {
    /// Writes the step for this task alone, as [`Linearization::write_step`].
    #[inline]
    pub fn write_step<'b>(&self, lambda: f64, x: &[f64], within: impl Into<StepBox<'b>>, out: &mut [f64]) {
        let Self { columns, residual, .. } = self;
        match within.into() {
            StepBox { lower, upper, weights: None } => {
                BoxStep { columns, residual, lambda, x, lower, upper }.write(out)
            }
            within => write_by_weights(&[self.rows()], lambda, x, within, out),
        }
    }

    /// Writes the step for this task alone, as [`Linearization::write_step_near`].
    #[inline]
    pub fn write_step_near<'b>(
        &self,
        preferred: &[f64],
        lambda: f64,
        x: &[f64],
        within: impl Into<StepBox<'b>>,
        out: &mut [f64],
    ) {
        let Self { columns, residual, .. } = self;
        match within.into() {
            StepBox { lower, upper, weights: None } => {
                BoxStep { columns, residual, lambda, x, lower, upper }.write_near(preferred, out);
            }
            within => write_near_by_weights(&[self.rows()], preferred, lambda, x, within, out),
        }
    }

    fn rows(&self) -> TaskRows<'_> {
        TaskRows { columns: &self.columns, residual: &self.residual, scale: self.scale }
    }

    /// Adds J'r to `gradient`.
    fn add_gradient(&self, gradient: &mut [f64]) {
        for (slope, column) in gradient.iter_mut().zip(&*self.columns) {
            *slope += column.iter().zip(&self.residual).map(|(c, r)| c * r).sum::<f64>();
        }
    }
}

/// All evaluations of the inverse kinematics problem that a solver may use.
pub trait Differentiable: LeastSquares + Gradient {}

impl<O: LeastSquares + Gradient + ?Sized> Differentiable for O {}

/// Writes the step of `tasks` by the weights of the box.
fn write_by_weights(tasks: &[TaskRows<'_>], lambda: f64, x: &[f64], within: StepBox<'_>, out: &mut [f64]) {
    let StepBox { lower, upper, weights } = within;
    let step = BlockStep { tasks, lambda, x, lower, upper };
    match weights {
        None => step.write(out),
        Some(weights) => weights.write(&step, out),
    }
}

/// Writes the step of `tasks` that ends near `preferred` by the weights of the box.
fn write_near_by_weights(
    tasks: &[TaskRows<'_>],
    preferred: &[f64],
    lambda: f64,
    x: &[f64],
    within: StepBox<'_>,
    out: &mut [f64],
) {
    let StepBox { lower, upper, weights } = within;
    let step = BlockStep { tasks, lambda, x, lower, upper };
    match weights {
        None => step.write_near(preferred, out),
        Some(weights) => step.near(preferred, |step| weights.write(step, out)),
    }
}
