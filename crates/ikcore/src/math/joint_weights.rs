//! Weights of joints: the cost of moving each, and the step by the joints that cost least.
//!
//! The length of a motion dx is |W dx|. Weights decide which joints make a motion, not where the tip goes: a weighted step has the
//! same effect on the tasks, to first order, as the plain one. Damping and bounds therefore act as without weights, and a heavy
//! joint still moves where the others cannot do it.

use smallvec::SmallVec;

use super::STACK_DOF;
use super::block_step::{BlockStep, TaskRows};
use super::box_step::{LEAST_DAMPING, POSITION_ROWS, ROWS};
use super::vector::{dot, squared_size};
use crate::error::{Error, Result};

/// Largest ratio of two weights; larger ones would differ by rounding alone.
const MOST: f64 = 1e8;

/// Longest weighted step of a joint (rad, m), unless the plain step is longer; the tasks are not linear farther away.
const LONGEST: f64 = 0.5;

/// Largest effect of second order of one joint, relative to the wanted effect, in a step that counts on linear tasks.
const BENT: f64 = 0.25;

/// Fraction of the effect, squared, that a weighted step may miss.
const MISSED: f64 = 1e-16;

/// Weights of the joints relative to the smallest, not all equal.
#[derive(Debug, Clone, PartialEq)]
pub struct JointWeights {
    relative: Vec<f64>,
    /// Largest effect of one joint, relative to the wanted effect. Near a singularity of the light joints, where theirs would be
    /// larger, the step fades into the plain one, so that they slow down before the heavy joints take over.
    largest_effect: f64,
}

/// Box of a step, and the weights of the joints.
#[derive(Debug, Clone, Copy)]
pub struct StepBox<'a> {
    /// Lower bounds, one per joint.
    pub lower: &'a [f64],
    /// Upper bounds, one per joint.
    pub upper: &'a [f64],
    /// Weights of the joints; `None` where all cost the same.
    pub weights: Option<&'a JointWeights>,
}

impl<'a> From<[&'a [f64]; 2]> for StepBox<'a> {
    #[inline]
    fn from([lower, upper]: [&'a [f64]; 2]) -> Self {
        Self { lower, upper, weights: None }
    }
}

/// Point with one entry per joint.
type Joints = SmallVec<[f64; STACK_DOF]>;

/// Six numbers for each task.
type TaskVector = SmallVec<[[f64; ROWS]; 4]>;

impl JointWeights {
    /// Weights relative to the smallest; `None` if all are equal.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a weight that is not positive and finite.
    pub(crate) fn new(weights: &[f64]) -> Result<Option<Self>> {
        if let Some(j) = weights.iter().position(|weight| !(*weight > 0.0 && weight.is_finite())) {
            let requirement = "positive and finite (a joint that must not move is locked by its limits)";
            return Err(Error::out_of_range(format!("joint_weights[{j}]"), requirement, weights[j]));
        }
        let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
        let relative: Vec<f64> = weights.iter().map(|weight| (weight / least).min(MOST)).collect();
        Ok(relative.iter().any(|weight| *weight != 1.0).then_some(Self { relative, largest_effect: f64::INFINITY }))
    }

    /// The weights of a motion, in which the effect of one joint is at most this multiple of the wanted one.
    pub(crate) fn fading_at(self, largest_effect: f64) -> Self {
        Self { largest_effect, ..self }
    }

    /// The weights, lowered to `largest` at most; `None` if all are equal then.
    pub(crate) fn at_most(&self, largest: f64) -> Option<Self> {
        let relative = self.relative.iter().map(|weight| weight.min(largest)).collect();
        (largest > 1.0).then_some(Self { relative, ..*self })
    }

    /// The weights (n,).
    pub(crate) fn as_slice(&self) -> &[f64] {
        &self.relative
    }

    /// Turns a gradient into the direction of steepest ascent per length of motion, W^-2 times the gradient.
    pub(crate) fn steepest(&self, gradient: &mut [f64]) {
        gradient.iter_mut().zip(&self.relative).for_each(|(slope, weight)| *slope /= weight * weight);
    }

