//! Arms of Franka Robotics.

use super::arm::{Arm, radians, row};
use crate::load::dh::Dh::Modified;

/// Distance of the flange from frame 7 (m).
const FLANGE: f64 = 0.107;

/// Franka Emika Robot (Panda): modified DH parameters and joint limits, including jerk, from the maker's control interface
/// documentation, "Robot and interface specifications".
pub(super) const PANDA: Arm = Arm {
    convention: Modified,
    base_roll: 0.0,
    joint_names: &[
        "panda_joint1",
        "panda_joint2",
        "panda_joint3",
        "panda_joint4",
        "panda_joint5",
        "panda_joint6",
        "panda_joint7",
    ],
    joints: &[
        row(0.0, 0.0, 0.333, 0.0, radians(-2.8973, 2.8973, 2.175).rated(15.0, 7500.0)),
        row(0.0, -90.0, 0.0, 0.0, radians(-1.7628, 1.7628, 2.175).rated(7.5, 3750.0)),
        row(0.0, 90.0, 0.316, 0.0, radians(-2.8973, 2.8973, 2.175).rated(10.0, 5000.0)),
        row(0.0825, 90.0, 0.0, 0.0, radians(-3.0718, -0.0698, 2.175).rated(12.5, 6250.0)),
        row(-0.0825, -90.0, 0.384, 0.0, radians(-2.8973, 2.8973, 2.61).rated(15.0, 7500.0)),
        row(0.0, 90.0, 0.0, 0.0, radians(-0.0175, 3.7525, 2.61).rated(20.0, 10000.0)),
        row(0.088, 90.0, 0.0, 0.0, radians(-2.8973, 2.8973, 2.61).rated(20.0, 10000.0)),
    ],
    flange: FLANGE,
};

/// Franka Research 3: the geometry of the Panda with its own joint limits, including jerk, from the same document (its table
/// for the FR3); `rate_limiting.h` of libfranka 0.10 and later has the same accelerations and jerks.
pub(super) const FR3: Arm = Arm {
    convention: Modified,
    base_roll: 0.0,
    joint_names: &["fr3_joint1", "fr3_joint2", "fr3_joint3", "fr3_joint4", "fr3_joint5", "fr3_joint6", "fr3_joint7"],
    joints: &[
        row(0.0, 0.0, 0.333, 0.0, radians(-2.7437, 2.7437, 2.62).rated(10.0, 5000.0)),
        row(0.0, -90.0, 0.0, 0.0, radians(-1.7837, 1.7837, 2.62).rated(10.0, 5000.0)),
        row(0.0, 90.0, 0.316, 0.0, radians(-2.9007, 2.9007, 2.62).rated(10.0, 5000.0)),
        row(0.0825, 90.0, 0.0, 0.0, radians(-3.0421, -0.1518, 2.62).rated(10.0, 5000.0)),
        row(-0.0825, -90.0, 0.384, 0.0, radians(-2.8065, 2.8065, 5.26).rated(10.0, 5000.0)),
        row(0.0, 90.0, 0.0, 0.0, radians(0.5445, 4.5169, 4.18).rated(10.0, 5000.0)),
        row(0.088, 90.0, 0.0, 0.0, radians(-3.0159, 3.0159, 5.26).rated(10.0, 5000.0)),
    ],
    flange: FLANGE,
};
