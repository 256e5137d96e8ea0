//! The Gram matrix J J' and its LDL' factorisation: the index far from singularities, at a tenth of the work of singular values.
//! Near singularities squaring J would lose the digits that matter; there the singular values take over.

use std::ops::Range;

use crate::kinematics::Columns;

const ROWS: usize = 6;

/// A pivot below this share of the trace counts as near a singularity: ten of sixteen digits are left there.
const NEAR: f64 = 1e-6;

/// J J' = L D L' of the rows that count.
pub(super) struct GramFactor {
    rows: Range<usize>,
    /// Below the diagonal L, on it the pivots.
    factor: [[f64; ROWS]; ROWS],
}

impl GramFactor {
    /// Of the matrix with these columns; None near a singularity.
    pub fn of(columns: &[[f64; ROWS]], rows: Range<usize>) -> Option<Self> {
        let mut a = [[0.0; ROWS]; ROWS];
        for column in columns {
            for i in rows.clone() {
                for k in rows.start..=i {
                    a[i][k] += column[i] * column[k];
                }
            }
        }
        let smallest = NEAR * rows.clone().map(|i| a[i][i]).sum::<f64>();
        for j in rows.clone() {
            // Written so that NaN is near too.
            if !(a[j][j] > smallest) {
                return None;
            }
            for i in j + 1..rows.end {
                let factor = a[i][j] / a[j][j];
                for k in j + 1..=i {
                    a[i][k] -= factor * a[k][j];
                }
            }
            let pivot = a[j][j];
            a[j + 1..rows.end].iter_mut().for_each(|row| row[j] /= pivot);
        }
        Some(Self { rows, factor: a })
    }

    /// w = sqrt(det(J J')).
    pub fn index(&self) -> f64 {
        self.rows.clone().map(|i| self.factor[i][i]).product::<f64>().sqrt()
    }

    /// dw/dJ = w (J J')^-1 J, column by column.
    pub fn sensitivity(&self, columns: &[[f64; ROWS]], out: &mut Columns) {
        let index = self.index();
        for (out, column) in out.iter_mut().zip(columns) {
            *out = self.solve(column).map(|entry| index * entry);
        }
    }

    /// (J J')^-1 b; zero in the rows that do not count.
    fn solve(&self, b: &[f64; ROWS]) -> [f64; ROWS] {
        let mut z = [0.0; ROWS];
        for i in self.rows.clone() {
            z[i] = b[i] - (self.rows.start..i).map(|k| self.factor[i][k] * z[k]).sum::<f64>();
        }
        for i in self.rows.clone().rev() {
            z[i] = z[i] / self.factor[i][i] - (i + 1..self.rows.end).map(|k| self.factor[k][i] * z[k]).sum::<f64>();
        }
        z
    }
}
