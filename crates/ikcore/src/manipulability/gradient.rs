//! Exact gradient of Yoshikawa's index.
//!
//! With J = sum of s_i u_i v_i', the product of the singular values changes by dw = <G, dJ>, with G = sum of (product of the
//! others) u_i v_i'. The Jacobian changes by cross products of its own columns: a rotation about an element carries along all
//! elements after it, and moves the tip relative to all elements before it.

use super::gram;
use super::index::Manipulability;
use crate::kinematics::Screw;
use crate::math::Columns;
use crate::math::MAX_DOF;
use crate::math::singular_values::SingularValues;
use crate::math::so3::cross;
use crate::robot::Robot;

impl Manipulability {
    /// Returns the index at `q`, and writes its gradient (n,) to `out`, without allocation. `q` and `out` have one
    /// entry per joint.
    ///
    /// The gradient is exact, by the derivative of the geometric Jacobian. At index zero there is no gradient: `out` then
    /// points out of the singularity on one of its two sides, or is zero.
    pub fn gradient(&self, robot: &Robot, q: &[f64], out: &mut [f64]) -> f64 {
        let screws = robot.screws_of(self.tip(), q);
        let Some(tip) = screws.last().map(|screw| screw.end) else { return 0.0 };
        out.fill(0.0);
        add(self, &screws, &tip, out)
    }
}

/// Adds the gradient of the index of the point `tip` after `screws` to `out` (n,), and returns the index.
pub(super) fn add(measure: &Manipulability, screws: &[Screw], tip: &[f64; 3], out: &mut [f64]) -> f64 {
    // Several elements share a joint if there are mimics, so their columns are summed.
    let mut elements = [[0.0; 6]; MAX_DOF];
    let mut columns = Columns::default();
    columns.fit(out.len());
    for (element, screw) in elements.iter_mut().zip(screws) {
        *element = screw.column(tip);
        columns[screw.joint].iter_mut().zip(&*element).for_each(|(sum, entry)| *sum += entry);
    }
    let (index, sensitivity) = sensitivity(measure, &mut columns[..out.len()]);
    for (b, (moved, moving)) in elements.iter().zip(screws).enumerate() {
        for (a, (element, screw)) in elements.iter().zip(screws).enumerate() {
            let change = change_of(element, moved, a >= b);
            out[moving.joint] += inner(&sensitivity[screw.joint], &change);
        }
    }
    index
}

/// Returns w and dw/dJ, by column.
fn sensitivity(measure: &Manipulability, columns: &mut [[f64; 6]]) -> (f64, Columns) {
    let mut sensitivity = Columns::default();
    sensitivity.fit(columns.len());
    if measure.has_full_rank()
        && let Some(index) = gram::index_and_sensitivity(columns, measure.motion(), &mut sensitivity)
    {
        return (index, sensitivity);
    }
    measure.motion().select(columns);
    let values = SingularValues::of(columns);
    let (n, rank) = (columns.len(), measure.rank());
    for i in 0..rank {
        let others: f64 = (0..rank).filter(|k| *k != i).map(|k| values.lengths[k]).product();
        for (column, right) in sensitivity[..n].iter_mut().zip(&values.right[i]) {
            for (entry, left) in column.iter_mut().zip(&values.left[i]) {
                *entry += others * left * right;
            }
        }
    }
    (measure.product(&values), sensitivity)
}

/// Derivative of one element's column by the motion of another element. `carried`: the column's element is the moving one or
/// after it; otherwise only the tip moves relative to it.
#[inline]
fn change_of(column: &[f64; 6], moving: &[f64; 6], carried: bool) -> [f64; 6] {
    let ([v, w], [moving_v, moving_w]) = (halves(column), halves(moving));
    let [x, y, z] = if carried { cross(&moving_w, &v) } else { cross(&w, &moving_v) };
    let [a, b, c] = if carried { cross(&moving_w, &w) } else { [0.0; 3] };
    [x, y, z, a, b, c]
}

fn halves(column: &[f64; 6]) -> [[f64; 3]; 2] {
    let [x, y, z, a, b, c] = *column;
    [[x, y, z], [a, b, c]]
}

/// Scalar product; the sensitivity is zero in unused rows.
fn inner(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    (0..6).map(|k| a[k] * b[k]).sum()
}
