//! The solution that serves the goals best, over all branches and curves of solutions.

mod arcs;
mod best_solution;
mod branch_flip;
mod curve_tracing;
mod curve_walk;
mod wrapped_limits;
