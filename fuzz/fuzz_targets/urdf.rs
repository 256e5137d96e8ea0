//! A URDF of any bytes is read or refused, and a robot that was read has poses.
#![no_main]

use ikcore::robot::Robot;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    // "tool" is the tip of the corpus; without it, the only leaf.
    for tip in [Some("tool"), None] {
        if let Ok(robot) = Robot::from_urdf(text, None, tip) {
            let q: Vec<f64> = robot.joints().iter().map(|joint| 0.0_f64.clamp(joint.lower, joint.upper)).collect();
            assert!(robot.fk(&q).is_ok());
        }
    }
});
