//! Following a path, tick by tick, inside the limits.
//!
//! Algorithm 1 of Cheng et al. (2020), with what it leaves open settled:
//!
//! - The box of a tick is the position limits intersected with what the velocity limit lets the accepted configuration
//!   reach, so that no answer can break either. A position limit that closes in faster than its joint may move is
//!   followed at the joint's limit, and reported.
//! - The tick's rule works until the error is in its band or, for random searches, below that of the tick before.
//! - Time always advances, and the best configuration found is always kept.

mod controller;
mod model_free;
mod plant;
mod record;
mod rule;
mod session;
mod step;
mod tip_pose;
mod track;
mod track_options;

pub use controller::{Antenna, ControlSession, Controller, Delay, UpdateRule, Znnbas};
pub use model_free::{ModelFreeOptions, ModelFreeRecord, track_model_free};
pub use plant::{Fault, FunctionPlant, KinematicPlant, Plant};
pub use record::Record;
pub use rule::{Integrator, TickRule, WeightedPseudoInverse};
pub use session::Session;
pub use step::Step;
pub use tip_pose::TipPose;
pub use track::track;
pub use track_options::TrackOptions;
