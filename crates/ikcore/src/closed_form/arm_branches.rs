//! All branches of an arm for one pose.

use crate::closed_form::branches::{BranchError, Branches, MOST};
use crate::closed_form::configurations::{ArmConfigurations, Drives};

/// ArmConfigurations of an arm for one pose, each at one of its whole turns, and verified by forward kinematics.
#[derive(Debug, Clone)]
pub(crate) struct ArmBranches {
    configurations: ArmConfigurations,
    errors: [BranchError; MOST],
    /// A configuration that was no solution was near one: the pose may be reached within wide tolerances.
    pub nearly: bool,
    /// No configuration is missing; for a redundant arm, none at this value of the parameter.
    pub complete: bool,
    /// One configuration at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
}

impl ArmBranches {
    /// From the values of the axes.
    #[inline]
    pub fn of<const N: usize>(branches: &Branches<N>, drives: &Drives) -> Self {
        let configurations = ArmConfigurations::new(drives, branches.len(), |sets| {
            for (set, values) in sets.iter_mut().zip(branches.iter()) {
                set[..N].copy_from_slice(values);
            }
        });
        let mut errors = [BranchError::default(); MOST];
        errors[..branches.len()].copy_from_slice(branches.errors());
        let Branches { nearly, complete, singular, evaluations, .. } = *branches;
        Self { configurations, errors, nearly, complete, singular, evaluations }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.configurations.len()
    }

    /// The configurations (n,) (rad, m), and by how much they miss the pose.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], BranchError)> {
        self.configurations.iter().zip(self.errors)
    }

    /// The configurations alone.
    pub fn into_configurations(self) -> ArmConfigurations {
        self.configurations
    }
}
