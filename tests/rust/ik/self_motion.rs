//! Redundant arms in closed form: samples of the self-motion.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::common::{configurations, message, pose_at, position_at, robot};
use ikcore::ik::{
    AllOptions, SelfMotion, SelfMotionOptions, SolutionSet, SolutionView, SolveOptions, self_motion, solve_all,
};
use ikcore::load::{Dh, DhTable};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;

#[track_caller]
fn sampled(robot: &Robot, target: &Target, redundancy: usize) -> SolutionSet {
    let options = AllOptions { redundancy, ..AllOptions::default() };
    let found = solve_all(robot, target, &options, &mut Unattended).unwrap();
    let Target::Pose(wanted) = target else { panic!("a pose") };
    for solution in found.solutions.iter() {
        let tip = robot.tip(solution.q);
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let miss = off(&tip.origin, &wanted.origin).max(off(tip.axes.as_flattened(), wanted.axes.as_flattened()));
        assert!(miss < 2e-10, "{}: off by {miss:e} at {:?}", robot.name(), solution.q);
        for (q, joint) in solution.q.iter().zip(robot.joints()) {
            assert!(joint.lower <= *q && *q <= joint.upper, "{}: {:?}", robot.name(), solution.q);
        }
    }
    found
}

#[test]
fn samples_are_distinct_and_more_values_bring_more_of_them() {
    for name in ["panda", "iiwa14", "gen3"] {
        let robot = robot(name);
        let (mut few, mut many) = (0, 0);
        for q in configurations(&robot, 40) {
            let target = pose_at(&robot, &q);
            let found = sampled(&robot, &target, 16);
            assert!(!found.complete && found.status() == Status::Solved, "{name} {q:?}");
            for (k, one) in found.solutions.iter().enumerate() {
                let near = |other: SolutionView<'_>| one.q.iter().zip(other.q).all(|(a, b)| (a - b).abs() < 1e-6);
                assert!(!found.solutions.iter().take(k).any(near), "{name} {q:?}");
            }
            few += found.solutions.len();
            many += sampled(&robot, &target, 64).solutions.len();
        }
        assert!(few > 40 * 8 && many > 3 * few, "{name}: {few} {many}");
    }
}

#[test]
fn joint_4_at_its_limit_leaves_a_point_that_is_found() {
    let panda = robot("panda");
    for mut q in configurations(&panda, 40) {
        q[3] = panda.joints()[3].lower;
        // A single value of joint 7 where the elbow is bent most.
        let found = sampled(&panda, &pose_at(&panda, &q), 16);
        assert_eq!(found.status(), Status::Solved, "{q:?}");
    }
}

#[test]
fn poses_beyond_the_elbow_are_proven_out_of_reach() {
    let panda = robot("panda");
    let target = Target::Pose(ikcore::math::Frame { origin: [0.86, 0.0, 0.333], ..ikcore::math::Frame::IDENTITY });
    let found = sampled(&panda, &target, 16);
    assert_eq!((found.solutions.len(), found.status(), found.complete), (0, Status::OutOfReach, true));
}

#[test]
fn without_samples_the_solutions_are_searched_for() {
    let panda = robot("panda");
    let q = &configurations(&panda, 1)[0];
    let found = sampled_by_search(&panda, &pose_at(&panda, q));
    assert_eq!(found.solutions.len(), 16);
}

fn sampled_by_search(robot: &Robot, target: &Target) -> SolutionSet {
    let options = AllOptions { redundancy: 0, ..AllOptions::default() };
    solve_all(robot, target, &options, &mut Unattended).unwrap()
}

#[test]
fn arms_of_five_joints_have_all_solutions_of_what_they_reach() {
    let q = FRAC_PI_2;
    let table = DhTable::new(
        Dh::Standard,
        vec![0.033, 0.155, 0.135, 0.0, 0.0],
        vec![q, 0.0, 0.0, q, 0.0],
        vec![0.147, 0.0, 0.0, 0.0, 0.2175],
    );
    let arm = Robot::from_dh("five", &table).unwrap();
    assert_eq!(arm.closed_form(), "five joints, solved as six: spherical wrist; at most 8 solutions");
    for q in configurations(&arm, 100) {
        let target = pose_at(&arm, &q);
        let options = AllOptions {
            each: SolveOptions { start: Some(q.clone()), ..SolveOptions::default() },
            ..AllOptions::default()
        };
        let found = solve_all(&arm, &target, &options, &mut Unattended).unwrap();
        // Beside a singular pose the tolerances admit configurations some milliradians away.
        let least = |q: &[f64]| arm.jacobian(q).unwrap().singular_values().min();
        let nearly_singular = found.solutions.iter().any(|solution| least(solution.q) < 5e-3);
        assert!((found.complete || nearly_singular) && found.solutions.len() >= 2, "{q:?}");
        let nearest = found.solutions.get(0).unwrap().q;
        assert!(q.iter().zip(nearest).all(|(a, b)| (a - b).abs() < 1e-4), "{q:?} {nearest:?}");
    }
}

