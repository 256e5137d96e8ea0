//! All solution branches of an arm for one pose.

use crate::closed_form::branches::{BranchError, Branches, Doubt, MOST, MOST_JOINTS};
use crate::closed_form::configurations::{ArmConfigurations, Drives};

/// Configurations of an arm for one pose, verified by forward kinematics; each is listed at one of its whole turns.
#[derive(Debug, Clone)]
pub(crate) struct ArmBranches {
    sets: [[f64; MOST_JOINTS]; MOST],
    count: usize,
    joints: usize,
    errors: [BranchError; MOST],
    /// True if a rejected configuration was near a solution: the pose may be reachable within wide tolerances.
    pub near_miss: bool,
    /// Doubt about missing branches; for a redundant arm, about further ones at this value of the parameter.
    pub doubt: Doubt,
    /// True if at least one configuration represents a family with a free joint.
    pub singular: bool,
    /// Number of forward kinematics evaluations.
    pub evaluations: usize,
}

impl ArmBranches {
    /// Converts axis values to joint values.
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
        let Branches { near_miss, doubt, singular, evaluations, .. } = *branches;
        Self { sets, count, joints, errors, near_miss, doubt, singular, evaluations }
    }

    /// Returns the number of configurations.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Iterates over the configurations (n,) (rad, m) and their pose errors.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], BranchError)> {
        self.sets[..self.count].iter().map(|set| &set[..self.joints]).zip(self.errors)
    }

    /// Returns the configurations without their errors.
    pub fn configurations(&self) -> ArmConfigurations {
        ArmConfigurations::of_sets(&self.sets[..self.count], self.joints)
    }
}
