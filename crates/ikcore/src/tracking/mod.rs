//! Tracking: following a path tick by tick, inside the limits.
//!
//! The method is Algorithm 1 of Cheng et al. (2020), with our choices where the paper leaves something open:
//!
//! - The box of a tick is the intersection of the position limits with the range that the velocity limits allow from
//!   the accepted configuration, so that no result can violate either. If a position limit closes in faster than its
//!   joint may move, the joint follows at its velocity limit, and the violation is reported.
//! - The rule of a tick works until the error is in its band or, for random searches, below the error of the previous
//!   tick.
//! - Time always advances, and the best configuration found is always kept.
//!
//! | file | what |
//! |---|---|
//! | `track`, `track_options` | the call for a whole path, and its options |
//! | `start_on_paths` | the configuration from which a track begins where none is given |
//! | `path_approach` | approach from rest onto a moving path, `TrackOptions::ease` |
//! | `commanded_motion` | the motion between ticks under acceleration limits |
//! | `session`, `step` | [`Session`]: arm, rule and safety filter; one [`Step`] per tick |
//! | `idle` | why no target leads the arm in a tick |
//! | `tracked_arm` | accepted configuration, clock, limits and targets |
//! | `outside_start` | an arm that begins outside its position limits |
//! | `limited_state` | the motion of an arm under acceleration or jerk limits |
//! | `around_arm` | obstacles and links around an arm, as constraint rows of its command |
//! | `safety_filter`, `command_and_stop`, `coupled_stop` | the motion of an arm among obstacles or with pairs of tips held, each command certified with the stop after it |
//! | `tip_pace` | limits of the speed and turn speed of tips |
//! | `torque_pace`, `stop_torques` | torque limits: commands and stops that the motors can make, and their certificate |
//! | `progress` | progress towards its target of an arm held by obstacles |
//! | `settling` | rest of an arm that comes no nearer to targets that stand still |
//! | `way_back`, `away` | the way of an arm that cannot come nearer to a configuration on its target, and the report on it |
//! | `constrained_step`, `step_context` | steps under constraint rows, and their inputs |
//! | `tip_paths`, `current_tasks`, `tip_pose` | paths, tasks and measured poses of the tips |
//! | `target_stream`, `target_filter`, `repeated_targets` | targets as they arrive: stamps, timeout, filters, repetitions |
//! | `rule` | tick rules: move a modelled arm by one tick inside the box |
//! | `record`, `record_message` | [`Record`]: one row per tick, violations and status; its outcome in a sentence |
//! | `model_free`, `plant` | tracking without a model: the call, and the arms that it commands |
//! | `late_sensor` | detects a sensor delay that the controller does not assume |
//! | `controller` | controllers, which only command and observe |

mod around_arm;
mod away;
mod command_and_stop;
mod commanded_motion;
mod constrained_step;
mod controller;
mod coupled_stop;
mod current_tasks;
mod idle;
mod kept;
mod late_sensor;
mod limited_state;
mod model_free;
mod outside_start;
mod path_approach;
mod plant;
mod progress;
mod record;
mod record_message;
mod repeated_targets;
mod rule;
mod safety_filter;
mod session;
mod settling;
mod start_on_paths;
mod step;
mod step_context;
mod stop_torques;
mod target_filter;
mod target_stream;
mod tip_pace;
mod tip_paths;
mod tip_pose;
mod torque_pace;
mod track;
mod track_options;
mod tracked_arm;
mod way_back;

pub use away::{Away, Way};
pub use controller::{Antenna, ControlSession, Controller, Delay, UpdateRule, Znnbas};
pub use idle::Idle;
pub use model_free::{ModelFreeOptions, ModelFreeRecord, track_model_free};
pub use plant::{Fault, FunctionPlant, KinematicPlant, Plant};
pub use record::{Record, TipTable};
pub use rule::{Integrator, TickRule, WeightedPseudoInverse};
pub use safety_filter::FilterWork;
pub use session::Session;
pub use step::Step;
pub use target_filter::{LowPass, OneEuro, TargetFilter};
pub use target_stream::Arrival;
pub use tip_paths::TipPaths;
pub use tip_pose::TipPose;
pub use track::{track, track_tips};
pub use track_options::TrackOptions;
