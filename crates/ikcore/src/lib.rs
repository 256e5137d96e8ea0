//! The core of beetle-ik.

pub mod error;
pub mod ik;
pub mod limits;
pub mod manipulability;
pub mod math;
pub mod objective;
pub mod path;
pub mod problem;
pub mod rng;
pub mod robot;
pub mod solver;
pub mod task;
pub mod tracking;
pub mod trajectory;

pub use error::{Error, Result};
pub use nalgebra;
