//! Arms of Kinova.

use super::arm::{Arm, degrees, endless, row};
use crate::load::dh::Dh::Standard;

/// Gen3, seven joints with spherical wrist: classical DH parameters, joint ranges and largest joint speeds of the maker's
/// user guide. The lengths are rounded to 0.1 mm. The last row extends to the interface module.
pub(super) const GEN3: Arm = Arm {
    convention: Standard,
    base_roll: 180.0,
    joint_names: &["joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6", "joint_7"],
    joints: &[
        row(0.0, 90.0, -(0.1564 + 0.1284), 0.0, endless(79.64)),
        row(0.0, 90.0, -(0.0054 + 0.0064), 180.0, degrees(-128.9, 128.9, 79.64)),
        row(0.0, 90.0, -(0.2104 + 0.2104), 180.0, endless(79.64)),
        row(0.0, 90.0, -(0.0064 + 0.0064), 180.0, degrees(-147.8, 147.8, 79.64)),
        row(0.0, 90.0, -(0.2084 + 0.1059), 180.0, endless(69.91)),
        row(0.0, 90.0, 0.0, 180.0, degrees(-120.3, 120.3, 69.91)),
        row(0.0, 180.0, -(0.1059 + 0.0615), 180.0, endless(69.91)),
    ],
    flange: 0.0,
    bodies: &[],
};
