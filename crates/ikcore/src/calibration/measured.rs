//! Measurements, one row per configuration.

use nalgebra::{Unit, Vector3};

use super::camera::PinholeCamera;
use super::landmark::Landmark;
use crate::error::{Error, Result, require_finite};
use crate::math::{Pose, pose};
use crate::robot::Robot;

/// Where the camera is that sees the poses or the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameraPlace {
    /// Beside the robot; the arm carries the board.
    Fixed,
    /// On the arm; the board is beside the robot.
    Hand,
}

crate::wording::words!("place of the camera": CameraPlace { Fixed => "fixed", Hand => "hand" });

/// Measurements of m configurations.
#[derive(Debug, Clone, PartialEq)]
pub enum Measured {
    /// Positions of the tip (m), m of them, in a frame of their own.
    Positions(Vec<[f64; 3]>),
    /// Poses of the tip in a frame of their own.
    Poses(Vec<Pose>),
    /// Poses of a board as a camera sees it.
    BoardPoses {
        /// Pose of the board in the frame of the camera.
        poses: Vec<Pose>,
        /// Where the camera is.
        camera: CameraPlace,
    },
    /// Image points of a board.
    Pixels {
        /// Points of the board, in its own frame (m).
        board: Vec<[f64; 3]>,
        /// Image points (pixels), one list per configuration and one entry per point of the board; NaN where a point is not seen.
        seen: Vec<Vec<[f64; 2]>>,
        /// The lens; distortion has been removed.
        lens: PinholeCamera,
        /// Where the camera is.
        camera: CameraPlace,
    },
    /// Distances of the tip from a fixed point (m): a ball bar. The point is a guess, fitted with the base.
    BallBar {
        /// Measured distances (m).
        distances: Vec<f64>,
        /// Fixed end of the bar in the frame of the robot's base (m).
        centre: [f64; 3],
    },
    /// Distances between the tip positions of two configurations (m), of m pairs.
    Pairs(Vec<f64>),
    /// Heights of the tip above a plane (m), zero for a contact. The plane is a guess, fitted with the base.
    Heights {
        /// Measured heights (m).
        heights: Vec<f64>,
        /// Normal of the plane, of any length but zero, in the frame of the robot's base.
        normal: [f64; 3],
        /// Height of the plane along its normal (m): normal . p for its points p.
        height: f64,
    },
}

impl Measured {
    /// Number of measurements.
    pub fn count(&self) -> usize {
        match self {
            Self::Positions(positions) => positions.len(),
            Self::Poses(poses) | Self::BoardPoses { poses, .. } => poses.len(),
            Self::Pixels { seen, .. } => seen.len(),
            Self::BallBar { distances: values, .. } | Self::Pairs(values) | Self::Heights { heights: values, .. } => {
                values.len()
            }
        }
    }

    /// Configurations in one measurement.
    pub fn configurations(&self) -> usize {
        if matches!(self, Self::Pairs(_)) { 2 } else { 1 }
    }

    /// Whether the measurements have an orientation.
    pub fn has_rotations(&self) -> bool {
        matches!(self, Self::Poses(_) | Self::BoardPoses { .. })
    }

    /// Whether the measurements are those of a camera.
    pub(super) fn camera(&self) -> Option<CameraPlace> {
        match self {
            Self::BoardPoses { camera, .. } | Self::Pixels { camera, .. } => Some(*camera),
            _ => None,
        }
    }

    /// Whether the measurements are of the point of the tip alone.
    pub(super) fn is_of_a_point(&self) -> bool {
        !matches!(self, Self::Poses(_) | Self::BoardPoses { .. } | Self::Pixels { .. })
    }

    pub(super) fn landmark(&self) -> Landmark {
        match self {
            Self::BallBar { centre, .. } => Landmark::Centre(Vector3::from(*centre)),
            Self::Heights { normal, height, .. } => {
                let normal = Vector3::from(*normal);
                Landmark::Plane { normal: Unit::new_normalize(normal), height: height / normal.norm() }
            }
            _ => Landmark::Nothing,
        }
    }

    /// Measurements of the same kind for `count` other configurations, of which only the derivatives are used.
    pub(super) fn like(&self, count: usize) -> Self {
        match self.clone() {
            Self::Positions(_) => Self::Positions(vec![[0.0; 3]; count]),
            Self::Poses(_) => Self::Poses(vec![Pose::identity(); count]),
            Self::BoardPoses { camera, .. } => Self::BoardPoses { poses: vec![Pose::identity(); count], camera },
            Self::Pixels { board, lens, camera, .. } => {
                Self::Pixels { seen: vec![vec![[0.0; 2]; board.len()]; count], board, lens, camera }
            }
            Self::BallBar { centre, .. } => Self::BallBar { distances: vec![1.0; count], centre },
            Self::Pairs(_) => Self::Pairs(vec![1.0; count]),
            Self::Heights { normal, height, .. } => Self::Heights { heights: vec![0.0; count], normal, height },
        }
    }

