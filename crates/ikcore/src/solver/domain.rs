//! Where the points of a solver may lie.

/// Where the points of a solver may lie. The returned point is always in the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// In the box: points outside are clipped.
    Clipped,
    /// Anywhere, for entries with a period: whole periods bring them into the box if possible, otherwise they stay
    /// outside. Entries without a period are clipped.
    Wrapped,
}
