//! Cubic splines through waypoints.

use std::str::FromStr;

use super::joint_path::{JointPath, POWERS, check_waypoints};
use crate::error::{Error, Result, require_finite};
use crate::interrupt::checkpoint;
use crate::math::cubic_spline::{CubicSpline, SplineEnds};

impl FromStr for SplineEnds {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "natural" => Ok(Self::Natural),
            "not-a-knot" => Ok(Self::NotAKnot),
            "clamped" => Ok(Self::Clamped),
            _ => Err(Error::unknown_option("spline", name, &["natural", "not-a-knot", "clamped", "polyline"])),
        }
    }
}

impl JointPath {
    /// The cubic spline of `joints` (names) through `waypoints` (rad or m, one row of all joints per point) at the path
    /// parameters `knots`. `None` means uniform in \[0, 1\].
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::InvalidPath`] if a waypoint repeats the previous one,
    /// [`Error::NotIncreasing`] for knots.
    pub fn spline(joints: Vec<String>, waypoints: &[f64], knots: Option<&[f64]>, ends: SplineEnds) -> Result<Self> {
        let rows = check_waypoints(&joints, waypoints)?;
        let breaks = match knots {
            None => (0..rows).map(|row| row as f64 / (rows - 1) as f64).collect(),
            Some(knots) => check_knots(knots, rows)?,
        };
        let n = joints.len();
        let spline = CubicSpline::over(breaks, ends);
        let [mut values, mut curvatures] = [(); 2].map(|()| vec![0.0; rows]);
        let mut coefficients = vec![0.0; POWERS * (rows - 1) * n];
        for j in 0..n {
            values.iter_mut().zip(waypoints.chunks_exact(n)).for_each(|(value, row)| *value = row[j]);
            checkpoint()?;
            spline.curvatures(&values, &mut curvatures);
            for piece in 0..rows - 1 {
                let of_joint = spline.piece(piece, &values, &curvatures).coefficients();
                for (power, coefficient) in of_joint.into_iter().enumerate() {
                    coefficients[(POWERS * piece + power) * n + j] = coefficient;
                }
            }
        }
        let breaks = spline.knots().to_vec();
        let lengths = breaks.windows(2).map(|ends| ends[1] - ends[0]).collect();
        Ok(Self::from_parts(joints, breaks, lengths, coefficients))
    }
}

fn check_knots(knots: &[f64], rows: usize) -> Result<Vec<f64>> {
    if knots.len() != rows {
        let expected = format!("{rows} (one per waypoint)");
        return Err(Error::WrongLength { what: "knots".into(), expected, got: knots.len() });
    }
    require_finite("knots", knots, |row| format!("row {row}"))?;
    match (1..rows).find(|&row| knots[row] <= knots[row - 1]) {
        None => Ok(knots.to_vec()),
        Some(row) => {
            let (previous, value) = (knots[row - 1], knots[row]);
            Err(Error::NotIncreasing { what: "knots".into(), row, previous, value })
        }
    }
}
