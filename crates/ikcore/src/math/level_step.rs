//! Step for several objectives in order of rank, in a box: each is lowered as far as those before it stay at their least.
//!
//! Each objective has a second-order model. The step lowers the first model, then the second along the directions in which the
//! first is flat, and so on (hierarchical least squares; Escande, Mansard and Wieber, "Hierarchical quadratic programming", 2014).
//! A joint that reaches its bound on the way is fixed there, and the step goes on with the others. Of several that are at bounds, the one
//! that is pushed there most is fixed first: without it, the direction may lead the others back inside.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Longest step of one objective (rad, m); the model holds no farther.
const LONGEST: f64 = 0.5;

/// Largest number of sweeps of the eigenvalue iteration.
const SWEEPS: usize = 200;

/// Second-order model of one objective at a point.
#[derive(Debug, Clone, Default)]
pub struct LevelModel {
    /// Gradient.
    pub gradient: DVector<f64>,
    /// Second derivatives.
    pub hessian: DMatrix<f64>,
    /// Curvature, relative to the largest entry of the second derivatives, below which a direction is flat.
    pub flat: f64,
}

/// Writes the point after the step from `x` in the box of `ends`, lower and upper, into `out`. The models are in order of rank.
pub fn write_level_step(models: &[&LevelModel], x: &[f64], ends: [&[f64]; 2], out: &mut [f64]) {
    out.copy_from_slice(x);
    let mut free: Vec<usize> = (0..x.len()).filter(|j| ends[0][*j] < ends[1][*j]).collect();
    while !free.is_empty() {
        let moved = DVector::from_fn(x.len(), |j, _| out[j] - x[j]);
        let Some(direction) = direction(models, &moved, &free) else { return };
        let blocking = move_along(&direction, &free, ends, out);
        let Some(fixed) = most_pushed(models, x, &direction, &blocking, out) else { return };
        free.retain(|j| *j != fixed);
    }
}

/// The joint of `blocking` that the slopes of the models at `out` push most along `direction`; `None` without any.
fn most_pushed(
    models: &[&LevelModel],
    x: &[f64],
    direction: &DVector<f64>,
    blocking: &[usize],
    out: &[f64],
) -> Option<usize> {
    let [only] = blocking else {
        let moved = DVector::from_fn(x.len(), |j, _| out[j] - x[j]);
        let slope =
            models.iter().fold(DVector::zeros(x.len()), |sum, model| sum + &model.gradient + &model.hessian * &moved);
        let push = |j: &usize| -slope[*j] * direction[*j].signum();
        return blocking.iter().copied().max_by(|a, b| push(a).total_cmp(&push(b)));
    };
    Some(*only)
}

