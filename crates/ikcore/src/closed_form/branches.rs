//! Results of a closed form: candidates as cosines and sines, then verified branches as joint values.

use crate::closed_form::angle::Angle;

/// Largest number of branches of one pose: sixteen for six joints (Raghavan and Roth 1990).
pub const MOST: usize = 16;

/// Largest number of joints that a closed form handles.
pub const MOST_JOINTS: usize = 7;

/// Doubt about whether a pose, or any pose within a caller's tolerances, has further branches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Doubt {
    /// No further branches exist.
    #[default]
    None,
    /// Branches nearly coincide or nearly form a family; forward kinematics near them decides.
    Nearby,
    /// Further branches may exist anywhere.
    Anywhere,
}

impl Doubt {
    /// Keeps the larger of two doubts.
    #[inline(always)]
    pub fn add(&mut self, other: Self) {
        *self = (*self).max(other);
    }

    /// Records that roots led to no branch: roots in doubt may have been too inexact.
    #[inline(always)]
    pub fn add_dead_end(&mut self) {
        if *self == Self::Nearby {
            *self = Self::Anywhere;
        }
    }
}

/// Unverified branches of an arm of up to seven joints, stored by columns: each joint holds the values of all candidates.
#[derive(Debug, Clone, Copy)]
pub struct Candidates {
    /// Cosines; 1 for a prismatic joint.
    pub cos: [[f64; MOST]; MOST_JOINTS],
    /// Sines; the displacement (m) for a prismatic joint.
    pub sin: [[f64; MOST]; MOST_JOINTS],
    /// Number of candidates.
    pub count: usize,
    /// True if at least one candidate represents a family with a free joint.
    pub singular: bool,
    /// Doubt about further candidates.
    pub doubt: Doubt,
    /// Fixed joint, added to each candidate of six joints.
    fixed: Option<FixedJoint>,
}

/// Fixed joint of a seven-joint arm, and its angle.
#[derive(Debug, Clone, Copy)]
pub enum FixedJoint {
    /// First of seven joints.
    First(Angle),
    /// Last of seven joints.
    Last(Angle),
}

impl Candidates {
    /// Creates an empty set.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            cos: [[1.0; MOST]; MOST_JOINTS],
            sin: [[0.0; MOST]; MOST_JOINTS],
            count: 0,
            singular: false,
            doubt: Doubt::None,
            fixed: None,
        }
    }

    /// Removes the first `count` candidates.
    pub fn remove_first(&mut self, count: usize) {
        for row in self.cos.iter_mut().chain(&mut self.sin) {
            row.copy_within(count..self.count, 0);
        }
        self.count -= count;
    }

    /// Fixes the first or the last joint for the six-joint candidates added from now on.
    pub fn fix_joint(&mut self, joint: FixedJoint) {
        self.fixed = Some(joint);
    }

    /// Adds a candidate of six joints, and of the fixed joint if there is one; ignored when full.
    #[inline(always)]
    pub fn push_six(&mut self, turns: &[Angle; 6]) {
        let [a, b, c, d, e, f] = *turns;
        match self.fixed {
            None => self.push(turns),
            Some(FixedJoint::First(first)) => self.push(&[first, a, b, c, d, e, f]),
            Some(FixedJoint::Last(last)) => self.push(&[a, b, c, d, e, f, last]),
        }
    }

    /// Adds a candidate of all joints; ignored when full.
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

/// Errors of a configuration at a pose, by forward kinematics, and its stiffness there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct BranchFit {
    /// Position error (m).
    pub position: f64,
    /// Rotation error (rad).
    pub rotation: f64,
    /// Lower bound on the change of the pose (m, rad) per unit of motion of the axes; 0 for redundant arms.
    pub stiffness: f64,
}

/// Branches found for one pose, each verified by forward kinematics, and configurations that miss it by little.
#[derive(Debug, Clone, Copy)]
pub struct Branches<const N: usize> {
    /// Branches from the front, near misses from the back.
    sets: [[f64; N]; MOST],
    errors: [BranchFit; MOST],
    count: usize,
    misses: usize,
    /// Number of forward kinematics evaluations used by verification.
    pub evaluations: usize,
    /// Doubt about further branches.
    pub doubt: Doubt,
    /// True if at least one branch represents a family with a free joint: aligned wrist or shoulder.
    pub singular: bool,
}

impl<const N: usize> Branches<N> {
    /// Returns an empty set that proves nothing.
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            sets: [[0.0; N]; MOST],
            errors: [BranchFit::default(); MOST],
            count: 0,
            misses: 0,
            evaluations: 0,
            doubt: Doubt::Anywhere,
            singular: false,
        }
    }

    /// Adds a branch; ignored when full.
    #[inline(always)]
    pub(crate) fn push(&mut self, set: [f64; N], error: BranchFit) {
        if self.count < MOST {
            self.sets[self.count] = set;
            self.errors[self.count] = error;
            self.count += 1;
            self.misses = self.misses.min(MOST - self.count);
        }
    }

    /// Adds a configuration that misses the pose by so little that a caller's tolerances may admit it or one beside it;
    /// ignored when full.
    #[cold]
    pub(crate) fn push_near_miss(&mut self, set: [f64; N]) {
        if self.count + self.misses < MOST {
            self.misses += 1;
            self.sets[MOST - self.misses] = set;
        }
    }

    /// Returns the configurations that miss the pose by little.
    #[inline(always)]
    pub(crate) fn near_misses(&self) -> &[[f64; N]] {
        &self.sets[MOST - self.misses..]
    }

    /// Returns the pose error of each branch.
    #[inline(always)]
    pub(crate) fn errors(&self) -> &[BranchFit] {
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
