//! Mathematics without robots: plain arrays where it is hot, nalgebra elsewhere.
//!
//! Kernels are compiled with and without FMA ([`arithmetic`]). Kernels for one number or four, one per lane of a register
//! ([`f64x4::F64x4`]), are written over [`real::Real`].
//!
//! | files | what |
//! |---|---|
//! | `pose`, `frame` | rigid transforms: checked ones of callers, plain ones of kernels |
//! | `so3`, `vec3`, `vector` | rotation vectors, and vectors of three or n entries |
//! | `arithmetic`, `f64x4`, `real` | instructions and lanes |
//! | `sincos`, `arctangent`, `logarithm`, `ordered` | functions without branches |
//! | `gram`, `ldl`, `box_step`, `four_box_steps`, `secant`, `singular` | small linear systems, and the bounded step |
//! | `polynomial`, `hermite`, `cubic_spline`, `knots`, `ticks`, `interval` | functions of one variable |

pub mod arctangent;
pub mod arithmetic;
pub mod box_step;
pub mod cubic_spline;
pub mod f64x4;
pub mod four_box_steps;
pub mod frame;
pub mod gram;
pub mod hermite;
pub mod interval;
pub mod knots;
pub mod ldl;
pub mod logarithm;
pub mod ordered;
pub mod polynomial;
pub mod pose;
pub mod real;
pub mod secant;
pub mod sincos;
pub mod singular;
pub mod so3;
pub mod ticks;
pub mod vec3;
pub mod vector;

pub use frame::Frame;
pub use knots::Knots;
pub use pose::Pose;

/// The largest number of independent joints, and of moving elements, of a robot.
pub const MAX_DOF: usize = 32;
