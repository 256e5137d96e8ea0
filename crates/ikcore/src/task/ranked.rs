//! Second-order models of a pose in which position or orientation comes first.
//!
//! With a the axis and v the linear column of a joint, and joint i before joint j on the chain, the second derivatives are
//! a_i x v_j for the position, and [a_i] [a_j] R for the rotation matrix.

use super::first::First;
use super::residual::position;
use crate::math::Frame;
use crate::math::ranked_step::RankedModel;
use crate::math::so3::{axes_of, cross, dot, rotation_and_jacobian};
use crate::math::vec3::Vec3;

impl First {
    /// Writes the model of a tip with the geometric Jacobian `columns`, and turns the rows of the Jacobian that the equations are
    /// into their derivatives.
    ///
    /// The objective of second rank is 1 - cos(angle) for the orientation, and half the squared distance (m^2) for the position.
    pub(crate) fn write_model(self, target: &Frame, tip: &Frame, columns: &mut [[f64; 6]], model: &mut RankedModel) {
        let n = columns.len();
        model.clear(n);
        match self {
            Self::Position => {
                model.first_row = 0;
                model.residual = position::residual(&target.origin, &tip.origin);
                write_angle(target, tip, columns, model);
                for (j, column) in columns.iter().enumerate() {
                    (model.axes[j], model.arms[j]) = (axis(column), linear(column));
                }
            }
            Self::Orientation => {
                model.first_row = 3;
                write_distance(target, tip, columns, model);
                for (j, column) in columns.iter().enumerate() {
                    (model.axes[j], model.arms[j]) = (axis(column), axis(column).map(|entry| 0.5 * entry));
                }
                let (phi, inverse) = rotation_and_jacobian(&axes_of(target), &axes_of(tip));
                model.residual = phi.stored();
                for column in columns {
                    let turned = inverse.apply(Vec3::of(&axis(column))).stored();
                    column[3..].copy_from_slice(&turned);
                }
            }
        }
    }
}

fn axis(column: &[f64; 6]) -> [f64; 3] {
    [column[3], column[4], column[5]]
}

fn linear(column: &[f64; 6]) -> [f64; 3] {
    [column[0], column[1], column[2]]
}

/// Pairs of joints, the one nearer to the base first.
fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)))
}

/// Writes 1 - cos(angle) and its derivatives. With M = R R_d', the derivative of tr M by q_i is tr([a_i] M), and the second one
/// a_i'M a_j - (a_i . a_j) tr M.
fn write_angle(target: &Frame, tip: &Frame, columns: &[[f64; 6]], model: &mut RankedModel) {
    let n = columns.len();
    let axes = || target.axes.iter().zip(&tip.axes);
    let trace: f64 = axes().map(|(d, r)| dot(d, r)).sum();
    let mut sine = [0.0; 3];
    for (d, r) in axes() {
        let part = cross(d, r);
        (0..3).for_each(|k| sine[k] += 0.5 * part[k]);
    }
    model.value = 0.5 * (3.0 - trace);
    for (i, column) in columns.iter().enumerate() {
        let a = axis(column);
        model.gradient[i] = dot(&a, &sine);
        let of_tip = tip.axes.map(|r| dot(&a, &r));
        // M a_i, so that a_i'M a_j is its product with a_j.
        let turned: [f64; 3] = std::array::from_fn(|k| (0..3).map(|c| target.axes[c][k] * of_tip[c]).sum());
        for (j, other) in columns.iter().enumerate().skip(i) {
            let b = axis(other);
            RankedModel::set(&mut model.hessian, n, i, j, 0.5 * (dot(&a, &b) * trace - dot(&turned, &b)));
        }
    }
}

/// Writes half the squared distance and its derivatives.
fn write_distance(target: &Frame, tip: &Frame, columns: &[[f64; 6]], model: &mut RankedModel) {
    let n = columns.len();
    let away = position::residual(&target.origin, &tip.origin);
    model.value = 0.5 * dot(&away, &away);
    for (i, column) in columns.iter().enumerate() {
        model.gradient[i] = dot(&linear(column), &away);
    }
    for (i, j) in pairs(n) {
        let (u, v) = (linear(&columns[i]), linear(&columns[j]));
        let bend = cross(&axis(&columns[i]), &v);
        RankedModel::set(&mut model.hessian, n, i, j, dot(&u, &v) + dot(&bend, &away));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Columns;
    use crate::robot::Robot;

    #[test]
    fn models_agree_with_finite_differences() {
        let robot = Robot::named("panda").unwrap();
        let q = [0.3, -0.4, 0.2, -1.9, 0.3, 1.4, 0.5];
        let n = q.len();
        let goal = robot.tip(&[0.5, -0.1, 0.4, -1.6, 0.1, 1.8, 0.2]);
        for first in [First::Position, First::Orientation] {
            // Second derivatives of the equations are those at their solution.
            let goal = match first {
                First::Position => goal,
                First::Orientation => Frame { axes: robot.tip(&q).axes, ..goal },
            };
            let at = |q: &[f64]| {
                let (mut columns, mut model) = (Columns::default(), RankedModel::default());
                let tip = robot.tip_and_jacobian(q, &mut columns);
                first.write_model(&goal, &tip, &mut columns[..n], &mut model);
                (columns, model)
            };
            let (_, here) = at(&q);
            let h = 1e-6;
            for j in 0..n {
                let moved = |by: f64| at(&std::array::from_fn::<f64, 7, _>(|k| if k == j { q[k] + by } else { q[k] }));
                let ((columns_ahead, ahead), (columns_behind, behind)) = (moved(h), moved(-h));
                let slope = (ahead.value - behind.value) / (2.0 * h);
                assert!((slope - here.gradient[j]).abs() < 1e-8, "{first}, gradient {j}");
                for i in 0..n {
                    let bend = (ahead.gradient[i] - behind.gradient[i]) / (2.0 * h);
                    assert!((bend - here.hessian[i * n + j]).abs() < 1e-7, "{first}, hessian {i} {j}");
                    let known = cross(&here.axes[i.min(j)], &here.arms[i.max(j)]);
                    for k in 0..3 {
                        let row = here.first_row + k;
                        let bend = (columns_ahead[i][row] - columns_behind[i][row]) / (2.0 * h);
                        assert!((bend - known[k]).abs() < 1e-7, "{first}, bend {k} {i} {j}");
                    }
                }
            }
        }
    }
}
