//! Step for two objectives in order of rank, in a box: three equations first, then a second-order model on their solutions.
//!
//! The step that solves the equations is the bounded step of [`box_step`](super::box_step). The second objective then moves the
//! point along the null space of the equations, by Newton's method in an orthonormal basis of it. A joint that reaches its bound
//! on the way is fixed there, and the others go on in what is left of the null space: the equations never give way.

use smallvec::SmallVec;

use super::MAX_DOF;
use super::box_step::{BoxStep, ROWS, least_damping};
use super::vector::dot;

/// Number of joints up to which nothing is allocated.
const FEW: usize = 8;

/// Number of equations.
const EQUATIONS: usize = 3;

/// Length of an equation's gradient, relative to the longest, below which it depends on the others.
const DEPENDENT: f64 = 1e-9;

/// Longest step along the null space (rad, m); the model holds no farther.
const LONGEST: f64 = 0.5;

/// Smallest curvature, relative to the largest entry, of a model that has a minimum.
const FLAT: f64 = 1e-9;

/// Entries of a point, on the stack up to eight joints.
type Entries = SmallVec<[f64; FEW]>;

/// Symmetric matrix by rows, on the stack up to eight joints.
pub type Square = SmallVec<[f64; 64]>;

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
    /// Second derivatives of each equation.
    pub bends: [Square; EQUATIONS],
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
        for matrix in std::iter::once(&mut self.hessian).chain(&mut self.bends) {
            matrix.clear();
            matrix.resize(n * n, 0.0);
        }
    }

    /// Adds to both sides of the diagonal of a matrix of `n` columns.
    pub fn set(matrix: &mut Square, n: usize, i: usize, j: usize, value: f64) {
        matrix[i * n + j] = value;
        matrix[j * n + i] = value;
    }
}

impl RankedStep<'_> {
    /// Writes the point after the step into `out`, and returns the multipliers of the equations.
    pub fn write(&self, out: &mut [f64]) -> [f64; EQUATIONS] {
        self.write_first(out);
        self.write_second(out)
    }

    /// Writes the point nearest to `x` that solves the equations.
    pub fn write_first(&self, out: &mut [f64]) {
        let n = self.x.len();
        let (mut columns, mut residual) = (SmallVec::<[[f64; ROWS]; FEW]>::new(), [0.0; ROWS]);
        // The position rows come first in a step that has no others.
        columns.extend(self.columns[..n].iter().map(|column| {
            let [x, y, z] = self.equations(column);
            [x, y, z, 0.0, 0.0, 0.0]
        }));
        residual[..EQUATIONS].copy_from_slice(&self.model.residual);
        let (columns, residual) = (&columns[..], &residual);
        let lambda = least_damping(columns);
        BoxStep { columns, residual, lambda, x: self.x, lower: self.lower, upper: self.upper }.write(out);
    }

    fn equations(&self, column: &[f64; ROWS]) -> [f64; EQUATIONS] {
        std::array::from_fn(|k| column[self.model.first_row + k])
    }

    /// Moves `out`, which solves the equations, along their null space.
    fn write_second(&self, out: &mut [f64]) -> [f64; EQUATIONS] {
        let n = self.x.len();
        let mut free: u64 = if n == MAX_DOF { u64::MAX } else { (1 << n) - 1 };
        let mut multipliers = None;
        while free != 0 {
            let gradient = self.gradient_at(out);
            let rows = EquationBasis::of(self, free);
            let of_equations = *multipliers.get_or_insert_with(|| rows.multipliers(&gradient));
            let null = rows.complement(free, n);
            let Some(direction) = self.newton(&null, &gradient, &of_equations) else { break };
            let mut reach = 1.0;
            let mut blocking = 0_u64;
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
            if blocking == 0 {
                break;
            }
            free &= !blocking;
        }
        multipliers.unwrap_or([0.0; EQUATIONS])
    }

    /// Gradient of the model at `out`.
    fn gradient_at(&self, out: &[f64]) -> Entries {
        let n = self.x.len();
        let change: Entries = out.iter().zip(self.x).map(|(out, x)| out - x).collect();
        let rows = self.model.hessian.chunks_exact(n).zip(&self.model.gradient);
        rows.map(|(row, slope)| slope + dot(row, &change)).collect()
    }

    /// Step along the null space to the minimum of the model, or downhill where it has none; `None` without a null space.
    fn newton(&self, null: &[Entries], gradient: &[f64], multipliers: &[f64; EQUATIONS]) -> Option<Entries> {
        if null.is_empty() {
            return None;
        }
        let (n, m) = (self.x.len(), null.len());
        let RankedModel { hessian, bends, .. } = self.model;
        let curved = |i: usize, j: usize| {
            let bend = multipliers.iter().zip(bends).map(|(multiplier, bend)| multiplier * bend[i * n + j]);
            hessian[i * n + j] + bend.sum::<f64>()
        };
        let mut reduced = Square::from_elem(0.0, m * m);
        for (b, vector) in null.iter().enumerate() {
            let image: Entries =
                (0..n).map(|i| (0..n).filter(|j| vector[*j] != 0.0).map(|j| curved(i, j) * vector[j]).sum()).collect();
            for (a, other) in null.iter().enumerate().take(b + 1) {
                RankedModel::set(&mut reduced, m, a, b, dot(other, &image));
            }
        }
        let right: Entries = null.iter().map(|vector| -dot(vector, gradient)).collect();
        let parts = downhill(&reduced, &right);
        let mut direction = Entries::from_elem(0.0, n);
        for (part, vector) in parts.iter().zip(null) {
            direction.iter_mut().zip(vector).for_each(|(way, entry)| *way += part * entry);
        }
        let longest = direction.iter().fold(0.0, |most: f64, way| most.max(way.abs()));
        if longest > LONGEST {
            direction.iter_mut().for_each(|way| *way *= LONGEST / longest);
        }
        Some(direction)
    }
}

