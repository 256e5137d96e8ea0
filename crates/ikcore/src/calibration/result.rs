//! The result of a calibration, and the sentence about it.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::identifiability::Identifiability;
use crate::math::Pose;
use crate::message::Message;
use crate::robot::Robot;
use crate::wording::{joined, listed, number};

/// Root mean square of the errors: of lengths (m, or pixels), and of rotations (rad; NaN where none are measured).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RmsError {
    /// Lengths (m or pixels).
    pub length: f64,
    /// Rotations (rad).
    pub rotation: f64,
}

/// A parameter with its value: its deviation from the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedParameter {
    /// Name, such as "offset elbow" or "link elbow rx".
    pub name: String,
    /// Value (rad or m).
    pub value: f64,
    /// Standard deviation of the value (rad or m).
    pub deviation: f64,
    /// True for an angle (rad), false for a length (m).
    pub is_angle: bool,
}

/// Errors of one measurement before and after (m or pixels, rad).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RowErrors {
    /// Of the robot as it was given.
    pub before: RmsError,
    /// Of the calibrated robot.
    pub after: RmsError,
}

/// Arm as it is built, and the results of the fit.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// The robot with the geometry, base and tool that were found.
    pub robot: Robot,
    /// Results of the fit.
    pub findings: Findings,
}

/// Parameters of a calibration, their errors and their identifiability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// Pose of the camera, where one sees the measurements: in the frame of the robot's base if it is fixed, else in that of the tip.
    pub camera: Option<Pose>,
    /// Pose of the board: in the frame of the tip if the camera is fixed, else in that of the robot's base.
    pub board: Option<Pose>,
    /// Centre of the ball bar in the frame of the robot's base (m).
    pub centre: Option<[f64; 3]>,
    /// Unit normal n and height h of the plane n . p = h in the frame of the robot's base (m).
    pub plane: Option<([f64; 3], f64)>,
    /// Deviations from the model.
    pub parameters: Vec<FittedParameter>,
    /// Covariance of the parameters. Where the measurements leave a combination open, it is that of the prior.
    pub covariance: DMatrix<f64>,
    /// Errors of the robot as it was given.
    pub before: RmsError,
    /// Errors of the robot as it was given, with base and tool placed as well as possible.
    pub placed: RmsError,
    /// Errors of the calibrated robot.
    pub after: RmsError,
    /// Errors of measurements that are held out, one at a time: what to expect of new ones.
    pub held_out: RmsError,
    /// Errors of each measurement.
    pub errors: Vec<RowErrors>,
    /// Measurements that were left out because they do not belong with the others, from 0.
    pub outliers: Vec<usize>,
    /// Noise of a measurement (m or pixels, rad): given, or estimated from the residuals.
    pub noise: RmsError,
    /// Residuals over the noise that was given; 1 without.
    pub excess: f64,
    /// Identifiability of the parameters.
    pub identifiability: Identifiability,
    /// Joints that never moved.
    pub still_joints: Vec<String>,
    /// Steps of the descent.
    pub iterations: usize,
    /// Whether the descent ended at an optimum.
    pub converged: bool,
    /// Whether lengths are in pixels.
    pub in_pixels: bool,
    /// Configurations that would tell most if they were measured too, (k, n) row by row.
    pub suggested: Vec<f64>,
}

/// Error (m) beyond which the model or the order of the rows is wrong.
const FAR: f64 = 0.02;
/// Error (m or pixels) below which measurements are exact.
const EXACT: f64 = 1e-9;
/// Excess of the residuals over the given noise from which the message mentions it.
const EXCESS: f64 = 1.5;

impl Findings {
    /// Outcome, and what to do about what is not known.
    pub fn message(&self) -> Message {
        let mut sentences = vec![self.errors_in_words(), self.identified_in_words()];
        sentences.extend(self.still_in_words());
        sentences.extend(self.outliers_in_words());
        if self.excess > EXCESS {
            sentences.push(format!(
                "residuals are {} times the noise that was given: the arm has errors that these parameters do not describe, such as bending or play",
                number(self.excess)
            ));
        }
        if !self.in_pixels && self.after.length > FAR {
            sentences.push(
                "the measurements do not fit this arm: see that joint angles and measurements are in the same order, and of this model".into(),
            );
        }
        if self.held_out.length > self.placed.length && self.held_out.length > EXACT {
            sentences.push(
                "measurements that are held out fit worse than with the uncalibrated arm: measure more configurations, or fit fewer parameters".into(),
            );
        }
        if !self.converged {
            sentences.push("the descent did not end: the model may be far from this arm".into());
        }
        sentences.join("; ").into()
    }

    fn errors_in_words(&self) -> String {
        let length = |error: &RmsError| match self.in_pixels {
            false => format!("{} mm", number(1e3 * error.length)),
            true => format!("{} pixels", number(error.length)),
        };
        let (before, after, held_out) = (length(&self.before), length(&self.after), length(&self.held_out));
        format!("error {before} before, {after} after, {held_out} on held-out measurements")
    }

    fn identified_in_words(&self) -> String {
        let unknown = &self.identifiability.unknown;
        if unknown.is_empty() {
            return "all is determined that such measurements can tell".into();
        }
        let names = listed(unknown.iter().map(String::as_str));
        let are = if unknown.len() == 1 { "combination of parameters is" } else { "combinations of parameters are" };
        format!("{} {are} not determined, and other configurations would tell: {names}", unknown.len())
    }

    fn still_in_words(&self) -> Option<String> {
        let names = || self.still_joints.iter().map(String::as_str);
        match &self.still_joints[..] {
            [] => None,
            [one] => Some(format!(
                "joint '{one}' never moved, so that its zero and the links beside it cannot be told apart"
            )),
            _ => Some(format!(
                "joints {} never moved, so that their zeros and the links beside them cannot be told apart",
                joined(names())
            )),
        }
    }

    fn outliers_in_words(&self) -> Option<String> {
        let rows: Vec<String> = self.outliers.iter().map(usize::to_string).collect();
        let names = listed(rows.iter().map(String::as_str));
        match rows.len() {
            0 => None,
            1 => Some(format!("row {names} does not belong with the others and was left out")),
            _ => Some(format!("rows {names} do not belong with the others and were left out")),
        }
    }
}
