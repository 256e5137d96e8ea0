//! Minimisation in a box: results, history, and errors.

use crate::common::{StopAt, bits, message};
use ikcore::minimize::{MinimizeOptions, Minimum, minimize};
use ikcore::objective::{Objective, Score};
use ikcore::solver::{AnySolver, DerivativeFree, DifferentialEvolution, Status, Stop, Unattended};

/// Function with a minimum of zero at 0.3 in every coordinate; NaN for a negative first coordinate.
struct Bowl;

impl Objective for Bowl {
    fn dimension(&self) -> usize {
        2
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        let value = x.iter().map(|x| (x - 0.3).powi(2)).sum();
        Score { value: if x[0] < 0.0 { f64::NAN } else { value }, solved: false }
    }
}

/// Options of differential evolution from a start.
fn options(start: Option<Vec<f64>>, stop: Stop) -> MinimizeOptions {
    let solver = DerivativeFree::DifferentialEvolution(DifferentialEvolution::default());
    MinimizeOptions { solver: AnySolver::Single(solver), start, stop, seed: 4 }
}

fn least(lower: &[f64], upper: &[f64], start: Option<Vec<f64>>, stop: Stop) -> ikcore::Result<Minimum> {
    minimize(&mut Bowl, lower, upper, &options(start, stop), &mut Unattended)
}

fn below(value: f64) -> Stop {
    Stop { value_below: Some(value), ..Stop::default() }
}

#[test]
fn the_bottom_is_found_and_its_history_falls_to_it() {
    let found = least(&[-1.0; 2], &[1.0; 2], None, below(1e-12)).unwrap();
    assert_eq!((found.status, found.restarts), (Status::Solved, 0));
    assert!(found.value < 1e-12 && found.x.iter().all(|x| (x - 0.3).abs() < 1e-6));
    assert!(found.history.is_sorted_by(|[before, worse], [after, better]| before < after && worse >= better));
    assert_eq!(*found.history.last().unwrap(), [found.evaluations as f64, found.value]);
    assert!(found.message().ends_with(" evaluations, below the requested value"));
    let again = least(&[-1.0; 2], &[1.0; 2], None, below(1e-12)).unwrap();
    assert_eq!((bits(&again.x), again.evaluations), (bits(&found.x), found.evaluations));
}

#[test]
fn a_start_that_is_good_enough_has_nothing_left_to_do() {
    let found = least(&[-1.0; 2], &[1.0; 2], Some(vec![0.3; 2]), below(1e-12)).unwrap();
    assert_eq!((found.status, found.evaluations, found.history.len()), (Status::Solved, 1, 1));
}

#[test]
fn without_a_value_asked_for_the_budget_ends_the_search() {
    let stop = Stop { max_evaluations: 500, ..Stop::default() };
    let found = least(&[-1.0; 2], &[1.0; 2], None, stop).unwrap();
    assert_eq!((found.status, found.evaluations), (Status::BudgetSpent, 500));
    assert!(found.message().ends_with("when all were spent: raise the budget, or say by a value what is low enough"));
}

#[test]
fn a_function_without_a_finite_value_is_said_to_have_none() {
    let stop = Stop { max_evaluations: 200, ..Stop::default() };
    let found = least(&[-2.0; 2], &[-1.0; 2], None, stop).unwrap();
    assert!(found.value.is_infinite());
    let expected = "the function had no finite value in 200 evaluations: try another box or start";
    assert_eq!(found.message(), expected);
}

#[test]
fn an_interrupted_search_keeps_its_best() {
    let stop = Stop { max_evaluations: 1_000_000, ..Stop::default() };
    let found = minimize(&mut Bowl, &[0.0; 2], &[1.0; 2], &options(None, stop), &mut StopAt(1)).unwrap();
    assert_eq!(found.status, Status::Interrupted);
    assert!(found.value.is_finite() && found.evaluations < 10_000);
    assert!(found.message().ends_with("when it was stopped: run again to finish"));
}

#[test]
fn wrong_boxes_and_starts_are_named() {
    let told = |lower: &[f64], upper: &[f64], start: Option<Vec<f64>>| message(least(lower, upper, start, below(1.0)));
    let cases = [
        (told(&[0.0], &[1.0; 2], None), "lower: expected 2 entries, got 1"),
        (told(&[f64::NEG_INFINITY, 0.0], &[1.0; 2], None), "lower must be finite, but entry 0 is -inf"),
        (told(&[0.0; 2], &[1.0, f64::NAN], None), "upper must be finite, but entry 1 is NaN"),
        (told(&[-1e308; 2], &[1e308; 2], None), "upper - lower must be finite, but entry 0 is inf"),
        (told(&[0.0; 2], &[1.0; 2], Some(vec![0.5])), "start: expected 2 entries as in lower, got 1"),
        (told(&[0.0; 2], &[1.0; 2], Some(vec![0.5, 2.0])), "start[1] must be within [0, 1], got 2"),
    ];
    for (told, expected) in cases {
        assert_eq!(told, expected);
    }
}
