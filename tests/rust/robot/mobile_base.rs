//! Robots on a planar base, or on a floating base with a rotation vector: kinematics against nalgebra, certified motions,
//! solving, planning, several tips, and errors.

use std::f64::consts::PI;

use ikcore::Error;
use ikcore::ik::{SolveOptions, solve, solve_tips};
use ikcore::load::UrdfOptions;
use ikcore::manipulability::Motion;
use ikcore::math::{Pose, pose};
use ikcore::nalgebra::{Rotation3, Vector3};
use ikcore::obstacle::{ClearanceSweep, Edge, Scene, Surroundings};
use ikcore::planning::{Endpoint, PointToPointOptions, plan_point_to_point};
use ikcore::rng;
use ikcore::robot::{BaseLimits, MobileBase, Robot};
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Goal, NamedTask, Subject, Target, Tolerance};

use crate::common::arms::two_arms;
use crate::common::{assert_derivative, configurations, message, pose_at};

const FLOATING: [f64; 6] = [1.5, 1.5, 1.0, PI, PI, PI];

fn limits(bound: &[f64]) -> BaseLimits {
    BaseLimits {
        lower: bound.iter().map(|bound| -bound).collect(),
        upper: bound.to_vec(),
        velocity: vec![1.0; bound.len()],
        acceleration: vec![f64::INFINITY; bound.len()],
    }
}

fn arm(name: &str) -> Robot {
    Robot::named(name).unwrap().with_base(pose::translation(0.1, -0.2, 0.4)).unwrap()
}

fn planar(name: &str) -> Robot {
    arm(name).with_mobile_base(MobileBase::Planar, &limits(&[2.0, 2.0, PI])).unwrap()
}

fn floating(name: &str) -> Robot {
    arm(name).with_mobile_base(MobileBase::Floating, &limits(&FLOATING)).unwrap()
}

/// Pose of the base at q, by nalgebra.
fn base_at(q: &[f64], joints: usize) -> Pose {
    let (slide, turn) = match joints {
        3 => (Vector3::new(q[0], q[1], 0.0), Vector3::new(0.0, 0.0, q[2])),
        _ => (Vector3::new(q[0], q[1], q[2]), Vector3::new(q[3], q[4], q[5])),
    };
    Pose::from_parts(slide.into(), Rotation3::from_scaled_axis(turn))
}

/// Random configurations; some at rotation vectors of zero length, and near the longest.
fn samples(robot: &Robot) -> Vec<Vec<f64>> {
    let mut samples = configurations(robot, 40);
    for (q, length) in samples.iter_mut().take(8).zip([0.0, 1e-9, 1e-5, 1e-3, 9.9e-3, 1.01e-2, PI, 5.4]) {
        let turn = Vector3::new(q[3], q[4], q[5]).normalize() * length;
        q[3..6].copy_from_slice(turn.as_slice());
    }
    samples
}

fn assert_near(a: &Pose, b: &Pose) {
    let off = (a.to_homogeneous() - b.to_homogeneous()).amax();
    assert!(off < 2e-14, "{off:.1e} apart:\n{a}{b}");
}

#[test]
fn the_base_carries_the_arm() {
    for (mobile, joints) in [(planar("panda"), 3), (floating("panda"), 6), (floating("ur5e"), 6)] {
        let own = arm(if mobile.dof() - joints == 7 { "panda" } else { "ur5e" });
        for q in samples(&mobile) {
            let base = base_at(&q, joints);
            assert_near(&mobile.fk(&q).unwrap(), &(base * own.fk(&q[joints..]).unwrap()));
            for (link, expected) in
                mobile.all_link_poses(&q).unwrap().iter().skip(1).zip(own.link_poses(&q[joints..]).unwrap())
            {
                assert_near(link, &(base * expected));
            }
            assert_near(&mobile.link_fk("world", &q).unwrap(), &Pose::identity());
        }
    }
}

