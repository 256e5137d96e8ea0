//! Step for two objectives in order of rank, in a box: three equations first, then a second-order model on their solutions.
//!
//! The step that solves the equations is the bounded step of [`box_step`](super::box_step). The second objective then moves the
//! point along the null space of the equations, by Newton's method in an orthonormal basis of it. A joint that reaches its bound
//! on the way is fixed there, and the others go on in what is left of the null space: the equations never give way.

use smallvec::SmallVec;

use super::MAX_DOF;
use super::box_step::{BoxStep, ROWS, least_damping};
use super::so3::{cross, dot as dot3};
use super::vector::dot;

/// Number of joints up to which small arrays are enough.
const FEW: usize = 8;

/// Number of equations.
const EQUATIONS: usize = 3;

/// Length of an equation's gradient, relative to the longest, below which it depends on the others.
const DEPENDENT: f64 = 1e-9;

/// Longest step along the null space (rad, m); the model holds no farther.
const LONGEST: f64 = 0.5;

/// Smallest curvature, relative to the largest entry, of a model that has a minimum.
const FLAT: f64 = 1e-9;

/// Symmetric matrix by rows, on the stack up to eight joints.
pub type Square = SmallVec<[f64; FEW * FEW]>;

/// Vectors of the joints, on the stack up to eight.
type Vectors = SmallVec<[[f64; 3]; FEW]>;

/// Second-order model of the objective of second rank.
#[derive(Debug, Clone, Default)]
pub struct RankedModel {
    /// Index of the first of the three rows of the Jacobian that the equations are.
    pub first_row: usize,
    /// Residual of the equations.
    pub residual: [f64; EQUATIONS],
    /// Value of the objective.
    pub value: f64,
    /// Gradient of the objective.
    pub gradient: SmallVec<[f64; FEW]>,
    /// Second derivatives of the objective.
    pub hessian: Square,
    /// Second derivatives of the equations by joints i and j, i not after j: `axes[i]` x `arms[j]`.
    pub axes: Vectors,
    /// See `axes`.
    pub arms: Vectors,
}

/// Step from `x` in the box \[`lower`, `upper`\].
#[derive(Debug, Clone, Copy)]
pub struct RankedStep<'a> {
    /// Columns of the Jacobian, at least one per entry of `x`.
    pub columns: &'a [[f64; ROWS]],
    /// Equations and objective.
    pub model: &'a RankedModel,
    /// Current point.
    pub x: &'a [f64],
    /// Lower bounds, one per entry of `x`.
    pub lower: &'a [f64],
    /// Upper bounds, one per entry of `x`.
    pub upper: &'a [f64],
}

impl RankedModel {
    /// Sets all entries to zero, for `n` unknowns.
    pub fn clear(&mut self, n: usize) {
        self.gradient.clear();
        self.gradient.resize(n, 0.0);
        self.hessian.clear();
        self.hessian.resize(n * n, 0.0);
        for vectors in [&mut self.axes, &mut self.arms] {
            vectors.clear();
            vectors.resize(n, [0.0; 3]);
        }
    }

    /// Writes both entries of a symmetric matrix of `n` columns.
    pub fn set(matrix: &mut Square, n: usize, i: usize, j: usize, value: f64) {
        matrix[i * n + j] = value;
        matrix[j * n + i] = value;
    }

    /// Second derivatives of the objective plus those of the equations times `multipliers`.
    fn curvature<const N: usize>(&self, n: usize, multipliers: &[f64; EQUATIONS]) -> [[f64; N]; N] {
        let mut curvature = [[0.0; N]; N];
        for i in 0..n {
            let across = cross(multipliers, &self.axes[i]);
            for j in i..n {
                curvature[i][j] = self.hessian[i * n + j] + dot3(&across, &self.arms[j]);
                curvature[j][i] = curvature[i][j];
            }
        }
        curvature
    }
}