/// Orthonormal basis of the equations' gradients over the free joints, and the gradients in it.
struct EquationBasis {
    basis: SmallVec<[Entries; EQUATIONS]>,
    /// Equations in the order of the basis, each with its components along it.
    parts: SmallVec<[(usize, [f64; EQUATIONS]); EQUATIONS]>,
}

impl EquationBasis {
    /// Orthogonalises the gradients, the longest remainder first.
    fn of(step: &RankedStep<'_>, free: u64) -> Self {
        let n = step.x.len();
        let mut found = Self { basis: SmallVec::new(), parts: SmallVec::new() };
        let entry = |k: usize, j: usize| {
            if free & (1 << j) != 0 { step.columns[j][step.model.first_row + k] } else { 0.0 }
        };
        let mut rest: SmallVec<[Entries; EQUATIONS]> =
            (0..EQUATIONS).map(|k| (0..n).map(|j| entry(k, j)).collect()).collect();
        let mut along = [[0.0; EQUATIONS]; EQUATIONS];
        let mut left: SmallVec<[usize; EQUATIONS]> = (0..EQUATIONS).collect();
        let mut longest = 0.0;
        while let Some(place) = (0..left.len()).max_by(|a, b| {
            let length = |place: usize| dot(&rest[left[place]], &rest[left[place]]);
            length(*a).total_cmp(&length(*b))
        }) {
            let k = left.remove(place);
            let length = dot(&rest[k], &rest[k]).sqrt();
            longest = if found.basis.is_empty() { length } else { longest };
            if length <= DEPENDENT * longest {
                break;
            }
            let unit: Entries = rest[k].iter().map(|entry| entry / length).collect();
            along[k][found.basis.len()] = length;
            for other in &left {
                let part = dot(&rest[*other], &unit);
                along[*other][found.basis.len()] = part;
                rest[*other].iter_mut().zip(&unit).for_each(|(entry, unit)| *entry -= part * unit);
            }
            found.parts.push((k, along[k]));
            found.basis.push(unit);
        }
        found
    }