    /// Entries of the residual of one measurement.
    pub(super) fn rows(&self, index: usize) -> usize {
        match self {
            Self::Positions(_) => 3,
            Self::Poses(_) | Self::BoardPoses { .. } => 6,
            Self::Pixels { seen, .. } => 2 * seen[index].iter().filter(|point| point[0].is_finite()).count(),
            Self::BallBar { .. } | Self::Pairs(_) | Self::Heights { .. } => 1,
        }
    }

    /// Checks the numbers, and that there are as many as configurations `qs`.
    pub(super) fn check(&self, robot: &Robot, qs: &[f64]) -> Result<()> {
        let (n, each) = (robot.dof(), self.configurations());
        if qs.len() != self.count() * each * n {
            let what = format!("measurements of robot '{}'", robot.name());
            let expected = format!("{}, one for each configuration", qs.len() / n / each);
            return Err(Error::WrongLength { what: what.into(), expected, got: self.count() });
        }
        for (row, q) in qs.chunks(n).enumerate() {
            robot.check("joint angles", q).map_err(|error| Error::InRow { row: row / each, error: error.into() })?;
        }
        self.check_numbers()
    }

    fn check_numbers(&self) -> Result<()> {
        let finite = |values: &[f64]| require_finite("measurements", values, |row| format!("row {row}"));
        match self {
            Self::Positions(positions) => {
                let flat = positions.as_flattened();
                require_finite("measurements", flat, |i| format!("row {}, entry {}", i / 3, i % 3))
            }
            Self::Poses(poses) | Self::BoardPoses { poses, .. } => poses
                .iter()
                .enumerate()
                .try_for_each(|(row, measured)| pose::checked(&format!("pose {row}"), *measured).map(|_| ())),
            Self::Pixels { board, seen, lens, .. } => check_pixels(board, seen, lens),
            Self::BallBar { distances, centre } => {
                pose::finite("centre", *centre)?;
                finite(distances)?;
                positive("distance", distances)
            }
            Self::Pairs(distances) => {
                finite(distances)?;
                positive("distance", distances)
            }
            Self::Heights { heights, normal, height } => {
                pose::finite("normal of the plane", *normal)?;
                require_finite("height of the plane", &[*height], |_| "it".into())?;
                let length = Vector3::from(*normal).norm();
                if !(length > 0.0) {
                    return Err(Error::out_of_range("length of the plane's normal", "positive", length));
                }
                finite(heights)
            }
        }
    }
}

/// Checks distances, which cannot be negative.
fn positive(what: &str, values: &[f64]) -> Result<()> {
    match values.iter().position(|value| *value < 0.0) {
        None => Ok(()),
        Some(row) => Err(Error::out_of_range(format!("{what} of row {row}"), "zero or more", values[row])),
    }
}

/// Checks image points: each has two numbers, or two NaNs where it was not seen.
fn check_pixels(board: &[[f64; 3]], seen: &[Vec<[f64; 2]>], lens: &PinholeCamera) -> Result<()> {
    lens.validate()?;
    require_finite("board", board.as_flattened(), |i| format!("point {}, entry {}", i / 3, i % 3))?;
    for (row, points) in seen.iter().enumerate() {
        if points.len() != board.len() {
            let what = format!("image points of row {row}");
            let expected = format!("{}, one for each point of the board", board.len());
            return Err(Error::WrongLength { what: what.into(), expected, got: points.len() });
        }
        if let Some(entry) =
            points.iter().position(|[u, v]| u.is_nan() != v.is_nan() || u.is_infinite() || v.is_infinite())
        {
            let [u, v] = points[entry];
            let value = if u.is_finite() { v } else { u };
            let place = format!("point {entry} of row {row} (give NaN twice for a point that was not seen)");
            return Err(Error::NotFinite { what: "image points".into(), place, value });
        }
        let count = points.iter().filter(|point| point[0].is_finite()).count();
        if count < 4 {
            let problem =
                format!("row {row} sees {count} points of the board; at least 4 are needed: leave the row out");
            return Err(Error::InvalidMeasurement { problem: problem.into() });
        }
    }
    Ok(())
}
