//! Plants: arms that take a joint command and return the measured position of their tip.

use serde::{Deserialize, Serialize};

use super::tip_pose::TipPose;
use crate::error::{Result, require_not_negative};
use crate::math::so3::rotated;
use crate::rng::{self, LazyRng};
use crate::robot::Robot;

/// An arm and its sensor, as a controller sees them.
pub trait Plant {
    /// Sends the arm to `command` (n,) (rad, m) and returns the measured tip: its position (m) or its pose.
    ///
    /// # Errors
    /// [`Fault`] ends the run; the rows recorded so far are kept.
    fn measure(&mut self, command: &[f64]) -> Result<TipPose, Fault>;

    /// Ticks between two polls of the monitor; more than one only where measurements are almost free.
    fn ticks_between_looks(&self) -> usize {
        1
    }
}

/// Reason for a failed measurement, worded as the end of "the plant ...".
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fault(pub String);

/// A plant that is a function of its command.
#[derive(Debug)]
pub struct FunctionPlant<F>(pub F);

impl<F: FnMut(&[f64]) -> T, T: Into<TipPose>> Plant for FunctionPlant<F> {
    fn measure(&mut self, command: &[f64]) -> Result<TipPose, Fault> {
        Ok(self.0(command).into())
    }
}

/// A robot that reaches every command at once, and a sensor with Gaussian noise. To simulate a wrong model, pass a
/// robot that differs from the nominal one ([`Robot::with_errors`]).
#[derive(Debug, Clone)]
pub struct KinematicPlant {
    robot: Robot,
    noise: f64,
    rotation_noise: Option<f64>,
    rng: LazyRng,
}

impl KinematicPlant {
    /// A plant whose sensor has this standard deviation (m) on each axis.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for noise that is negative or not finite; [`Error::SeveralTips`](crate::Error::SeveralTips).
    pub fn new(robot: Robot, noise: f64, seed: u64) -> Result<Self> {
        robot.require_one_tip("KinematicPlant")?;
        require_not_negative("noise", noise)?;
        // The controller uses stream 0 of the same seed.
        Ok(Self { robot, noise, rotation_noise: None, rng: rng::stream(seed, 1) })
    }

    /// Replaces the sensor by one that measures poses, with noise of this standard deviation (rad) about each axis of the base.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for noise that is negative or not finite.
    pub fn with_orientation(self, rotation_noise: f64) -> Result<Self> {
        require_not_negative("rotation_noise", rotation_noise)?;
        Ok(Self { rotation_noise: Some(rotation_noise), ..self })
    }

    /// The simulated robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Standard deviation of the sensor on each axis (m).
    pub fn noise(&self) -> f64 {
        self.noise
    }

    /// Standard deviation of the measured orientation about each axis (rad); `None` if only the position is measured.
    pub fn rotation_noise(&self) -> Option<f64> {
        self.rotation_noise
    }

    /// Gaussian noise on three axes.
    fn draw(&mut self, deviation: f64) -> [f64; 3] {
        let ([x, y], [z, _]) = (self.rng.normal_pair(), self.rng.normal_pair());
        [x, y, z].map(|draw| deviation * draw)
    }

    /// Adds the noise of the sensor to `position` (m).
    #[inline]
    fn noisy(&mut self, position: [f64; 3]) -> [f64; 3] {
        if self.noise == 0.0 {
            return position;
        }
        let noise = self.draw(self.noise);
        std::array::from_fn(|k| position[k] + noise[k])
    }
}

impl Plant for KinematicPlant {
    #[inline]
    fn measure(&mut self, command: &[f64]) -> Result<TipPose, Fault> {
        let Some(rotation_noise) = self.rotation_noise else {
            let position = self.robot.tip_position(command);
            return Ok(self.noisy(position).into());
        };
        let mut tip = self.robot.tip(command);
        tip.origin = self.noisy(tip.origin);
        if rotation_noise > 0.0 {
            let turn = self.draw(rotation_noise);
            tip.axes = tip.axes.map(|axis| rotated(&axis, &turn));
        }
        Ok(tip.into())
    }

    fn ticks_between_looks(&self) -> usize {
        64
    }
}

/// Checks that a measurement is finite, and has an orientation if `target` has one.
#[inline]
pub(super) fn check(tip: &TipPose, target: &TipPose) -> Result<(), Fault> {
    if !tip.is_finite() {
        let what = if tip.is_oriented() { "pose" } else { "position" };
        return Err(Fault(format!("returned a {what} that is not finite: {:?}", tip.position())));
    }
    if target.is_oriented() && !tip.is_oriented() {
        let remedy = "return a pose (4, 4), or give a path of positions alone";
        return Err(Fault(format!("returned a position (3,), but the path has orientations: {remedy}")));
    }
    Ok(())
}