/// Distance of two configurations, whole turns aside.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let turn = |(a, b): (&f64, &f64)| ((a - b + PI).rem_euclid(TAU) - PI).powi(2);
    a.iter().zip(b).map(turn).sum::<f64>().sqrt()
}

#[track_caller]
fn curves(robot: &Robot, target: &Target, spacing: f64) -> Vec<SelfMotion> {
    let options = SelfMotionOptions { spacing, ..SelfMotionOptions::default() };
    let found = self_motion(robot, target, &options, &mut Unattended).unwrap();
    for curve in &found {
        let qs: Vec<&[f64]> = curve.iter().collect();
        for q in &qs {
            let tip = robot.tip(q);
            let (wanted, axes) = match target {
                Target::Position(position) => (*position, tip.axes),
                Target::Pose(pose) => (pose.origin, pose.axes),
                _ => panic!("a pose or a position"),
            };
            let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let miss = off(&tip.origin, &wanted).max(off(tip.axes.as_flattened(), axes.as_flattened()));
            assert!(miss < 3e-9, "off by {miss:e} at {q:?}");
            for (q, joint) in q.iter().zip(robot.joints()) {
                assert!(joint.lower <= *q && *q <= joint.upper, "{q:?}");
            }
        }
        for pair in qs.windows(2) {
            let length = pair[0].iter().zip(pair[1]).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            assert!(length <= spacing, "{length}");
        }
        let ends = [(qs[0], curve.lower_cut), (qs[qs.len() - 1], curve.upper_cut)];
        if curve.closed {
            assert!(apart(ends[0].0, ends[1].0) <= spacing && ends.iter().all(|(_, cut)| cut.is_none()));
        } else {
            for (q, cut) in ends {
                let joint = cut.expect("a limit ends it");
                let (lower, upper) = (robot.joints()[joint].lower, robot.joints()[joint].upper);
                assert!((q[joint] - lower).min(upper - q[joint]) < 1e-6, "joint {joint} at {q:?}");
            }
        }
    }
    found
}

#[test]
fn curves_of_the_self_motion_pass_every_solution() {
    for name in ["panda", "iiwa14", "gen3"] {
        let robot = robot(name);
        let mut count = 0;
        for q in configurations(&robot, 6) {
            let target = pose_at(&robot, &q);
            let found = curves(&robot, &target, 0.05);
            count += found.len();
            let on_a_curve = |q: &[f64]| found.iter().any(|curve| curve.iter().any(|point| apart(point, q) <= 0.05));
            assert!(on_a_curve(&q), "{name}: {q:?}");
            let sampled = sampled(&robot, &target, 40);
            let lost = sampled.solutions.iter().filter(|solution| !on_a_curve(solution.q)).count();
            assert_eq!(lost, 0, "{name}: {lost} of {} at {q:?}", sampled.solutions.len());
            assert!(found.iter().all(|curve| curve.complete == (name == "iiwa14")));
        }
        assert!(count >= 6, "{name}: {count} curves");
    }
}

#[test]
fn a_planar_arm_of_three_joints_moves_about_a_position() {
    let arm = Robot::planar(&[0.5, 0.4, 0.3]).unwrap();
    for q in configurations(&arm, 5) {
        let found = curves(&arm, &position_at(&arm, &q), 0.05);
        assert!(found.iter().any(|curve| curve.iter().any(|point| apart(point, &q) <= 0.05)), "{q:?}");
    }
    // Out of reach.
    assert!(curves(&arm, &Target::Position([2.0, 0.0, 0.0]), 0.05).is_empty());
}

#[test]
fn curves_are_sorted_and_asked_for_where_there_are_any() {
    let iiwa = robot("iiwa14");
    let q = configurations(&iiwa, 1).remove(0);
    let target = pose_at(&iiwa, &q);
    let options = SelfMotionOptions { start: Some(q.clone()), ..SelfMotionOptions::default() };
    let found = self_motion(&iiwa, &target, &options, &mut Unattended).unwrap();
    assert!(found[0].iter().any(|point| apart(point, &q) <= 0.05));
    let ur10 = robot("ur10");
    let says = message(self_motion(&ur10, &target, &SelfMotionOptions::default(), &mut Unattended));
    let expected =
        "self_motion needs one joint more than the target: robot 'ur10' has 6 joints, and this target takes 6";
    assert_eq!(says, expected);
    let wide = SelfMotionOptions { spacing: 1.0, ..SelfMotionOptions::default() };
    let says = message(self_motion(&iiwa, &target, &wide, &mut Unattended));
    assert_eq!(says, "spacing must be from 0.001 to 0.5, got 1");
}
