//! Programs of moves: geometry by independent formulas, limits by the exact extremes of the motion.

use std::f64::consts::{PI, TAU};

use crate::common::robot;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::Pose;
use ikcore::nalgebra::{Rotation3, Translation3, Vector3};
use ikcore::planning::{JointGoal, Move, MoveKind, MovesOptions, Plan, plan_moves};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::{Error, Result};

const HOME: [f64; 6] = [0.0, -1.5, 1.8, -1.9, -1.57, 0.3];

fn options(arm: &Robot, jerk: Option<f64>) -> MovesOptions {
    let constant = |value: f64| vec![Profile::Constant(value); arm.dof()];
    let mut limits = Limits::of(arm).replace(Field::Acceleration, constant(5.0)).unwrap();
    if let Some(jerk) = jerk {
        limits = limits.replace(Field::Jerk, constant(jerk)).unwrap();
    }
    MovesOptions { limits: Some(limits), ..MovesOptions::default() }
}

fn planned(arm: &Robot, moves: &[Move], jerk: Option<f64>) -> Result<Plan> {
    plan_moves(arm, moves, &HOME, &options(arm, jerk), &mut Unattended)
}

fn line(pose: Pose, speed: Option<f64>, blend: f64) -> Move {
    Move { blend, ..Move::new(MoveKind::Line { pose, speed }) }
}

fn moved(pose: &Pose, by: [f64; 3]) -> Pose {
    Pose::from_parts(Translation3::from(pose.translation.vector + Vector3::from(by)), pose.rotation)
}

fn at(plan: &Plan, t: f64) -> [Vec<f64>; 2] {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 6]);
    plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
    [q, qd]
}

