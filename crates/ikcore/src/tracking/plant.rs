//! Plants: arms that take a joint command and return the measured position of their tip.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_finite};
use crate::rng::{self, LazyRng};
use crate::robot::Robot;

/// An arm and its sensor, as a controller sees them.
pub trait Plant {
    /// Sends the arm to `command` (n,) (rad, m) and returns the measured position of its tip (m).
    ///
    /// # Errors
    /// [`Fault`] ends the run; the rows recorded so far are kept.
    fn measure(&mut self, command: &[f64]) -> Result<[f64; 3], Fault>;

    /// Ticks between two polls of the monitor: one, unless measurements are almost free.
    fn ticks_between_looks(&self) -> usize {
        1
    }
}

/// Why a plant failed, as the end of "the plant ...".
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault(pub String);

/// A plant that is a function of its command.
#[derive(Debug)]
pub struct FunctionPlant<F>(pub F);

impl<F: FnMut(&[f64]) -> [f64; 3]> Plant for FunctionPlant<F> {
    fn measure(&mut self, command: &[f64]) -> Result<[f64; 3], Fault> {
        Ok(self.0(command))
    }
}

/// A robot that reaches every command at once, and a sensor with Gaussian noise. To simulate a wrong model, pass a
/// robot that differs from the nominal one ([`Robot::with_errors`]).
#[derive(Debug, Clone)]
pub struct KinematicPlant {
    robot: Robot,
    noise: f64,
    rng: LazyRng,
}

impl KinematicPlant {
    /// A plant whose sensor has this standard deviation (m) on each axis.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for noise that is negative or not finite.
    pub fn new(robot: Robot, noise: f64, seed: u64) -> Result<Self> {
        if !(noise.is_finite() && noise >= 0.0) {
            return Err(Error::out_of_range("noise", "zero or more and finite", noise));
        }
        // The controller uses stream 0 of the same seed.
        Ok(Self { robot, noise, rng: rng::stream(seed, 1) })
    }

    /// The simulated robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Standard deviation of the sensor on each axis (m).
    pub fn noise(&self) -> f64 {
        self.noise
    }
}

impl Plant for KinematicPlant {
    #[inline]
    fn measure(&mut self, command: &[f64]) -> Result<[f64; 3], Fault> {
        let position = self.robot.tip_position(command);
        if self.noise == 0.0 {
            return Ok(position);
        }
        let ([x, y], [z, _]) = (self.rng.normal_pair(), self.rng.normal_pair());
        let noise = [x, y, z].map(|draw| self.noise * draw);
        Ok(std::array::from_fn(|k| position[k] + noise[k]))
    }

    fn ticks_between_looks(&self) -> usize {
        64
    }
}

/// Checks that a measured position is finite.
pub(super) fn check(position: [f64; 3]) -> Result<[f64; 3], Fault> {
    match require_finite("the position", &position, |k| format!("entry {k}")) {
        Ok(()) => Ok(position),
        Err(_) => Err(Fault(format!("returned a position that is not finite: {position:?}"))),
    }
}
