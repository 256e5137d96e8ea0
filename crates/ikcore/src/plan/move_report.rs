//! How each move of a program came out.

use serde::{Deserialize, Serialize};

/// When a move was made, how fast, and what slowed it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MoveReport {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// When it starts (s). A blend belongs to its two moves by halves of its length.
    pub start: f64,
    /// When it ends (s).
    pub end: f64,
    /// Largest speed of the tip on it (m/s), between its blends. A turn on the spot counts 0.1 m for each radian.
    pub speed: f64,
    /// What kept the tip below the speed asked for, between its blends, and when; empty where it had that speed, and where none is asked
    /// for.
    pub bound_by: Vec<SpeedBound>,
}

/// A limit that keeps the tip below the speed asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpeedBound {
    /// The limit: "velocity", "acceleration" or "jerk" of a joint, "tip speed", "tip acceleration" or "tip turn speed".
    pub limit: String,
    /// Name of the joint, or of the tip.
    pub of: String,
    /// From when (s).
    pub start: f64,
    /// Until when (s).
    pub end: f64,
}
