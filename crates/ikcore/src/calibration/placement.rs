//! Placement of base and tool, or of camera and board, before the fit.

use nalgebra::Vector3;

use super::arm_model::CameraFrames;
use super::board_pose::board_pose;
use super::measured::{CameraPlace, Measured};
use super::start::{aligned, both_ends, first_end};
use crate::error::Result;
use crate::math::Pose;
use crate::robot::Robot;

/// Start of the poses of camera and board; none without a camera.
pub(super) fn outside_start(robot: &Robot, qs: &[f64], measured: &Measured) -> Result<Option<CameraFrames>> {
    let (poses, camera) = match measured {
        Measured::BoardPoses { poses, camera } => (poses.clone(), *camera),
        Measured::Pixels { board, seen, lens, camera } => {
            (seen.iter().map(|points| board_pose(board, points, lens)).collect(), *camera)
        }
        _ => return Ok(None),
    };
    let beside: Vec<Pose> = match camera {
        CameraPlace::Fixed => poses,
        CameraPlace::Hand => poses.iter().map(Pose::inverse).collect(),
    };
    let [before, after] = both_ends(&tips(robot, qs), &beside);
    let names = match camera {
        CameraPlace::Fixed => ["camera", "board"],
        CameraPlace::Hand => ["board", "camera"],
    };
    Ok(Some(CameraFrames { before: (before, names[0]), after: (after, names[1]) }))
}

/// Copy of the robot with the base and tool that are to be fitted placed by closed form, if that is better than as they are.
pub(super) fn placed_ends(robot: &Robot, qs: &[f64], measured: &Measured, [base, tool]: [bool; 2]) -> Result<Robot> {
    let found = match (measured, base, tool) {
        (Measured::Positions(positions), true, _) => {
            let points: Vec<Vector3<f64>> = tips(robot, qs).iter().map(|tip| tip.translation.vector).collect();
            let measured: Vec<Vector3<f64>> = positions.iter().map(|p| Vector3::from(*p)).collect();
            robot.with_geometry(
                robot.elements().to_vec(),
                aligned(&points, &measured).pose * robot.base(),
                *robot.tool(),
            )?
        }
        (Measured::Poses(poses), true, true) => {
            let [before, after] = both_ends(&tips(robot, qs), poses);
            robot.with_geometry(robot.elements().to_vec(), before * robot.base(), robot.tool() * after)?
        }
        (Measured::Poses(poses), true, false) => {
            let before = first_end(&tips(robot, qs), poses);
            robot.with_geometry(robot.elements().to_vec(), before * robot.base(), *robot.tool())?
        }
        (Measured::Poses(poses), false, true) => {
            let back = |poses: &[Pose]| poses.iter().map(Pose::inverse).collect::<Vec<_>>();
            let after = first_end(&back(&tips(robot, qs)), &back(poses)).inverse();
            robot.with_geometry(robot.elements().to_vec(), *robot.base(), robot.tool() * after)?
        }
        _ => return Ok(robot.clone()),
    };
    let better = median_error(&found, qs, measured) < 0.5 * median_error(robot, qs, measured);
    Ok(if better { found } else { robot.clone() })
}

/// Median of the errors of position and, as for an arm a metre long, rotation.
fn median_error(robot: &Robot, qs: &[f64], measured: &Measured) -> f64 {
    let tips = tips(robot, qs);
    let mut errors: Vec<f64> = match measured {
        Measured::Positions(positions) => {
            tips.iter().zip(positions).map(|(tip, p)| (tip.translation.vector - Vector3::from(*p)).norm()).collect()
        }
        Measured::Poses(poses) => {
            let apart = |(tip, pose): (&Pose, &Pose)| {
                (tip.translation.vector - pose.translation.vector).norm() + tip.rotation.angle_to(&pose.rotation)
            };
            tips.iter().zip(poses).map(apart).collect()
        }
        _ => vec![0.0],
    };
    errors.sort_by(f64::total_cmp);
    errors[errors.len() / 2]
}

/// Poses of the tip at each configuration.
fn tips(robot: &Robot, qs: &[f64]) -> Vec<Pose> {
    qs.chunks(robot.dof()).map(|q| Pose::from(robot.tip(q))).collect()
}
