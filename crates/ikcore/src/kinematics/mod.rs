//! Kinematics of a serial chain as plain data: no names, limits or files, and no `Robot`.
//!
//! Read `chain` for the data and `forward_pass` for the pass along it; then each file is one algorithm. `kernels` compiles
//! them for each number of stages and for the instructions of the processor.
//!
//! | file | contents |
//! |---|---|
//! | `chain`, `stages` | constant frames, and the joint that drives each stage |
//! | `forward_pass`, `wide_frame` | forward pass from base to tip, one frame per stage |
//! | `tip`, `jacobian`, `torques`, `link_frames` | kernels |
//! | `four_forward_pass`, `eight_frames` | forward pass at four configurations, and at eight in single precision |
//! | `kernels` | table of compiled kernels |
//! | `rotation_vector` | rotation of a floating base |
//! | `joint_curve` | joints that follow others by a polynomial |
//! | `loop_kernels` | kernels for chains with a rotation vector or a curve, and for long chains |
//! | `link_tree` | all links, including branches off the chain |
//! | `screws` | axis and velocity of every stage |
//! | `reach`, `fixed_direction` | bounds on the tip positions |
//! | `task_rank` | rank of the Jacobian by task |

pub(crate) mod chain;
pub(crate) mod eight_frames;
mod fixed_direction;
mod forward_pass;
mod four_forward_pass;
mod jacobian;
mod joint_curve;
pub(crate) mod kernels;
pub(crate) mod link_frames;
pub(crate) mod link_tree;
mod loop_kernels;
mod reach;
mod rotation_vector;
mod screws;
mod stages;
mod task_rank;
mod tip;
mod torques;
mod wide_frame;

pub use fixed_direction::FixedDirection;
pub(crate) use joint_curve::{CurvedStages, JointCurve, restored};
pub use reach::{Reach, ReachShortfall};
pub(crate) use rotation_vector::RotationVector;
pub use screws::{Screw, Screws};
pub use task_rank::TaskRank;
pub use torques::Wrench;
