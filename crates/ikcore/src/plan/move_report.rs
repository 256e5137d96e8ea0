//! Report on each move of a program: its times, speed, and the limits that slowed it.

use serde::{Deserialize, Serialize};

use crate::wording::number;

/// Times of a move, its speed, and the limits that slowed it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MoveReport {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// When it starts (s). A blend belongs to its two moves by halves of its length.
    pub start: f64,
    /// When it ends (s).
    pub end: f64,
    /// Motion between its blends.
    pub course: MoveCourse,
    /// Largest speed of the tip on it (m/s), between its blends. A turn on the spot counts 0.1 m for each radian.
    pub speed: f64,
    /// Limits that kept the tip below the requested speed, between its blends, and when; empty where it had that speed, and where none is
    /// requested.
    pub bound_by: Vec<SpeedBound>,
}

impl MoveReport {
    /// Describes the motion in words.
    pub fn message(&self) -> String {
        match self.course {
            MoveCourse::Rest => "the arm rests".into(),
            MoveCourse::Blends => "wholly in blends".into(),
            MoveCourse::Way => format!("up to {} m/s between blends", number(self.speed)),
        }
    }
}

/// Motion between the blends of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MoveCourse {
    /// A way of the tip or the joints.
    Way,
    /// Nothing: the blends take the whole move.
    Blends,
    /// No motion at all: a wait, or a move that ends where it begins.
    Rest,
}

/// A limit that keeps the tip below the requested speed.
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
