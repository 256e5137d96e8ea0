//! Named configurations.

use serde::{Deserialize, Serialize};

/// A named configuration, such as "ready".
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stance {
    /// Its name.
    pub name: String,
    /// Joint angles (n,) (rad, m).
    pub q: Vec<f64>,
}