impl RankedStep<'_> {
    /// Writes the point after the step into `out`, and returns the multipliers of the equations.
    pub fn write(&self, out: &mut [f64]) -> [f64; EQUATIONS] {
        self.write_first(out);
        if self.x.len() <= FEW { self.write_second::<FEW>(out) } else { self.write_second::<MAX_DOF>(out) }
    }

    /// Writes the point nearest to `x` that solves the equations.
    pub fn write_first(&self, out: &mut [f64]) {
        if self.x.len() <= FEW { self.write_least::<FEW>(out) } else { self.write_least::<MAX_DOF>(out) }
    }

    fn write_least<const N: usize>(&self, out: &mut [f64]) {
        let n = self.x.len();
        let (mut columns, mut residual) = ([[0.0; ROWS]; N], [0.0; ROWS]);
        let row = self.model.first_row;
        // The position rows come first in a step that has no others.
        for (own, column) in columns.iter_mut().zip(&self.columns[..n]) {
            own[..EQUATIONS].copy_from_slice(&column[row..row + EQUATIONS]);
        }
        residual[..EQUATIONS].copy_from_slice(&self.model.residual);
        let (columns, residual) = (&columns[..n], &residual);
        let lambda = least_damping(columns);
        BoxStep { columns, residual, lambda, x: self.x, lower: self.lower, upper: self.upper }.write(out);
    }

    /// Moves `out`, which solves the equations, along their null space.
    fn write_second<const N: usize>(&self, out: &mut [f64]) -> [f64; EQUATIONS] {
        let n = self.x.len();
        let mut free: u64 = if n == MAX_DOF { u64::MAX } else { (1 << n) - 1 };
        let mut known = None;
        while free != 0 {
            let gradient = self.gradient_at::<N>(out);
            let rows = EquationBasis::<N>::of(self, free);
            let (multipliers, curvature) = known.get_or_insert_with(|| {
                let multipliers = rows.multipliers(&gradient, n);
                (multipliers, self.model.curvature::<N>(n, &multipliers))
            });
            let multipliers = *multipliers;
            let null = rows.complement(free, n);
            let Some(direction) = newton(n, &null, &gradient, curvature) else { return multipliers };
            let blocking = self.move_along(&direction[..n], free, out);
            if blocking == 0 {
                return multipliers;
            }
            free &= !blocking;
        }
        known.map_or([0.0; EQUATIONS], |(multipliers, _)| multipliers)
    }

    /// Moves the `free` joints of `out` along `direction` until the first reaches its bound; returns those that do.
    fn move_along(&self, direction: &[f64], free: u64, out: &mut [f64]) -> u64 {
        let (mut reach, mut blocking) = (1.0, 0_u64);
        for (j, way) in direction.iter().enumerate().filter(|(j, way)| free & (1 << j) != 0 && **way != 0.0) {
            let room = if *way > 0.0 { self.upper[j] - out[j] } else { self.lower[j] - out[j] };
            let part = (room / way).max(0.0);
            if part < reach {
                (reach, blocking) = (part, 1 << j);
            } else if part == reach && blocking != 0 {
                blocking |= 1 << j;
            }
        }
        for (j, way) in direction.iter().enumerate() {
            let bound = if *way > 0.0 { self.upper[j] } else { self.lower[j] };
            let at_bound = blocking & (1 << j) != 0;
            let moved = (out[j] + reach * way).clamp(self.lower[j], self.upper[j]);
            out[j] = if at_bound { bound } else { moved };
        }
        blocking
    }

    /// Gradient of the model at `out`.
    fn gradient_at<const N: usize>(&self, out: &[f64]) -> [f64; N] {
        let n = self.x.len();
        let (mut change, mut gradient) = ([0.0; N], [0.0; N]);
        (0..n).for_each(|j| change[j] = out[j] - self.x[j]);
        for (i, row) in self.model.hessian.chunks_exact(n).enumerate() {
            gradient[i] = self.model.gradient[i] + dot(row, &change[..n]);
        }
        gradient
    }
}

