//! Options of TPBSO.

use crate::error::{Error, Result};
use crate::planning::planar_arm::Elbow;
use crate::solver::{AnySolver, DerivativeFree};

/// Trajectory planning by beetle swarm optimisation (Wang et al. 2019). The default is as published.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tpbso {
    /// Which way a planar arm bends at the start and at the end. Given joint angles decide for themselves; along a path
    /// both must be the same.
    pub elbows: [Elbow; 2],
    /// The search; None: the published beetle swarm.
    pub solver: Option<AnySolver<DerivativeFree>>,
}

impl Tpbso {
    /// The one elbow that the arm keeps along a path.
    ///
    /// # Errors
    /// [`Error::Contradiction`] where start and end differ.
    pub(super) fn elbow_along_path(&self) -> Result<Elbow> {
        let [start, end] = self.elbows;
        if start == end {
            return Ok(start);
        }
        let [start, end] = [start.sign(), end.sign()];
        let problem =
            format!("elbows is ({start}, {end}), but along a path the arm keeps one elbow: give one sign twice");
        Err(Error::Contradiction { problem })
    }
}
