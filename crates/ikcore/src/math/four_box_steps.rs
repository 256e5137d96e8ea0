//! Four [bounded steps](super::box_step) at once, lane by lane to the same bits.

use super::MAX_DOF;
use super::arithmetic::{Arithmetic, by_instructions};
use super::box_step::{POSITION_ROWS, ROUNDS, ROWS, dot};
use super::f64x4::F64x4;
use super::ldl;
use super::real::{Four, Real};

/// Four steps in one box.
#[derive(Debug, Clone, Copy)]
pub struct FourBoxSteps<'a> {
    /// Columns of the Jacobians, one per entry of `x`.
    pub columns: &'a [[F64x4; ROWS]],
    /// Residuals that the steps are to remove.
    pub residual: &'a [F64x4; ROWS],
    /// The damping of each.
    pub lambda: F64x4,
    /// The current points.
    pub x: &'a [F64x4],
    /// The box of all four.
    pub lower: &'a [f64],
    /// See `lower`.
    pub upper: &'a [f64],
}

impl FourBoxSteps<'_> {
    /// Writes the points after the steps into `out`, lane by lane those of [`BoxStep::write`](super::box_step::BoxStep::write).
    /// The angular rows of the Jacobians are zero in all lanes, or in none.
    pub fn write(&self, out: &mut [F64x4]) {
        write_steps(self, out);
    }

    /// Solves on the position rows alone where the others are zero.
    #[inline(always)]
    fn write_rows_in_use<A: Arithmetic>(&self, out: &mut [F64x4]) {
        let moves_position_alone =
            |column: &[F64x4; ROWS]| column[POSITION_ROWS..] == [F64x4::ZERO; ROWS - POSITION_ROWS];
        if self.columns.iter().all(moves_position_alone) {
            self.write_first_rows::<A, POSITION_ROWS>(out);
        } else {
            self.write_first_rows::<A, ROWS>(out);
        }
    }

    /// On the first `R` rows.
    #[inline(always)]
    fn write_first_rows<A: Arithmetic, const R: usize>(&self, out: &mut [F64x4]) {
        let mut remaining = [Four::<A>::splat(0.0); R];
        remaining.iter_mut().zip(self.residual).for_each(|(entry, residual)| *entry = Four::of(*residual));
        // One where a joint is free, zero where it sits at a bound.
        let mut free = [Four::<A>::splat(1.0); MAX_DOF];
        for _ in 0..ROUNDS {
            let z = ldl::solve(self.gram::<A, R>(&free), remaining);
            let mut some_joint_hit_a_bound = false;
            for j in 0..self.x.len() {
                let (zero, x) = (Four::splat(0.0), Four::<A>::of(self.x[j]));
                let wanted = x - dot(&self.columns[j], &z);
                let bounded = wanted.larger(Four::splat(self.lower[j])).smaller(Four::splat(self.upper[j]));
                let was_free = free[j];
                out[j] = zero.choose_below(was_free, bounded, Four::of(out[j])).stored();
                let stays_free = bounded.choose_equal(wanted, was_free, zero);
                if stays_free.stored() == was_free.stored() {
                    continue;
                }
                some_joint_hit_a_bound = true;
                // Motion of the joint where it has just hit a bound; zero in other lanes.
                let moved = stays_free.choose_below(was_free, bounded - x, zero);
                for (rest, entry) in remaining.iter_mut().zip(&self.columns[j]) {
                    *rest = Four::of(*entry).mul_add(moved, *rest);
                }
                free[j] = stays_free;
            }
            if !some_joint_hit_a_bound {
                return;
            }
        }
    }

    /// J J' + lambda I over the joints that are free, in the lower triangle.
    #[inline(always)]
    fn gram<A: Arithmetic, const R: usize>(&self, free: &[Four<A>; MAX_DOF]) -> [[Four<A>; R]; R] {
        let mut sum = [[Four::<A>::splat(0.0); R]; R];
        for (column, free) in self.columns.iter().zip(free) {
            for i in 0..R {
                let entry = Four::of(column[i]) * *free;
                // Of a length that the compiler knows, so that it unrolls the loop.
                for k in 0..R {
                    if k > i {
                        break;
                    }
                    sum[i][k] = entry.mul_add(Four::of(column[k]), sum[i][k]);
                }
            }
        }
        for (i, row) in sum.iter_mut().enumerate() {
            row[i] = row[i] + Four::of(self.lambda);
        }
        sum
    }
}

by_instructions! {
    fn write_steps(steps: &FourBoxSteps<'_>, out: &mut [F64x4]) {
        steps.write_rows_in_use::<A>(out);
    }
}

#[cfg(test)]
mod tests {
    use super::super::box_step::BoxStep;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Some of the joints hit their bounds in some of the lanes.
        #[test]
        fn each_is_what_it_is_alone_to_the_bit(
            columns in prop::collection::vec(prop::array::uniform6(prop::array::uniform4(-1.0..1.0)), 1..10),
            residual in prop::array::uniform6(prop::array::uniform4(-2.0..2.0)),
            lambda in prop::array::uniform4(1e-6..1.0),
            width in 0.0_f64..1.0,
            rows in prop::sample::select(vec![3, 6]),
        ) {
            let cut = |all: [[f64; 4]; 6]| -> [F64x4; 6] {
                std::array::from_fn(|row| if row < rows { F64x4(all[row]) } else { F64x4::ZERO })
            };
            let columns: Vec<[F64x4; 6]> = columns.into_iter().map(cut).collect();
            let (residual, lambda, n) = (cut(residual), F64x4(lambda), columns.len());
            let (x, lower, upper) = (vec![F64x4::splat(0.1 * width); n], vec![-width; n], vec![0.5 * width; n]);
            let mut four = vec![F64x4::ZERO; n];
            let (columns, residual) = (&columns[..], &residual);
            FourBoxSteps { columns, residual, lambda, x: &x, lower: &lower, upper: &upper }.write(&mut four);
            for lane in 0..4 {
                let alone = |lanes: &[F64x4; 6]| lanes.map(|row| row.0[lane]);
                let own: Vec<_> = columns.iter().map(alone).collect();
                let mut out = vec![0.0; n];
                let (residual, lambda, x) = (&alone(residual), lambda.0[lane], &vec![0.1 * width; n]);
                BoxStep { columns: &own, residual, lambda, x, lower: &lower, upper: &upper }.write(&mut out);
                let lane: Vec<f64> = four.iter().map(|lanes| lanes.0[lane]).collect();
                prop_assert_eq!(lane, out);
            }
        }
    }
}