    /// Multipliers that balance `gradient` as far as the equations can.
    fn multipliers(&self, gradient: &[f64]) -> [f64; EQUATIONS] {
        let mut multipliers = [0.0; EQUATIONS];
        for s in (0..self.basis.len()).rev() {
            let later: f64 = self.parts[s + 1..].iter().map(|(k, along)| multipliers[*k] * along[s]).sum();
            let (k, along) = &self.parts[s];
            multipliers[*k] = (-dot(&self.basis[s], gradient) - later) / along[s];
        }
        multipliers
    }

    /// Orthonormal basis of the free directions that leave the equations unchanged.
    fn complement(&self, free: u64, n: usize) -> SmallVec<[Entries; 4]> {
        let count = (free.count_ones() as usize).saturating_sub(self.basis.len());
        let mut found: SmallVec<[Entries; 4]> = SmallVec::new();
        let mut rests: SmallVec<[Entries; FEW]> = SmallVec::new();
        for j in (0..n).filter(|j| free & (1 << j) != 0) {
            let mut rest = Entries::from_elem(0.0, n);
            rest[j] = 1.0;
            self.basis.iter().for_each(|unit| remove(unit, &mut rest));
            rests.push(rest);
        }
        while found.len() < count {
            let length = |rest: &Entries| dot(rest, rest);
            let Some(mut next) = rests.iter().max_by(|a, b| length(a).total_cmp(&length(b))).cloned() else { break };
            // Twice is enough to be orthogonal to rounding.
            self.basis.iter().chain(&found).for_each(|unit| remove(unit, &mut next));
            let size = dot(&next, &next).sqrt();
            if size < DEPENDENT {
                break;
            }
            next.iter_mut().for_each(|entry| *entry /= size);
            rests.iter_mut().for_each(|rest| remove(&next, rest));
            found.push(next);
        }
        found
    }
}

/// Removes the part of `from` along `unit`.
fn remove(unit: &[f64], from: &mut [f64]) {
    let part = dot(unit, from);
    from.iter_mut().zip(unit).for_each(|(entry, unit)| *entry -= part * unit);
}

/// Solves A z = b after raising the diagonal of A until it is positive definite, so that z leads downhill.
fn downhill(matrix: &[f64], right: &[f64]) -> Entries {
    let m = right.len();
    let largest = matrix.iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let mut shift = 0.0;
    loop {
        if let Some(solved) = cholesky(matrix, shift, FLAT * largest, right) {
            return solved;
        }
        if largest == 0.0 || !largest.is_finite() {
            return Entries::from_elem(0.0, m);
        }
        shift = if shift == 0.0 { 0.1 * largest } else { 4.0 * shift };
    }
}

/// Solves (A + shift I) z = b by Cholesky's method; `None` where a pivot is not above `least`.
fn cholesky(matrix: &[f64], shift: f64, least: f64, right: &[f64]) -> Option<Entries> {
    let m = right.len();
    let mut lower = Square::from_elem(0.0, m * m);
    for i in 0..m {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i * m + k] * lower[j * m + k]).sum();
            let entry = matrix[i * m + j] - known;
            if i == j {
                let pivot = entry + shift;
                if !(pivot > least) {
                    return None;
                }
                lower[i * m + i] = pivot.sqrt();
            } else {
                lower[i * m + j] = entry / lower[j * m + j];
            }
        }
    }
    let mut z = Entries::from_slice(right);
    for i in 0..m {
        let known: f64 = (0..i).map(|k| lower[i * m + k] * z[k]).sum();
        z[i] = (z[i] - known) / lower[i * m + i];
    }
    for i in (0..m).rev() {
        let known: f64 = (i + 1..m).map(|k| lower[k * m + i] * z[k]).sum();
        z[i] = (z[i] - known) / lower[i * m + i];
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
