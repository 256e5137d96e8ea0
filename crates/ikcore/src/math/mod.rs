//! Mathematics without robots: plain arrays in hot code, nalgebra elsewhere.
//!
//! Kernels are compiled with and without FMA (`arithmetic`).
//!
//! | files | contents |
//! |---|---|
//! | `pose`, `frame` | rigid transforms: `pose` for checked input, `frame` for kernels |
//! | `so3` | rotation vectors |
//! | `vector3`, `vec3`, `vector` | vectors of three numbers, of three SIMD lanes, of n numbers |
//! | `arithmetic`, `f64x4`, `f32x8`, `real` | instructions and lanes |
//! | `sincos`, `arctangent`, `logarithm`, `comparison` | functions without branches |
//! | `columns` | columns of Jacobians |
//! | `gram`, `ldl`, `banded`, `singular_values` | small linear systems, and banded ones |
//! | `box_step`, `block_step`, `row_step` | damped least-squares steps: in a box, for several tasks, with inequalities |
//! | `joint_weights`, `overshoot` | steps by the joints that cost least, and weights with which ticks of them overshoot |
//! | `ranked_step`, `level_step` | step for two objectives, one before the other; for any number in order |
//! | `nearest_by_lane` | nearest of many points, eight compared at once |
//! | `secant` | Jacobian estimated from differences |
//! | `majorant`, `bernstein` | bounds of Taylor coefficients; polynomials within their control points |
//! | `one_joint` | time-optimal motions of one joint between two states |
//! | `polynomial`, `hermite`, `cubic_spline`, `cubic_bspline`, `knots`, `ticks`, `turns`, `sampling_range` | functions of one variable |

pub(crate) mod arctangent;
pub(crate) mod arithmetic;
pub(crate) mod banded;
pub(crate) mod bernstein;
pub mod block_step;
pub mod box_step;
mod columns;
pub(crate) mod comparison;
pub(crate) mod cubic_bspline;
pub(crate) mod cubic_spline;
pub(crate) mod f32x8;
pub(crate) mod f64x4;
mod frame;
pub(crate) mod gram;
pub(crate) mod hermite;
mod joint_weights;
mod knots;
pub(crate) mod ldl;
pub(crate) mod level_step;
pub(crate) mod logarithm;
pub(crate) mod majorant;
pub(crate) mod nearest_by_lane;
pub mod one_joint;
pub(crate) mod overshoot;
pub mod polynomial;
pub mod pose;
pub(crate) mod ranked_step;
pub(crate) mod real;
pub(crate) mod row_step;
pub(crate) mod sampling_range;
pub(crate) mod secant;
pub(crate) mod sincos;
pub(crate) mod singular_values;
pub mod so3;
pub mod ticks;
pub(crate) mod turns;
pub(crate) mod vec3;
pub(crate) mod vector;
pub(crate) mod vector3;

pub use arithmetic::instructions;
pub use columns::Columns;
pub use frame::Frame;
pub use joint_weights::{JointWeights, StepBox};
pub use knots::Knots;

/// Largest number of independent joints, and of moving elements, of a robot.
pub const MAX_DOF: usize = 64;

/// Number of joints up to which scratch memory is on the stack, so that no hot loop allocates.
pub const STACK_DOF: usize = 32;

/// Rigid transform: rotation matrix and translation (m).
pub type Pose = nalgebra::IsometryMatrix3<f64>;