/// Orthonormal basis of the free directions that leave the equations unchanged.
struct NullSpace<const N: usize> {
    vectors: [[f64; N]; N],
    count: usize,
}

/// Step along the null space to the minimum of the model, or downhill where it has none; `None` without a null space.
fn newton<const N: usize>(
    n: usize,
    null: &NullSpace<N>,
    gradient: &[f64; N],
    curvature: &[[f64; N]; N],
) -> Option<[f64; N]> {
    let m = null.count;
    if m == 0 {
        return None;
    }
    let (mut reduced, mut right) = ([[0.0; N]; N], [0.0; N]);
    for (b, vector) in null.vectors[..m].iter().enumerate() {
        let mut image = [0.0; N];
        (0..n).for_each(|i| image[i] = dot(&curvature[i][..n], &vector[..n]));
        for (a, other) in null.vectors[..=b].iter().enumerate() {
            reduced[a][b] = dot(&other[..n], &image[..n]);
            reduced[b][a] = reduced[a][b];
        }
        right[b] = -dot(&vector[..n], &gradient[..n]);
    }
    let parts = downhill(&reduced, &right, m);
    let mut direction = [0.0; N];
    for (part, vector) in parts[..m].iter().zip(&null.vectors) {
        (0..n).for_each(|j| direction[j] += part * vector[j]);
    }
    let longest = direction[..n].iter().fold(0.0, |most: f64, way| most.max(way.abs()));
    if longest > LONGEST {
        direction[..n].iter_mut().for_each(|way| *way *= LONGEST / longest);
    }
    Some(direction)
}

/// Orthonormal basis of the equations' gradients over the free joints, and the gradients in it.
struct EquationBasis<const N: usize> {
    basis: [[f64; N]; EQUATIONS],
    /// Equations in the order of the basis.
    order: [usize; EQUATIONS],
    /// Components of each equation along the basis.
    along: [[f64; EQUATIONS]; EQUATIONS],
    count: usize,
}

impl<const N: usize> EquationBasis<N> {
    /// Orthogonalises the gradients, the longest remainder first.
    fn of(step: &RankedStep<'_>, free: u64) -> Self {
        let n = step.x.len();
        let mut found =
            Self { basis: [[0.0; N]; EQUATIONS], order: [0, 1, 2], along: [[0.0; EQUATIONS]; EQUATIONS], count: 0 };
        let mut rest = [[0.0; N]; EQUATIONS];
        for j in (0..n).filter(|j| free & (1 << j) != 0) {
            (0..EQUATIONS).for_each(|k| rest[k][j] = step.columns[j][step.model.first_row + k]);
        }
        let mut first = 0.0;
        for s in 0..EQUATIONS {
            let mut longest = (-1.0, s);
            for place in s..EQUATIONS {
                let square = squared(&rest[found.order[place]][..n]);
                if square >= longest.0 {
                    longest = (square, place);
                }
            }
            let length = longest.0.sqrt();
            first = if s == 0 { length } else { first };
            if !(length > DEPENDENT * first) {
                break;
            }
            found.order.swap(s, longest.1);
            let k = found.order[s];
            let unit = &mut found.basis[s];
            (0..n).for_each(|j| unit[j] = rest[k][j] / length);
            found.along[k][s] = length;
            for other in &found.order[s + 1..] {
                found.along[*other][s] = removed(&unit[..n], &mut rest[*other][..n]);
            }
            found.count += 1;
        }
        found
    }

    /// Multipliers that balance `gradient` as far as the equations can.
    fn multipliers(&self, gradient: &[f64; N], n: usize) -> [f64; EQUATIONS] {
        let mut multipliers = [0.0; EQUATIONS];
        for s in (0..self.count).rev() {
            let later = &self.order[s + 1..self.count];
            let later: f64 = later.iter().map(|k| multipliers[*k] * self.along[*k][s]).sum();
            let k = self.order[s];
            multipliers[k] = (-dot(&self.basis[s][..n], &gradient[..n]) - later) / self.along[k][s];
        }
        multipliers
    }

