//! The interface of all curves.

use std::any::Any;
use std::fmt::Debug;

use nalgebra::Matrix3;

/// A curve that is passed through in time.
///
/// Time `t` (s) is clamped to `[0, duration]`: before and after, the values are those of the ends.
pub trait Curve: Any + Debug + Send + Sync {
    /// How long one pass takes (s); positive.
    fn duration(&self) -> f64;

    /// Position (m) in the frame of the robot's base.
    fn position(&self, t: f64) -> [f64; 3];

    /// Velocity (m/s): the derivative of [`position`](Self::position); at a corner, that of the segment that begins.
    fn velocity(&self, t: f64) -> [f64; 3];

    /// Orientation, for a curve that has its own.
    fn rotation(&self, _t: f64) -> Option<Matrix3<f64>> {
        None
    }

    /// Times (s) at which the direction may jump: a planner stops or slows down there.
    fn corners(&self) -> Vec<f64> {
        vec![]
    }
}
