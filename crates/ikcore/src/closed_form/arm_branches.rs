//! All solution branches of an arm for one pose.

use crate::closed_form::branches::{BranchFit, Branches, Doubt, MOST, MOST_JOINTS};
use crate::closed_form::configurations::{ArmConfigurations, Drives};

/// Configurations of an arm for one pose, verified by forward kinematics; each is listed at one of its whole turns. Also those
/// that miss it by little.
#[derive(Debug, Clone)]
pub(crate) struct ArmBranches {
    /// Branches, then near misses.
    sets: [[f64; MOST_JOINTS]; MOST],
    count: usize,
    misses: usize,
    joints: usize,
    errors: [BranchFit; MOST],
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
        let (count, misses, joints) = (branches.len(), branches.near_misses().len(), drives.len());
        let mut sets = [[0.0; MOST_JOINTS]; MOST];
        for (set, values) in sets.iter_mut().zip(branches.iter().chain(branches.near_misses())) {
            set[..N].copy_from_slice(values);
            drives.joints_of(set);
        }
        let mut errors = [BranchFit::default(); MOST];
        errors[..count].copy_from_slice(branches.errors());
        let Branches { doubt, singular, evaluations, .. } = *branches;
        Self { sets, count, misses, joints, errors, doubt, singular, evaluations }
    }

    /// Returns the number of configurations.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Iterates over the configurations (n,) (rad, m) and their pose errors.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], BranchFit)> {
        self.sets[..self.count].iter().map(|set| &set[..self.joints]).zip(self.errors)
    }

    /// Iterates over configurations (n,) (rad, m) that miss the pose by so little that a caller's tolerances may admit them or
    /// others beside them.
    pub fn near_misses(&self) -> impl Iterator<Item = &[f64]> {
        self.sets[self.count..self.count + self.misses].iter().map(|set| &set[..self.joints])
    }

    /// Returns the configurations without their errors.
    pub fn configurations(&self) -> ArmConfigurations {
        ArmConfigurations::of_sets(&self.sets[..self.count], self.joints)
    }
}