    /// Orthonormal basis of the free directions that leave the equations unchanged.
    fn complement(&self, free: u64, n: usize) -> NullSpace<N> {
        let mut found = NullSpace { vectors: [[0.0; N]; N], count: 0 };
        let count = (free.count_ones() as usize).saturating_sub(self.count);
        let mut rests = [[0.0; N]; N];
        for j in (0..n).filter(|j| free & (1 << j) != 0) {
            rests[j][j] = 1.0;
            for unit in &self.basis[..self.count] {
                (0..n).for_each(|i| rests[j][i] -= unit[j] * unit[i]);
            }
        }
        while found.count < count {
            let mut longest = (0.0, 0);
            for (j, rest) in rests[..n].iter().enumerate() {
                let square = squared(&rest[..n]);
                if square >= longest.0 {
                    longest = (square, j);
                }
            }
            let mut next = rests[longest.1];
            // Twice is enough to be orthogonal to rounding.
            for unit in self.basis[..self.count].iter().chain(&found.vectors[..found.count]) {
                removed(&unit[..n], &mut next[..n]);
            }
            let size = squared(&next[..n]).sqrt();
            if !(size >= DEPENDENT) {
                break;
            }
            next[..n].iter_mut().for_each(|entry| *entry /= size);
            found.vectors[found.count] = next;
            found.count += 1;
            if found.count < count {
                rests[..n].iter_mut().for_each(|rest| {
                    removed(&next[..n], &mut rest[..n]);
                });
            }
        }
        found
    }
}

fn squared(v: &[f64]) -> f64 {
    dot(v, v)
}

/// Removes the part of `from` along `unit`, and returns it.
fn removed(unit: &[f64], from: &mut [f64]) -> f64 {
    let part = dot(unit, from);
    from.iter_mut().zip(unit).for_each(|(entry, unit)| *entry -= part * unit);
    part
}

/// Solves A z = b for `m` unknowns after raising the diagonal of A until it is positive definite, so that z leads downhill.
fn downhill<const N: usize>(matrix: &[[f64; N]; N], right: &[f64; N], m: usize) -> [f64; N] {
    let rows = || matrix[..m].iter().flat_map(|row| &row[..m]);
    let largest = rows().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    if largest == 0.0 || !rows().all(|entry| entry.is_finite()) {
        return [0.0; N];
    }
    let mut shift = 0.0;
    loop {
        if let Some(solved) = cholesky(matrix, shift, FLAT * largest, right, m) {
            return solved;
        }
        shift = if shift == 0.0 { 0.1 * largest } else { 4.0 * shift };
    }
}

