//! The exact gradient of Yoshikawa's index.
//!
//! With J = sum of s_i u_i v_i', the product of the singular values changes by dw = <G, dJ>, G = sum of
//! (product of the others) u_i v_i'. The Jacobian changes by cross products of its own columns: turning about an element
//! carries all elements behind it along, and moves the tip as seen from all before it.

use super::{Manipulability, Motion};
use crate::math::MAX_DOF;
use crate::math::singular::SingularValues;
use crate::math::so3::cross;
use crate::robot::{Columns, Robot, Screw};

/// The index at `q` and its gradient.
pub(super) fn index(measure: &Manipulability, robot: &Robot, q: &[f64], out: &mut [f64]) -> f64 {
    let screws = robot.screws(q);
    let Some(tip) = screws.last().map(|screw| screw.end) else { return 0.0 };
    out.fill(0.0);
    add(measure, &screws, &tip, out)
}

/// The index of the point `tip` behind `screws`; its gradient is added to `out` (n,).
pub(super) fn add(measure: &Manipulability, screws: &[Screw], tip: &[f64; 3], out: &mut [f64]) -> f64 {
    // Mimics: several elements may share a joint, so that their columns are summed.
    let mut shares = [[0.0; 6]; MAX_DOF];
    let mut columns: Columns = [[0.0; 6]; MAX_DOF];
    for (share, screw) in shares.iter_mut().zip(screws) {
        *share = screw.column(tip);
        columns[screw.joint].iter_mut().zip(&*share).for_each(|(sum, entry)| *sum += entry);
    }
    let columns = &mut columns[..out.len()];
    measure.motion().select(columns);
    let values = SingularValues::of(columns);
    let sensitivity = sensitivity(&values, measure.directions(), out.len());
    for (b, (moved, moving)) in shares.iter().zip(screws).enumerate() {
        for (a, (share, screw)) in shares.iter().zip(screws).enumerate() {
            let change = change_of(share, moved, a >= b);
            out[moving.joint] += inner(&sensitivity[screw.joint], &change, measure.motion());
        }
    }
    measure.product(&values)
}

/// dw/dJ, column by column.
fn sensitivity(values: &SingularValues, directions: usize, n: usize) -> Columns {
    let mut sensitivity: Columns = [[0.0; 6]; MAX_DOF];
    for i in 0..directions {
        let others: f64 = (0..directions).filter(|k| *k != i).map(|k| values.lengths[k]).product();
        for (column, right) in sensitivity[..n].iter_mut().zip(&values.right[i]) {
            for (entry, left) in column.iter_mut().zip(&values.left[i]) {
                *entry += others * left * right;
            }
        }
    }
    sensitivity
}

/// The derivative of one element's column by the motion of another: `carried` along if it is that one or behind it,
/// else only the tip moves as seen from it.
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

/// The sum of products over the rows that count.
fn inner(a: &[f64; 6], b: &[f64; 6], motion: Motion) -> f64 {
    let rows = match motion {
        Motion::Pose => 0..6,
        Motion::Position => 0..3,
        Motion::Rotation => 3..6,
    };
    rows.map(|k| a[k] * b[k]).sum()
}
