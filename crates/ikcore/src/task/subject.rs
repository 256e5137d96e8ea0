//! Subject of a target: a tip, or a pair of tips.

use serde::{Deserialize, Serialize};

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
}

impl Subject {
    /// Whether the subject is a pair of tips.
    pub(crate) fn is_pair(&self) -> bool {
        matches!(self, Self::Pair { .. })
    }
}
