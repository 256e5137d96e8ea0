//! The core of beetle-ik.

pub mod error;
pub mod math;
pub mod path;
pub mod robot;
pub mod trajectory;

pub use error::{Error, Result};
pub use nalgebra;
