//! A solver's declarations: where it searches, and what ends it.

/// Where a solver's points may lie. What is returned lies in the box whatever the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Domain {
    /// In the box: what is outside is clipped.
    #[default]
    Clipped,
    /// Anywhere, for entries with a period: they are brought into the box by whole periods where that is possible, and left
    /// outside where it is not. Other entries are clipped.
    Wrapped,
}

/// What ends a run before its budget does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Termination {
    /// The problem's own test.
    #[default]
    Solved,
    /// A threshold of the solver's own ([`Halt::BelowThreshold`](super::Halt::BelowThreshold)). The problem's test still
    /// decides whether the result counts as solved.
    Threshold,
}

/// A solver's declarations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Conduct {
    /// Where it searches.
    pub domain: Domain,
    /// What ends it before its budget does.
    pub termination: Termination,
}
