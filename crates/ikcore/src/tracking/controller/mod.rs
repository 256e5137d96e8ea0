//! Controllers: what moves an arm that it has no model of. A controller sees the target, the box of the tick and what was
//! measured, and nothing else.
//!
//! | file | controller | measurements a tick | when to use it |
//! |---|---|---|---|
//! | `broyden_bas` | a Jacobian from antenna differences, kept up to date by every step | 1 to a few | the choice, where a tick leaves time to measure more than once, or a step a tick will do |
//! | `znnbas` | a random antenna a tick and the sign of what it brought (Khan et al. 2022) | exactly 1 | to repeat the paper; it learns nothing, needs a fast clock, and its antennae shake the tool |
//!
//! `controller_choice` holds the choice of controller and the controller in use, `control_session` runs one tick by tick,
//! `control_tick` is what a controller is given, `noise` estimates that of the sensor.

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