    /// Returns the inner product of two motions, a'W^2 b.
    pub(crate) fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.relative.iter().zip(a.iter().zip(b)).map(|(weight, (a, b))| weight * weight * a * b).sum()
    }

    /// Writes the point after `step` by the joints that cost least.
    #[cold]
    pub(crate) fn write(&self, step: &BlockStep<'_>, out: &mut [f64]) {
        step.write(out);
        let still: TaskVector = step.tasks.iter().map(|_| [0.0; ROWS]).collect();
        let wanted = after(step, still, out, -1.0);
        let size = squared_size(&wanted);
        if size == 0.0 {
            return;
        }
        self.write_cheapest(step, &wanted, out);
        let left = after(step, wanted, out, 1.0);
        if squared_size(&left) > MISSED * size {
            let from = Joints::from_slice(out);
            let tasks = with_residuals(step.tasks, &left);
            BlockStep { tasks: &tasks, lambda: least_damping(step), x: &from, ..*step }.write(out);
        }
    }

    /// Moves `out`, the point after the plain step, to one with the effect `-wanted` that costs least, by the change of
    /// variables y = W (x' - x).
    fn write_cheapest(&self, step: &BlockStep<'_>, wanted: &[[f64; ROWS]], out: &mut [f64]) {
        let n = step.x.len();
        let mut columns: SmallVec<[[f64; ROWS]; STACK_DOF]> = SmallVec::with_capacity(n * step.tasks.len());
        for task in step.tasks {
            let scaled =
                task.columns.iter().zip(&self.relative).map(|(column, weight)| column.map(|entry| entry / weight));
            columns.extend(scaled);
        }
        let rows = columns.chunks_exact(n).zip(wanted);
        let rows = rows.map(|(columns, residual)| TaskRows { columns, residual, scale: 1.0 });
        let tasks: SmallVec<[TaskRows<'_>; 4]> = rows.collect();
        let (mut lower, mut upper) = (Joints::new(), Joints::new());
        for (j, weight) in self.relative.iter().enumerate() {
            let farthest = (out[j] - step.x[j]).abs().max(LONGEST);
            lower.push(weight * (step.lower[j] - step.x[j]).max(-farthest));
            upper.push(weight * (step.upper[j] - step.x[j]).min(farthest));
        }
        let (start, mut end) = (Joints::from_elem(0.0, n), Joints::from_elem(0.0, n));
        let lambda = LEAST_DAMPING * squared_size(&columns);
        BlockStep { tasks: &tasks, lambda, x: &start, lower: &lower, upper: &upper }.write(&mut end);
        end.iter_mut().zip(&self.relative).for_each(|(end, weight)| *end /= weight);
        let fraction = self.fraction(step, wanted, out, &end);
        for (j, out) in out.iter_mut().enumerate() {
            let cheapest = (step.x[j] + end[j]).max(step.lower[j]).min(step.upper[j]);
            *out = if fraction == 1.0 { cheapest } else { *out + fraction * (cheapest - *out) };
        }
    }

    /// Fraction of the way from the plain step, which ends at `plain`, to the cheapest motion. Both have the same effect.
    fn fraction(&self, step: &BlockStep<'_>, wanted: &[[f64; ROWS]], plain: &[f64], cheapest: &[f64]) -> f64 {
        if self.largest_effect == f64::INFINITY {
            return 1.0;
        }
        let each = step.tasks.iter().zip(wanted).map(|(task, rows)| squared_sizes(rows, task.scale));
        let wanted = each.fold([0.0; 2], |sums, sizes| [sums[0] + sizes[0], sums[1] + sizes[1]]).map(f64::sqrt);
        let beyond = |j: usize| {
            let valid = self.valid_step(wanted, step.tasks, j).max((plain[j] - step.x[j]).abs());
            if cheapest[j] == 0.0 { 0.0 } else { cheapest[j].abs() / valid }
        };
        (0..plain.len()).map(beyond).fold(1.0, f64::max).powi(-2)
    }

    /// Longest step of joint `j` for which the tasks are linear, against the wanted effect of these sizes in position or in rotation.
    fn valid_step(&self, wanted: [f64; 2], tasks: &[TaskRows<'_>], j: usize) -> f64 {
        // Two arms that hold a pair both move it as far as the tip: the task that the joint moves most counts.
        let each = tasks.iter().map(|task| squared_sizes(&task.columns[j], task.scale));
        let own = each
            .fold([0.0_f64; 2], |most: [f64; 2], sizes: [f64; 2]| [most[0].max(sizes[0]), most[1].max(sizes[1])])
            .map(f64::sqrt);
        let part = |k: usize| {
            let ratio = wanted[k] / own[k];
            if wanted[k] > 0.0 { (self.largest_effect * ratio).min((2.0 * BENT * ratio).sqrt()) } else { 0.0 }
        };
        part(0).max(part(1)).min(LONGEST)
    }
}

/// Returns `residuals` + `sign` * J (out - x).
fn after(step: &BlockStep<'_>, mut residuals: TaskVector, out: &[f64], sign: f64) -> TaskVector {
    for (task, residual) in step.tasks.iter().zip(&mut residuals) {
        for (column, (out, x)) in task.columns.iter().zip(out.iter().zip(step.x)) {
            let way = sign * (out - x);
            residual.iter_mut().zip(column).for_each(|(sum, entry)| *sum += entry * way);
        }
    }
    residuals
}

/// Squared norms of the position row and of the rotation row of a task, without the `scale` that they contain.
fn squared_sizes(row: &[f64; ROWS], scale: f64) -> [f64; 2] {
    let (position, rotation) = row.split_at(POSITION_ROWS);
    [position, rotation].map(|part| dot(part, part) / (scale * scale))
}

/// The tasks with these residuals in place of their own.
fn with_residuals<'a>(tasks: &[TaskRows<'a>], residuals: &'a [[f64; ROWS]]) -> SmallVec<[TaskRows<'a>; 4]> {
    tasks.iter().zip(residuals).map(|(task, residual)| TaskRows { residual, ..*task }).collect()
}

