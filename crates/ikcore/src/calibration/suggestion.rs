//! Further configurations that would tell most: D-optimal by exchange (Fedorov 1972), the determinant of the covariance becomes least.

use nalgebra::{DMatrix, Vector3};

use super::arm_model::Marks;
use super::camera::PinholeCamera;
use super::estimate::Estimate;
use super::measured::{CameraPlace, Measured};
use super::residual::{Block, Comparison, ResidualScratch};
use crate::error::{Error, Result};
use crate::interrupt::checkpoint;
use crate::math::Pose;
use crate::obstacle::Surroundings;
use crate::rng::stream;
use crate::robot::Robot;

/// Number of configurations to choose from.
const CANDIDATES: usize = 300;
/// Maximum number of draws for each of them.
const DRAWS: usize = 30;
/// Largest number of suggestions.
const MOST: usize = 100;
/// Passes of the exchange.
const PASSES: usize = 8;
/// Gain (of the logarithm of the determinant) that counts as none.
const NO_GAIN: f64 = 1e-9;

/// Number of configurations to suggest, and their surroundings.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SuggestionOptions {
    /// Number of suggestions.
    pub count: usize,
    /// Obstacles to keep clear of.
    pub surroundings: Surroundings,
    /// Seed of the candidates.
    pub seed: u64,
}

impl SuggestionOptions {
    pub(super) fn check(&self, robot: &Robot) -> Result<()> {
        if self.count > MOST {
            let most = format!("at most {MOST}");
            return Err(Error::out_of_range("number of suggested configurations", most, self.count as f64));
        }
        self.surroundings.clear_space(robot).map(|_| ())
    }
}

/// A configuration to choose, or a pair.
struct Candidate {
    q: Vec<f64>,
    /// Its whitened Jacobian A.
    jacobian: DMatrix<f64>,
    /// A C, with C the covariance of what was measured and chosen so far.
    informed: DMatrix<f64>,
}

impl Candidate {
    /// A C A'.
    fn predicted(&self) -> DMatrix<f64> {
        &self.informed * self.jacobian.transpose()
    }

    /// Logarithm of the factor by which measuring it lowers the determinant of the covariance.
    fn gain(&self) -> f64 {
        let rows = self.jacobian.nrows();
        let factor = (DMatrix::identity(rows, rows) + self.predicted()).cholesky();
        factor.map_or(0.0, |factor| 2.0 * factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum::<f64>())
    }
}

/// Chooses configurations for the calibrated `robot`, as rows of joint angles.
pub(super) fn suggested(
    robot: &Robot,
    comparison: &Comparison<'_>,
    estimate: &Estimate,
    sigma: [f64; 2],
    scales: &[f64],
    covariance: &DMatrix<f64>,
    options: &SuggestionOptions,
) -> Result<Vec<f64>> {
    if options.count == 0 {
        return Ok(vec![]);
    }
    let qs = drawn(robot, comparison, estimate, options)?;
    let each = comparison.dof * comparison.measured.configurations();
    let kind = comparison.measured.like(qs.len() / each);
    let there = Comparison { model: comparison.model, measured: &kind, qs: &qs, dof: comparison.dof };
    let (mut scratch, mut block) = (ResidualScratch::default(), Block::default());
    let mut candidates: Vec<Candidate> = (0..kind.count())
        .map(|index| {
            there.write(index, estimate, &mut scratch, &mut block);
            block.whiten(sigma, kind.has_rotations(), scales);
            let jacobian = DMatrix::from_row_slice(block.residual.len(), scales.len(), &block.jacobian);
            let informed = &jacobian * covariance;
            Candidate { q: qs[index * each..][..each].to_vec(), jacobian, informed }
        })
        .collect();
    if candidates.is_empty() {
        return Ok(vec![]);
    }
    let chosen = exchanged(&mut candidates, options.count)?;
    Ok(chosen.into_iter().flat_map(|index| candidates[index].q.clone()).collect())
}

