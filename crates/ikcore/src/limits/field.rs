//! The kinds of limits, and their names.

use std::fmt;

/// A kind of limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// Lower position limit (rad or m).
    Lower,
    /// Upper position limit (rad or m).
    Upper,
    /// Velocity (rad/s or m/s).
    Velocity,
    /// Acceleration (rad/s^2 or m/s^2).
    Acceleration,
    /// Jerk (rad/s^3 or m/s^3).
    Jerk,
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
        })
    }
}
