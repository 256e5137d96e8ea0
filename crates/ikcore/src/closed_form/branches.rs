//! What a closed form hands over: candidates as cosines and sines side by side, then verified branches as joint values.

use crate::closed_form::angle::Angle;

/// Most branches of one pose: sixteen for six joints (Raghavan and Roth 1990).
pub const MOST: usize = 16;

/// Most joints that a closed form has.
pub const MOST_JOINTS: usize = 7;

/// How sure it is that a pose has no branches beside those found, and neither have poses within the tolerances of a caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Doubt {
    /// For certain.
    #[default]
    None,
    /// Branches nearly coincide, or nearly make a family: forward kinematics beside them decides.
    Beside,
    /// Others may exist anywhere.
    Open,
}

impl Doubt {
    /// Adds another doubt.
    #[inline(always)]
    pub fn add(&mut self, other: Self) {
        *self = (*self).max(other);
    }

    /// Notes that roots have led to no branch, though perhaps only just: if they are in doubt, they may only have been inexact.
    #[inline(always)]
    pub fn add_dead_end(&mut self) {
        if *self == Self::Beside {
            *self = Self::Open;
        }
    }
}

/// Unverified branches of an arm of up to seven joints, each number for all of them side by side.
#[derive(Debug, Clone, Copy)]
pub struct Candidates {
    /// Cosines; of a joint that slides, 1.
    pub cos: [[f64; MOST]; MOST_JOINTS],
    /// Sines; of a joint that slides, the displacement (m).
    pub sin: [[f64; MOST]; MOST_JOINTS],
    /// How many there are.
    pub count: usize,
    /// One candidate at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// Whether there may be others.
    pub doubt: Doubt,
    /// Beside the six joints that a method solves.
    given: Option<Given>,
}

/// The turn of a joint beside six.
#[derive(Debug, Clone, Copy)]
pub enum Given {
    /// Of the first of seven joints.
    First(Angle),
    /// Of the last.
    Last(Angle),
}

impl Candidates {
    /// None yet.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            cos: [[1.0; MOST]; MOST_JOINTS],
            sin: [[0.0; MOST]; MOST_JOINTS],
            count: 0,
            singular: false,
            doubt: Doubt::None,
            given: None,
        }
    }

    /// Removes the first `count`.
    pub fn remove_first(&mut self, count: usize) {
        for row in self.cos.iter_mut().chain(&mut self.sin) {
            row.copy_within(count..self.count, 0);
        }
        self.count -= count;
    }

    /// Sets the turn of the first or the last joint beside the six of those that follow.
    pub fn give(&mut self, given: Given) {
        self.given = Some(given);
    }

    /// Adds one of six joints, beside the given one if there is one; ignored when full.
    #[inline(always)]
    pub fn push_six(&mut self, turns: &[Angle; 6]) {
        let [a, b, c, d, e, f] = *turns;
        match self.given {
            None => self.push(turns),
            Some(Given::First(first)) => self.push(&[first, a, b, c, d, e, f]),
            Some(Given::Last(last)) => self.push(&[a, b, c, d, e, f, last]),
        }
    }

    /// Adds one of all joints; ignored when full.
    #[inline(always)]
    pub fn push<const N: usize>(&mut self, turns: &[Angle; N]) {
        if self.count < MOST {
            for k in 0..N {
                self.write(k, turns[k]);
            }
            self.count += 1;
        }
    }

    #[inline(always)]
    fn write(&mut self, joint: usize, turn: Angle) {
        self.cos[joint][self.count] = turn.cos;
        self.sin[joint][self.count] = turn.sin;
    }
}

impl Default for Candidates {
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
    /// Whether there may be others.
    pub doubt: Doubt,
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
            doubt: Doubt::Open,
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
