//! State and limits of one joint.

/// Position, velocity and acceleration of a joint (rad or m, per s, per s^2).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionState {
    /// Position.
    pub q: f64,
    /// Velocity.
    pub v: f64,
    /// Acceleration.
    pub a: f64,
}

impl MotionState {
    /// Returns the state of rest at `q`.
    pub fn rest(q: f64) -> Self {
        Self { q, v: 0.0, a: 0.0 }
    }

    /// Returns the state after `t` (s) of constant jerk.
    pub fn after(&self, jerk: f64, t: f64) -> Self {
        Self {
            q: self.q + t * (self.v + t * (0.5 * self.a + t * jerk / 6.0)),
            v: self.v + t * (self.a + 0.5 * t * jerk),
            a: self.a + t * jerk,
        }
    }

    /// Returns the state with the axis reversed.
    pub fn mirrored(&self) -> Self {
        Self { q: -self.q, v: -self.v, a: -self.a }
    }
}

/// Velocity, acceleration and jerk limits of a joint, all positive; infinite if unlimited.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// Largest speed (rad/s, m/s).
    pub velocity: f64,
    /// Largest acceleration (rad/s^2, m/s^2).
    pub acceleration: f64,
    /// Largest jerk (rad/s^3, m/s^3).
    pub jerk: f64,
}
