//! Limits of joints that look like degrees or millimetres.

use std::f64::consts::PI;

use super::angles::{MOST_DEGREES, are_degrees};
use super::doubt::{Unit, UnitDoubt};
use super::lengths::reach_of_links;
use crate::limits::{Field, Limits, TipField};
use crate::message::{Setting, message};
use crate::robot::{Joint, Robot};

/// Least of the ranges of all joints, and of their largest, that look like degrees together (rad).
const WIDE: [f64; 2] = [15.0, 30.0];

/// Least velocity of joints that looks like degrees per second (rad/s).
const FAST: f64 = 60.0;

/// Speed of a tip (m/s) that looks like millimetres per second.
const FAST_TIP: f64 = 20.0;
/// Turn speed of a tip (rad/s) that looks like degrees per second.
const FAST_TURN: f64 = 45.0;

/// Slide (m) that looks like millimetres, with the multiple of the reach of the links.
const LONG_SLIDE: [f64; 2] = [150.0, 30.0];

/// Largest limit of all joints (rad) that looks like radians converted from degrees: 1 and 2 pi degrees.
const CONVERTED: [f64; 2] = [PI / 180.0, PI * PI / 90.0];

/// Round numbers that stand for "no limit".
const UNLIMITED: [f64; 5] = [50.0, 100.0, 200.0, 500.0, 1000.0];

/// Doubts the position and velocity limits of a robot.
pub fn of_limits(robot: &Robot) -> Vec<UnitDoubt> {
    of_joints(robot, robot.joints())
}

/// Doubts the limits of a call as far as they differ from those of the robot; limits that vary count as at the start.
pub fn of_limits_of_call(robot: &Robot, limits: &Limits) -> Vec<UnitDoubt> {
    let mut doubts = of_joints_of_call(robot, limits);
    doubts.extend(of_tips(limits));
    doubts
}

/// Doubts a speed of a tip (m/s), which `what` names.
pub fn of_tip_speed(what: &str, speed: f64) -> Option<UnitDoubt> {
    (speed >= FAST_TIP).then(|| UnitDoubt::millimetres_per_second(what, speed, "no arm is as fast"))
}

/// Doubts limits of tips.
fn of_tips(limits: &Limits) -> impl Iterator<Item = UnitDoubt> {
    let largest =
        |field: TipField| limits.of_tips(field).iter().copied().filter(|limit| limit.is_finite()).fold(0.0, f64::max);
    let [speed, turn] = [TipField::Speed, TipField::TurnSpeed].map(largest);
    let speed = of_tip_speed("tip speed limit", speed);
    let turn = (turn >= FAST_TURN).then(|| UnitDoubt::degrees_per_second("tip turn speed limit", turn));
    speed.into_iter().chain(turn)
}

fn of_joints_of_call(robot: &Robot, limits: &Limits) -> Vec<UnitDoubt> {
    let value = |field: Field, j: usize| limits.field(field).map_or(f64::INFINITY, |profiles| profiles[j].at(0.0));
    let range = |j: usize| [value(Field::Lower, j), value(Field::Upper, j)];
    if !(0..robot.dof()).any(|j| is_large(range(j), value(Field::Velocity, j))) {
        return vec![];
    }
    let joint = |(j, own): (usize, &Joint)| {
        let [lower, upper] = range(j);
        own.clone().with_range(lower, upper).with_velocity(value(Field::Velocity, j))
    };
    let joints: Vec<Joint> = robot.joints().iter().enumerate().map(joint).collect();
    let known = of_limits(robot);
    of_joints(robot, &joints).into_iter().filter(|doubt| !known.contains(doubt)).collect()
}

/// Doubts the limits of a model whose angles were converted from degrees: all are as small as radians would become.
pub fn of_converted_limits(robot: &Robot) -> Option<UnitDoubt> {
    let bounded = || robot.joints().iter().filter(|joint| joint.kind.turns() && is_bounded(joint));
    let most = bounded().map(|joint| farther(joint).abs()).fold(0.0, f64::max);
    if bounded().count() < 2 || !(CONVERTED[0]..=CONVERTED[1]).contains(&most) {
        return None;
    }
    let doubt = doubted(bounded(), |thing, joint| UnitDoubt::joint_degrees(thing, farther(joint)))?;
    let remedy = "angles of the model are in degrees unless its compiler says radian".into();
    Some(UnitDoubt { unit: Unit::RadiansAsDegrees, remedy, ..doubt })
}

fn of_joints(robot: &Robot, joints: &[Joint]) -> Vec<UnitDoubt> {
    if !joints.iter().any(|joint| is_large([joint.lower, joint.upper], joint.velocity)) {
        return vec![];
    }
    let reach = reach_of_links(robot);
    of_position_limits(joints, reach).into_iter().chain(of_velocity_limits(joints)).collect()
}