#[test]
fn its_joints_come_first() {
    let mobile = floating("panda");
    let names: Vec<&str> = mobile.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names[..7], ["base_x", "base_y", "base_z", "base_rx", "base_ry", "base_rz", "panda_joint1"]);
    assert_eq!(mobile.link_names().next(), Some("world"));
    assert_eq!(planar("panda").joints()[2].name, "base_yaw");
    let again = Robot::from_bytes(&mobile.to_bytes().unwrap()).unwrap();
    assert_eq!(again, mobile);
    // A base on a base: a floating platform on rails.
    let on_rails = mobile.with_mobile_base(MobileBase::Planar, &limits(&[1.0, 1.0, PI]));
    assert!(message(on_rails).contains("two joints are named 'base_x'"));
}

#[test]
fn derivatives_are_those_of_the_tip() {
    for robot in [planar("panda"), floating("panda"), floating("ur5e")] {
        let all = if robot.dof() == 10 { configurations(&robot, 20) } else { samples(&robot) };
        for (q, other) in all.iter().zip(configurations(&robot, 20)) {
            assert_derivative(&robot, &pose_at(&robot, &other), Tolerance::default(), q);
        }
    }
}

#[test]
fn many_at_once_are_what_each_is_alone() {
    let robot = floating("ur5e");
    let all = samples(&robot);
    let flat: Vec<f64> = all.iter().flatten().copied().collect();
    let mut next = robot.fk_all(&flat).unwrap().into_iter();
    let mut positions = vec![];
    robot.tip_positions(&flat, |position| positions.push(position));
    let scene = [Shape::sphere([0.4, 0.1, 0.5], 0.2).unwrap()];
    let with_bodies = robot.with_capsules_along_links(0.05).unwrap();
    let scene = Scene::new(&with_bodies, &scene).unwrap();
    let four = scene.clearances(&flat).unwrap();
    for ((q, position), clearance) in all.iter().zip(positions).zip(four) {
        let tip = robot.fk(q).unwrap();
        assert_eq!(tip.translation.vector, Vector3::from(position));
        let row_major: Vec<f64> = tip.to_homogeneous().transpose().iter().copied().collect();
        assert_eq!(row_major, next.by_ref().take(16).collect::<Vec<_>>());
        assert!((scene.clearance(q).unwrap() - clearance).abs() < 1e-12);
    }
}

#[test]
fn certified_motions_are_clear_and_others_are_found_out() {
    let robot = floating("ur5e").with_capsules_along_links(0.06).unwrap();
    let ball = [Shape::sphere([0.6, 0.2, 0.4], 0.25).unwrap()];
    let scene = Scene::new(&robot, &ball).unwrap().without_self_collision();
    let (mut certified, mut refused) = (0, 0);
    let ends = configurations(&robot, 300);
    for pair in ends.chunks_exact(2) {
        let at =
            |fraction: f64| -> Vec<f64> { pair[0].iter().zip(&pair[1]).map(|(a, b)| a + fraction * (b - a)).collect() };
        let least =
            (0..=400).map(|i| scene.clearance(&at(f64::from(i) / 400.0)).unwrap()).fold(f64::INFINITY, f64::min);
        let smallest =
            ClearanceSweep::new(&scene).smallest(&Edge { from: &pair[0], to: &pair[1] }, [0.0, 1.0]).unwrap();
        assert!(
            smallest.contact.distance <= least + 1e-12,
            "certified {} m, seen {least} m",
            smallest.contact.distance
        );
        assert!(smallest.contact.distance > least - 0.05);
        match ClearanceSweep::new(&scene).check(&Edge { from: &pair[0], to: &pair[1] }, [0.0, 1.0], 0.0) {
            Ok(()) => {
                certified += 1;
                assert!(least >= 0.0);
            }
            Err(_) => {
                refused += 1;
                assert!(least < 1e-3);
            }
        }
    }
    assert!(certified > 20 && refused > 20, "{certified} certified, {refused} refused");
}

#[test]
fn it_reaches_where_the_arm_alone_does_not() {
    for robot in [planar("panda"), floating("panda")] {
        let mut missed = 0;
        for (seed, goal) in (0..).zip(configurations(&robot, 200)) {
            let options = SolveOptions { seed, ..SolveOptions::default() };
            let found = solve(&robot, &pose_at(&robot, &goal), &options, &mut Unattended).unwrap();
            missed += usize::from(found.status != Status::Solved);
            let inside = robot.joints().iter().zip(&found.q).all(|(joint, q)| joint.lower <= *q && *q <= joint.upper);
            assert!(inside, "{:?}", found.q);
        }
        assert_eq!(missed, 0);
    }
}

