//! Options of TPBSO.

use super::planar_arm::Elbow;
use crate::error::{Error, Result};
use crate::solver::{AnySolver, DerivativeFree};

/// Trajectory planning by beetle swarm optimisation (Wang et al. 2019). The defaults are the published settings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tpbso {
    /// Elbow of a planar arm at the start and at the end. Given joint angles determine their own; along a path both
    /// must be the same.
    pub elbows: [Elbow; 2],
    /// The solver. `None` means the published beetle swarm.
    pub solver: Option<AnySolver<DerivativeFree>>,
}

impl Tpbso {
    /// The elbow of the arm along a path.
    ///
    /// # Errors
    /// [`Error::Contradiction`] if start and end differ.
    pub(crate) fn elbow_along_path(&self) -> Result<Elbow> {
        let [start, end] = self.elbows;
        if start == end {
            return Ok(start);
        }
        let [start, end] = [start.sign(), end.sign()];
        let problem =
            format!("elbows is ({start}, {end}), but along a path the arm keeps one elbow: give one sign twice");
        Err(Error::Contradiction { problem: problem.into() })
    }
}