/// Whether one of these limits of a joint is large enough for a doubt; most joints have none.
fn is_large(range: [f64; 2], velocity: f64) -> bool {
    let beyond = |limit: f64, least: f64| limit.abs() >= least && limit.is_finite();
    range.iter().any(|limit| beyond(*limit, WIDE[1])) || beyond(velocity, FAST)
}

/// Doubts position limits (rad, m); `reach` is that of the links (m).
fn of_position_limits(joints: &[Joint], reach: f64) -> Vec<UnitDoubt> {
    let turning: Vec<&Joint> = joints.iter().filter(|joint| joint.kind.turns() && is_bounded(joint)).collect();
    let wide = together(&turning);
    let in_degrees = turning.into_iter().filter(|joint| wide || typed(joint));
    let sliding = joints.iter().filter(|joint| !joint.kind.turns() && is_bounded(joint) && is_long(joint, reach));
    let remedy = message!["limits are in radians: ", Setting::RadiansFromDegrees];
    let angle = doubted(in_degrees, |thing, joint| UnitDoubt::degrees(thing, farther(joint), &remedy));
    let length = doubted(sliding, |thing, joint| {
        UnitDoubt::millimetres(thing, farther(joint), format!("the links reach {reach:.4} m"))
    });
    angle.into_iter().chain(length).collect()
}

/// Doubts velocity limits of joints that turn (rad/s).
fn of_velocity_limits(joints: &[Joint]) -> Option<UnitDoubt> {
    let turning = || joints.iter().filter(|joint| joint.kind.turns() && joint.velocity.is_finite());
    let first = turning().next()?;
    let same = turning().all(|joint| joint.velocity == first.velocity);
    let unlimited = same && (UNLIMITED.contains(&first.velocity) || first.velocity > 1000.0);
    let fast = turning().all(|joint| joint.velocity >= FAST && joint.velocity <= MOST_DEGREES);
    if unlimited || !fast || turning().count() < 2 {
        return None;
    }
    let name = |joint: &Joint| format!("velocity limit of joint '{}'", joint.name);
    doubted_by(turning(), name, |thing, joint| UnitDoubt::degrees_per_second(thing, joint.velocity))
}

/// Returns the doubt about the first joint, with the number of others.
fn doubted<'a>(
    joints: impl Iterator<Item = &'a Joint>,
    doubt: impl Fn(String, &Joint) -> UnitDoubt,
) -> Option<UnitDoubt> {
    let name = |joint: &Joint| {
        let side = if farther(joint) == joint.upper { "upper" } else { "lower" };
        format!("{side} limit of joint '{}'", joint.name)
    };
    doubted_by(joints, name, doubt)
}

fn doubted_by<'a>(
    mut joints: impl Iterator<Item = &'a Joint>,
    name: impl Fn(&Joint) -> String,
    doubt: impl Fn(String, &Joint) -> UnitDoubt,
) -> Option<UnitDoubt> {
    let first = joints.next()?;
    let others = match joints.count() {
        0 => String::new(),
        1 => " (and that of another joint)".into(),
        more => format!(" (and those of {more} other joints)"),
    };
    Some(doubt(format!("{}{others}", name(first)), first))
}

fn is_bounded(joint: &Joint) -> bool {
    joint.lower.is_finite() && joint.upper.is_finite()
}

/// Returns the limit that is farther from zero.
fn farther(joint: &Joint) -> f64 {
    if joint.lower.abs() > joint.upper.abs() { joint.lower } else { joint.upper }
}

/// Whether the limits of all joints are implausibly wide, and none of them means turns, or no limit.
fn together(joints: &[&Joint]) -> bool {
    let ranges: Vec<f64> = joints.iter().map(|joint| farther(joint).abs()).collect();
    let largest = ranges.iter().copied().fold(0.0, f64::max);
    let wide = largest >= WIDE[1] && ranges.iter().all(|range| (WIDE[0]..=MOST_DEGREES).contains(range));
    joints.len() > 1 && wide && !joints.iter().any(|joint| is_unlimited(joint) || is_of_turns(joint))
}

/// Whether both limits look typed in degrees.
fn typed(joint: &Joint) -> bool {
    are_degrees(&[joint.lower, joint.upper], 5.0) && !is_unlimited(joint)
}

/// Whether the limits are a round number to both sides, which stands for "no limit".
fn is_unlimited(joint: &Joint) -> bool {
    joint.lower == -joint.upper && UNLIMITED.contains(&joint.upper)
}

/// Whether the limits are multiples of half a turn (rad).
fn is_of_turns(joint: &Joint) -> bool {
    [joint.lower, joint.upper].iter().all(|limit| (limit / PI - (limit / PI).round()).abs() < 1e-2)
}