#[test]
fn it_drives_round_an_obstacle() {
    let robot = planar("panda").with_capsules_along_links(0.05).unwrap();
    let ready = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];
    let [start, end] = [-1.5, 1.5].map(|x| [&[x, 0.0, 0.0], &ready[..]].concat());
    let pillar = vec![Shape::cylinder([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 0.3, 2.0).unwrap()];
    let options = PointToPointOptions { surroundings: Surroundings::among(pillar), ..PointToPointOptions::default() };
    let plan = plan_point_to_point(
        &robot,
        &Endpoint::Configuration(start),
        &[Endpoint::Configuration(end)],
        &options,
        &mut Unattended,
    )
    .unwrap();
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
}

#[test]
fn both_hands_of_a_floating_torso() {
    let tips = ["left_tool", "right_tool"].map(str::to_owned).to_vec();
    let torso = Robot::from_urdf_with(&two_arms(), &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap();
    let robot = torso.with_mobile_base(MobileBase::Floating, &limits(&FLOATING)).unwrap();
    assert_eq!(robot.dof(), torso.dof() + 6);
    let task = |tip| NamedTask { subject: Subject::Tip(tip), task: None, tolerance: Tolerance::default() };
    for (seed, q) in (0..).zip(configurations(&robot, 20)) {
        let base = base_at(&q, 6);
        let [left, right] = ["left_tool", "right_tool"].map(|link| robot.link_fk(link, &q).unwrap());
        assert_near(&left, &(base * torso.link_fk("left_tool", &q[6..]).unwrap()));
        let targets = [Target::from(&left), Target::from(&right)];
        let options = SolveOptions { seed, tips: vec![task(0), task(1)], ..SolveOptions::default() };
        let found = solve_tips(&robot, &targets, &options, &mut Unattended).unwrap();
        assert_eq!(found.status, Status::Solved, "{seed}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let panda = arm("panda");
    let with = |base, limits: &BaseLimits| message(panda.with_mobile_base(base, limits));
    let wrong = with(MobileBase::Planar, &limits(&[1.0; 6]));
    assert_eq!(wrong, "lower of a planar base: expected 3 joints: base_x, base_y, base_yaw, got 6");
    let open = with(MobileBase::Planar, &limits(&[1.0, f64::INFINITY, PI]));
    assert!(
        open.starts_with("lower limit of joint 'base_y' must be finite: configurations are drawn from the range"),
        "{open}"
    );
    let long = with(MobileBase::Floating, &limits(&[1.0, 1.0, 1.0, 4.0, 4.0, 4.0]));
    assert!(long.contains("below 5.97 rad") && long.contains("6.92"), "{long}");
    let mut backwards = limits(&[1.0, 1.0, PI]);
    backwards.lower[0] = 2.0;
    assert!(matches!(panda.with_mobile_base(MobileBase::Planar, &backwards), Err(Error::EmptyRange { .. })));
    // A yaw without limits goes round and round.
    let mut open = limits(&[1.0, 1.0, f64::INFINITY]);
    assert!(panda.with_mobile_base(MobileBase::Planar, &open).is_ok());
    open.lower[2] = 0.0;
    assert!(panda.with_mobile_base(MobileBase::Planar, &open).is_err());

    let robot = floating("panda");
    assert!(
        message(robot.with_mobile_base(MobileBase::Floating, &limits(&FLOATING))).contains("its base floats already")
    );
    let goals = vec![Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 }];
    let options = SolveOptions { goals, ..SolveOptions::default() };
    let target = pose_at(&robot, &configurations(&robot, 1)[0]);
    let refused = message(solve(&robot, &target, &options, &mut Unattended));
    assert!(refused.ends_with("are not for robots on a floating base"), "{refused}");
    assert_eq!(floating("panda").closed_form(), "none: 13 joints; closed forms are for 3 to 7");
    let pendulum = Robot::planar(&[1.0]).unwrap().with_mobile_base(MobileBase::Floating, &limits(&FLOATING)).unwrap();
    assert_eq!(pendulum.closed_form(), "none: the base floats");
    assert!(robot.random_configurations(3, &mut rng::stream(0, 0)).is_ok());
}
