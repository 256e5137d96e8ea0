//! Bounding ball of a shape.

/// Bounding ball of a shape (m); its radius is infinite for a half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingBall {
    /// Centre.
    pub center: [f64; 3],
    /// Radius.
    pub radius: f64,
}
