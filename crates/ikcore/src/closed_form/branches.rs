//! What a closed form hands over: candidates as cosines and sines side by side, then verified branches as joint values.

use crate::closed_form::angle::Angle;

/// Most branches of one pose: sixteen for six joints (Raghavan and Roth 1990).
pub const MOST: usize = 16;

/// Unverified branches, each number for all of them side by side.
#[derive(Debug, Clone, Copy)]
pub struct Candidates<const N: usize> {
    /// Cosines; of a joint that slides, 1.
    pub cos: [[f64; MOST]; N],
    /// Sines; of a joint that slides, the displacement (m).
    pub sin: [[f64; MOST]; N],
    /// How many there are.
    pub count: usize,
    /// One candidate at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// The method cannot tell whether there are others.
    pub unsettled: bool,
}

impl<const N: usize> Candidates<N> {
    /// None yet.
    #[inline(always)]
    pub fn new() -> Self {
        Self { cos: [[1.0; MOST]; N], sin: [[0.0; MOST]; N], count: 0, singular: false, unsettled: false }
    }

    /// Removes the first `count`.
    pub fn remove_first(&mut self, count: usize) {
        for row in self.cos.iter_mut().chain(&mut self.sin) {
            row.copy_within(count..self.count, 0);
        }
        self.count -= count;
    }

    /// Adds one; ignored when full.
    #[inline(always)]
    pub fn push(&mut self, turns: &[Angle; N]) {
        if self.count < MOST {
            for k in 0..N {
                self.cos[k][self.count] = turns[k].cos;
                self.sin[k][self.count] = turns[k].sin;
            }
            self.count += 1;
        }
    }
}

impl Candidates<7> {
    /// Adds those of six joints, with the turn of one more at place `joint`; as many as there is room for.
    pub fn add_with(&mut self, six: &Candidates<6>, joint: usize, turn: Angle) {
        let count = six.count.min(MOST - self.count);
        let places = self.count..self.count + count;
        for k in 0..7 {
            let (cos, sin) = (&mut self.cos[k][places.clone()], &mut self.sin[k][places.clone()]);
            if k == joint {
                cos.fill(turn.cos);
                sin.fill(turn.sin);
            } else {
                let k = if k < joint { k } else { k - 1 };
                cos.copy_from_slice(&six.cos[k][..count]);
                sin.copy_from_slice(&six.sin[k][..count]);
            }
        }
        self.count += count;
        self.singular |= six.singular;
        self.unsettled |= six.unsettled;
    }
}

impl<const N: usize> Default for Candidates<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// By how much a configuration misses its pose, by forward kinematics.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct BranchError {
    /// Distance (m).
    pub position: f64,
    /// Angle (rad).
    pub rotation: f64,
}

/// All branches found for one pose, each verified by forward kinematics.
#[derive(Debug, Clone, Copy)]
pub struct Branches<const N: usize> {
    sets: [[f64; N]; MOST],
    errors: [BranchError; MOST],
    count: usize,
    /// A candidate was near the pose, but no branch: the tolerances of a caller may be wide enough for it.
    pub nearly: bool,
    /// Evaluations of the forward kinematics that verification took.
    pub evaluations: usize,
    /// The method proves that there are no others.
    pub complete: bool,
    /// One branch at least stands for a family, in which a joint is free: aligned wrist or shoulder.
    pub singular: bool,
}

impl<const N: usize> Branches<N> {
    /// No branch, and nothing proven.
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            sets: [[0.0; N]; MOST],
            errors: [BranchError::default(); MOST],
            count: 0,
            nearly: false,
            evaluations: 0,
            complete: false,
            singular: false,
        }
    }

    /// Adds one; ignored when full.
    #[inline(always)]
    pub(crate) fn push(&mut self, set: [f64; N], error: BranchError) {
        if self.count < MOST {
            self.sets[self.count] = set;
            self.errors[self.count] = error;
            self.count += 1;
        }
    }

    /// The error of each.
    #[inline(always)]
    pub(crate) fn errors(&self) -> &[BranchError] {
        &self.errors[..self.count]
    }
}

impl<const N: usize> std::ops::Deref for Branches<N> {
    type Target = [[f64; N]];

    #[inline(always)]
    fn deref(&self) -> &[[f64; N]] {
        &self.sets[..self.count]
    }
}
