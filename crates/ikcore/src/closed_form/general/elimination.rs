//! Elimination of eight unknown products from fourteen linear equations, by Householder triangularization with column
//! pivoting.

/// Number of rows.
pub const ROWS: usize = 14;
/// Number of eliminated unknowns.
pub const COLUMNS: usize = 8;
/// Number of remaining equations.
pub const LEFT: usize = ROWS - COLUMNS;

/// Triangularized matrix.
#[derive(Debug, Clone, Copy)]
pub struct Elimination {
    /// Columns; below the diagonal they hold the reflectors, scaled to v'v = 2.
    columns: [[f64; ROWS]; COLUMNS],
    diagonal: [f64; COLUMNS],
    order: [usize; COLUMNS],
}

impl Elimination {
    /// Triangularizes the matrix with these columns.
    pub fn new(mut columns: [[f64; ROWS]; COLUMNS]) -> Self {
        let mut order: [usize; COLUMNS] = std::array::from_fn(|k| k);
        let mut diagonal = [0.0; COLUMNS];
        for k in 0..COLUMNS {
            let size = |column: &[f64; ROWS]| column[k..].iter().map(|x| x * x).sum::<f64>();
            let sizes: [f64; COLUMNS] = std::array::from_fn(|j| if j < k { -1.0 } else { size(&columns[j]) });
            let pivot = (k..COLUMNS).fold(k, |best, j| if sizes[j] > sizes[best] { j } else { best });
            columns.swap(k, pivot);
            order.swap(k, pivot);
            let (mut reflector, norm) = (columns[k], sizes[pivot].sqrt());
            reflector[..k].fill(0.0);
            let sign = if reflector[k] < 0.0 { -1.0 } else { 1.0 };
            diagonal[k] = -sign * norm;
            reflector[k] += sign * norm;
            let square = norm * (norm + sign * columns[k][k]);
            let scale = if square > 0.0 { square.sqrt().recip() } else { 0.0 };
            reflector.iter_mut().for_each(|x| *x *= scale);
            for column in &mut columns[k + 1..] {
                reflect(&reflector, column);
            }
            columns[k][k..].copy_from_slice(&reflector[k..]);
        }
        Self { columns, diagonal, order }
    }

    /// Returns six rows that annihilate the matrix.
    pub fn annihilators(&self) -> [[f64; ROWS]; LEFT] {
        std::array::from_fn(|row| {
            let mut unit = [0.0; ROWS];
            unit[COLUMNS + row] = 1.0;
            for k in (0..COLUMNS).rev() {
                reflect(&self.reflector(k), &mut unit);
            }
            unit
        })
    }

    /// Returns the least-squares solution for the right-hand side `right`.
    pub fn solve(&self, mut right: [f64; ROWS]) -> [f64; COLUMNS] {
        for k in 0..COLUMNS {
            reflect(&self.reflector(k), &mut right);
        }
        let mut found = [0.0; COLUMNS];
        for k in (0..COLUMNS).rev() {
            // Dependent columns contribute nothing.
            let value = right[k] / self.diagonal[k];
            let value = if self.diagonal[k].abs() > 1e-12 * self.diagonal[0].abs() { value } else { 0.0 };
            found[self.order[k]] = value;
            (0..k).for_each(|i| right[i] -= self.columns[k][i] * value);
        }
        found
    }

    fn reflector(&self, k: usize) -> [f64; ROWS] {
        let mut reflector = self.columns[k];
        reflector[..k].fill(0.0);
        reflector
    }
}

/// Reflects x: x - v (v'x).
#[inline(always)]
fn reflect(v: &[f64; ROWS], x: &mut [f64; ROWS]) {
    let product: f64 = (0..ROWS).map(|k| v[k] * x[k]).sum();
    (0..ROWS).for_each(|k| x[k] -= product * v[k]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn annihilates_and_solves() {
        let matrix: [[f64; ROWS]; COLUMNS] =
            std::array::from_fn(|j| std::array::from_fn(|i| ((3 * i + 5 * j * j + i * j) as f64 * 0.7).sin()));
        let elimination = Elimination::new(matrix);
        for row in elimination.annihilators() {
            for column in &matrix {
                assert!((0..ROWS).map(|k| row[k] * column[k]).sum::<f64>().abs() < 1e-14);
            }
        }
        let wanted: [f64; COLUMNS] = std::array::from_fn(|k| k as f64 - 3.3);
        let right = std::array::from_fn(|i| (0..COLUMNS).map(|j| matrix[j][i] * wanted[j]).sum());
        for (found, wanted) in elimination.solve(right).iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-12);
        }
    }
}
