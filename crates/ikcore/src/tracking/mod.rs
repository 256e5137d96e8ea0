//! Following a path, tick by tick, inside the limits.
//!
//! Algorithm 1 of Cheng et al. (2020). Our choices where the paper leaves something open:
//!
//! - The box of a tick is the intersection of the position limits with the range that the velocity limits allow from
//!   the accepted configuration, so that no result can violate either. If a position limit closes in faster than its
//!   joint may move, the joint follows at its velocity limit, and the violation is reported.
//! - The rule of a tick works until the error is in its band or, for random searches, below the error of the previous
//!   tick.
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
