//! Evaluation of residuals and derivatives, and the evaluator for solvers that use only values.

use std::mem;

use super::budgeted::Evaluator;
use crate::objective::{
    Differentiable, Gradient, LeastSquares, Linearization, Objective, Residual, SmoothScore, TaskResiduals,
};
use crate::solver::status::Status;

impl<O: Residual + ?Sized> Evaluator<'_, O> {
    /// Clips `x` to the box, writes the residuals, and returns the value.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    #[inline]
    pub fn residual(&mut self, x: &mut [f64], out: &mut TaskResiduals) -> Result<f64, Status> {
        self.spend(1)?;
        self.admit(x);
        let score = self.objective.residual(x, out);
        Ok(self.record(x, score))
    }
}

impl<O: LeastSquares + ?Sized> Evaluator<'_, O> {
    /// Clips `x` to the box, writes residuals and Jacobians, and returns the value. Counts as one evaluation.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    #[inline]
    pub fn linearize(&mut self, x: &mut [f64], out: &mut Linearization) -> Result<f64, Status> {
        self.spend(1)?;
        self.admit(x);
        let score = self.objective.linearize(x, out);
        Ok(self.record(x, score))
    }
}

impl<O: Gradient + ?Sized> Evaluator<'_, O> {
    /// Brings `x` into the domain, writes the gradient, and returns the smooth error, infinite if it is not finite. Counts as
    /// one evaluation.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    #[inline]
    pub fn differentiate(&mut self, x: &mut [f64], gradient: &mut [f64]) -> Result<f64, Status> {
        self.spend(1)?;
        self.admit(x);
        let SmoothScore { error, score } = self.objective.differentiate(x, gradient);
        let value = self.record(x, score);
        Ok(if value.is_finite() { error } else { f64::INFINITY })
    }
}

impl Evaluator<'_, dyn Differentiable + '_> {
    /// Runs `work` with an evaluator of values only, so that a derivative-free solver is compiled once for all
    /// objectives.
    pub(in crate::solver) fn with_values_only<R>(
        &mut self,
        work: impl FnOnce(&mut Evaluator<'_, dyn Objective + '_>) -> R,
    ) -> R {
        let mut narrowed = Evaluator {
            objective: &mut *self.objective as &mut dyn Objective,
            bounds: self.bounds,
            stop: self.stop,
            rng: &mut *self.rng,
            monitor: &mut *self.monitor,
            stopwatch: self.stopwatch,
            progress: mem::take(&mut self.progress),
            dimension: self.dimension,
            pattern: self.pattern,
            domain: self.domain,
            own_threshold: self.own_threshold,
            periods: Vec::new(),
            solved_outside: false,
        };
        let result = work(&mut narrowed);
        self.progress = narrowed.progress;
        result
    }
}
