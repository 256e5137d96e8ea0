//! Constraints of a motion: errors of tasks that stay within their tolerances at every instant, such as a cup that stays upright.
//!
//! Each constraint gives its errors at a configuration and a bound of them between two, so that one walker certifies them all: it
//! halves the intervals of a motion until the bounds hold or an error is too large. So no motion leaves a tolerance between samples.
//!
//! | file | what |
//! |---|---|
//! | `keep` | [`Keep`]: a task and its target |
//! | `gauge` | one error of a task: its value, and its bound between two configurations |
//! | `drift` | how a joint changes the errors: their slopes |
//! | `tip_bend` | how far a tip, or one tip seen from another, gets off the straight line between two configurations |
//! | `keep_sweep` | certificate of a motion, and its largest errors |
//! | `joint_span` | intervals of joint motions |
//! | `joint_torques`, `torque_bend` | limits of joint torques; how far torques get off parabolas |
//! | `four_torque_points` | joint torques along a path at four points at a time |
//! | `hold_check` | whether joints can hold the arm along straight lines |
//! | `largest_factor` | the largest factor by which a motion exceeds limits, from bounds over intervals |
//! | `onto` | configurations moved to where constraints hold |
//! | `tip_jet` | velocity and turn rate of a tip over an interval |
//! | `tip_rates` | limits of the speed, acceleration and turn speed of tips |

mod drift;
mod four_torque_points;
mod gauge;
mod hold_check;
mod joint_span;
mod joint_torques;
mod keep;
mod keep_sweep;
mod largest_factor;
mod onto;
mod tip_bend;
mod tip_jet;
mod tip_rates;
mod torque_bend;

pub(crate) use four_torque_points::FourTorquePoints;
pub(crate) use hold_check::HoldCheck;
pub(crate) use joint_span::JointSpan;
pub(crate) use joint_torques::{
    Drag, Friction, JointTorques, TooHeavy, TorqueExcess, TorquePoint, TorqueTerms, control_points,
};
pub use keep::Keep;
pub(crate) use keep::{KeepRow, refuse_broken};
pub(crate) use keep_sweep::KeepScratch;
pub use keep_sweep::{Broken, KeepSweep};
pub(crate) use largest_factor::TIGHT;
pub(crate) use onto::{KeepTasks, Onto};
pub(crate) use tip_jet::{SQUARE, TipJet, VectorJet};
pub(crate) use tip_rates::{TipExcess, TipRates};
pub(crate) use torque_bend::{ALL_FACTORS, BendScratch, HOLD_AND_SQUARE, Rest};
