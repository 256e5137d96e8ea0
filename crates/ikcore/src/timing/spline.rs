//! Cubic splines through waypoints.

use std::borrow::Cow;
use std::str::FromStr;

use super::joint_path::{JointPath, NEGLIGIBLE_LENGTH, POWERS, waypoint_rows};
use crate::error::{Error, Result, require_finite};
use crate::interrupt::checkpoint;
use crate::math::cubic_spline::{CubicSpline, SplineEnds};
use crate::math::vector::largest_difference;

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
    /// parameters `knots`. `None` means uniform in \[0, 1\]. Consecutive rows that are equal, to 1e-12 of the path's extent, are one row: a
    /// rest has no length.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::InvalidPath`] where all waypoints are the same,
    /// [`Error::NotIncreasing`] for knots.
    pub fn spline(joints: Vec<String>, waypoints: &[f64], knots: Option<&[f64]>, ends: SplineEnds) -> Result<Self> {
        let given = waypoint_rows(&joints, waypoints)?;
        let knots = knots.map(|knots| check_knots(knots, given)).transpose()?;
        let kept = rows_that_differ(waypoints, joints.len());
        if kept.len() < 2 {
            let problem = "all waypoints are the same: give at least two that differ".into();
            return Err(Error::InvalidPath { problem });
        }
        let (waypoints, rows) = (of_rows(waypoints, joints.len(), &kept), kept.len());
        let breaks = match knots {
            None => (0..rows).map(|row| row as f64 / (rows - 1) as f64).collect(),
            Some(knots) => without_rests(knots, &kept),
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

/// Indices of the rows that differ, by more than rounding, from the row kept before them, and of the first.
fn rows_that_differ(waypoints: &[f64], n: usize) -> Vec<usize> {
    let row = |i: usize| &waypoints[i * n..(i + 1) * n];
    let rows = waypoints.len() / n;
    let extent = (1..rows).map(|i| largest_difference(row(i), row(0))).fold(0.0, f64::max);
    let mut kept = vec![0];
    for i in 1..rows {
        if largest_difference(row(i), row(kept[kept.len() - 1])) > NEGLIGIBLE_LENGTH * extent {
            kept.push(i);
        }
    }
    kept
}

/// The kept rows, without a copy if these are all.
fn of_rows<'a>(waypoints: &'a [f64], n: usize, kept: &[usize]) -> Cow<'a, [f64]> {
    if kept.len() * n == waypoints.len() {
        return Cow::Borrowed(waypoints);
    }
    Cow::Owned(kept.iter().flat_map(|&row| &waypoints[row * n..(row + 1) * n]).copied().collect())
}

/// Knots of the kept rows, moved together by the rests between them.
fn without_rests(knots: &[f64], kept: &[usize]) -> Vec<f64> {
    if kept.len() == knots.len() {
        return knots.to_vec();
    }
    let mut at = knots[0];
    let moved = kept[1..].iter().map(|&row| {
        at += knots[row] - knots[row - 1];
        at
    });
    std::iter::once(knots[0]).chain(moved).collect()
}

fn check_knots(knots: &[f64], rows: usize) -> Result<&[f64]> {
    if knots.len() != rows {
        let expected = format!("{rows} (one per waypoint)");
        return Err(Error::WrongLength { what: "knots".into(), expected, got: knots.len() });
    }
    require_finite("knots", knots, |row| format!("row {row}"))?;
    match (1..rows).find(|&row| knots[row] <= knots[row - 1]) {
        None => Ok(knots),
        Some(row) => {
            let (previous, value) = (knots[row - 1], knots[row]);
            Err(Error::NotIncreasing { what: "knots".into(), row, previous, value })
        }
    }
}