/// Chooses one after another, then exchanges each for a better one until none is.
fn exchanged(candidates: &mut [Candidate], count: usize) -> Result<Vec<usize>> {
    let mut chosen = Vec::with_capacity(count);
    for _ in 0..count.min(candidates.len()) {
        checkpoint()?;
        let best = best_of(candidates, &chosen);
        include(candidates, best, 1.0);
        chosen.push(best);
    }
    for _ in 0..PASSES {
        let mut changed = false;
        for slot in 0..chosen.len() {
            checkpoint()?;
            let old = chosen[slot];
            include(candidates, old, -1.0);
            let others: Vec<usize> = chosen.iter().copied().filter(|index| *index != old).collect();
            let best = best_of(candidates, &others);
            let new = if candidates[best].gain() > candidates[old].gain() + NO_GAIN { best } else { old };
            include(candidates, new, 1.0);
            changed |= new != old;
            chosen[slot] = new;
        }
        if !changed {
            break;
        }
    }
    Ok(chosen)
}

fn best_of(candidates: &[Candidate], taken: &[usize]) -> usize {
    let free = (0..candidates.len()).filter(|index| !taken.contains(index));
    free.map(|index| (candidates[index].gain(), index)).max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, index)| index)
}

/// Measures a candidate (`sign` 1) or takes it back (-1): C changes by -sign C A' (I + sign A C A')^-1 A C.
fn include(candidates: &mut [Candidate], index: usize, sign: f64) {
    let rows = candidates[index].jacobian.nrows();
    let system = DMatrix::identity(rows, rows) + sign * candidates[index].predicted();
    let Some(gained) = system.lu().solve(&candidates[index].informed) else { return };
    let across = candidates[index].jacobian.transpose();
    for candidate in candidates {
        let change = sign * (&candidate.informed * &across) * &gained;
        candidate.informed -= change;
    }
}

/// Draws configurations inside the limits that are clear of obstacles and in view: half of them anywhere, half on the way from a measured
/// one to anywhere.
fn drawn(
    robot: &Robot,
    comparison: &Comparison<'_>,
    estimate: &Estimate,
    options: &SuggestionOptions,
) -> Result<Vec<f64>> {
    let n = robot.dof();
    let space = options.surroundings.clear_space(robot)?;
    let mut rng = stream(options.seed, 1);
    let anywhere = robot.random_configurations(CANDIDATES * DRAWS, &mut rng)?;
    let measured: Vec<&[f64]> = comparison.qs.chunks(n).collect();
    let mut marks = Marks::default();
    let mut found = vec![];
    let wanted = CANDIDATES * comparison.measured.configurations() * n;
    for (draw, to) in anywhere.chunks(n).enumerate() {
        if found.len() == wanted {
            break;
        }
        checkpoint()?;
        let from = measured[draw % measured.len()];
        let part = if draw % 2 == 0 { 1.0 } else { 0.5 * rng.uniform() };
        let q: Vec<f64> = (0..n)
            .map(|j| {
                let joint = &robot.joints()[j];
                (from[j] + part * (to[j] - from[j])).max(joint.lower).min(joint.upper)
            })
            .collect();
        let is_clear = space.as_ref().is_none_or(|space| space.holds(&q));
        if is_clear && comparison.measured.shows(&comparison.model.tip(estimate, &q, &mut marks)) {
            found.extend(q);
        }
    }
    found.truncate(found.len() / (n * comparison.measured.configurations()) * n * comparison.measured.configurations());
    Ok(found)
}

impl Measured {
    /// Whether the camera sees the board when the arm's end is at `tip`.
    fn shows(&self, tip: &Pose) -> bool {
        let seen = |camera: &CameraPlace| if *camera == CameraPlace::Hand { tip.inverse() } else { *tip };
        match self {
            Self::BoardPoses { camera, .. } => seen(camera).translation.vector.z > 0.0,
            Self::Pixels { board, lens, camera, .. } => sees_all(lens, &seen(camera), board),
            _ => true,
        }
    }
}

fn sees_all(lens: &PinholeCamera, pose: &Pose, board: &[[f64; 3]]) -> bool {
    board.iter().all(|point| lens.sees(&(pose.rotation * Vector3::from(*point) + pose.translation.vector)))
}
