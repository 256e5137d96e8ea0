//! A place where the tool leaves its path.

use serde::{Deserialize, Serialize};

/// A place where the tool leaves its path, and goes on with another posture of the arm or farther along.
///
/// Places are numbers of points, with the part of the way to the next one, or times of a path in time (s).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Break {
    /// Where the tool leaves the path.
    pub at: f64,
    /// Where it goes on; the same place, where nothing is left out.
    pub until: f64,
    /// Why the arm cannot go on along the path.
    pub reason: String,
    /// When it leaves the path (s).
    pub start: f64,
    /// When it is back (s).
    pub end: f64,
}

impl Break {
    /// The break of a motion that takes `factor` times as long.
    pub(crate) fn slower(&self, factor: f64) -> Self {
        Self { start: factor * self.start, end: factor * self.end, ..self.clone() }
    }
}
