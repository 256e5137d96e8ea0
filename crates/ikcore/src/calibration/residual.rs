//! Residuals of one measurement and their Jacobian by the parameters.

use nalgebra::Vector3;

use super::arm_model::{ArmModel, Marks};
use super::camera::PinholeCamera;
use super::estimate::Estimate;
use super::landmark::{Landmark, tangents};
use super::measured::{CameraPlace, Measured};
use super::parameters::Place;
use crate::math::{Frame, Pose, so3};

/// Residuals, predicted minus measured, with one row of the Jacobian each.
#[derive(Debug, Clone, Default)]
pub(super) struct Block {
    pub residual: Vec<f64>,
    /// Row-major, one column per parameter.
    pub jacobian: Vec<f64>,
}

/// Entries of a residual that are lengths come first; the others are angles.
pub(super) const LENGTHS: usize = 3;

/// Scratch memory of the derivatives.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    marks: Marks,
    columns: Vec<[f64; 6]>,
}

/// The model with its measurements.
pub(super) struct Comparison<'a> {
    pub model: &'a ArmModel,
    pub measured: &'a Measured,
    pub qs: &'a [f64],
    /// Joints of the robot.
    pub dof: usize,
}

impl Comparison<'_> {
    /// The configurations of one measurement.
    fn configurations(&self, index: usize) -> &[f64] {
        let width = self.dof * self.measured.configurations();
        &self.qs[index * width..][..width]
    }

    /// Writes residual and Jacobian of measurement `index`.
    pub fn write(&self, index: usize, estimate: &Estimate, scratch: &mut Scratch, block: &mut Block) {
        let unknowns = self.model.parameters.len();
        let Scratch { marks, columns } = scratch;
        columns.resize(unknowns, [0.0; 6]);
        block.residual.clear();
        block.jacobian.clear();
        let q = self.configurations(index);
        let tip = self.model.tip(estimate, &q[..self.dof], marks);
        self.model.derivatives(&tip, marks, columns);
        let point = tip.translation.vector;
        match self.measured {
            Measured::Positions(positions) => block.push_difference(&(point - Vector3::from(positions[index])), columns, 0),
            Measured::Poses(poses) => block.push_pose(&tip, columns, &poses[index]),
            Measured::BoardPoses { poses, camera } => {
                let seen = as_seen(tip, columns, *camera);
                block.push_pose(&seen, columns, &poses[index]);
            }
            Measured::Pixels { board, seen, lens, camera } => {
                let pose = as_seen(tip, columns, *camera);
                block.push_pixels(&pose, columns, board, &seen[index], lens);
            }
            Measured::BallBar { distances, .. } => {
                let Landmark::Centre(centre) = &estimate.landmark else { return };
                let direction = unit(&(point - centre));
                block.push_distance(&direction, columns, (point - centre).norm() - distances[index]);
                self.add_landmark(block, |entry| -direction[entry]);
            }
            Measured::Pairs(distances) => {
                let other = self.model.tip(estimate, &q[self.dof..], marks);
                let mut others = vec![[0.0; 6]; unknowns];
                self.model.derivatives(&other, marks, &mut others);
                for (column, other) in columns.iter_mut().zip(&others) {
                    column.iter_mut().zip(other).for_each(|(entry, other)| *entry -= other);
                }
                let between = point - other.translation.vector;
                block.push_distance(&unit(&between), columns, between.norm() - distances[index]);
            }
            Measured::Heights { heights, .. } => {
                let Landmark::Plane { normal, height } = &estimate.landmark else { return };
                block.push_distance(normal, columns, normal.dot(&point) - height - heights[index]);
                let [first, second] = tangents(normal);
                let slopes = [-1.0, first.cross(normal).dot(&point), second.cross(normal).dot(&point)];
                self.add_landmark(block, |entry| slopes[entry]);
            }
        }
    }

    /// Adds the derivatives by the landmark to the only row.
    fn add_landmark(&self, block: &mut Block, slope: impl Fn(usize) -> f64) {
        for (entry, parameter) in block.jacobian.iter_mut().zip(&self.model.parameters) {
            if let Place::Landmark(of) = parameter.place {
                *entry += slope(of);
            }
        }
    }
}

