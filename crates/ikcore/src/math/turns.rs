//! Whole turns of angles.

use std::f64::consts::TAU;

/// The same angle in [-pi, pi], whole turns aside.
#[inline]
pub fn without_turns(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
