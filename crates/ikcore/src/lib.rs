//! The core of beetle-ik.

pub mod error;
pub mod math;
pub mod robot;

pub use error::{Error, Result};
pub use nalgebra;
