//! What several test files need: robots, targets, generated chains with a slow twin, error messages.

#![allow(dead_code, reason = "every test file uses its own share")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

pub mod chains;
pub mod circles;

use ikcore::robot::Robot;
use ikcore::task::Target;

/// A built-in robot.
pub fn robot(name: &str) -> Robot {
    Robot::named(name).unwrap()
}

/// The text of the error that must have come.
#[track_caller]
pub fn message<T>(result: ikcore::Result<T>) -> String {
    match result {
        Ok(_) => panic!("no error came"),
        Err(error) => error.to_string(),
    }
}

/// The pose of the tip at `q`, as something to reach.
pub fn pose_at(robot: &Robot, q: &[f64]) -> Target {
    Target::from(&robot.fk(q).unwrap())
}

/// The position of the tip at `q`, as something to reach.
pub fn position_at(robot: &Robot, q: &[f64]) -> Target {
    Target::Position(robot.tip_position(q))
}

/// The bits of these numbers: equal bits also tell 0 from -0 and compare NaN.
pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
