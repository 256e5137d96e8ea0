//! [`Prefer::Best`](super::Prefer::Best): the solution that serves the goals best, over all branches and curves.
//!
//! `best_solution` is the search. Where the self-motion is a curve, `curve_tracing` follows it once round by the steps of
//! `self_motion/curve_walk.rs`; `arcs` finds the candidate minima between the joint limits.
//! `branch_flip` offers starts on other branches.

mod arcs;
mod best_solution;
mod branch_flip;
mod curve_tracing;

pub(super) use best_solution::best_solution;
