//! Candidate postures at the points of a path.

use super::passage::Passage;
use super::price::Price;
use super::sequence::LayerPosture;
use crate::along_path::timed::PathProblem;
use crate::along_path::tip_path::TipPath;
use crate::error::Result;
use crate::ik::{AllOptions, SolveOptions, solve_all};
use crate::interrupt::checkpoint;
use crate::objective::Point;
use crate::rng;
use crate::solver::Unattended;
use crate::task::Target;

/// Distance between layers along the path (m, rad).
const SPACING: f64 = 0.03;
/// Minimum and maximum number of intervals between layers.
const INTERVALS: [f64; 2] = [50.0, 400.0];

/// Number of segments from which on a path gets layers at its points alone: it is straight between them, unlike the
/// curve that they sample.
const SEGMENTS: usize = 25;

/// Postures of a layer, as in [`LayerSampling::density`]: more where fewer do not suffice.
pub(super) const DENSITIES: [usize; 2] = [32, 128];

/// Starts tried for each motion along the path.
const TRIES: usize = 4;

/// Path parameters of the layers, and their density of postures.
#[derive(Debug)]
pub(super) struct LayerSampling<'a> {
    /// Path parameters of the layers.
    pub fractions: &'a [f64],
    /// Samples of the redundancy of an arm with a closed form; other arms take four times as many random starts.
    pub density: usize,
}

/// Returns the number of intervals between layers.
pub(super) fn intervals(tip_path: &TipPath) -> usize {
    let wanted = (tip_path.length() / SPACING).clamp(INTERVALS[0], INTERVALS[1]) as usize;
    let segments = tip_path.positions().len() - 1;
    if segments < SEGMENTS { wanted } else { wanted.min(segments) }
}

/// The clear postures of each layer.
pub(super) fn clear_layers(
    passage: &Passage<'_>,
    fractions: &[f64],
    postures: &[Vec<Point>],
) -> Result<Vec<Vec<LayerPosture>>> {
    let clear = |(fraction, postures): (&f64, &Vec<Point>)| -> Result<Vec<LayerPosture>> {
        checkpoint()?;
        let clear = postures.iter().filter(|q| passage.is_clear(*fraction, q));
        Ok(clear.map(|q| LayerPosture { q: q.clone(), penalty: 0.0 }).collect())
    };
    fractions.iter().zip(postures).map(clear).collect()
}

/// Returns the postures of each layer, clear or not.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub(super) fn postures(
    passage: &mut Passage<'_>,
    price: &Price,
    sampling: &LayerSampling<'_>,
) -> Result<Vec<Vec<Point>>> {
    let mut layers = vec![vec![]; sampling.fractions.len()];
    if has_closed_form(passage) {
        layers = by_branches(passage, sampling)?;
    }
    if !(has_closed_form(passage) && passage.problem.tip_path.fixes_pose()) {
        by_following(passage, price, sampling, &mut layers)?;
    }
    if let Some(start) = &passage.problem.options.start {
        layers[0] = vec![Point::from_slice(start)];
    }
    Ok(layers)
}

/// Whether the postures at this path parameter are all that exist, whole turns aside.
pub(super) fn are_all(passage: &Passage<'_>, fraction: f64) -> bool {
    let PathProblem { robot, tip_path, .. } = passage.problem;
    let found = || solve_all(robot, &tip_path.target(fraction), &AllOptions::default(), &mut Unattended);
    tip_path.fixes_pose() && has_closed_form(passage) && found().is_ok_and(|found| found.complete)
}

fn has_closed_form(passage: &Passage<'_>) -> bool {
    let PathProblem { robot, tip_path, .. } = passage.problem;
    matches!(tip_path.target(0.0), Target::Pose(_)) && robot.solves_at_once() == Some(true)
}

/// Returns all branches; of a redundant arm the branches at many values of its parameter.
fn by_branches(passage: &Passage<'_>, sampling: &LayerSampling<'_>) -> Result<Vec<Vec<Point>>> {
    let (robot, tip_path) = (&passage.problem.robot, passage.problem.tip_path);
    let each = SolveOptions { seed: passage.problem.options.seed, ..SolveOptions::default() };
    let options = AllOptions { each, redundancy: sampling.density, ..AllOptions::default() };
    let at = |fraction: &f64| {
        checkpoint()?;
        let found = solve_all(robot, &tip_path.target(*fraction), &options, &mut Unattended)?;
        Ok(found.solutions.iter().map(|solution| Point::from_slice(solution.q)).collect())
    };
    sampling.fractions.iter().map(at).collect()
}

/// Follows the path from random configurations at random points of it, to both sides, as far as each motion leads.
fn by_following(
    passage: &mut Passage<'_>,
    price: &Price,
    sampling: &LayerSampling<'_>,
    layers: &mut [Vec<Point>],
) -> Result<()> {
    let fractions = sampling.fractions;
    let motions = 4 * sampling.density;
    for motion in 0..motions {
        checkpoint()?;
        let mut rng = rng::stream(passage.problem.options.seed, motion as u64 + 1);
        let begin = motion * fractions.len() / motions;
        let starts = passage.problem.robot.random_configurations(TRIES, &mut rng)?;
        let starts = starts.chunks_exact(passage.problem.robot.dof());
        let Some(first) = starts.into_iter().find_map(|start| passage.on_path(fractions[begin], start)) else {
            continue;
        };
        layers[begin].push(first.clone());
        follow(passage, price, fractions, (begin + 1..fractions.len()).zip(begin..), &first, layers);
        follow(passage, price, fractions, (0..begin).rev().zip((0..=begin).rev()), &first, layers);
    }
    Ok(())
}

/// Follows the path from the posture `q` through `steps`, pairs of a layer and the one before, until that takes a jump.
fn follow(
    passage: &mut Passage<'_>,
    price: &Price,
    fractions: &[f64],
    steps: impl Iterator<Item = (usize, usize)>,
    q: &Point,
    layers: &mut [Vec<Point>],
) {
    let mut here = q.clone();
    for (layer, before) in steps {
        let Some(next) = passage.on_path(fractions[layer], &here) else { return };
        if price.of_step(&here, &next, (fractions[layer] - fractions[before]).abs()).is_infinite() {
            return;
        }
        layers[layer].push(next.clone());
        here = next;
    }
}
