//! Parameters of a calibration: what may differ from the model, and by how much a real arm usually does.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::wording::words;

/// Group of parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Part {
    /// Zero of each joint.
    Offsets,
    /// Constant transform before each joint but the first.
    Links,
    /// Pose of the tool in the frame of the tip link.
    Tool,
    /// Pose of the base in the frame of the measurements.
    Base,
}

words!("part of a calibration": Part { Offsets => "offsets", Links => "links", Tool => "tool", Base => "base" });

impl Part {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Offsets, Self::Links, Self::Tool, Self::Base];
}

/// Parts to fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FittedParts(Vec<Part>);

impl FittedParts {
    pub fn new(parts: &[Part]) -> Result<Self> {
        if parts.is_empty() {
            let known = Part::ALL.map(|part| format!("'{part}'")).join(", ");
            let problem = format!("nothing is to be fitted: name one or more of {known}");
            return Err(Error::Contradiction { problem: problem.into() });
        }
        Ok(Self(parts.to_vec()))
    }

    pub fn has(&self, part: Part) -> bool {
        self.0.contains(&part)
    }
}

/// Usual deviation of a real arm from its model: standard deviation of the prior.
///
/// The prior decides only what the measurements leave open: among all models that explain them alike, the nearest one by these
/// sizes is taken. They are generous (a hobby arm keeps them), so that they do not pull where the measurements speak.
pub(super) mod usual {
    /// Translation of a link's transform (m).
    pub const LINK_LENGTH: f64 = 0.02;
    /// Rotation of a link's transform (rad).
    pub const LINK_ANGLE: f64 = 0.03;
    /// Zero of a rotating joint (rad).
    pub const ANGLE_OFFSET: f64 = 0.2;
    /// Zero of a sliding joint (m).
    pub const SLIDE_OFFSET: f64 = 0.02;
    /// Poses whose start is a fit already: base, tool, camera, board, centre and plane (m and rad).
    pub const PLACEMENT: f64 = 1.0;
}

/// Quantity that a parameter changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Zero of this joint.
    Offset(usize),
    /// Correction of this number, along (0, 1, 2) or about (3, 4, 5) an axis of its frame.
    Correction { number: usize, direction: usize },
    /// Entry of the landmark: centre of the ball bar, or plane.
    Landmark(usize),
}

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FitParameter {
    pub name: String,
    /// True for an angle (rad), false for a length (m).
    pub is_angle: bool,
    /// Standard deviation of the prior.
    pub usual: f64,
    pub place: Place,
}

/// Names of the six directions of a correction.
pub(super) const DIRECTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Parameters of one correction; `directions` of them are free, translations first.
pub(super) fn of_correction(
    name: &str,
    number: usize,
    directions: usize,
    [length, angle]: [f64; 2],
) -> impl Iterator<Item = FitParameter> {
    (0..directions).map(move |direction| FitParameter {
        name: format!("{name} {}", DIRECTIONS[direction]),
        is_angle: direction > 2,
        usual: if direction > 2 { angle } else { length },
        place: Place::Correction { number, direction },
    })
}
