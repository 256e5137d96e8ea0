//! Members and generations of a population.
//!
//! The first generation is the start and uniform draws in the box. A step of a swarm is one generation: the first step draws
//! and evaluates the other members, so that a start that is already solved costs one evaluation.

use super::schedule::Schedule;
use crate::objective::{Objective, Point};
use crate::solver::Status;
use crate::solver::evaluator::Evaluator;

/// Relative improvement of the best value that counts as a gain: the function tolerance of the MATLAB solvers.
const GAIN: f64 = 1e-6;

/// Points, stored consecutively, and their values.
#[derive(Debug, Clone, Default)]
pub(super) struct Members {
    /// Coordinates, member by member.
    pub points: Vec<f64>,
    /// Value of each member.
    pub values: Vec<f64>,
    dimension: usize,
}

impl Members {
    /// List of `count` members without values.
    pub fn new(count: usize, dimension: usize) -> Self {
        Self { points: vec![0.0; count * dimension], values: vec![f64::INFINITY; count], dimension }
    }

    /// Number of coordinates of a member.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Coordinates of member `i`.
    #[inline]
    pub fn point(&self, i: usize) -> &[f64] {
        &self.points[i * self.dimension..(i + 1) * self.dimension]
    }

    /// Coordinates of member `i`, writable.
    #[inline]
    pub fn point_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.points[i * self.dimension..(i + 1) * self.dimension]
    }

    /// Iterates over all points in order.
    pub fn points(&self) -> impl Iterator<Item = &[f64]> {
        self.points.chunks_exact(self.dimension)
    }

    /// Copies member `j` of `other` to member `i`.
    #[inline]
    pub fn take(&mut self, i: usize, other: &Self, j: usize) {
        self.point_mut(i).copy_from_slice(other.point(j));
        self.values[i] = other.values[j];
    }

    /// Index of the member with the lowest value, the first of equals.
    pub fn best(&self) -> usize {
        (1..self.values.len()).fold(0, |best, i| if self.values[i] < self.values[best] { i } else { best })
    }

    /// Clips the members from `first` on to the box, and evaluates them in bulk.
    ///
    /// # Errors
    /// The evaluator's [`Status`].
    pub fn evaluate_from<O: Objective + ?Sized>(
        &mut self,
        first: usize,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<(), Status> {
        evaluator.evaluate_all(&mut self.points[first * self.dimension..], &mut self.values[first..])
    }
}

/// Current generation of a population.
#[derive(Debug, Clone, Default)]
pub(super) struct Population {
    /// Points and values of the members.
    pub members: Members,
    /// Widths of the ranges that the first generation is drawn from.
    pub widths: Point,
    /// Generations so far, the first included.
    pub generation: usize,
    /// Best value at the last gain.
    milestone: f64,
    /// Generations since the last gain.
    without_gain: usize,
}

/// Generation that a step begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Generation {
    /// First generation, whose members are already drawn and evaluated.
    First,
    /// Later generation, which the algorithm derives from the previous one.
    Later,
}

impl Population {
    /// Evaluates the start as the first member.
    ///
    /// # Errors
    /// The evaluator's [`Status`].
    pub fn start<O: Objective + ?Sized>(
        schedule: &Schedule,
        evaluator: &mut Evaluator<'_, O>,
        x0: &[f64],
    ) -> Result<Self, Status> {
        let mut members = Members::new(schedule.population, x0.len());
        let start = members.point_mut(0);
        start.copy_from_slice(x0);
        members.values[0] = evaluator.evaluate(start)?;
        let widths = evaluator.bounds().ranges().map(|(lower, upper)| upper - lower).collect();
        Ok(Self { members, widths, generation: 0, milestone: f64::INFINITY, without_gain: 0 })
    }

    /// Begins a step: gives up if the schedule requires it, and completes the first generation by drawing and evaluating its
    /// other members. Later generations are left to the algorithm.
    ///
    /// # Errors
    /// The evaluator's [`Status`]; [`Status::Stalled`] by the schedule.
    pub fn begin_generation<O: Objective + ?Sized>(
        &mut self,
        schedule: &Schedule,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<Generation, Status> {
        if self.generation == schedule.max_generations || self.has_stalled(schedule, evaluator.attempt_value()) {
            return Err(Status::Stalled);
        }
        self.generation += 1;
        if self.generation > 1 {
            return Ok(Generation::Later);
        }
        for i in 1..schedule.population {
            evaluator.bounds().sample(evaluator.rng(), self.members.point_mut(i));
        }
        self.members.evaluate_from(1, evaluator)?;
        Ok(Generation::First)
    }

    fn has_stalled(&mut self, schedule: &Schedule, best: f64) -> bool {
        let gained = best < self.milestone && (self.milestone - best > GAIN * best.abs());
        if gained {
            (self.milestone, self.without_gain) = (best, 0);
        } else {
            self.without_gain += 1;
        }
        self.without_gain > schedule.stall_generations
    }
}

/// Fills `rows` with copies of `row`, so that one loop over the coordinates of all members can read shared data.
pub(super) fn tile(row: &[f64], rows: &mut [f64]) {
    let mut filled = row.len().min(rows.len());
    rows[..filled].copy_from_slice(&row[..filled]);
    while filled < rows.len() {
        let more = filled.min(rows.len() - filled);
        rows.copy_within(..more, filled);
        filled += more;
    }
}