/// Direction of the step after the motion `moved`, along the `free` joints; `None` where a model is not finite.
fn direction(models: &[&LevelModel], moved: &DVector<f64>, free: &[usize]) -> Option<DVector<f64>> {
    let n = moved.len();
    let mut direction = DVector::zeros(n);
    let mut basis = DMatrix::zeros(n, free.len());
    free.iter().enumerate().for_each(|(column, joint)| basis[(*joint, column)] = 1.0);
    for model in models {
        if basis.ncols() == 0 {
            break;
        }
        let slope = &model.gradient + &model.hessian * (moved + &direction);
        let reduced = basis.tr_mul(&(&model.hessian * &basis));
        let downhill = -basis.tr_mul(&slope);
        if !reduced.iter().chain(&downhill).all(|entry| entry.is_finite()) {
            return None;
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::try_new(reduced, f64::EPSILON, SWEEPS)?;
        let flat = model.flat * model.hessian.amax();
        let is_flat = |i: &usize| !(eigenvalues[*i].abs() > flat);
        let mut along = DVector::zeros(basis.ncols());
        for i in (0..basis.ncols()).filter(|i| !is_flat(i)) {
            let vector = eigenvectors.column(i);
            // A negative curvature counts by its size, so that the step leads downhill.
            along.axpy(vector.dot(&downhill) / eigenvalues[i].abs(), &vector, 1.0);
        }
        let mut step = &basis * along;
        let longest = step.amax();
        if longest > LONGEST {
            step *= LONGEST / longest;
        }
        direction += step;
        let left: Vec<usize> = (0..basis.ncols()).filter(is_flat).collect();
        basis = &basis * eigenvectors.select_columns(&left);
    }
    Some(direction)
}

/// Moves the `free` joints of `out` along `direction` until the first reaches its bound; returns those that do.
fn move_along(direction: &DVector<f64>, free: &[usize], ends: [&[f64]; 2], out: &mut [f64]) -> Vec<usize> {
    let bound = |j: usize| if direction[j] > 0.0 { ends[1][j] } else { ends[0][j] };
    let (mut reach, mut blocking) = (1.0, vec![]);
    for j in free.iter().copied().filter(|j| direction[*j] != 0.0) {
        let part = ((bound(j) - out[j]) / direction[j]).max(0.0);
        if part < reach {
            (reach, blocking) = (part, vec![j]);
        } else if part == reach && !blocking.is_empty() {
            blocking.push(j);
        }
    }
    for j in free.iter().copied() {
        let moved = (out[j] + reach * direction[j]).clamp(ends[0][j], ends[1][j]);
        out[j] = if blocking.contains(&j) { bound(j) } else { moved };
    }
    blocking
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Model of half the squared residual of `rows` linear equations.
    fn model(rows: &DMatrix<f64>, residual: &DVector<f64>) -> LevelModel {
        LevelModel { gradient: rows.tr_mul(residual), hessian: rows.tr_mul(rows), flat: 1e-12 }
    }

    /// Round numbers and ties as often as reals.
    fn entry() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), Just(1.0), Just(-1.0), Just(0.5), -1.0..1.0]
    }

    fn level(n: usize) -> impl Strategy<Value = (DMatrix<f64>, DVector<f64>)> {
        (1_usize..4).prop_flat_map(move |m| {
            let rows = prop::collection::vec(entry(), m * n);
            let residual = prop::collection::vec(-0.02..0.02, m);
            (rows, residual)
                .prop_map(move |(rows, residual)| (DMatrix::from_row_slice(m, n, &rows), DVector::from_vec(residual)))
        })
    }

    #[test]
    fn in_a_corner_a_joint_that_leads_inside_is_not_fixed() {
        // The direction of both leads outside, that of the second alone inside.
        let gradient = DVector::from_row_slice(&[0.1, 0.05]);
        let corner =
            LevelModel { gradient, hessian: DMatrix::from_row_slice(2, 2, &[1.0, 0.9, 0.9, 1.0]), flat: 1e-12 };
        let mut out = [0.0; 2];
        write_level_step(&[&corner], &[0.0, 1.0], [&[0.0; 2], &[1.0; 2]], &mut out);
        assert!(out[0] == 0.0 && (out[1] - 0.95).abs() < 1e-12, "{out:?}");
    }

    proptest! {
        #[test]
        fn a_level_below_does_not_feel_those_above(first in level(6), second in level(6), width in 0.0_f64..0.1) {
            let (one, two) = (model(&first.0, &first.1), model(&second.0, &second.1));
            let (lower, upper) = ([-width; 6], [0.5 * width; 6]);
            let mut out = [0.0; 6];
            write_level_step(&[&one, &two], &[0.0; 6], [&lower, &upper], &mut out);
            prop_assert!(out.iter().zip(&lower).zip(&upper).all(|((x, l), u)| l <= x && x <= u));
            if width == 0.0 {
                return Ok(());
            }
            let (lower, upper) = ([-9.0; 6], [9.0; 6]);
            let (mut alone, mut both) = ([0.0; 6], [0.0; 6]);
            write_level_step(&[&one], &[0.0; 6], [&lower, &upper], &mut alone);
            write_level_step(&[&one, &two], &[0.0; 6], [&lower, &upper], &mut both);
            let error = |x: &[f64; 6]| (&first.0 * DVector::from_row_slice(x) + &first.1).norm();
            prop_assert!((error(&alone) - error(&both)).abs() < 1e-7, "{} {}", error(&alone), error(&both));
        }

        #[test]
        fn without_bounds_each_level_is_least_on_those_below(first in level(6), second in level(6)) {
            let (one, two) = (model(&first.0, &first.1), model(&second.0, &second.1));
            let singular = first.0.clone().singular_values();
            prop_assume!(singular.iter().all(|value| *value > 0.1 || *value < 1e-9));
            let mut out = [0.0; 6];
            write_level_step(&[&one, &two], &[0.0; 6], [&[-9.0; 6], &[9.0; 6]], &mut out);
            // Oracle: pseudo-inverses of the rows and of the rows on their null space.
            let inverse = first.0.clone().pseudo_inverse(1e-6).unwrap();
            let base = -&inverse * &first.1;
            let projector = DMatrix::identity(6, 6) - &inverse * &first.0;
            let reduced = &second.0 * &projector;
            prop_assume!(reduced.clone().singular_values().iter().all(|value| *value > 0.1 || *value < 1e-9));
            let rest = reduced.pseudo_inverse(1e-6).unwrap() * (-(&second.0 * &base + &second.1));
            let expected = &base + &projector * rest;
            prop_assume!(expected.amax() < 0.4);
            prop_assert!((DVector::from_row_slice(&out) - &expected).amax() < 1e-6, "{out:?} {expected}");
        }
    }
}
