//! [`Prefer::Best`](super::Prefer::Best): the solution that serves the goals best, over all branches and curves.
//!
//! `best_solution` is the search. Where the self-motion is a curve, `curve_tracing` follows it once round by the steps of
//! `curve_walk`; `arcs` finds the candidate minima between the joint limits, which `wrapped_limits` knows up to whole turns.
//! `branch_flip` offers starts on other branches.

mod arcs;
mod best_solution;
mod branch_flip;
mod curve_tracing;
mod curve_walk;
mod wrapped_limits;

pub(super) use best_solution::best_solution;
