//! Places where curves of a self-motion cross: singular postures.
//!
//! There the Jacobian loses rank, so that the task leaves two directions free. A curve that crosses another may run at a single
//! value of the closed form's parameter, which then has no seed on it.

use nalgebra::{DMatrix, SMatrix, SVD};

use super::trace::TracedCurve;
use super::unwrapping::EXACT;
use super::wrapped_limits::WrappedLimits;
use crate::ik::attempt::Attempt;
use crate::ik::goal_descent::difference;
use crate::math::box_step::ROWS;
use crate::math::vector::norm;
use crate::objective::{Bounds, LeastSquares, Linearization, Point};
use crate::problem::Problem;
use crate::solver::LevenbergMarquardt;

/// Distance of the points of a curve (rad, m) at which its rank is measured.
const MEASURED_EVERY: f64 = 0.1;

/// Change of the tip per joint motion (m, rad per rad, m) below which a crossing is looked for.
const NEARLY: f64 = 0.1;
/// Change of the tip below which it is one.
const CROSSING: f64 = 5e-3;

/// Halvings of the interval in which the rank is least.
const HALVINGS: usize = 12;

/// Largest number of crossings looked at on a curve.
const MOST_CROSSINGS: usize = 8;

/// Number of directions from a crossing in which other curves are sought.
const DIRECTIONS: usize = 12;
/// Distance from it (rad, m).
const BESIDE: f64 = 0.3;

/// Crossings of a curve with others, as far as the rank shows them.
pub(super) fn crossings(curve: &TracedCurve, spacing: f64, attempt: &mut Attempt<'_, '_>) -> Vec<Point> {
    let stride = (MEASURED_EVERY / spacing).round().max(1.0) as usize;
    let points: Vec<&Point> = curve.points.iter().step_by(stride).map(|point| &point.q).collect();
    let mut at = Linearization::default();
    let mut change = |attempt: &mut Attempt<'_, '_>, q: &Point| second_least_change(attempt.problem, q, &mut at);
    let changes: Vec<f64> = points.iter().map(|q| change(attempt, q)).collect();
    attempt.budget.evaluations += points.len();
    let is_least = |k: &usize| {
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten().filter_map(|i| changes.get(i));
        changes[*k] < NEARLY && beside.fold(f64::INFINITY, |least: f64, other| least.min(*other)) >= changes[*k]
    };
    let mut found = Vec::new();
    for k in (0..points.len()).filter(is_least).take(MOST_CROSSINGS) {
        let mut best = (changes[k], points[k].clone());
        for other in [k.checked_sub(1), Some(k + 1)].into_iter().flatten().filter_map(|i| points.get(i)) {
            let mut way = difference(other, points[k]);
            for _ in 0..HALVINGS {
                way.iter_mut().for_each(|way| *way *= 0.5);
                for sign in [1.0, -1.0] {
                    let there: Point = best.1.iter().zip(&way).map(|(q, way)| q + sign * way).collect();
                    let change = change(attempt, &there);
                    if change < best.0 {
                        best = (change, there);
                    }
                }
            }
            attempt.budget.evaluations += 2 * HALVINGS;
        }
        if best.0 < CROSSING {
            found.push(best.1);
        }
    }
    found
}

/// Solutions beside the crossing `q`, in all of the directions that the task leaves free there.
pub(super) fn beside(q: &[f64], attempt: &mut Attempt<'_, '_>, limits: &WrappedLimits<'_>) -> Vec<Point> {
    let [one, other] = weak_pair(attempt.problem, q);
    let anywhere = Bounds::from_ranges(q.iter().map(|_| (f64::NEG_INFINITY, f64::INFINITY)));
    let mut found = Vec::new();
    for k in 0..DIRECTIONS {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        let from: Point = (0..q.len()).map(|j| q[j] + BESIDE * (cos * one[j] + sin * other[j])).collect();
        let there = attempt.descend_beyond(&LevenbergMarquardt::default(), from, EXACT, &anywhere);
        let away = norm(&limits.apart(&there, q));
        if attempt.problem.assess(&there).score.solved && 0.3 * BESIDE < away && away < 3.0 * BESIDE {
            found.push(there);
        }
    }
    found
}

/// The change of the tip in the direction of joint space, of all but one, that moves it least: the second least singular value of the
/// Jacobian, as the root of an eigenvalue of J Jᵀ. `at` is scratch.
fn second_least_change(problem: &mut Problem<'_>, q: &[f64], at: &mut Linearization) -> f64 {
    problem.linearize(q, at);
    let columns = &at.first.columns[..q.len()];
    let product = SMatrix::<f64, ROWS, ROWS>::from_fn(|i, k| columns.iter().map(|column| column[i] * column[k]).sum());
    let mut squares: [f64; ROWS] = product.symmetric_eigenvalues().into();
    squares.sort_by(|a, b| b.total_cmp(a));
    squares.get(q.len().saturating_sub(2)).map_or(0.0, |square| square.max(0.0).sqrt())
}

/// The two directions that move the tip least.
fn weak_pair(problem: &mut Problem<'_>, q: &[f64]) -> [Point; 2] {
    let mut at = Linearization::default();
    problem.linearize(q, &mut at);
    let n = q.len();
    // More rows than columns, so that the decomposition has a right vector for each joint.
    let jacobian =
        DMatrix::from_fn(n.max(ROWS), n, |row, joint| if row < ROWS { at.first.columns[joint][row] } else { 0.0 });
    let decomposed = SVD::new(jacobian, false, true);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| decomposed.singular_values[*a].total_cmp(&decomposed.singular_values[*b]));
    [0, 1].map(|place| {
        let rows = decomposed.v_t.as_ref();
        rows.map_or_else(|| Point::from_elem(0.0, n), |v| v.row(order[place]).iter().copied().collect())
    })
}
