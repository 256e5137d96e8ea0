//! Controllers that move an arm without a model of it, from the target, the box of the tick and measurements alone.
//!
//! | file | controller | measurements a tick | when to use it |
//! |---|---|---|---|
//! | `broyden_bas` | a Jacobian from antenna differences, updated by every step | 1 to a few | the default; if a tick has time for more than one measurement, or one step a tick is enough |
//! | `znnbas` | a random antenna each tick and the sign of the measured change (Khan et al. 2022) | exactly 1 | to reproduce the paper; it learns nothing, needs a fast clock, and its antennae shake the tool |
//!
//! `controller_choice` lists the controllers and holds the running one, `control_session` runs it tick by tick, `control_tick`
//! is the input of a controller, `noise` estimates the noise of the sensor.

mod broyden_bas;
mod control_session;
mod control_tick;
mod controller_choice;
mod noise;
mod znnbas;
mod znnbas_state;

pub use control_session::ControlSession;
pub use controller_choice::Controller;
pub use znnbas::{Antenna, Delay, UpdateRule, Znnbas};
