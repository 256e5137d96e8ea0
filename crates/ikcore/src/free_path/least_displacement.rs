//! Moves both ends along the self-motion that their targets leave free, so that the slowest joint takes less time.
//!
//! The minimum of the largest displacement is found by Lawson's algorithm (1961): least squares over weighted
//! displacements, in which joints with larger displacements gain weight until the largest ones are equal. Each round is
//! also a Gauss-Newton step towards the targets.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::end_pair::EndPair;
use crate::error::Result;
use crate::math::box_step::ROWS;
use crate::objective::{Point, TaskBlock};
use crate::robot::Robot;
use crate::task::{Criterion, Target, Task, Tolerance};
use crate::timing::ConstantLimits;

const ROUNDS: usize = 20;
/// Largest displacement of a joint in one round (rad, m).
const LONGEST_STEP: f64 = 0.4;
/// Damping of the steps, relative to the sum of all weights. With this value, all tested motions of planar arms with 3
/// to 5 links reach the shortest duration; with a tenth of it or ten times as much, fewer do.
const DAMPING: f64 = 0.0125;
/// The smallest weight, relative to the sum.
const SMALLEST_WEIGHT: f64 = 1e-3;

/// Freedom that the targets leave.
pub(super) struct Freedom<'a> {
    /// The robot with the tool of the task, if there is one.
    robot: Cow<'a, Robot>,
    limits: &'a ConstantLimits,
    task: Option<Task>,
    criterion: Criterion,
}

impl<'a> Freedom<'a> {
    /// # Errors
    /// As [`Task::robot`].
    pub(super) fn new(robot: &'a Robot, limits: &'a ConstantLimits, task: Option<Task>) -> Result<Self> {
        let with_tool = task.map_or(Ok(None), |task| task.robot(robot))?;
        // The region may be left on the way: the ends are solved for once more.
        let criterion = task.map(|task| Criterion { region: None, ..task.criterion(Tolerance::default()) });
        Ok(Self {
            robot: with_tool.map_or(Cow::Borrowed(robot), Cow::Owned),
            limits,
            task,
            criterion: criterion.unwrap_or_default(),
        })
    }

    /// The part of a target that the task uses.
    fn part_used(&self, target: &Target) -> Option<Target> {
        self.task.map_or(Some(*target), |task| task.target(target).ok())
    }
}

/// Moves those ends of `pair` that are given by a target; returns the number of evaluations of the kinematics.
pub(super) fn shorten(freedom: &Freedom, free: [Option<&Target>; 2], pair: &mut EndPair) -> usize {
    let Freedom { robot, limits, criterion, .. } = freedom;
    let n = robot.dof();
    let used = |end: Option<&Target>| end.and_then(|target| freedom.part_used(target));
    let free_ends: Vec<(usize, Target)> = (0..2).filter_map(|i| Some((i, used(free[i])?))).collect();
    if free_ends.is_empty() {
        return 0;
    }
    let mut weights = vec![1.0 / n as f64; n];
    let mut linearizations = vec![TaskBlock::default(); free_ends.len()];
    for _ in 0..ROUNDS {
        for ((end, target), linearization) in free_ends.iter().zip(&mut linearizations) {
            let q = if *end == 0 { &pair.start } else { &pair.end };
            target.linearize(robot, q, criterion, linearization);
        }
        let displacement: Vec<f64> = pair.start.iter().zip(&pair.end).map(|(start, end)| end - start).collect();
        let duration = limits.quintic_duration(displacement.iter().copied());
        if duration == 0.0 {
            break;
        }
        let scales: Vec<f64> = (0..n).map(|j| 1.0 / limits.quintic_reach(j, duration).max(1e-9)).collect();
        let Some(step) = weighted_step(&displacement, &scales, &weights, &free_ends, &linearizations) else { break };
        for (block, (end, _)) in free_ends.iter().enumerate() {
            let q = if *end == 0 { &mut pair.start } else { &mut pair.end };
            apply(&step.as_slice()[block * n..(block + 1) * n], limits, q);
        }
        for j in 0..n {
            weights[j] *= ((pair.end[j] - pair.start[j]) * scales[j]).abs();
        }
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight = (*weight / sum).max(SMALLEST_WEIGHT));
    }
    ROUNDS * free_ends.len()
}

/// Returns the step of all free ends that minimises the sum of w (scale (displacement + step of the end - step of the
/// start))^2 while the residual of each target vanishes to first order: the system of Lagrange multipliers.
fn weighted_step(
    displacement: &[f64],
    scales: &[f64],
    weights: &[f64],
    free: &[(usize, Target)],
    linearizations: &[TaskBlock],
) -> Option<DVector<f64>> {
    let n = displacement.len();
    let unknowns = n * free.len();
    let rows: Vec<(usize, usize)> = (0..free.len()).flat_map(|a| (0..ROWS).map(move |row| (a, row))).collect();
    // Rows that no joint moves, e.g. z for an arm in the plane, constrain nothing.
    let constrains = |(a, row): &(usize, usize)| linearizations[*a].columns[..n].iter().any(|c| c[*row] != 0.0);
    let rows: Vec<(usize, usize)> = rows.into_iter().filter(constrains).collect();
    if rows.len() >= unknowns {
        return None; // nothing is free
    }
    let size = unknowns + rows.len();
    let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let sign = |end: usize| if end == 0 { -1.0 } else { 1.0 };
    let damping = DAMPING * (0..n).map(|j| weights[j] * scales[j] * scales[j]).sum::<f64>();
    for (a, (end_a, _)) in free.iter().enumerate() {
        for j in 0..n {
            let weight = weights[j] * scales[j] * scales[j];
            right[a * n + j] = -sign(*end_a) * weight * displacement[j];
            for (b, (end_b, _)) in free.iter().enumerate() {
                matrix[(a * n + j, b * n + j)] = sign(*end_a) * sign(*end_b) * weight;
            }
            matrix[(a * n + j, a * n + j)] += damping;
        }
    }
    for (index, (a, row)) in rows.into_iter().enumerate() {
        let index = unknowns + index;
        right[index] = -linearizations[a].residual[row];
        // In a singular configuration not all rows can be met.
        matrix[(index, index)] = -1e-9;
        for j in 0..n {
            let entry = linearizations[a].columns[j][row];
            matrix[(a * n + j, index)] = entry;
            matrix[(index, a * n + j)] = entry;
        }
    }
    let step = matrix.lu().solve(&right)?;
    step.iter().all(|x| x.is_finite()).then_some(step)
}

fn apply(step: &[f64], limits: &ConstantLimits, q: &mut Point) {
    let largest = step.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let fraction = if largest > LONGEST_STEP { LONGEST_STEP / largest } else { 1.0 };
    for (j, (q, step)) in q.iter_mut().zip(step).enumerate() {
        *q = (*q + fraction * step).clamp(limits.lower[j], limits.upper[j]);
    }
}