/// Solves (A + shift I) z = b for `m` unknowns by Cholesky's method; `None` where a pivot is not above `least`.
fn cholesky<const N: usize>(
    matrix: &[[f64; N]; N],
    shift: f64,
    least: f64,
    right: &[f64; N],
    m: usize,
) -> Option<[f64; N]> {
    let mut lower = [[0.0; N]; N];
    for i in 0..m {
        for j in 0..=i {
            let entry = matrix[i][j] - dot(&lower[i][..j], &lower[j][..j]);
            if i == j {
                let pivot = entry + shift;
                if !(pivot > least) {
                    return None;
                }
                lower[i][i] = pivot.sqrt();
            } else {
                lower[i][j] = entry / lower[j][j];
            }
        }
    }
    let mut z = *right;
    for i in 0..m {
        z[i] = (z[i] - dot(&lower[i][..i], &z[..i])) / lower[i][i];
    }
    for i in (0..m).rev() {
        let known: f64 = (i + 1..m).map(|k| lower[k][i] * z[k]).sum();
        z[i] = (z[i] - known) / lower[i][i];
    }
    Some(z)
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;

    /// Model of `n` joints with a positive definite Hessian and straight equations.
    fn model(n: usize, entries: &[f64], residual: [f64; 3]) -> (Vec<[f64; ROWS]>, RankedModel) {
        let entry = |k: usize| entries[k % entries.len()];
        let columns = (0..n).map(|j| [entry(3 * j), entry(3 * j + 1), entry(3 * j + 2), 0.0, 0.0, 0.0]).collect();
        let mut model = RankedModel { residual, ..RankedModel::default() };
        model.clear(n);
        let factor = DMatrix::from_fn(n, n, |i, j| entry(5 * i + 7 * j + 11));
        let hessian = &factor * factor.transpose() + DMatrix::identity(n, n) * 0.5;
        for i in 0..n {
            model.gradient[i] = 0.05 * entry(2 * i + 3);
            (0..n).for_each(|j| model.hessian[i * n + j] = hessian[(i, j)]);
        }
        (columns, model)
    }

    #[test]
    fn a_matrix_with_nan_beside_numbers_leads_nowhere() {
        let matrix = [[1.0, f64::NAN], [f64::NAN, 1.0]];
        assert_eq!(downhill(&matrix, &[1.0, 1.0], 2), [0.0; 2]);
    }

    proptest! {
        #[test]
        fn without_bounds_it_is_the_optimum_on_the_equations(
            n in 4_usize..8,
            entries in prop::collection::vec(-1.0..1.0, 61),
            residual in prop::array::uniform3(-0.02..0.02),
        ) {
            let (columns, model) = model(n, &entries, residual);
            let rows = DMatrix::from_fn(3, n, |i, j| columns[j][i]);
            prop_assume!(rows.clone().singular_values().min() > 0.1);
            let (x, lower, upper) = (vec![0.0; n], vec![-9.0; n], vec![9.0; n]);
            let mut out = vec![0.0; n];
            let step = RankedStep { columns: &columns, model: &model, x: &x, lower: &lower, upper: &upper };
            let multipliers = step.write(&mut out);
            // Conditions of Lagrange: H x + g + J' m = 0, J x + r = 0.
            let mut system = DMatrix::zeros(n + 3, n + 3);
            system.view_mut((0, 0), (n, n)).copy_from(&DMatrix::from_row_slice(n, n, &model.hessian));
            system.view_mut((n, 0), (3, n)).copy_from(&rows);
            system.view_mut((0, n), (n, 3)).copy_from(&rows.transpose());
            let right: Vec<f64> = model.gradient.iter().chain(&residual).map(|entry| -entry).collect();
            let expected = system.lu().solve(&DVector::from_vec(right)).unwrap();
            prop_assume!(expected.rows(0, n).amax() < 0.4);
            let found = DVector::from_vec(out);
            prop_assert!((&found - expected.rows(0, n)).amax() < 1e-6, "{found} {expected} {multipliers:?}");
        }

        #[test]
        fn the_equations_hold_and_no_joint_leaves_the_box(
            n in 4_usize..8,
            entries in prop::collection::vec(-1.0..1.0, 61),
            width in 0.05_f64..0.5,
        ) {
            let (columns, mut model) = model(n, &entries, [0.0; 3]);
            model.gradient.iter_mut().for_each(|slope| *slope *= 100.0);
            let (x, lower, upper) = (vec![0.0; n], vec![-width; n], vec![0.5 * width; n]);
            let mut out = vec![0.0; n];
            RankedStep { columns: &columns, model: &model, x: &x, lower: &lower, upper: &upper }.write(&mut out);
            prop_assert!(out.iter().zip(&lower).zip(&upper).all(|((x, l), u)| l <= x && x <= u));
            for k in 0..3 {
                let moved: f64 = out.iter().zip(&columns).map(|(x, column)| x * column[k]).sum();
                prop_assert!(moved.abs() < 1e-8, "equation {k} moves by {moved}");
            }
        }
    }
}
