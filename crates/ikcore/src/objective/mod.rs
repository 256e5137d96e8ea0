//! The meeting point of the robot side and the solver side: what is minimised, and within which box.

mod evaluation;

pub use evaluation::*;
