//! `minimize`: any derivative-free solver on a function of Python's.

mod function;
mod minimum;

pub use minimum::{PyMinimum, minimize_function};