/// Pose of the board in the camera's frame, from that of the arm's end in the frame of what is beside the arm; changes the columns
/// likewise.
fn as_seen(tip: Pose, columns: &mut [[f64; 6]], camera: CameraPlace) -> Pose {
    if camera == CameraPlace::Fixed {
        return tip;
    }
    let (back, point) = (tip.rotation.inverse(), tip.translation.vector);
    for column in columns {
        let [vx, vy, vz, wx, wy, wz] = *column;
        let (v, w) = (Vector3::new(vx, vy, vz), Vector3::new(wx, wy, wz));
        // Derivative of -R'p, and of R' as a turn on the left.
        let linear = back * (w.cross(&point) - v);
        let angular = back * -w;
        *column = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z];
    }
    tip.inverse()
}

fn unit(v: &Vector3<f64>) -> Vector3<f64> {
    v.try_normalize(1e-12).unwrap_or_else(Vector3::x)
}

impl Block {
    /// Appends three rows: a difference, whose derivatives are three entries of each column from `from` on.
    fn push_difference(&mut self, difference: &Vector3<f64>, columns: &[[f64; 6]], from: usize) {
        self.residual.extend(difference.iter());
        for row in 0..3 {
            self.jacobian.extend(columns.iter().map(|column| column[from + row]));
        }
    }

    fn push_pose(&mut self, pose: &Pose, columns: &mut [[f64; 6]], measured: &Pose) {
        self.push_difference(&(pose.translation.vector - measured.translation.vector), columns, 0);
        let turn = so3::rotation_between(&Frame::from(measured), &Frame::from(pose));
        // The logarithm follows a turn on the left by the inverse of its left Jacobian, which is that of the right one at -phi.
        let by = so3::inverse_right_jacobian(&turn.map(|entry| -entry));
        for column in columns.iter_mut() {
            let w = [column[3], column[4], column[5]];
            for row in 0..3 {
                column[3 + row] = (0..3).map(|k| by[k][row] * w[k]).sum();
            }
        }
        self.push_difference(&Vector3::from(turn), columns, 3);
    }

    /// Appends one row: a length, whose derivative is along `direction`.
    fn push_distance(&mut self, direction: &Vector3<f64>, columns: &[[f64; 6]], residual: f64) {
        self.residual.push(residual);
        let along = |c: &[f64; 6]| direction.x * c[0] + direction.y * c[1] + direction.z * c[2];
        self.jacobian.extend(columns.iter().map(along));
    }

    /// Appends two rows for each point that was seen.
    fn push_pixels(
        &mut self,
        pose: &Pose,
        columns: &[[f64; 6]],
        board: &[[f64; 3]],
        seen: &[[f64; 2]],
        lens: &PinholeCamera,
    ) {
        for (point, at) in board.iter().zip(seen).filter(|(_, at)| at[0].is_finite()) {
            let arm = pose.rotation * Vector3::from(*point);
            let (image, slopes) = lens.image(&(pose.translation.vector + arm));
            for row in 0..2 {
                self.residual.push(image[row] - at[row]);
                let slope = Vector3::new(slopes[(row, 0)], slopes[(row, 1)], slopes[(row, 2)]);
                // The point moves by v + w x arm.
                let turning = arm.cross(&slope);
                let of = |c: &[f64; 6]| {
                    slope.x * c[0] + slope.y * c[1] + slope.z * c[2]
                        + turning.x * c[3] + turning.y * c[4] + turning.z * c[5]
                };
                self.jacobian.extend(columns.iter().map(of));
            }
        }
    }
}
