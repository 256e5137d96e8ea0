//! Bounded step for several tasks of six rows each: damped least squares as in [`box_step`](super::box_step), on J J' or J'J,
//! whichever is smaller.

use smallvec::SmallVec;

use super::MAX_DOF;
use super::arithmetic::{Arithmetic, by_instructions};
use super::box_step::{BoxStep, ROUNDS, ROWS};
use super::comparison::{larger, smaller};
use super::ldl;

/// Jacobian and residual of one task.
#[derive(Debug, Clone, Copy)]
pub struct TaskRows<'a> {
    /// Columns of the Jacobian, at least one per entry of x.
    pub columns: &'a [[f64; ROWS]],
    /// Residual to be removed by the step.
    pub residual: &'a [f64; ROWS],
    /// Factor that both contain.
    pub scale: f64,
}

/// Damped least-squares step in a box for several tasks; [`BoxStep`] is the case of one.
#[derive(Debug, Clone, Copy)]
pub struct BlockStep<'a> {
    /// Tasks; J stacks their rows.
    pub tasks: &'a [TaskRows<'a>],
    /// Damping factor.
    pub lambda: f64,
    /// Current point.
    pub x: &'a [f64],
    /// Lower bounds, one per entry of `x`.
    pub lower: &'a [f64],
    /// Upper bounds, one per entry of `x`.
    pub upper: &'a [f64],
}

/// Remaining residuals of the tasks; up to eight on the stack.
type Remaining = SmallVec<[[f64; ROWS]; 8]>;