/// Distance of a point from a segment.
fn off(point: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let way = to - from;
    let fraction = ((point - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (point - from - fraction * way).norm()
}

#[test]
fn corners_of_lines_stay_inside_their_balls() {
    let arm = robot("ur5e");
    let start = arm.fk(&HOME).unwrap();
    let mut rng = rng::stream(7, 0);
    for case in 0..12 {
        let round = case % 2 == 0;
        let mut draw = |size: f64| {
            if round { size * (rng.uniform_in(-2.0, 2.0)).round() / 2.0 } else { rng.uniform_in(-size, size) }
        };
        let first = moved(&start, [0.05 + draw(0.02), draw(0.1), draw(0.05)]);
        let second = moved(&first, [draw(0.05), 0.08 + draw(0.05), draw(0.05)]);
        let radius = [0.01, 0.02, 0.004][case % 3];
        let jerk = (case % 4 == 3).then_some(100.0);
        let moves = [line(first, Some(0.1), radius), line(second, Some(0.05), 0.0)];
        let plan = match planned(&arm, &moves, jerk) {
            Ok(plan) => plan,
            Err(Error::InvalidMove { .. }) => continue, // too short, or a reversal
            Err(error) => panic!("case {case}: {error}"),
        };
        assert_eq!(plan.status, Status::Solved, "case {case}: {}", plan.message());
        let corner = first.translation.vector;
        let mut inside = 0;
        for i in 0..=2000 {
            let t = plan.trajectory.duration() * f64::from(i) / 2000.0;
            let [q, _] = at(&plan, t);
            let tip = Vector3::from(arm.tip_position(&q));
            let nearest =
                off(&tip, &start.translation.vector, &corner).min(off(&tip, &corner, &second.translation.vector));
            let from_corner = (tip - corner).norm();
            assert!(nearest < 1e-5 || from_corner <= radius * (1.0 + 1e-9), "case {case}: {nearest} m off at {t} s");
            inside += usize::from(from_corner < radius);
        }
        assert!(inside > 0, "case {case}");
        let [_, qd] = at(&plan, plan.moves[0].end);
        assert!(qd.iter().any(|speed| speed.abs() > 1e-3), "case {case}: it stops at the corner");
    }
}

#[test]
fn joint_moves_blend_inside_their_balls() {
    let arm = robot("ur5e");
    let there: Vec<f64> = HOME.iter().zip([0.4, 0.2, -0.3, 0.1, 0.0, 0.2]).map(|(q, by)| q + by).collect();
    let corner = arm.fk(&there).unwrap();
    let joints = Move { blend: 0.03, ..Move::new(MoveKind::Joints(JointGoal::Configuration(there.clone()))) };
    let end = moved(&corner, [0.0, 0.0, -0.1]);
    let home = Move::new(MoveKind::Joints(JointGoal::Configuration(HOME.to_vec())));
    for jerk in [None, Some(100.0)] {
        let moves = [joints.clone(), line(end, Some(0.1), 0.02), home.clone()];
        let plan = planned(&arm, &moves, jerk).unwrap();
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        for (k, (centre, radius)) in [(corner, 0.03), (end, 0.02)].into_iter().enumerate() {
            let [q, qd] = at(&plan, plan.moves[k].end);
            let tip = Vector3::from(arm.tip_position(&q));
            assert!((tip - centre.translation.vector).norm() <= radius, "corner {k}");
            assert!(qd.iter().any(|speed| speed.abs() > 1e-3), "it stops at corner {k}");
        }
        let sharp = [Move { blend: 0.0, ..joints.clone() }, line(end, Some(0.1), 0.0), home.clone()];
        assert!(plan.trajectory.duration() < planned(&arm, &sharp, jerk).unwrap().trajectory.duration());
    }
}

#[test]
fn orientations_turn_uniformly_on_lines_and_arcs() {
    let arm = robot("ur5e");
    let start = arm.fk(&HOME).unwrap();
    let turn = Rotation3::new(Vector3::new(0.2, -0.1, 0.4));
    let end = Pose::from_parts(moved(&start, [0.0, 0.1, -0.1]).translation, turn * start.rotation);
    let via = moved(&start, [0.03, 0.08, -0.02]).translation.vector.into();
    for kind in [MoveKind::Line { pose: end, speed: None }, MoveKind::Arc { via, pose: end, angle: None, speed: None }]
    {
        let plan = planned(&arm, &[Move::new(kind)], None).unwrap();
        let (mut length, mut way) = (vec![0.0], 0.0);
        let tips: Vec<Pose> = (0..=4000)
            .map(|i| arm.fk(&at(&plan, plan.trajectory.duration() * f64::from(i) / 4000.0)[0]).unwrap())
            .collect();
        for pair in tips.windows(2) {
            way += (pair[1].translation.vector - pair[0].translation.vector).norm();
            length.push(way);
        }
        for (tip, length) in tips.iter().zip(&length) {
            let expected = Rotation3::new(turn.scaled_axis() * (length / way)) * start.rotation;
            let apart = (tip.rotation.matrix() - expected.matrix()).norm();
            assert!(apart < 1e-4, "{apart} at {length} of {way}");
        }
        assert!((tips[4000].translation.vector - end.translation.vector).norm() < 1e-8);
    }
}

#[test]
fn a_full_circle_ends_where_it_begins() {
    let arm = robot("ur5e");
    let start = arm.fk(&HOME).unwrap();
    let via = moved(&start, [0.05, 0.05, 0.0]).translation.vector.into();
    for (angle, end) in [(TAU, [0.0; 3]), (PI, [0.0, 0.1, 0.0])] {
        let kind = MoveKind::Arc { via, pose: moved(&start, [0.0, 0.1, 0.0]), angle: Some(angle), speed: Some(0.1) };
        let plan = planned(&arm, &[Move::new(kind)], None).unwrap();
        let [q, _] = at(&plan, plan.trajectory.duration());
        let expected = moved(&start, end);
        assert!((Vector3::from(arm.tip_position(&q)) - expected.translation.vector).norm() < 1e-8);
        assert!((plan.moves[0].speed - 0.1).abs() < 1e-6);
    }
}

#[test]
fn speeds_asked_for_are_kept_under_jerk_limits_too() {
    let arm = robot("ur5e");
    let end = moved(&arm.fk(&HOME).unwrap(), [0.0, 0.2, 0.0]);
    for speed in [0.02, 0.05, 0.1] {
        for jerk in [None, Some(50.0), Some(500.0)] {
            let plan = planned(&arm, &[line(end, Some(speed), 0.0)], jerk).unwrap();
            let report = &plan.moves[0];
            assert!((report.speed / speed - 1.0).abs() < 1e-3, "{} of {speed} m/s with jerk {jerk:?}", report.speed);
            let slow: f64 = report.bound_by.iter().map(|bound| bound.end - bound.start).sum();
            assert!(slow < 0.5 * plan.trajectory.duration(), "slow for {slow} s at {speed} m/s with jerk {jerk:?}");
        }
    }
}

#[test]
fn a_last_move_that_its_blend_takes_whole_has_its_own_report() {
    let arm = robot("ur5e");
    let corner = moved(&arm.fk(&HOME).unwrap(), [0.0, 0.1, 0.0]);
    let named = |each: Move, name: &str| Move { name: Some(name.into()), ..each };
    let moves = [
        named(line(corner, Some(0.1), 0.05), "along"),
        named(line(moved(&corner, [0.0, 0.0, 0.05]), Some(0.01), 0.0), "up"),
    ];
    let plan = planned(&arm, &moves, None).unwrap();
    let names: Vec<_> = plan.moves.iter().filter_map(|report| report.name.as_deref()).collect();
    assert_eq!(names, ["along", "up"]);
    assert_eq!(plan.moves[1].message(), "wholly in blends");
    assert!(plan.moves[1].bound_by.is_empty());
}
