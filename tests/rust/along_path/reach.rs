//! Reach along a path: an arm follows every path that it can, through singularities, at limits and on other branches; errors
//! claim only what is proven.

use std::f64::consts::PI;

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::Pose;
use ikcore::path::{Circle, Path, Plane, Waypoints};
use ikcore::planning::{AlongPathOptions, Plan, TipPath, plan_along_path};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Stop, Unattended};
use ikcore::task::{Task, TaskKind};

const POINTS: usize = 80;

fn through(poses: &[Pose]) -> TipPath {
    let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
    let rotations = poses.iter().map(|pose| *pose.rotation.matrix()).collect();
    TipPath::through(&Waypoints::new(positions, Some(rotations)).unwrap()).unwrap()
}

/// Path of the tip along a line in joint space.
fn line(robot: &Robot, first: &[f64], last: &[f64]) -> TipPath {
    let at = |i: usize| {
        let s = i as f64 / (POINTS - 1) as f64;
        let q: Vec<f64> = first.iter().zip(last).map(|(from, to)| from + s * (to - from)).collect();
        robot.fk(&q).unwrap()
    };
    through(&(0..POINTS).map(at).collect::<Vec<_>>())
}

fn options(robot: &Robot) -> AlongPathOptions {
    let constant = |value: f64| vec![Profile::Constant(value); robot.dof()];
    let limits = Limits::of(robot)
        .replace(Field::Velocity, constant(1.0))
        .and_then(|limits| limits.replace(Field::Acceleration, constant(5.0)))
        .unwrap();
    let stop = Some(Stop { max_evaluations: 100, ..Stop::default() });
    AlongPathOptions { limits: Some(limits), stop, ..AlongPathOptions::default() }
}

fn planned(robot: &Robot, tip_path: &TipPath, options: &AlongPathOptions) -> Result<Plan, String> {
    let plan = plan_along_path(robot, tip_path, options, &mut Unattended).map_err(|error| error.to_string())?;
    if plan.status == Status::Solved { Ok(plan) } else { Err(plan.message().to_string()) }
}

fn followed(name: &str, first: &[f64], last: &[f64]) {
    let robot = Robot::named(name).unwrap();
    let plan = planned(&robot, &line(&robot, first, last), &options(&robot));
    assert!(plan.is_ok(), "{name}: {}", plan.unwrap_err());
}

#[test]
fn a_path_through_a_straight_wrist_is_followed() {
    followed("ur5e", &[0.3, -1.6, 1.8, -1.7, 0.35, 0.2], &[0.5, -1.4, 1.6, -1.5, -0.3, 0.1]);
    followed("ur5e", &[0.0, -PI / 2.0, PI / 2.0, 0.0, 0.5, 0.0], &[0.2, -PI / 2.0, PI / 2.0, 0.0, -0.5, 0.0]);
    followed("kr210", &[0.2, -1.5, 1.4, 0.3, 0.4, 0.1], &[0.5, -1.3, 1.6, 0.3, -0.4, 0.3]);
}

#[test]
fn a_path_to_the_stretched_arm_is_followed() {
    followed("ur5e", &[0.3, -1.2, 0.8, -1.0, 1.2, 0.2], &[0.5, -1.0, 0.0, -1.0, 1.2, 0.2]);
    followed("iiwa14", &[0.0, 0.5, 0.0, -0.9, 0.0, 0.7, 0.0], &[0.0, 0.9, 0.0, 0.0, 0.0, 0.7, 0.0]);
}

#[test]
fn a_joint_that_stays_at_its_limit_keeps_it() {
    for name in ["ur5e", "iiwa14", "panda"] {
        let robot = Robot::named(name).unwrap();
        let first = robot.random_configurations(1, &mut rng::stream(3, 0)).unwrap();
        let last: Vec<f64> = first.iter().enumerate().map(|(j, q)| if j == 1 { *q } else { 0.8 * q }).collect();
        let robot = robot.with_limits(|j, joint| joint.upper = if j == 1 { first[1] } else { joint.upper }).unwrap();
        let plan = planned(&robot, &line(&robot, &first, &last), &options(&robot)).unwrap();
        assert!(plan.trajectory.position_range()[1].1 <= first[1] + 1e-12, "{name}");
    }
}

/// Random line in joint space, half of the values round, with limits that leave little room beside it.
fn drawn(robot: &Robot, rng: &mut LazyRng) -> (Robot, TipPath) {
    const ROUND: [f64; 8] = [0.0, 0.0, PI / 2.0, -PI / 2.0, PI / 4.0, -PI / 4.0, PI / 3.0, PI];
    let mut draw = || -> Vec<f64> {
        let any = robot.random_configurations(1, rng).unwrap();
        let mut round = |q: f64| {
            let pick = ROUND[rng.below(ROUND.len())];
            if rng.uniform() < 0.5 { q } else { pick }
        };
        any.into_iter().zip(robot.joints()).map(|(q, joint)| round(q).clamp(joint.lower, joint.upper)).collect()
    };
    let (first, far) = (draw(), draw());
    let last: Vec<f64> = first.iter().zip(&far).map(|(from, to)| from + 0.2 * (to - from)).collect();
    let narrow = robot
        .with_limits(|j, joint| {
            joint.lower = joint.lower.max(first[j].min(last[j]) - 0.05);
            joint.upper = joint.upper.min(first[j].max(last[j]) + 0.05);
        })
        .unwrap();
    let tip_path = line(robot, &first, &last);
    (narrow, tip_path)
}

