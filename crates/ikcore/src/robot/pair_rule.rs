//! Source of the pairs of links that are tested against each other.

use serde::{Deserialize, Serialize};

/// Rule for the pairs of links that are tested against each other.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) enum PairRule {
    /// Random configurations show which links can touch.
    #[default]
    Sampled,
    /// All but these pairs of links, and those that always touch.
    AllBut(Vec<[String; 2]>),
    /// These pairs of links.
    Given(Vec<[String; 2]>),
}
