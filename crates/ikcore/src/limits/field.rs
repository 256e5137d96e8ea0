//! The kinds of limits, and their names.

use crate::wording::words;

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

words!("kind of limit": Field {
    Lower => "lower",
    Upper => "upper",
    Velocity => "velocity",
    Acceleration => "acceleration",
    Jerk => "jerk",
});
