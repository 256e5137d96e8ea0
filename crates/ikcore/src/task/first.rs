//! Part of a pose that comes before the other.

use serde::{Deserialize, Serialize};

use crate::wording::words;

/// Part of a pose that is reached exactly, before the other part comes as near as the first allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum First {
    /// Position of the tip.
    Position,
    /// Orientation of the tip.
    Orientation,
}

words!("first": First { Position => "position", Orientation => "orientation" });