/// Damping that only keeps singular systems solvable.
fn least_damping(step: &BlockStep<'_>) -> f64 {
    LEAST_DAMPING * step.tasks.iter().map(|task| squared_size(&task.columns[..step.x.len()])).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    const FREE: f64 = f64::INFINITY;

    /// Returns the plain and the weighted step of one task from the origin.
    fn stepped(
        weights: &[f64],
        columns: &[[f64; 6]],
        residual: &[f64; 6],
        lambda: f64,
        [lower, upper]: [&[f64]; 2],
    ) -> (Vec<f64>, Vec<f64>) {
        let n = columns.len();
        let (x, mut plain, mut out) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let tasks = [TaskRows { columns, residual, scale: 1.0 }];
        let step = BlockStep { tasks: &tasks, lambda, x: &x, lower, upper };
        step.write(&mut plain);
        match JointWeights::new(weights).unwrap() {
            None => step.write(&mut out),
            Some(weights) => weights.write(&step, &mut out),
        }
        (plain, out)
    }

    fn effect(columns: &[[f64; 6]], dx: &[f64]) -> [f64; 6] {
        std::array::from_fn(|i| columns.iter().zip(dx).map(|(column, dx)| column[i] * dx).sum())
    }

    fn differs(a: &[f64; 6], b: &[f64; 6]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    fn round_or_real() -> impl Strategy<Value = f64> {
        prop_oneof![Just(1.0), Just(10.0), Just(100.0), Just(1e3), Just(1e6), 0.1..20.0_f64]
    }

    proptest! {
        #[test]
        fn the_weighted_pseudo_inverse_is_the_oracle(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 9..12),
            residual in prop::array::uniform6(-1e-4..1e-4),
            weights in prop::collection::vec(prop_oneof![Just(1.0), Just(10.0), 0.5..20.0_f64], 12),
        ) {
            let n = columns.len();
            let (lower, upper) = (vec![-FREE; n], vec![FREE; n]);
            let (_, out) = stepped(&weights[..n], &columns, &residual, 1e-9, [&lower, &upper]);
            let j = DMatrix::from_fn(6, n, |i, k| columns[k][i]);
            let compliance = DMatrix::from_diagonal(&DVector::from_fn(n, |k, _| weights[k].powi(-2)));
            let normal = &j * &compliance * j.transpose();
            prop_assume!(normal.clone().symmetric_eigen().eigenvalues.min() > 1e-3);
            let expected = -&compliance * j.transpose() * normal.lu().solve(&DVector::from_row_slice(&residual)).unwrap();
            prop_assert!((DVector::from_vec(out) - expected).norm() < 1e-8);
        }

        #[test]
        fn the_effect_on_the_tasks_is_that_of_the_plain_step(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 1..12),
            residual in prop::array::uniform6(-1.0..1.0),
            weights in prop::collection::vec(round_or_real(), 12),
            lambda in prop_oneof![Just(1e-9), Just(0.05), 1e-6..1.0],
        ) {
            let n = columns.len();
            let least = DMatrix::from_fn(6, n, |i, k| columns[k][i]).singular_values().min();
            prop_assume!(least > 0.01);
            // The least damping takes this part of an effect along the weakest direction.
            let damped = LEAST_DAMPING * squared_size(&columns) / least.powi(2);
            let (lower, upper) = (vec![-FREE; n], vec![FREE; n]);
            let (plain, out) = stepped(&weights[..n], &columns, &residual, lambda, [&lower, &upper]);
            let [plain, weighted] = [&plain, &out].map(|dx| effect(&columns, dx));
            prop_assert!(differs(&plain, &weighted) < 1e-6 + 3.0 * damped, "{plain:?} {weighted:?}");
        }

        #[test]
        fn no_step_leaves_the_box(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 1..12),
            residual in prop::array::uniform6(-5.0..5.0),
            weights in prop::collection::vec(round_or_real(), 12),
            width in prop_oneof![Just(0.0), Just(0.1), 0.0..0.5],
        ) {
            let n = columns.len();
            let (lower, upper) = (vec![-width; n], vec![0.5 * width; n]);
            let (_, out) = stepped(&weights[..n], &columns, &residual, 1e-6, [&lower, &upper]);
            prop_assert!(out.iter().zip(&lower).zip(&upper).all(|((x, l), u)| l <= x && x <= u));
        }

        #[test]
        fn a_common_factor_of_all_weights_changes_nothing(
            columns in prop::collection::vec(prop::array::uniform6(-1.0..1.0), 2..12),
            residual in prop::array::uniform6(-0.1..0.1),
            weights in prop::collection::vec(round_or_real(), 12),
            exponent in -20..20_i32,
        ) {
            let n = columns.len();
            let (lower, upper) = (vec![-FREE; n], vec![FREE; n]);
            let scaled: Vec<f64> = weights.iter().map(|weight| weight * 2_f64.powi(exponent)).collect();
            let of = |weights: &[f64]| stepped(&weights[..n], &columns, &residual, 1e-6, [&lower, &upper]).1;
            prop_assert_eq!(of(&weights), of(&scaled));
        }
    }

    #[test]
    fn near_a_singularity_a_motion_fades_into_the_plain_step() {
        // Two light joints of opposite effect along x, nearly parallel, and a heavy one along y, which they can move by large steps.
        let columns = |sine: f64| {
            [[1.0, sine, 0.0, 0.0, 0.0, 0.0], [-1.0, sine, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]
        };
        let residual = [0.0, -0.001, 0.0, 0.0, 0.0, 0.0];
        let mut last = 0.0;
        for sine in [0.5, 0.1, 0.03, 0.01, 1e-3, 0.0] {
            let (columns, x, mut out) = (columns(sine), [0.0; 3], [0.0; 3]);
            let tasks = [TaskRows { columns: &columns, residual: &residual, scale: 1.0 }];
            let step = BlockStep { tasks: &tasks, lambda: 1e-12, x: &x, lower: &[-FREE; 3], upper: &[FREE; 3] };
            JointWeights::new(&[1.0, 1.0, 1e3]).unwrap().unwrap().fading_at(10.0).write(&step, &mut out);
            assert!(differs(&effect(&columns, &out), &residual.map(|r| -r)) < 1e-9, "{out:?}");
            assert!(out[0].abs() <= 0.01 + 1e-9 && out[2] >= last - 1e-9, "{sine}: {out:?}");
            last = out[2];
        }
        assert!((last - 0.001).abs() < 1e-9, "{last}");
    }

    #[test]
    fn equal_weights_are_none() {
        let of = |relative| JointWeights { relative, largest_effect: f64::INFINITY };
        assert_eq!(JointWeights::new(&[3.0; 7]).unwrap(), None);
        assert_eq!(JointWeights::new(&[2.0, 1.0, 4.0]).unwrap(), Some(of(vec![2.0, 1.0, 4.0])));
        assert_eq!(JointWeights::new(&[1e300, 1e-300]).unwrap(), Some(of(vec![1e8, 1.0])));
    }

    #[test]
    fn weights_are_positive_and_finite() {
        for (weight, got) in [(0.0, "0"), (-2.0, "-2"), (f64::INFINITY, "inf"), (f64::NAN, "NaN")] {
            let error = JointWeights::new(&[1.0, weight]).unwrap_err().to_string();
            let expected = "joint_weights[1] must be positive and finite (a joint that must not move is locked by its limits), got ";
            assert_eq!(error, format!("{expected}{got}"));
        }
    }

    #[test]
    fn a_heavy_joint_alone_in_a_direction_moves_as_far_as_a_light_one() {
        let columns = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]];
        let residual = [0.5, -0.5, 0.0, 0.0, 0.0, 0.0];
        let free = [&[-FREE; 2][..], &[FREE; 2][..]];
        for lambda in [1e-10, 0.05] {
            let (plain, out) = stepped(&[1e8, 1.0], &columns, &residual, lambda, free);
            assert!((out[0] - plain[0]).abs() < 1e-9 && (out[1] - plain[1]).abs() < 1e-9, "{plain:?} {out:?}");
        }
    }

    #[test]
    fn the_heavy_joint_takes_over_what_bounds_leave() {
        // Both joints push along x; the light one may move by 0.1 alone.
        let columns = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; 2];
        let residual = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let (_, out) = stepped(&[1e3, 1.0], &columns, &residual, 1e-12, [&[-FREE, -0.1], &[FREE, 0.1]]);
        assert!((out[0] - 0.9).abs() < 1e-9 && (out[1] - 0.1).abs() < 1e-15, "{out:?}");
    }
}