impl BlockStep<'_> {
    /// Writes the point after the step into `out`.
    pub fn write(&self, out: &mut [f64]) {
        let Self { tasks, lambda, x, lower, upper } = *self;
        match tasks {
            [] => out.copy_from_slice(x),
            [TaskRows { columns, residual, .. }] => BoxStep { columns, residual, lambda, x, lower, upper }.write(out),
            _ => write_step(self, out),
        }
    }

    /// Writes the point in the box that (approximately) solves residual + J (out - x) = 0 and is nearest to `preferred`,
    /// which must be in the box.
    pub fn write_near(&self, preferred: &[f64], out: &mut [f64]) {
        self.near(preferred, |step| step.write(out));
    }

    /// Calls `then` with the step from `preferred` that solves the same equations.
    pub fn near(&self, preferred: &[f64], then: impl FnOnce(&BlockStep<'_>)) {
        let mut there: Remaining = self.tasks.iter().map(|task| *task.residual).collect();
        for (j, (x, preferred)) in self.x.iter().zip(preferred).enumerate() {
            shift(&mut there, self.tasks, j, preferred - x);
        }
        let tasks = self.tasks.iter().zip(&there).map(|(task, residual)| TaskRows { residual, ..*task });
        let tasks: SmallVec<[TaskRows<'_>; 8]> = tasks.collect();
        then(&BlockStep { tasks: &tasks, x: preferred, ..*self });
    }

    /// Solves a system of at most `N` unknowns: all rows, or all entries of x.
    #[inline(always)]
    fn write_within<A: Arithmetic, const N: usize>(&self, out: &mut [f64]) {
        let Self { tasks, x, lower, upper, .. } = *self;
        let mut remaining: Remaining = tasks.iter().map(|task| *task.residual).collect();
        let moved = self.moved_tasks();
        // Bit j is set if entry j is fixed at a bound.
        let mut fixed = 0_u64;
        for _ in 0..ROUNDS {
            let mut change = [0.0; MAX_DOF];
            if ROWS * tasks.len() <= x.len() {
                self.by_rows::<A, N>(&remaining, &moved, fixed, &mut change);
            } else {
                self.by_entries::<A, N>(&remaining, &moved, fixed, &mut change);
            }
            let fixed_before = fixed;
            for j in (0..x.len()).filter(|j| fixed_before & (1 << j) == 0) {
                let wanted = x[j] + change[j];
                let bounded = smaller(larger(wanted, lower[j]), upper[j]);
                out[j] = bounded;
                if bounded != wanted {
                    fixed |= 1 << j;
                    shift(&mut remaining, tasks, j, bounded - x[j]);
                }
            }
            if fixed == fixed_before {
                return;
            }
        }
    }

    /// Returns for each entry of x a bit mask of the tasks that it moves; most entries move few tasks.
    #[inline(always)]
    fn moved_tasks(&self) -> [u64; MAX_DOF] {
        let mut moved = [0; MAX_DOF];
        for (t, task) in self.tasks.iter().enumerate() {
            for (bits, column) in moved.iter_mut().zip(&task.columns[..self.x.len()]) {
                *bits |= u64::from(*column != [0.0; ROWS]) << t;
            }
        }
        moved
    }

    /// Computes dx = -J' (J J' + lambda I)^-1 r over the free entries.
    #[inline(always)]
    fn by_rows<A: Arithmetic, const N: usize>(
        &self,
        remaining: &[[f64; ROWS]],
        moved: &[u64; MAX_DOF],
        fixed: u64,
        change: &mut [f64; MAX_DOF],
    ) {
        let Self { tasks, lambda, x, .. } = *self;
        let (mut system, mut right) = ([[0.0; N]; N], [0.0; N]);
        for (i, entry) in remaining.as_flattened().iter().enumerate() {
            (right[i], system[i][i]) = (*entry, lambda);
        }
        for j in (0..x.len()).filter(|j| fixed & (1 << j) == 0) {
            for a in bits(moved[j]) {
                for b in bits(moved[j]).take_while(|b| *b <= a) {
                    let (one, other) = (&tasks[a].columns[j], &tasks[b].columns[j]);
                    for (i, entry) in one.iter().enumerate() {
                        let row = &mut system[ROWS * a + i][ROWS * b..ROWS * (b + 1)];
                        for (sum, other) in row.iter_mut().zip(other) {
                            *sum = A::mul_add(*entry, *other, *sum);
                        }
                    }
                }
            }
        }
        let z = ldl::solve::<A, N>(system, right);
        for j in 0..x.len() {
            for t in bits(moved[j]) {
                for (entry, z) in tasks[t].columns[j].iter().zip(&z[ROWS * t..]) {
                    change[j] = A::mul_add(-*entry, *z, change[j]);
                }
            }
        }
    }

    /// Computes dx = -(J' J + lambda I)^-1 J' r over the free entries.
    #[inline(always)]
    fn by_entries<A: Arithmetic, const N: usize>(
        &self,
        remaining: &[[f64; ROWS]],
        moved: &[u64; MAX_DOF],
        fixed: u64,
        change: &mut [f64; MAX_DOF],
    ) {
        let Self { tasks, lambda, x, .. } = *self;
        let (mut system, mut right) = ([[0.0; N]; N], [0.0; N]);
        let free = |j: &usize| fixed & (1 << j) == 0;
        let product =
            |one: &[f64; ROWS], other: &[f64; ROWS]| (0..ROWS).fold(0.0, |sum, k| A::mul_add(one[k], other[k], sum));
        for j in (0..x.len()).filter(free) {
            for t in bits(moved[j]) {
                right[j] -= product(&tasks[t].columns[j], &remaining[t]);
            }
            for k in (0..=j).filter(free) {
                for t in bits(moved[j] & moved[k]) {
                    system[j][k] += product(&tasks[t].columns[j], &tasks[t].columns[k]);
                }
            }
            system[j][j] += lambda;
        }
        // Fixed entries have zero rows, which the factorization skips.
        change[..N.min(MAX_DOF)].copy_from_slice(&ldl::solve::<A, N>(system, right)[..N.min(MAX_DOF)]);
    }
}

/// Iterates over the indices of the set bits, lowest first.
#[inline(always)]
fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = (set != 0).then(|| set.trailing_zeros() as usize)?;
        set &= set - 1;
        Some(lowest)
    })
}

