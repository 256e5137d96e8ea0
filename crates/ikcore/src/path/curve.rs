//! The interface of all curves.

use std::any::Any;
use std::fmt::Debug;

use nalgebra::Matrix3;

/// A curve parametrised by time.
///
/// Time `t` (s) is clamped to `[0, duration]`.
pub trait Curve: Any + Debug + Send + Sync {
    /// Duration of one pass (s); positive.
    fn duration(&self) -> f64;

    /// Position (m) in the frame of the robot's base.
    fn position(&self, t: f64) -> [f64; 3];

    /// Velocity (m/s): the derivative of [`position`](Self::position); at a corner, the velocity of the next segment.
    fn velocity(&self, t: f64) -> [f64; 3];

    /// Orientation, if the curve defines one.
    fn rotation(&self, _t: f64) -> Option<Matrix3<f64>> {
        None
    }

    /// Times (s) at which the direction may jump: a planner stops or slows down there.
    fn corners(&self) -> Vec<f64> {
        vec![]
    }
}
