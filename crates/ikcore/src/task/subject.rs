//! Subject of a target: a tip, a pair of tips, or the centre of mass.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::robot::Robot;

/// Frame that a target refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Subject {
    /// Tip of this number.
    Tip(usize),
    /// Tip `of`, relative to tip `from`.
    Pair {
        /// Number of the reference tip.
        from: usize,
        /// Number of the moving tip.
        of: usize,
    },
    /// Centre of all masses, in the axes of the base.
    CenterOfMass,
}

impl Subject {
    /// Whether the subject is a pair of tips.
    pub(crate) fn is_pair(&self) -> bool {
        matches!(self, Self::Pair { .. })
    }

    /// The centre of mass of `robot`.
    ///
    /// # Errors
    /// [`Error::NoDynamics`]; [`Error::Contradiction`] for a robot with one tip.
    pub fn center_of_mass(robot: &Robot) -> Result<Self> {
        if robot.tip_count() == 1 {
            let problem =
                format!("the centre of mass is a task beside those of several tips; robot '{}' has one", robot.name());
            return Err(Error::Contradiction { problem: problem.into() });
        }
        robot.dynamics().map(|_| Self::CenterOfMass)
    }

    /// The subject in words, by the names of the tips.
    pub(crate) fn in_words(self, tips: &[&str]) -> String {
        match self {
            Self::Tip(tip) => format!("'{}'", tips[tip]),
            Self::Pair { from, of } => format!("('{}', '{}')", tips[from], tips[of]),
            Self::CenterOfMass => "the centre of mass".into(),
        }
    }
}
