//! Arms of KUKA.

use super::arm::{Arm, degrees, row};
use crate::load::dh::Dh::{Modified, Standard};

/// LBR iiwa 14 R820: dimensions, ranges and speeds of the data sheet, up to the flange. The sign of joint 4 is that of the
/// real arm, opposite to joint 2.
pub(super) const IIWA14: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &["joint_a1", "joint_a2", "joint_a3", "joint_a4", "joint_a5", "joint_a6", "joint_a7"],
    joints: &[
        row(0.0, -90.0, 0.36, 0.0, degrees(-170.0, 170.0, 85.0)),
        row(0.0, 90.0, 0.0, 0.0, degrees(-120.0, 120.0, 85.0)),
        row(0.0, 90.0, 0.42, 0.0, degrees(-170.0, 170.0, 100.0)),
        row(0.0, -90.0, 0.0, 0.0, degrees(-120.0, 120.0, 75.0)),
        row(0.0, -90.0, 0.4, 0.0, degrees(-170.0, 170.0, 130.0)),
        row(0.0, 90.0, 0.0, 0.0, degrees(-120.0, 120.0, 135.0)),
        row(0.0, 0.0, 0.126, 0.0, degrees(-175.0, 175.0, 135.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// LBR iiwa 7 R800: the same arm, shorter and faster; from its data sheet.
pub(super) const IIWA7: Arm = Arm {
    convention: Standard,
    base_roll: 0.0,
    joint_names: &["joint_a1", "joint_a2", "joint_a3", "joint_a4", "joint_a5", "joint_a6", "joint_a7"],
    joints: &[
        row(0.0, -90.0, 0.34, 0.0, degrees(-170.0, 170.0, 98.0)),
        row(0.0, 90.0, 0.0, 0.0, degrees(-120.0, 120.0, 98.0)),
        row(0.0, 90.0, 0.4, 0.0, degrees(-170.0, 170.0, 100.0)),
        row(0.0, -90.0, 0.0, 0.0, degrees(-120.0, 120.0, 130.0)),
        row(0.0, -90.0, 0.4, 0.0, degrees(-170.0, 170.0, 140.0)),
        row(0.0, 90.0, 0.0, 0.0, degrees(-120.0, 120.0, 180.0)),
        row(0.0, 0.0, 0.126, 0.0, degrees(-175.0, 175.0, 180.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// KR 210 R2700 extra: dimensions, ranges and speeds of the data sheet. Joint values match the controller: A2 = -90 with A3 =
/// 90 holds the upper arm upright and the forearm level.
pub(super) const KR210: Arm = Arm {
    convention: Modified,
    base_roll: 0.0,
    joint_names: &["joint_a1", "joint_a2", "joint_a3", "joint_a4", "joint_a5", "joint_a6"],
    joints: &[
        row(0.0, 180.0, -0.675, 0.0, degrees(-185.0, 185.0, 123.0)),
        row(0.35, 90.0, 0.0, 0.0, degrees(-140.0, -5.0, 115.0)),
        row(1.15, 0.0, 0.0, 90.0, degrees(-120.0, 155.0, 112.0)),
        row(0.041, -90.0, -1.2, 0.0, degrees(-350.0, 350.0, 179.0)),
        row(0.0, 90.0, 0.0, 0.0, degrees(-125.0, 125.0, 172.0)),
        row(0.0, -90.0, -0.215, 0.0, degrees(-350.0, 350.0, 219.0)),
    ],
    flange: 0.0,
    bodies: &[],
};

/// KR 210 R2700 extra as printed in Table 1 of Yuan et al. 2016, "Autonomous path planning solution for industrial
/// robot manipulator using backpropagation algorithm": the maker's geometry with the paper's own zero of joint 3 and
/// range of joint 2. Speeds are not printed there.
pub(super) const KR210_YUAN2016: Arm = Arm {
    convention: Modified,
    base_roll: 0.0,
    joint_names: &["joint_a1", "joint_a2", "joint_a3", "joint_a4", "joint_a5", "joint_a6"],
    joints: &[
        row(0.0, 180.0, -0.675, 0.0, degrees(-185.0, 185.0, f64::INFINITY)),
        row(0.35, 90.0, 0.0, 0.0, degrees(-95.0, 50.0, f64::INFINITY)),
        row(1.15, 0.0, 0.0, 0.0, degrees(-30.0, 245.0, f64::INFINITY)),
        row(0.041, -90.0, -1.2, 0.0, degrees(-350.0, 350.0, f64::INFINITY)),
        row(0.0, 90.0, 0.0, 0.0, degrees(-125.0, 125.0, f64::INFINITY)),
        row(0.0, -90.0, -0.215, 0.0, degrees(-350.0, 350.0, f64::INFINITY)),
    ],
    flange: 0.0,
    bodies: &[],
};
