//! Angles that look like degrees.

use std::f64::consts::TAU;

use super::doubt::UnitDoubt;
use crate::message::Setting;

/// Angle that neither an unwrapped encoder nor an accumulated rotation is outside its range by (rad): 3.5 turns.
pub const MANY_TURNS: f64 = 22.0;

/// Largest number that people type in degrees: ten turns.
pub(super) const MOST_DEGREES: f64 = 3600.0;

/// Length of a rotation vector (rad) beyond which it looks like degrees: eight turns.
const LONG_ROTATION: f64 = 8.0 * TAU;

/// Twist or offset in a table of joints (rad) beyond which it looks like degrees: two turns.
const TWISTED: f64 = 2.0 * TAU;

/// Whether angles look typed in degrees: multiples of 5, the largest from 30 to 720. An angle alone, all others being zero, is
/// a multiple of 15, since round numbers of radians such as 50 and 100 are honest turns of a joint.
pub fn typed_in_degrees(angles: &[f64]) -> bool {
    let alone = angles.iter().filter(|angle| **angle != 0.0).count() == 1;
    are_degrees(angles, if alone { 15.0 } else { 5.0 })
}

/// Whether angles are multiples of `step`, the largest from 30 to 720.
pub(super) fn are_degrees(angles: &[f64], step: f64) -> bool {
    let largest = angles.iter().fold(0.0, |largest: f64, angle| largest.max(angle.abs()));
    (30.0..=720.0).contains(&largest) && angles.iter().all(|angle| angle % step == 0.0)
}

/// Doubts roll, pitch and yaw (rad); `what` names them. Yaw may have been accumulated over many turns.
pub fn of_rpy(what: &str, rpy: [f64; 3]) -> Option<UnitDoubt> {
    let turned = |angle: f64| angle.abs() > MANY_TURNS && angle.abs() <= MOST_DEGREES;
    let doubted = turned(rpy[0]) || turned(rpy[1]) || typed_in_degrees(&rpy);
    doubted.then(|| largest_of(what, &rpy))
}

/// Doubts roll, pitch and yaw (rad) in a file; `what` names them.
pub fn of_rpy_in_file(what: &str, rpy: [f64; 3]) -> Option<UnitDoubt> {
    of_rpy(what, rpy).map(|doubt| UnitDoubt { remedy: "angles of a file are in radians".into(), ..doubt })
}

/// Doubts a rotation vector (rad); `what` names it.
pub fn of_rotation_vector(what: &str, vector: [f64; 3]) -> Option<UnitDoubt> {
    let length = vector.iter().map(|angle| angle * angle).sum::<f64>().sqrt();
    let long = length > LONG_ROTATION && length <= MOST_DEGREES;
    (long || typed_in_degrees(&vector)).then(|| largest_of(what, &vector))
}

/// Doubts twists or joint offsets (rad) of a Denavit-Hartenberg table; `what` names the column.
pub fn of_dh_angles(what: &str, angles: &[f64]) -> Option<UnitDoubt> {
    let twisted = |angle: &f64| angle.abs() > TWISTED && angle.abs() <= MOST_DEGREES;
    let row = angles.iter().position(twisted)?;
    Some(UnitDoubt::joint_degrees(format!("{what}: entry {row}"), angles[row]))
}

/// Returns the doubt about the largest angle.
fn largest_of(what: &str, angles: &[f64; 3]) -> UnitDoubt {
    let largest = (0..3).max_by(|i, j| angles[*i].abs().total_cmp(&angles[*j].abs())).unwrap_or_default();
    UnitDoubt::degrees(format!("{what}: entry {largest}"), angles[largest], Setting::AnglesInDegrees)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn angles_typed_in_degrees_are_doubted_and_turns_are_not() {
        for degrees in [[180.0, 0.0, 90.0], [0.0, 0.0, 45.0], [-90.0, 0.0, 0.0], [10.0, 20.0, 35.0], [0.0, 360.0, 0.0]]
        {
            assert!(of_rpy("rpy", degrees).is_some() && of_rotation_vector("rotvec", degrees).is_some(), "{degrees:?}");
        }
        for honest in [[PI, 0.0, -PI], [0.1, 0.2, 85.3], [20.0, 0.0, 0.0], [0.0, 0.0, 100.0], [0.0; 3], [1e9, 0.0, 0.0]]
        {
            assert_eq!(of_rpy("rpy", honest), None, "{honest:?}");
        }
        for honest in [[6.0 * PI, 0.0, 0.0], [20.0, 20.0, 20.0], [1e300, 0.0, 0.0], [f64::NAN; 3]] {
            assert_eq!(of_rotation_vector("rotvec", honest), None, "{honest:?}");
        }
    }

    #[test]
    fn measured_degrees_are_doubted_by_roll_and_pitch() {
        let doubt = of_rpy("rpy", [179.62, -0.31, 0.5]).unwrap();
        assert_eq!((doubt.thing.as_str(), doubt.value), ("rpy: entry 0", 179.62));
        assert!(of_rotation_vector("rotvec", [31.2, 54.1, -60.0]).is_some());
        assert!(of_dh_angles("alpha", &[0.0, 90.0]).is_some() && of_dh_angles("alpha", &[-PI, 2.0 * PI]).is_none());
    }
}