fn is_long(joint: &Joint, reach: f64) -> bool {
    let range = farther(joint).abs();
    range >= LONG_SLIDE[0] && range >= LONG_SLIDE[1] * reach && range < 1e5 && !is_unlimited(joint)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::JointKind;

    fn turning(ranges: &[(f64, f64)]) -> Vec<Joint> {
        let joint = |(i, (lower, upper)): (usize, &(f64, f64))| {
            Joint::new(format!("j{i}"), JointKind::Revolute).with_range(*lower, *upper)
        };
        ranges.iter().enumerate().map(joint).collect()
    }

    #[test]
    fn limits_in_degrees_are_doubted() {
        for ranges in [
            &[(-170.0, 170.0); 3][..],
            &[(-169.99, 169.99), (-119.5, 120.2), (-20.0, 31.5)],
            &[(-3.1, 3.1), (-90.0, 90.0)],
            &[(0.0, 180.0)],
            &[(-100.0, 100.0), (-170.0, 170.0)],
        ] {
            let doubts = of_position_limits(&turning(ranges), 1.0);
            assert_eq!(doubts.len(), 1, "{ranges:?}");
        }
        let doubt = &of_position_limits(&turning(&[(-170.0, 100.0), (-20.0, 30.0)]), 1.0)[0];
        assert_eq!(
            (doubt.thing.as_str(), doubt.value),
            ("lower limit of joint 'j0' (and that of another joint)", -170.0)
        );
    }

    #[test]
    fn limits_of_many_turns_are_not_doubted() {
        for ranges in [
            &[(-9.42477796077, 9.42477796077); 12][..],
            &[(-10.0, 10.0); 6],
            &[(-100.0, 100.0); 6],
            &[(-20.0 * PI, 20.0 * PI), (-40.0 * PI, 40.0 * PI)],
            &[(-62.8, 62.8)],
            &[(-3.0, 3.0), (-100.0, 100.0)],
            &[(-96.29, 96.29), (-100.0, 100.0)],
            &[(-1e16, 1e16); 4],
            &[(0.0, 12.5), (-2.0, 85.3)],
        ] {
            assert_eq!(of_position_limits(&turning(ranges), 1.0), [], "{ranges:?}");
        }
    }

    #[test]
    fn velocities_in_degrees_are_doubted_those_of_motors_are_not() {
        let of = |velocities: &[f64]| {
            let joints = turning(&vec![(-3.0, 3.0); velocities.len()]);
            let joints = joints.into_iter().zip(velocities).map(|(joint, velocity)| joint.with_velocity(*velocity));
            of_velocity_limits(&joints.collect::<Vec<_>>()).is_some()
        };
        assert!(of(&[98.0, 98.0, 100.0, 130.0, 140.0, 180.0, 180.0]) && of(&[180.0; 6]));
        for honest in
            [&[28.6, 52.4, 52.4][..], &[1000.0; 6], &[100.0; 29], &[1e4; 5], &[25.0, 100.0], &[180.0], &[2.0; 7]]
        {
            assert!(!of(honest), "{honest:?}");
        }
    }

    #[test]
    fn radians_read_as_degrees_are_doubted() {
        let table = |limit: f64| {
            let mut table =
                crate::load::DhTable::new(crate::load::Dh::Modified, vec![0.3; 3], vec![0.0; 3], vec![0.0; 3]);
            (table.lower, table.upper) = (vec![-limit; 3], vec![limit; 3]);
            Robot::from_dh("arm", &table).unwrap()
        };
        let doubt = of_converted_limits(&table(3.1_f64.to_radians())).unwrap();
        assert_eq!(
            doubt.message(),
            "upper limit of joint 'joint_1' (and those of 2 other joints) is 0.05411 rad (0.008611 turns), which looks like \
             radians read as degrees: 0.05411 rad are 3.100 degrees; angles of the model are in degrees unless its compiler says radian"
        );
        assert_eq!(of_converted_limits(&table(3.1)), None);
        assert_eq!(of_converted_limits(&table(0.3)), None);
    }

    #[test]
    fn a_slide_is_compared_with_the_links() {
        let slide = |lower: f64, upper: f64, reach: f64| {
            let joint = Joint::new("rail", JointKind::Prismatic).with_range(lower, upper);
            !of_position_limits(&[joint], reach).is_empty()
        };
        assert!(slide(0.0, 850.0, 0.9) && slide(-180.0, 0.0, 0.5));
        for (lower, upper, reach) in [(0.0, 12.0, 0.9), (-1000.0, 1000.0, 0.9), (0.0, 250.0, 12.0), (0.0, 1e6, 0.5)] {
            assert!(!slide(lower, upper, reach), "{lower} {upper} {reach}");
        }
    }
}