/// Updates the residuals for a change of entry `j` of x.
fn shift(residuals: &mut [[f64; ROWS]], tasks: &[TaskRows<'_>], j: usize, change: f64) {
    for (residual, task) in residuals.iter_mut().zip(tasks) {
        for (entry, slope) in residual.iter_mut().zip(&task.columns[j]) {
            *entry += slope * change;
        }
    }
}

by_instructions! {
    fn write_step(step: &BlockStep<'_>, out: &mut [f64]) {
        match (ROWS * step.tasks.len()).min(step.x.len()) {
            ..=12 => step.write_within::<A, 12>(out),
            13..=18 => step.write_within::<A, 18>(out),
            19..=24 => step.write_within::<A, 24>(out),
            25..=36 => step.write_within::<A, 36>(out),
            _ => step.write_within::<A, MAX_DOF>(out),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    type Columns = Vec<[f64; ROWS]>;

    fn tasks<'a>(columns: &'a [Columns], residuals: &'a [[f64; ROWS]]) -> Vec<TaskRows<'a>> {
        columns.iter().zip(residuals).map(|(columns, residual)| TaskRows { columns, residual, scale: 1.0 }).collect()
    }

    /// Generates `count` tasks with `n` entries of x, the first of which moves only the first task.
    fn columns(count: usize, n: usize) -> impl Strategy<Value = Vec<Columns>> {
        let task = prop::collection::vec(prop::array::uniform6(-1.0..1.0), n);
        prop::collection::vec(task, count).prop_map(|mut tasks: Vec<Columns>| {
            tasks[1..].iter_mut().for_each(|columns| columns[0] = [0.0; ROWS]);
            tasks
        })
    }

    fn damped_step(columns: &[Columns], residuals: &[[f64; ROWS]], lambda: f64) -> DVector<f64> {
        let n = columns[0].len();
        let j = DMatrix::from_fn(ROWS * columns.len(), n, |i, k| columns[i / ROWS][k][i % ROWS]);
        let normal = j.transpose() * &j + DMatrix::identity(n, n) * lambda;
        -normal.lu().solve(&(j.transpose() * DVector::from_row_slice(residuals.as_flattened()))).unwrap()
    }

    proptest! {
        #[test]
        fn without_bounds_it_is_the_damped_pseudo_inverse(
            (columns, residuals) in (2_usize..5, 1_usize..32).prop_flat_map(|(count, n)| {
                (columns(count, n), prop::collection::vec(prop::array::uniform6(-1.0..1.0), count))
            }),
            lambda in 1e-2..1.0,
        ) {
            let n = columns[0].len();
            let (x, lower, upper) = (vec![0.0; n], vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
            let mut out = vec![0.0; n];
            let tasks = tasks(&columns, &residuals);
            BlockStep { tasks: &tasks, lambda, x: &x, lower: &lower, upper: &upper }.write(&mut out);
            prop_assert!((DVector::from_vec(out) - damped_step(&columns, &residuals, lambda)).norm() < 1e-9);
        }

        #[test]
        fn never_leaves_the_box(
            (columns, residuals) in (2_usize..4, 1_usize..20).prop_flat_map(|(count, n)| {
                (columns(count, n), prop::collection::vec(prop::array::uniform6(-5.0..5.0), count))
            }),
            width in 0.0_f64..0.5,
        ) {
            let n = columns[0].len();
            let (x, lower, upper) = (vec![0.0; n], vec![-width; n], vec![0.5 * width; n]);
            let mut out = vec![f64::NAN; n];
            let tasks = tasks(&columns, &residuals);
            BlockStep { tasks: &tasks, lambda: 1e-6, x: &x, lower: &lower, upper: &upper }.write(&mut out);
            prop_assert!(out.iter().zip(&lower).zip(&upper).all(|((x, l), u)| l <= x && x <= u));
        }
    }

    #[test]
    fn what_a_stuck_entry_cannot_do_the_others_take_over_and_what_is_free_stays_near_the_preferred() {
        // The first entry moves both tasks, each other entry one task.
        let column = |x: f64| [x, 0.0, 0.0, 0.0, 0.0, 0.0];
        let columns = [vec![column(1.0), column(1.0), column(0.0)], vec![column(1.0), column(0.0), column(1.0)]];
        let residuals = [column(-1.0), column(-2.0)];
        let tasks = tasks(&columns, &residuals);
        let free = [f64::INFINITY; 3];
        let step = BlockStep {
            tasks: &tasks,
            lambda: 1e-12,
            x: &[0.0; 3],
            lower: &free.map(|x| -x),
            upper: &[0.25, 9.0, 9.0],
        };
        let mut out = [0.0; 3];
        step.write(&mut out);
        assert!(out.iter().zip([0.25, 0.75, 1.75]).all(|(x, e)| (x - e).abs() < 1e-9), "{out:?}");
        BlockStep { upper: &free, ..step }.write_near(&[0.0, 1.0, 2.0], &mut out);
        assert!(out.iter().zip([0.0, 1.0, 2.0]).all(|(x, e)| (x - e).abs() < 1e-9), "{out:?}");
    }
}
