//! Hydraulic arm with two revolute joints and one prismatic joint.

use nalgebra::Vector3;

use crate::error::Result;
use crate::math::pose;
use crate::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};

/// Lengths L1 and L2 (m): half of the swing arm radius of Table 1, 1.4 m, each.
const LENGTH: f64 = 0.7;

/// 2R1P arm of "Trajectory tracking of redundant manipulator based on PSO algorithm optimization", in the x-y plane:
///
/// x = L1 cos q1 + (L2 + q3) cos(q1 - q2) (eq. 1), y = L1 sin q1 + (L2 + q3) sin(q1 - q2) (eq. 2).
///
/// The upper limit of joint 3 and the lower limits are those printed in the paper's experiment; the upper limits of joints 1
/// and 2 are not printed, and assumed symmetric to the lower ones. Speeds are 0.8 m/s for the prismatic joint, from Table 1,
/// and 1 rad/s for the other joints.
pub(super) fn hydraulic3() -> Result<Robot> {
    let mut arm = ChainBuilder::new("hydraulic3", "base");
    let swing = Joint::new("joint_1", JointKind::Revolute).with_range(-1.2, 1.2).with_velocity(1.0);
    let bend = Joint::new("joint_2", JointKind::Revolute).with_range(-0.96, 0.96).with_velocity(1.0);
    let slide = Joint::new("joint_3", JointKind::Prismatic).with_range(0.0, 0.3).with_velocity(0.8);
    let (swing, bend, slide) = (arm.add_joint(swing), arm.add_joint(bend), arm.add_joint(slide));

    arm.moving(swing, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    arm.link("link_1");
    arm.fixed(pose::translation(LENGTH, 0.0, 0.0));
    arm.moving(bend, JointKind::Revolute, -Vector3::z(), Drive::DIRECT);
    arm.link("link_2");
    arm.fixed(pose::translation(LENGTH, 0.0, 0.0));
    arm.moving(slide, JointKind::Prismatic, Vector3::x(), Drive::DIRECT);
    arm.link("tip");
    arm.build()
}
