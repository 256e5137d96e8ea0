//! Arms of Universal Robots: standard DH parameters of the maker's article "DH parameters for calculations of kinematics and
//! dynamics", joint ranges and speeds of the data sheets. Frame 0 is the maker's base frame; the base frame of the ROS
//! descriptions is rotated by 180 degrees about z.

use super::arm::{Arm, JointRange, degrees, endless, row};
use crate::load::dh::Dh::Standard;

/// Joint names of the maker's ROS descriptions.
const JOINTS: [&str; 6] =
    ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"];

/// Creates the limits of a joint with a range of two full turns, with the speed in degrees per second.
const fn two_turns(speed: f64) -> JointRange {
    degrees(-360.0, 360.0, speed)
}

/// UR3e, whose last joint is continuous.
pub(super) const UR3E: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &JOINTS,
    joints: &[
        row(0.0, 90.0, 0.15185, 0.0, two_turns(180.0)),
        row(-0.24355, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(-0.2132, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(0.0, 90.0, 0.13105, 0.0, two_turns(360.0)),
        row(0.0, -90.0, 0.08535, 0.0, two_turns(360.0)),
        row(0.0, 0.0, 0.0921, 0.0, endless(360.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// UR5 (CB series, third version).
pub(super) const UR5: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &JOINTS,
    joints: &[
        row(0.0, 90.0, 0.089159, 0.0, two_turns(180.0)),
        row(-0.425, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(-0.39225, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(0.0, 90.0, 0.10915, 0.0, two_turns(180.0)),
        row(0.0, -90.0, 0.09465, 0.0, two_turns(180.0)),
        row(0.0, 0.0, 0.0823, 0.0, two_turns(180.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// UR5e.
pub(super) const UR5E: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &JOINTS,
    joints: &[
        row(0.0, 90.0, 0.1625, 0.0, two_turns(180.0)),
        row(-0.425, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(-0.3922, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(0.0, 90.0, 0.1333, 0.0, two_turns(180.0)),
        row(0.0, -90.0, 0.0997, 0.0, two_turns(180.0)),
        row(0.0, 0.0, 0.0996, 0.0, two_turns(180.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// UR10 (CB series).
pub(super) const UR10: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &JOINTS,
    joints: &[
        row(0.0, 90.0, 0.1273, 0.0, two_turns(120.0)),
        row(-0.612, 0.0, 0.0, 0.0, two_turns(120.0)),
        row(-0.5723, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(0.0, 90.0, 0.163941, 0.0, two_turns(180.0)),
        row(0.0, -90.0, 0.1157, 0.0, two_turns(180.0)),
        row(0.0, 0.0, 0.0922, 0.0, two_turns(180.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// UR10e.
pub(super) const UR10E: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &JOINTS,
    joints: &[
        row(0.0, 90.0, 0.1807, 0.0, two_turns(120.0)),
        row(-0.6127, 0.0, 0.0, 0.0, two_turns(120.0)),
        row(-0.57155, 0.0, 0.0, 0.0, two_turns(180.0)),
        row(0.0, 90.0, 0.17415, 0.0, two_turns(180.0)),
        row(0.0, -90.0, 0.11985, 0.0, two_turns(180.0)),
        row(0.0, 0.0, 0.11655, 0.0, two_turns(180.0)),
    ],
    flange: 0.0,
    bodies: &[],
};
