//! Redundant arms in closed form: samples of the self-motion.

use std::f64::consts::FRAC_PI_2;

use crate::common::{configurations, pose_at, robot};
use ikcore::ik::{AllOptions, SolutionSet, SolutionView, SolveOptions, solve_all};
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
        assert!(found.complete && found.solutions.len() >= 2, "{q:?}");
        let nearest = found.solutions.get(0).unwrap().q;
        assert!(q.iter().zip(nearest).all(|(a, b)| (a - b).abs() < 1e-4), "{q:?} {nearest:?}");
    }
}