#[test]
fn what_a_line_in_joint_space_follows_is_followed() {
    let mut lost = vec![];
    for (name, seed) in [("ur5e", 1), ("kr210", 2), ("panda", 3), ("iiwa14", 4), ("gen3", 5)] {
        let (robot, mut rng) = (Robot::named(name).unwrap(), rng::stream(seed, 0));
        for case in 0..8 {
            let (narrow, tip_path) = drawn(&robot, &mut rng);
            if let Err(said) = planned(&narrow, &tip_path, &options(&narrow)) {
                assert!(!said.contains("cannot be reached"), "{name} {case}: {said}");
                lost.push(format!("{name} {case}: {said}"));
            }
        }
    }
    assert!(lost.len() <= 2, "{lost:#?}");
}

#[test]
fn wider_tolerances_and_limits_lose_no_path() {
    for (name, seed) in [("ur5e", 11), ("panda", 12), ("gen3", 13)] {
        let (robot, mut rng) = (Robot::named(name).unwrap(), rng::stream(seed, 0));
        for case in 0..4 {
            let (narrow, tip_path) = drawn(&robot, &mut rng);
            let mut least = f64::INFINITY;
            for tolerance in [1e-4, 1e-3, 1e-2, 0.1] {
                let [p, r] = [1e-3_f64.max(0.1 * tolerance), tolerance];
                let task = Task::new(TaskKind::Pose, None, Some(&[p, p, p, r, r, r]), None).unwrap();
                let options = AlongPathOptions { task: Some(task), ..options(&narrow) };
                match planned(&narrow, &tip_path, &options) {
                    Ok(plan) => {
                        assert!(plan.cost <= 1.05 * least, "{name} {case} {tolerance}: {} s, not {least} s", plan.cost);
                        least = least.min(plan.cost);
                    }
                    Err(said) => assert!(least == f64::INFINITY, "{name} {case} {tolerance}: {said}"),
                }
            }
        }
    }
}

/// Asserts that a line in joint space with the limits of the robot takes no longer than with limits close around it.
fn no_slower_with_wide_limits(name: &str, first: &[f64], last: &[f64]) {
    let robot = Robot::named(name).unwrap();
    let narrow = robot
        .with_limits(|j, joint| {
            joint.lower = joint.lower.max(first[j].min(last[j]) - 0.003);
            joint.upper = joint.upper.min(first[j].max(last[j]) + 0.003);
        })
        .unwrap();
    let tip_path = line(&robot, first, last);
    let [narrow, wide] = [narrow, robot].map(|robot| planned(&robot, &tip_path, &options(&robot)).unwrap().cost);
    assert!(wide <= 1.01 * narrow, "{name}: {wide} s, not {narrow} s");
}

#[test]
fn wide_limits_lose_no_motion_through_a_singularity() {
    let (first, last) = ([-2.41, -1.07, -1.14, -1.07, 1.31, 3.13], [1.38, -1.08, 1.19, 1.48, 0.49, -0.06]);
    no_slower_with_wide_limits("kr210", &first, &last);
    let (first, last) = ([-0.63, -0.31, 2.31, 2.14, -1.37, -0.75], [1.77, -0.37, -0.71, -1.36, -0.26, 0.19]);
    no_slower_with_wide_limits("kr210", &first, &last);
}

#[test]
fn wide_limits_lose_no_motion_from_another_turn_or_a_singularity() {
    let (first, last) = ([PI, -0.0873, -1.889, 3.014, 1.443, -0.785], [0.942, -0.0873, -0.567, 0.286, 1.443, -0.785]);
    no_slower_with_wide_limits("kr210", &first, &last);
    no_slower_with_wide_limits("ur10", &[0.0, 0.0, -3.0, 1.0, -PI, 0.0], &[0.0, 0.0, 0.0, 0.0, 1.0, 2.0]);
}

#[test]
fn only_what_is_proven_is_called_out_of_reach() {
    let far = Plane::xy([3.0, 0.0, 0.0]).unwrap();
    let robot = Robot::named("ur5e").unwrap();
    let circle = TipPath::along(&Path::new(Circle::new(far, 0.4, 5.0).unwrap())).unwrap();
    let said = planned(&robot, &circle, &options(&robot)).unwrap_err();
    assert!(said.starts_with("the path at t = 0 s cannot be reached: the nearest configurations"), "{said}");
    // Each point is in reach, with the elbow on one side first and on the other at last.
    let robot = Robot::planar(&[1.0, 1.0]).unwrap();
    let robot = robot
        .with_limits(|j, joint| {
            if j == 0 {
                (joint.lower, joint.upper) = (-0.5, 0.5)
            }
        })
        .unwrap();
    let at = |i: usize| {
        let angle = -0.7 + 1.4 * i as f64 / (POINTS - 1) as f64;
        [1.9 * angle.cos(), 1.9 * angle.sin(), 0.0]
    };
    let arc = TipPath::through(&Waypoints::new((0..POINTS).map(at).collect(), None).unwrap()).unwrap();
    let said = planned(&robot, &arc, &options(&robot)).unwrap_err();
    assert!(said.starts_with("a motion past point ") && said.contains(" was not found: "), "{said}");
}
