//! All branches of an arm for one pose.

use crate::closed_form::branches::{BranchError, Branches, Doubt, MOST, MOST_JOINTS};
use crate::closed_form::configurations::{ArmConfigurations, Drives};

/// Configurations of an arm for one pose, each at one of its whole turns, and verified by forward kinematics.
#[derive(Debug, Clone)]
pub(crate) struct ArmBranches {
    sets: [[f64; MOST_JOINTS]; MOST],
    count: usize,
    joints: usize,
    errors: [BranchError; MOST],
    /// A configuration that was no solution was near one: the pose may be reached within wide tolerances.
    pub nearly: bool,
    /// Whether others may be missing; for a redundant arm, others at this value of the parameter.
    pub doubt: Doubt,
    /// One configuration at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
}

impl ArmBranches {
    /// From the values of the axes.
    #[inline]
    pub fn of<const N: usize>(branches: &Branches<N>, drives: &Drives) -> Self {
        let (count, joints) = (branches.len(), drives.len());
        let mut sets = [[0.0; MOST_JOINTS]; MOST];
        for (set, values) in sets.iter_mut().zip(branches.iter()) {
            set[..N].copy_from_slice(values);
            drives.joints_of(set);
        }
        let mut errors = [BranchError::default(); MOST];
        errors[..count].copy_from_slice(branches.errors());
        let Branches { nearly, doubt, singular, evaluations, .. } = *branches;
        Self { sets, count, joints, errors, nearly, doubt, singular, evaluations }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The configurations (n,) (rad, m), and by how much they miss the pose.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], BranchError)> {
        self.sets[..self.count].iter().map(|set| &set[..self.joints]).zip(self.errors)
    }

    /// The configurations alone.
    pub fn configurations(&self) -> ArmConfigurations {
        ArmConfigurations::of_sets(&self.sets[..self.count], self.joints)
    }
}
