//! Verification of candidates by forward kinematics: residuals, polishing where needed, removal of duplicates.

mod angles;
mod polish;
mod residuals;
mod stiffness;

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::branches::{BranchFit, Branches, Candidates};
use crate::closed_form::configurations::AxisColumns;
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, Baseline, by_instructions};
use residuals::FixedFrames;
pub use residuals::LANES;

/// Bound on the pose error of every branch (m, rad), implied by [`polish::TOLERANCE`] on each entry.
pub(crate) const VERIFIED: f64 = 3.0 * polish::TOLERANCE;

/// Residual (m, rad) above which a candidate is polished: near singular poses a residual within [`polish::TOLERANCE`] leaves
/// larger errors in the angles.
const GOOD: f64 = 1e-12;

/// Residual of a rejected candidate (m, rad) below which it is a near miss: twice the tolerances that count as narrow.
const NEARLY: f64 = 2e-5;

/// Largest joint difference (rad, m) between branches that count as one: a double root.
const SAME: f64 = 1e-6;

/// Chain prepared for checking candidates.
#[derive(Debug, Clone, Copy)]
pub struct Verifier<const N: usize> {
    chain: AxisChain<N>,
    frames: FixedFrames<N>,
    slides: [bool; N],
    /// Residual (m, rad) above which a candidate is not worth polishing.
    worth_polishing: f64,
}

impl<const N: usize> Verifier<N> {
    /// Prepares a chain for candidates whose error is at most `worth_polishing` (m, rad).
    pub fn new(chain: &AxisChain<N>, worth_polishing: f64) -> Self {
        let slides = std::array::from_fn(|k| chain.joints[k].motion == AxisKind::Slides);
        Self { chain: *chain, frames: FixedFrames::new(chain), slides, worth_polishing }
    }

    /// Adds the branch near a candidate, if there is one.
    pub fn add(&self, target: &Frame, candidate: &[Angle; N], found: &mut Branches<N>) {
        self.accept_polished(target, candidate.map(Angle::angle), found);
    }

    /// Adds the branch near joint values, if there is one.
    pub fn add_near(&self, target: &Frame, set: [f64; N], found: &mut Branches<N>) {
        self.accept_polished(target, set, found);
    }

    /// Returns the pose error (m, rad) of the tip at the joint values `set`.
    pub fn residual(&self, target: &Frame, set: &[f64; N]) -> f64 {
        residuals::difference(&self.chain.tip_at(set), target)
    }

    /// Returns the candidates that bring the tip to `target`, as joint values. [`verified`] is faster.
    pub fn verified(&self, target: &Frame, candidates: &Candidates) -> Branches<N> {
        self.branches_by::<Baseline>(target, candidates)
    }

    #[inline(always)]
    fn branches_by<A: Arithmetic>(&self, target: &Frame, candidates: &Candidates) -> Branches<N> {
        let mut found = Branches::none();
        (found.singular, found.doubt) = (candidates.singular, candidates.doubt);
        found.evaluations = candidates.count;
        let mut first = 0;
        while first < candidates.count {
            let residuals = residuals::residuals::<A, N>(&self.frames, &self.slides, target, candidates, first);
            let angles = angles::angles::<A, N, LANES>(&self.slides, candidates, first);
            for lane in 0..LANES.min(candidates.count - first) {
                let set = std::array::from_fn(|k| angles[k][lane]);
                self.accept(target, residuals.worst[lane], set, residuals.fit(lane), &mut found);
            }
            first += LANES;
        }
        if candidates.count == 0 {
            found.doubt.add_dead_end();
        }
        found
    }

    /// Writes the joint values of unverified candidates.
    #[inline(always)]
    fn write_values<A: Arithmetic>(&self, candidates: &Candidates, columns: &mut AxisColumns) {
        let mut first = 0;
        while first < candidates.count {
            let angles = angles::angles::<A, N, 4>(&self.slides, candidates, first);
            (0..N).for_each(|k| columns[k][first..first + 4].copy_from_slice(&angles[k]));
            first += 4;
        }
    }

    #[inline(always)]
    fn accept(&self, target: &Frame, residual: f64, set: [f64; N], fit: BranchFit, found: &mut Branches<N>) {
        if residual <= GOOD {
            push_new(set, fit, &self.slides, found);
        } else if residual <= self.worth_polishing {
            self.accept_polished(target, set, found);
        }
    }

    #[cold]
    fn accept_polished(&self, target: &Frame, set: [f64; N], found: &mut Branches<N>) {
        match polish::polished(&self.chain, target, set, &mut found.evaluations) {
            Ok((set, fit)) => push_new(set, fit, &self.slides, found),
            Err((residual, set)) if residual < NEARLY => found.push_near_miss(set),
            Err(_) => {}
        }
    }
}

by_instructions! {
    /// Writes the joint values of unverified candidates.
    pub fn write_values<const N: usize>(verifier: &Verifier<N>, candidates: &Candidates, columns: &mut AxisColumns) {
        verifier.write_values::<A>(candidates, columns);
    }
}

by_instructions! {
    /// Returns the candidates that bring the tip to `target`, as joint values.
    pub fn verified<const N: usize>(verifier: &Verifier<N>, target: &Frame, candidates: &Candidates) -> Branches<N> {
        verifier.branches_by::<A>(target, candidates)
    }
}

/// Adds a branch unless it is listed already.
#[inline(always)]
fn push_new<const N: usize>(set: [f64; N], fit: BranchFit, slides: &[bool; N], found: &mut Branches<N>) {
    let near = |a: f64, b: f64, slides: bool| {
        let apart = (a - b).abs();
        apart < SAME || !slides && std::f64::consts::TAU - apart < SAME
    };
    if !found.iter().any(|other| (0..N).all(|k| near(other[k], set[k], slides[k]))) {
        found.push(set, fit);
    }
}
