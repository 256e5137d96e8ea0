//! Evaluation of values, at one point or many.

use smallvec::SmallVec;

use super::budgeted::Evaluator;
use crate::objective::{Objective, Score};
use crate::solver::status::Status;

/// Number of scores kept on the stack.
const CHUNK: usize = 8;

impl<O: Objective + ?Sized> Evaluator<'_, O> {
    /// Clips `x` to the box and returns its value; infinite if it is not finite.
    ///
    /// # Errors
    /// A [`Status`] if the budget is spent or the monitor asks to stop; `x` was then not evaluated.
    #[inline]
    pub fn evaluate(&mut self, x: &mut [f64]) -> Result<f64, Status> {
        self.spend(1)?;
        self.admit(x);
        let score = self.objective.evaluate(x);
        Ok(self.record(x, score))
    }

    /// Clips the points stored consecutively in `xs`, and writes the value of each.
    ///
    /// # Errors
    /// As for one point. If the budget covers only some of the points, the first ones are evaluated before the run ends.
    pub fn evaluate_all(&mut self, mut xs: &mut [f64], values: &mut [f64]) -> Result<(), Status> {
        for values in values.chunks_mut(self.pattern.batch_size) {
            let affordable = values.len().min(self.stop.max_evaluations - self.progress.evaluations);
            if affordable == 0 {
                return Err(Status::BudgetSpent);
            }
            self.spend(affordable)?;
            let (chunk, rest) = xs.split_at_mut(affordable * self.dimension);
            self.evaluate_chunk(chunk, &mut values[..affordable]);
            if affordable < values.len() {
                return Err(Status::BudgetSpent);
            }
            xs = rest;
        }
        Ok(())
    }

    #[inline]
    fn evaluate_chunk(&mut self, xs: &mut [f64], values: &mut [f64]) {
        let unknown = Score { value: f64::INFINITY, solved: false };
        let mut scores: SmallVec<[Score; CHUNK]> = SmallVec::from_elem(unknown, values.len());
        xs.chunks_exact_mut(self.dimension).for_each(|x| self.admit(x));
        self.objective.evaluate_all(xs, &mut scores);
        for ((x, score), value) in xs.chunks_exact(self.dimension).zip(&scores).zip(values) {
            *value = self.record(x, *score);
        }
    }
}
