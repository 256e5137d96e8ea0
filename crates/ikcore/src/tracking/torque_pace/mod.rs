//! Torque limits of a tracked arm: in every command, and in the stop after it.
//!
//! All joints brake with the same fraction of their acceleration limits, the largest that the motors allow. A command that is not
//! certified is tried with a milder stop, or moved towards the command that brakes, which was certified with the command before. Where there
//! is room, the stop becomes harder again. Where the joints could not hold the arm at rest after a command, it is led aside first.
//!
//! | file | what |
//! |---|---|
//! | `limited_pace` | [`TorquePace`]: keeps the limits in each tick, and says what holds the arm back |
//! | `command_search` | the command nearest to the one asked for that is certified |
//! | `stop_choice` | how hard a stop brakes |
//! | `unloading` | the way out of where the joints cannot hold the arm |
//! | `other_limits` | [`OtherLimits`]: what else a command has to satisfy |

mod command_search;
mod limited_pace;
mod other_limits;
mod stop_choice;
mod unloading;

pub(super) use limited_pace::TorquePace;
pub(super) use other_limits::OtherLimits;
