//! Why a run ends.

/// Why a solver cannot go on; passed up with `?`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Halt {
    /// The best point passes the problem's own test.
    Solved,
    /// The best value fell below [`Stop::value_below`](super::super::stop::Stop::value_below).
    BelowValue,
    /// The solver's own threshold was met.
    BelowThreshold,
    /// The search arrived at a solution outside the box that whole periods do not bring inside.
    OutsideBox,
    /// The solver's own rule: nothing more to gain from here.
    Stalled,
    /// The evaluation or iteration budget is spent.
    Budget,
    /// The time limit is over.
    Time,
    /// The monitor asked to stop.
    Interrupted,
}
