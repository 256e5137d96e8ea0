//! Rotations, rigid transforms, fast sines and arctangents, singular values, small systems, polynomials, cubics between two ends, splines,
//! knots in time and the one bounded step. Plain arrays where it is hot, nalgebra elsewhere.
//!
//! What is computed for four at once keeps each number of all four in one register, a [`quad::F64x4`]; kernels that are the same for one and
//! for four are written over [`real::Real`].

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
