//! Joint positions that look like degrees or millimetres.

use super::angles::{MANY_TURNS, MOST_DEGREES, typed_in_degrees};
use super::doubt::UnitDoubt;
use crate::robot::{Joint, Robot};

/// Name of configurations to evaluate, as for forward kinematics. Computations make many of these, and a simulation that
/// diverges passes through any angle, so only numbers as people write them are doubted: of two decimals at most.
const EVALUATED: &str = "joint angles";

/// Multiple of its range by which a joint that slides is outside it.
const RANGES: f64 = 20.0;

/// Doubts the positions of joints (rad, m), one configuration after another, and returns the first doubt. `what` names the
/// argument. The usual path is one comparison per entry.
pub fn of_configurations(robot: &Robot, what: &str, qs: &[f64]) -> Option<UnitDoubt> {
    // NaN is for others to report.
    if !qs.iter().any(|value| value.abs() > MANY_TURNS) {
        return None;
    }
    let joints = robot.joints();
    qs.chunks_exact(joints.len().max(1)).find_map(|q| of_configuration(joints, what, q))
}

#[cold]
fn of_configuration(joints: &[Joint], what: &str, q: &[f64]) -> Option<UnitDoubt> {
    let thing = |joint: &Joint| format!("{what}: joint '{}'", joint.name);
    let is_written = |value: f64| what != EVALUATED || (100.0 * value - (100.0 * value).round()).abs() < 1e-9;
    let found = joints.iter().zip(q).find_map(|(joint, value)| match joint.kind.turns() {
        true => {
            (in_degrees(joint, *value) && is_written(*value)).then(|| UnitDoubt::joint_degrees(thing(joint), *value))
        }
        false => in_millimetres(joint, *value).then(|| {
            let against = format!("its range is {} to {} m", joint.lower, joint.upper);
            UnitDoubt::millimetres(thing(joint), *value, against)
        }),
    });
    found.or_else(|| typed(joints, q).map(|j| UnitDoubt::joint_degrees(thing(&joints[j]), q[j])))
}

/// Distance of a value from the range of a joint; zero or less inside, and without limits minus infinity.
fn outside(joint: &Joint, value: f64) -> f64 {
    (joint.lower - value).max(value - joint.upper)
}

fn in_degrees(joint: &Joint, value: f64) -> bool {
    let bounded = joint.lower.is_finite() && joint.upper.is_finite();
    bounded && outside(joint, value) > MANY_TURNS && value.abs() <= MOST_DEGREES
}

fn in_millimetres(joint: &Joint, value: f64) -> bool {
    let range = joint.upper - joint.lower;
    let beyond = outside(joint, value);
    range.is_finite() && beyond > MANY_TURNS.max(RANGES * range) && outside(joint, 1e-3 * value) <= range
}

/// Returns the largest angle if all angles look typed in degrees, for joints without limits.
fn typed(joints: &[Joint], q: &[f64]) -> Option<usize> {
    let turning: Vec<usize> = (0..q.len()).filter(|j| joints[*j].kind.turns()).collect();
    let angles: Vec<f64> = turning.iter().map(|j| q[*j]).collect();
    let largest = turning.into_iter().max_by(|i, j| q[*i].abs().total_cmp(&q[*j].abs()))?;
    (outside(&joints[largest], q[largest]) == f64::NEG_INFINITY && typed_in_degrees(&angles)).then_some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::DhTable;
    use crate::robot::JointKind;

    #[test]
    fn degrees_are_doubted_and_turns_of_an_encoder_are_not() {
        let panda = Robot::named("panda").unwrap();
        let degrees = [0.0, -45.0, 0.0, -135.0, 0.0, 90.0, 45.0];
        let doubt = of_configurations(&panda, "start", &degrees).unwrap();
        assert_eq!((doubt.thing.as_str(), doubt.value), ("start: joint 'panda_joint2'", -45.0));
        for honest in [[20.0; 7], [f64::NAN; 7], [1e6; 7], [0.0, 0.0, 0.0, -2.0, 0.0, 2.0 + 12.56, 0.0]] {
            assert_eq!(of_configurations(&panda, "start", &honest), None, "{honest:?}");
        }
        let diverged = [0.0, -45.123, 0.0, -2.0, 0.0, 1.0, 0.0];
        assert_eq!(of_configurations(&panda, "joint angles", &diverged), None);
        assert!(of_configurations(&panda, "joint angles", &degrees).is_some());
        let second = [[0.0; 7], degrees].concat();
        assert_eq!(of_configurations(&panda, "start", &second), Some(doubt));
    }

    #[test]
    fn joints_without_limits_may_turn_for_long() {
        let mut table = DhTable::new(crate::load::Dh::Standard, vec![0.3; 3], vec![0.0; 3], vec![0.0; 3]);
        table.kinds = vec![JointKind::Continuous; 3];
        let robot = Robot::from_dh("turntables", &table).unwrap();
        for honest in [[100.0, 0.0, 0.0], [85.3, 0.1, -62.0], [20.0, 20.0, 20.0], [314.159, 0.0, 0.0]] {
            assert_eq!(of_configurations(&robot, "q", &honest), None, "{honest:?}");
        }
        assert!(of_configurations(&robot, "q", &[90.0, 45.0, -30.0]).is_some());
    }

    #[test]
    fn a_slide_in_millimetres_is_doubted_and_a_long_rail_is_not() {
        let slide = |upper: f64, value: f64| {
            let joint = Joint::new("rail", JointKind::Prismatic).with_range(0.0, upper);
            of_configuration(&[joint], "q", &[value]).is_some()
        };
        assert!(slide(2.0, 500.0) && slide(0.4, 150.0));
        assert!(!slide(30.0, 35.0) && !slide(2.0, 2.5) && !slide(2.0, 1e6));
    }
}
