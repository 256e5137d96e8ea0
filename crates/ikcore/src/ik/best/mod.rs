//! Best solution for the goals, over all branches and curves: [`Prefer::Best`](super::Prefer::Best).
//!
//! `best_solution` is the search. If the self-motion is a curve, `curve_tracing` traces it once by the steps of
//! `self_motion/curve_walk.rs`; `arcs` finds the candidate minima between the joint limits. `branch_flip` provides starts on
//! other branches.

mod arcs;
mod best_solution;
mod branch_flip;
mod curve_tracing;

pub(super) use best_solution::best_solution;
