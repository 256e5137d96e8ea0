//! Domain of the points of a solver.

/// Domain of the points of a solver. The returned point is always in the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// The box: points outside are clipped.
    Clipped,
    /// The whole space for entries with a period: whole periods bring them into the box if possible, otherwise they stay
    /// outside. Entries without a period are clipped.
    Wrapped,
}
