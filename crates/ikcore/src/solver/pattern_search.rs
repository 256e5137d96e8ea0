//! Pattern search (Hooke and Jeeves 1961) with parabolas: a local search by values alone.
//!
//! Each coordinate in turn is tried a step to either side; where neither is better, the parabola through the three values says where its
//! lowest point is. A sweep that made progress is tried once more as a whole.

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::objective::{Objective, Point};

/// The first step of each round, as a fraction of the range of a coordinate. A round ends when no step leads lower; the next one begins at
/// the best point with a longer step, which may lead out of a local minimum.
const FIRST_STEPS: [f64; 3] = [0.05, 0.2, 0.1];

/// Smallest step of a coordinate, as a fraction of its range.
const FINEST_STEP: f64 = 2e-3;

/// Factor on a step that led lower.
const GROWTH: f64 = 2.0;
/// Factor on a step that did not.
const SHRINKAGE: f64 = 0.4;

/// The local search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PatternSearch;

/// The best point, its value, and the next step of each coordinate, whose sign is the side that is tried first.
#[derive(Debug, Default)]
pub(crate) struct State {
    x: Point,
    value: f64,
    steps: Point,
    finest: Point,
    /// Rounds begun.
    rounds: usize,
}

impl State {
    /// Moves to another point if that is better; returns its value.
    fn try_point<O: Objective + ?Sized>(
        &mut self,
        mut x: Point,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<f64, Status> {
        let value = evaluator.evaluate(&mut x)?;
        if value < self.value {
            (self.x, self.value) = (x, value);
        }
        Ok(value)
    }

    /// Tries to move one coordinate.
    fn explore<O: Objective + ?Sized>(&mut self, i: usize, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let (step, before) = (self.steps[i], self.value);
        let moved = |x: &Point, by: f64| {
            let mut x = x.clone();
            x[i] += by;
            x
        };
        let ahead = self.try_point(moved(&self.x, step), evaluator)?;
        if ahead < before {
            self.steps[i] *= GROWTH;
            return Ok(());
        }
        let behind = self.try_point(moved(&self.x, -step), evaluator)?;
        if behind < before {
            self.steps[i] *= -GROWTH;
            return Ok(());
        }
        let lowest = 0.5 * (behind - ahead) / (ahead - before + (behind - before));
        if lowest.is_finite() && (lowest * step).abs() > self.finest[i] {
            self.try_point(moved(&self.x, lowest * step), evaluator)?;
        }
        self.steps[i] *= SHRINKAGE;
        Ok(())
    }
}

impl<O: Objective + ?Sized> Solver<O> for PatternSearch {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let [lower, upper] = evaluator.bounds().ends();
        let finest = lower.iter().zip(upper).map(|(lower, upper)| FINEST_STEP * (upper - lower)).collect();
        let mut x = Point::from_slice(x0);
        let value = evaluator.evaluate(&mut x)?;
        *state = State { steps: Point::from_elem(0.0, x.len()), x, value, finest, rounds: 0 };
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let before = state.x.clone();
        let is_moving = |state: &State, i: usize| state.steps[i].abs() > state.finest[i];
        let moving: Vec<usize> = (0..before.len()).filter(|i| is_moving(state, *i)).collect();
        if moving.is_empty() {
            let first = FIRST_STEPS.get(state.rounds).ok_or(Status::Stalled)?;
            state.steps = state.finest.iter().map(|finest| first / FINEST_STEP * finest).collect();
            state.rounds += 1;
            return Ok(());
        }
        for i in moving {
            state.explore(i, evaluator)?;
        }
        if state.x != before {
            let further = state.x.iter().zip(&before).map(|(x, before)| 2.0 * x - before).collect();
            state.try_point(further, evaluator)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::objective::{Bounds, Score};
    use crate::rng;
    use crate::solver::{Stop, Unattended, run};

    /// A bowl with a bent valley, whose lowest point is at (0.5, 0.25, ...), counted.
    struct Valley(usize);

    impl Objective for Valley {
        fn dimension(&self) -> usize {
            3
        }

        fn evaluate(&mut self, x: &[f64]) -> Score {
            self.0 += 1;
            let value = (x[0] - 0.5).powi(2) + 4.0 * (x[1] - x[0] * x[0]).powi(2) + (x[2] + 0.3).abs();
            Score { value, solved: false }
        }
    }

    fn lowest(ranges: [(f64, f64); 3], start: [f64; 3], most: usize) -> (Point, f64, Status, usize) {
        let mut valley = Valley(0);
        let bounds = Bounds::from_ranges(ranges.into_iter());
        let stop = Stop { max_evaluations: most, ..Stop::default() };
        let (mut rng, mut monitor) = (rng::stream(0, 0), Unattended);
        let objective: &mut dyn Objective = &mut valley;
        let mut evaluator = Evaluator::new(objective, &bounds, stop, &mut rng, &mut monitor);
        let status = run(&PatternSearch, &mut evaluator, &start);
        let (x, evaluations) = (evaluator.best().x.clone(), evaluator.evaluations());
        let value = valley.evaluate(&x).value;
        (x, value, status, evaluations)
    }

    #[test]
    fn a_bent_valley_with_a_crease_is_followed_in_few_evaluations() {
        let (x, value, status, evaluations) = lowest([(-2.0, 2.0); 3], [-1.5, 1.5, 1.0], 2000);
        assert_eq!(status, Status::Stalled);
        assert!(value < 0.02, "{value} at {x:?}");
        assert!(evaluations < 400, "{evaluations}");
    }

    #[test]
    fn held_coordinates_stay_and_budgets_are_kept() {
        let (x, ..) = lowest([(0.2, 0.2), (-2.0, 2.0), (-2.0, 2.0)], [0.2, 1.0, 1.0], 2000);
        assert_eq!(x[0], 0.2);
        assert!((x[1] - 0.04).abs() < 0.02, "{x:?}");
        for most in [1, 2, 7, 30] {
            let (_, value, status, evaluations) = lowest([(-2.0, 2.0); 3], [-1.5, 1.5, 1.0], most);
            assert_eq!((status, evaluations), (Status::BudgetSpent, most));
            assert!(value <= Valley(0).evaluate(&[-1.5, 1.5, 1.0]).value);
        }
    }
}
