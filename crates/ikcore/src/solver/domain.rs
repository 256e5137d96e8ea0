//! Where a solver's points may lie.

/// Where a solver's points may lie. The returned point always lies in the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// In the box: points outside are clipped.
    Clipped,
    /// Anywhere, for entries with a period: whole periods bring them into the box where that is possible, and they stay
    /// outside where it is not. Entries without a period are clipped.
    Wrapped,
}
