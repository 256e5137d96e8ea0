//! `minimize`: derivative-free minimisation of a Python function.

mod function;
mod minimum;

pub use minimum::{PyMinimum, minimize_function};
