//! Measurements that cannot be right: too few, all alike, in millimetres or degrees, from a mirrored frame.

use nalgebra::Vector3;

use super::measured::Measured;
use super::start::{Alignment, aligned};
use crate::error::{Error, Result};
use crate::message::Message;
use crate::robot::Robot;
use crate::wording::number;

/// Motion of a joint (rad or m) that counts as rest.
const STILL: f64 = 1e-6;
/// Angles beyond this are not written in radians (rad): more than two turns.
const MANY_TURNS: f64 = 13.0;
/// Part of the error that a mirror image leaves if the measured frame is left-handed.
const MIRRORED: f64 = 0.2;
/// Flatness of points from which a mirror image is another shape.
const SOLID: f64 = 0.02;
/// Factors of a wrong unit of length, and its name.
const UNITS: [(f64, &str); 3] = [(1000.0, "millimetres"), (100.0, "centimetres"), (39.37, "inches")];
/// Likeness of the measured shape and the arm's from which their sizes are compared.
const ALIKE: f64 = 0.9;
/// Tolerance of these factors.
const NEAR: f64 = 0.2;

fn invalid(problem: impl Into<Message>) -> Error {
    Error::InvalidMeasurement { problem: problem.into() }
}

/// Checks the configurations: they differ, and are in radians.
pub(super) fn check_configurations(robot: &Robot, measured: &Measured, qs: &[f64]) -> Result<()> {
    let n = robot.dof();
    let count = measured.count();
    if count < 2 {
        let noun = if count == 1 { "measurement" } else { "measurements" };
        return Err(invalid(format!("{count} {noun}: two or more are needed")));
    }
    let widest = (0..n).map(|joint| range(qs, n, joint)).fold(0.0, f64::max);
    if widest < STILL {
        let problem = "all configurations are alike: move the arm between measurements, each joint over as much of its range as possible";
        return Err(invalid(problem));
    }
    for (joint, described) in robot.joints().iter().enumerate().filter(|(_, joint)| joint.kind.turns()) {
        let largest = qs.chunks(n).map(|q| q[joint].abs()).fold(0.0, f64::max);
        let limit = described.lower.abs().max(described.upper.abs());
        if largest > MANY_TURNS && largest > 2.0 * limit && largest.to_radians() <= 1.1 * limit {
            let (name, largest) = (&described.name, number(largest));
            return Err(invalid(format!(
                "joint '{name}' reaches {largest} rad, far beyond its limits: angles are in radians, and these look like degrees"
            )));
        }
    }
    Ok(())
}

/// Names of joints that were the same in all measurements.
pub(super) fn still_joints(robot: &Robot, qs: &[f64]) -> Vec<String> {
    let n = robot.dof();
    let still = (0..n).filter(|joint| range(qs, n, *joint) < STILL);
    still.map(|joint| robot.joints()[joint].name.clone()).collect()
}

fn range(qs: &[f64], n: usize, joint: usize) -> f64 {
    let values = || qs.chunks(n).map(|q| q[joint]);
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

/// Checks the measured lengths against the arm's.
pub(super) fn check_lengths(robot: &Robot, measured: &Measured, qs: &[f64]) -> Result<()> {
    let n = robot.dof();
    let tip = |q: &[f64]| Vector3::from(robot.tip_position(q));
    match measured {
        Measured::Positions(positions) => {
            let tips: Vec<_> = qs.chunks(n).map(tip).collect();
            let measured: Vec<_> = positions.iter().map(|p| Vector3::from(*p)).collect();
            check_alignment(&aligned(&tips, &measured))
        }
        Measured::Poses(poses) => {
            let tips: Vec<_> = qs.chunks(n).map(tip).collect();
            let measured: Vec<_> = poses.iter().map(|pose| pose.translation.vector).collect();
            check_spread(&aligned(&tips, &measured))
        }
        Measured::BallBar { distances, centre } => {
            let centre = Vector3::from(*centre);
            check_distances(distances, qs.chunks(n).map(|q| (tip(q) - centre).norm()))
        }
        Measured::Pairs(distances) => {
            check_distances(distances, qs.chunks(2 * n).map(|q| (tip(&q[..n]) - tip(&q[n..])).norm()))
        }
        Measured::BoardPoses { .. } | Measured::Pixels { .. } | Measured::Heights { .. } => Ok(()),
    }
}

fn check_alignment(alignment: &Alignment) -> Result<()> {
    check_spread(alignment)?;
    let Alignment { rms, mirrored_rms, flatness, .. } = alignment;
    if *flatness > SOLID && *mirrored_rms < MIRRORED * rms {
        let (rms, mirrored) = (number(*rms), number(*mirrored_rms));
        return Err(invalid(format!(
            "the measured frame is mirrored: a mirror image of it fits the arm to {mirrored} m, and it itself to {rms} m; reverse the sign of one coordinate, or swap two"
        )));
    }
    Ok(())
}

/// Checks the size of the measured shape, if it is that of the arm's.
fn check_spread(alignment: &Alignment) -> Result<()> {
    if alignment.likeness < ALIKE {
        return Ok(());
    }
    check_unit(alignment.scale, "the measured positions spread")
}

fn check_distances(distances: &[f64], predicted: impl Iterator<Item = f64>) -> Result<()> {
    let mut ratios: Vec<f64> = distances.iter().zip(predicted).map(|(d, p)| d / p.max(1e-9)).collect();
    ratios.sort_by(f64::total_cmp);
    let quarter = ratios.len() / 4;
    let [first, last] = [ratios[quarter], ratios[ratios.len() - 1 - quarter]];
    if last - first > NEAR * last {
        return Ok(());
    }
    check_unit(ratios[ratios.len() / 2], "the measured distances are")
}

fn check_unit(scale: f64, what: &str) -> Result<()> {
    match UNITS.into_iter().find(|(factor, _)| (scale / factor - 1.0).abs() < NEAR) {
        None => Ok(()),
        Some((factor, unit)) => Err(invalid(format!(
            "{what} {} times as far as the arm moves: lengths are in metres, and these look like {unit}; divide by {factor}",
            number(scale)
        ))),
    }
}
