//! Arms of Franka Robotics.

use super::arm::{Arm, LinkBody, radians, row};
use crate::load::dh::Dh::Modified;

/// Distance of the flange from frame 7 (m).
const FLANGE: f64 = 0.107;

/// Franka Emika Robot (Panda): modified DH parameters and joint limits, including jerk, from the maker's control interface
/// documentation, "Robot and interface specifications", with its torque limits.
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
        row(0.0, 0.0, 0.333, 0.0, radians(-2.8973, 2.8973, 2.175).rated(15.0, 7500.0).torque(87.0)),
        row(0.0, -90.0, 0.0, 0.0, radians(-1.7628, 1.7628, 2.175).rated(7.5, 3750.0).torque(87.0)),
        row(0.0, 90.0, 0.316, 0.0, radians(-2.8973, 2.8973, 2.175).rated(10.0, 5000.0).torque(87.0)),
        row(0.0825, 90.0, 0.0, 0.0, radians(-3.0718, -0.0698, 2.175).rated(12.5, 6250.0).torque(87.0)),
        row(-0.0825, -90.0, 0.384, 0.0, radians(-2.8973, 2.8973, 2.61).rated(15.0, 7500.0).torque(12.0)),
        row(0.0, 90.0, 0.0, 0.0, radians(-0.0175, 3.7525, 2.61).rated(20.0, 10000.0).torque(12.0)),
        row(0.088, 90.0, 0.0, 0.0, radians(-2.8973, 2.8973, 2.61).rated(20.0, 10000.0).torque(12.0)),
    ],
    flange: FLANGE,
    bodies: &PANDA_BODIES,
};

/// Franka Research 3: the geometry of the Panda with its own joint limits, including jerk, from the same document (its table
/// for the FR3); `rate_limiting.h` of libfranka 0.10 and later has the same accelerations and jerks.
pub(super) const FR3: Arm = Arm {
    convention: Modified,
    base_roll: 0.0,
    joint_names: &["fr3_joint1", "fr3_joint2", "fr3_joint3", "fr3_joint4", "fr3_joint5", "fr3_joint6", "fr3_joint7"],
    joints: &[
        row(0.0, 0.0, 0.333, 0.0, radians(-2.7437, 2.7437, 2.62).rated(10.0, 5000.0).torque(87.0)),
        row(0.0, -90.0, 0.0, 0.0, radians(-1.7837, 1.7837, 2.62).rated(10.0, 5000.0).torque(87.0)),
        row(0.0, 90.0, 0.316, 0.0, radians(-2.9007, 2.9007, 2.62).rated(10.0, 5000.0).torque(87.0)),
        row(0.0825, 90.0, 0.0, 0.0, radians(-3.0421, -0.1518, 2.62).rated(10.0, 5000.0).torque(87.0)),
        row(-0.0825, -90.0, 0.384, 0.0, radians(-2.8065, 2.8065, 5.26).rated(10.0, 5000.0).torque(12.0)),
        row(0.0, 90.0, 0.0, 0.0, radians(0.5445, 4.5169, 4.18).rated(10.0, 5000.0).torque(12.0)),
        row(0.088, 90.0, 0.0, 0.0, radians(-3.0159, 3.0159, 5.26).rated(10.0, 5000.0).torque(12.0)),
    ],
    flange: FLANGE,
    bodies: &[],
};

/// Inertias of the Panda, as identified by Gaz, Cognetti, Oliva, Robuffo Giordano and De Luca, "Dynamic identification of the Franka
/// Emika Panda robot with retrieval of feasible parameters using penalty-based optimization", IEEE RA-L 4(4), 2019: one set of values
/// that gives the measured torques. No hand is included.
const PANDA_BODIES: [LinkBody; 8] = [
    LinkBody {
        link: "base",
        mass: 0.629769,
        center: [-0.041018, -0.00014, 0.049974],
        matrix: [0.00315, 8.2904e-7, 0.00015, 0.00388, 8.2299e-6, 0.004285],
    },
    LinkBody {
        link: "link_1",
        mass: 4.970684,
        center: [0.003875, 0.002081, -0.04762],
        matrix: [0.70337, -0.000139, 0.006772, 0.70661, 0.019169, 0.009117],
    },
    LinkBody {
        link: "link_2",
        mass: 0.646926,
        center: [-0.003141, -0.02872, 0.003495],
        matrix: [0.007962, -0.003925, 0.010254, 0.02811, 0.000704, 0.025995],
    },
    LinkBody {
        link: "link_3",
        mass: 3.228604,
        center: [0.027518, 0.039252, -0.066502],
        matrix: [0.037242, -0.004761, -0.011396, 0.036155, -0.012805, 0.01083],
    },
    LinkBody {
        link: "link_4",
        mass: 3.587895,
        center: [-0.05317, 0.104419, 0.027454],
        matrix: [0.025853, 0.007796, -0.001332, 0.019552, 0.008641, 0.028323],
    },
    LinkBody {
        link: "link_5",
        mass: 1.225946,
        center: [-0.011953, 0.041065, -0.038437],
        matrix: [0.035549, -0.002117, -0.004037, 0.029474, 0.000229, 0.008627],
    },
    LinkBody {
        link: "link_6",
        mass: 1.666555,
        center: [0.060149, -0.014117, -0.010517],
        matrix: [0.001964, 0.000109, -0.001158, 0.004354, 0.000341, 0.005433],
    },
    LinkBody {
        link: "link_7",
        mass: 0.735522,
        center: [0.010517, -0.004252, 0.061597],
        matrix: [0.012516, -0.000428, -0.001196, 0.010027, -0.000741, 0.004815],
    },
];
