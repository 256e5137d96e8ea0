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
pub(super) struct ResidualScratch {
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
    pub fn write(&self, index: usize, estimate: &Estimate, scratch: &mut ResidualScratch, block: &mut Block) {
        scratch.columns.resize(self.model.parameters.len(), [0.0; 6]);
        self.write_columns(index, estimate, scratch, block);
    }

    /// Writes the residual of measurement `index`, and no Jacobian.
    pub fn write_residual(&self, index: usize, estimate: &Estimate, scratch: &mut ResidualScratch, block: &mut Block) {
        scratch.columns.clear();
        self.write_columns(index, estimate, scratch, block);
    }

    /// Writes the residual of measurement `index`, and the derivatives of as many parameters as there are columns: all or none.
    fn write_columns(&self, index: usize, estimate: &Estimate, scratch: &mut ResidualScratch, block: &mut Block) {
        let ResidualScratch { marks, columns } = scratch;
        block.residual.clear();
        block.jacobian.clear();
        let q = self.configurations(index);
        let tip = self.model.tip(estimate, &q[..self.dof], marks);
        self.model.derivatives(&tip, marks, columns);
        let point = tip.translation.vector;
        match self.measured {
            Measured::Positions(positions) => {
                block.push_difference(&(point - Vector3::from(positions[index])), columns, 0)
            }
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
                let mut others = vec![[0.0; 6]; columns.len()];
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
                    slope.x * c[0]
                        + slope.y * c[1]
                        + slope.z * c[2]
                        + turning.x * c[3]
                        + turning.y * c[4]
                        + turning.z * c[5]
                };
                self.jacobian.extend(columns.iter().map(of));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::arm_model::{CameraFrames, FreeEnds};
    use crate::calibration::parameters::{FitParameter, FittedParts, Part, usual};
    use crate::math::pose;
    use crate::rng::stream;
    use crate::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};

    const PINHOLE: PinholeCamera = PinholeCamera { focal: [600.0, 610.0], centre: [320.0, 240.0] };

    /// A joint that drives two axes, a slide right behind a turn, and transforms beside links.
    fn odd_arm() -> Robot {
        let mut arm = ChainBuilder::new("odd", "base");
        let joints = ["turn", "slide", "swing"].map(|name| {
            let kind = if name == "slide" { JointKind::Prismatic } else { JointKind::Revolute };
            arm.add_joint(Joint::new(name, kind).with_range(-1.5, 1.5))
        });
        arm.fixed(pose::from_rpy([0.1, 0.2, 0.3], [0.0, 0.1, 0.2]));
        arm.moving(joints[0], JointKind::Revolute, Vector3::new(0.0, 1.0, 1.0), Drive { scale: -1.0, offset: 0.2 });
        arm.moving(joints[1], JointKind::Prismatic, Vector3::x(), Drive { scale: 0.5, offset: 0.1 });
        arm.link("middle");
        arm.fixed(pose::from_rpy([0.0, 0.7, 0.0], [0.3, 0.0, 0.1]));
        arm.fixed(pose::translation(0.1, 0.0, 0.0));
        arm.moving(joints[2], JointKind::Revolute, Vector3::z(), Drive::DIRECT);
        arm.fixed(pose::translation(0.3, 0.1, 0.0));
        arm.moving(joints[0], JointKind::Revolute, Vector3::y(), Drive { scale: 0.5, offset: 0.0 });
        arm.link("tip");
        arm.build().expect("a robot")
    }

    fn kinds() -> Vec<Measured> {
        let near = pose::from_rpy([0.3, -0.2, 2.0], [0.1, 0.2, 0.9]);
        let board = vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.02], [0.1, 0.1, 0.0]];
        let mut kinds = vec![
            Measured::Positions(vec![[0.1, -0.2, 0.3]]),
            Measured::Poses(vec![near]),
            Measured::BallBar { distances: vec![0.4], centre: [0.5, -0.3, 0.1] },
            Measured::Pairs(vec![0.4]),
            Measured::Heights { heights: vec![0.01], normal: [0.2, -0.1, 2.0], height: 0.3 },
        ];
        for camera in [CameraPlace::Fixed, CameraPlace::Hand] {
            kinds.push(Measured::BoardPoses { poses: vec![near], camera });
            let seen = vec![vec![[100.0, 90.0], [f64::NAN; 2], [300.0, 200.0], [320.0, 240.0]]];
            kinds.push(Measured::Pixels { board: board.clone(), seen, lens: PINHOLE, camera });
        }
        kinds
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        for robot in [odd_arm(), Robot::named("panda").expect("built in")] {
            for measured in kinds() {
                let outside = measured.camera().map(|_| CameraFrames {
                    before: (pose::from_rpy([0.2, 0.1, -0.4], [0.1, -0.1, 2.0]), "camera"),
                    after: (pose::from_rpy([0.0, 0.3, 0.1], [0.02, 0.01, 0.1]), "board"),
                });
                let parts = FittedParts::new(&Part::ALL).expect("parts");
                let mut model = ArmModel::new(&robot, &parts, FreeEnds { base: 6, tool: 6 }, outside);
                for (entry, (name, is_angle)) in measured.landmark().parameters().iter().enumerate() {
                    let place = Place::Landmark(entry);
                    let usual = usual::PLACEMENT;
                    model.parameters.push(FitParameter { name: (*name).into(), is_angle: *is_angle, usual, place });
                }
                let qs = robot.random_configurations(2, &mut stream(3, 0)).expect("configurations");
                let qs = &qs[..measured.configurations() * robot.dof()];
                check(&Comparison { model: &model, measured: &measured, qs, dof: robot.dof() }, robot.dof());
            }
        }
    }

    fn check(comparison: &Comparison<'_>, dof: usize) {
        let parameters = &comparison.model.parameters;
        let nominal = Estimate {
            corrections: comparison.model.corrections(),
            offsets: vec![0.0; dof],
            landmark: comparison.measured.landmark(),
        };
        let away: Vec<f64> = (0..parameters.len()).map(|k| 0.02 * ((k * 7 % 5) as f64 - 2.0)).collect();
        let estimate = nominal.stepped(parameters, &away);
        let (mut scratch, mut block, mut moved) = (ResidualScratch::default(), Block::default(), Block::default());
        comparison.write(0, &estimate, &mut scratch, &mut block);
        let n = parameters.len();
        for k in 0..n {
            let h = 1e-6;
            let mut beside = |sign: f64| {
                let mut step = vec![0.0; n];
                step[k] = sign * h;
                comparison.write(0, &estimate.stepped(parameters, &step), &mut scratch, &mut moved);
                moved.residual.clone()
            };
            let (after, before) = (beside(1.0), beside(-1.0));
            for row in 0..block.residual.len() {
                let difference = (after[row] - before[row]) / (2.0 * h);
                let slope = block.jacobian[row * n + k];
                let name = &parameters[k].name;
                let rounding = 4.0 * f64::EPSILON * block.residual[row].abs() / h;
                let error = (difference - slope).abs();
                assert!(error < 1e-6 * (1.0 + slope.abs()) + rounding, "{name} {row}: {difference} {slope}");
            }
        }
    }
}
