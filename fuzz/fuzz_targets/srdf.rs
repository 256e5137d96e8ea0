//! An SRDF of any bytes is read or refused.
#![no_main]

use std::sync::LazyLock;

use ikcore::robot::Robot;
use libfuzzer_sys::fuzz_target;

static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
    Robot::from_urdf(include_str!("../../tests/corpus/urdf/arm.urdf"), None, Some("tool")).expect("the corpus is valid")
});

fuzz_target!(|text: &str| drop(ROBOT.with_srdf(text)));
