//! A ball that holds a shape.

/// A ball that holds a shape (m); its radius is infinite for a half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingBall {
    /// Its centre.
    pub center: [f64; 3],
    /// Its radius.
    pub radius: f64,
}
