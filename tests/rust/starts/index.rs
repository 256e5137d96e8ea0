//! Starts from the robot's index: near the target, inside the box, shared and repeatable; random robots reach random targets
//! from them.

use crate::common::chains::RandomChain;
use crate::common::{pose_at, position_at, robot};
use ikcore::ik::{Solution, SolveOptions, solve};
use ikcore::math::{Frame, pose};
use ikcore::nalgebra::Vector3;
use ikcore::objective::{Bounds, Objective};
use ikcore::problem::Problem;
use ikcore::rng;
use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Aims, Target, Tolerance};

/// Number of indexed starts for one target.
const INDEXED: usize = 8;

fn box_of(robot: &Robot) -> Bounds {
    let (lower, upper): (Vec<_>, Vec<_>) = robot.joints().iter().map(|joint| (joint.lower, joint.upper)).unzip();
    Bounds::new(&lower, &upper).unwrap()
}

/// First `count` starts proposed for `target`.
fn starts(robot: &Robot, target: &Target, bounds: &Bounds, seed: u64, count: usize) -> Vec<Vec<f64>> {
    let task = Tolerance::default().into();
    let mut problem = Problem::new(robot, Aims::of_one(&task, target));
    let mut rng = rng::stream(seed, 0);
    let propose = |attempt| {
        let mut q = vec![0.0; robot.dof()];
        problem.propose_start(attempt, bounds, &mut rng, &mut q);
        q
    };
    (0..count).map(propose).collect()
}

fn solved(robot: &Robot, target: &Target, seed: u64) -> Solution {
    solve(robot, target, &SolveOptions { seed, ..SolveOptions::default() }, &mut Unattended).unwrap()
}

/// Mean value r'r of the first start and of a random one, over `count` targets.
fn first_and_random(robot: &Robot, count: usize, target_at: impl Fn(&Robot, &[f64]) -> Target) -> (f64, f64) {
    let goals = robot.random_configurations(count, &mut rng::stream(5, 0)).unwrap();
    let randoms = robot.random_configurations(count, &mut rng::stream(6, 0)).unwrap();
    let (mut first, mut random) = (0.0, 0.0);
    for (goal, drawn) in goals.chunks_exact(robot.dof()).zip(randoms.chunks_exact(robot.dof())) {
        let target = target_at(robot, goal);
        first += target
            .assess(robot, &starts(robot, &target, &box_of(robot), 0, 1)[0], &Tolerance::default().into())
            .score
            .value;
        random += target.assess(robot, drawn, &Tolerance::default().into()).score.value;
    }
    (first / count as f64, random / count as f64)
}

#[test]
fn the_first_start_is_far_nearer_than_a_random_one() {
    for name in ["iiwa14", "panda", "ur5e", "kr210"] {
        let (first, random) = first_and_random(&robot(name), 200, pose_at);
        assert!(first < random / 25.0, "{name}: {first} against {random}");
        let (first, random) = first_and_random(&robot(name), 200, position_at);
        assert!(first < random / 100.0, "{name}, position: {first} against {random}");
    }
}

#[test]
fn an_arm_of_one_joint_is_turned_onto_its_target_at_once() {
    let mut builder = ChainBuilder::new("crank", "base");
    builder.add_joint(Joint::new("turn", JointKind::Revolute).with_range(-3.0, 3.0));
    builder.moving(0, JointKind::Revolute, Vector3::x(), Drive { scale: -0.5, offset: 0.3 });
    builder.fixed(pose::translation(0.1, 0.2, 0.3));
    let crank = builder.build().unwrap();
    for target in [pose_at(&crank, &[2.4]), position_at(&crank, &[2.4])] {
        let start = &starts(&crank, &target, &box_of(&crank), 0, 1)[0];
        assert!((start[0] - 2.4).abs() < 1e-12, "{start:?}");
    }
}

#[test]
fn base_and_tool_change_nothing_but_the_target() {
    let arm = robot("panda");
    let base = pose::from_rpy([0.4, -0.3, 2.0], [0.5, -1.0, 0.3]);
    let tool = pose::from_rpy([0.1, 0.7, -0.4], [0.02, 0.05, 0.2]);
    let moved = arm.with_base(base).unwrap().with_tool(tool).unwrap();
    let goals = arm.random_configurations(50, &mut rng::stream(8, 0)).unwrap();
    for goal in goals.chunks_exact(7) {
        let here = starts(&arm, &pose_at(&arm, goal), &box_of(&arm), 0, 1);
        let there = starts(&moved, &pose_at(&moved, goal), &box_of(&arm), 0, 1);
        assert!(here[0].iter().zip(&there[0]).all(|(a, b)| (a - b).abs() < 1e-9), "{here:?} {there:?}");
    }
}

#[test]
fn indexed_starts_do_not_depend_on_the_seed_and_random_ones_do() {
    let arm = robot("ur5e");
    let target = pose_at(&arm, &[0.3, -0.9, 1.2, 0.4, -1.0, 0.7]);
    let (one, other) =
        (starts(&arm, &target, &box_of(&arm), 1, INDEXED + 4), starts(&arm, &target, &box_of(&arm), 2, INDEXED + 4));
    assert_eq!(one[0], other[0]);
    assert_ne!(one[INDEXED], other[INDEXED]);
    assert_eq!(one, starts(&robot("ur5e"), &target, &box_of(&arm), 1, INDEXED + 4), "an index built afresh");
}

#[test]
fn starts_lie_inside_whatever_box_is_asked_for() {
    let mut draws = rng::stream(11, 0);
    for name in ["iiwa14", "kr210", "hydraulic3", "gen3"] {
        let arm = robot(name);
        for _ in 0..100 {
            let corners = arm.random_configurations(3, &mut draws).unwrap();
            let rows: Vec<_> = corners.chunks_exact(arm.dof()).collect();
            let (lower, upper): (Vec<_>, Vec<_>) =
                rows[0].iter().zip(rows[1]).map(|(a, b)| (a.min(*b), a.max(*b))).unzip();
            let bounds = Bounds::new(&lower, &upper).unwrap();
            let target = pose_at(&arm, rows[2]);
            let outside = starts(&arm, &target, &bounds, 0, INDEXED + 2).into_iter().find(|q| !bounds.contains(q));
            assert_eq!(outside, None, "{name}");
        }
    }
}

#[test]
fn other_limits_get_an_index_of_their_own() {
    let arm = robot("iiwa14");
    let target = pose_at(&arm, &[0.1; 7]);
    let wide = starts(&arm, &target, &box_of(&arm), 0, 1);
    let narrow = arm.with_limits(|_, joint| (joint.lower, joint.upper) = (-0.3, 0.3)).unwrap();
    let start = starts(&narrow, &target, &box_of(&narrow), 0, 1);
    assert_ne!(wide, start);
    // In so narrow a range the index is dense: its best entry is nearly there.
    assert!(target.assess(&narrow, &start[0], &Tolerance::default().into()).score.value < 0.05, "{start:?}");
}

#[test]
fn random_robots_of_six_joints_and_more_reach_their_targets() {
    for joints in 6..=12 {
        for seed in 0..12 {
            let chain = RandomChain::new(seed, joints, joints + 3);
            let arm = &chain.robot;
            let goals = arm.random_configurations(25, &mut rng::stream(seed, 77)).unwrap();
            for (goal, number) in goals.chunks_exact(joints).zip(0..) {
                for target in [pose_at(arm, goal), position_at(arm, goal)] {
                    let solution = solved(arm, &target, number);
                    assert_eq!(solution.status, Status::Solved, "{joints} joints, robot {seed}, target {number}");
                    assert!(box_of(arm).contains(&solution.q), "{joints} joints, robot {seed}, target {number}");
                }
            }
        }
    }
}

#[test]
fn robots_of_1_to_32_joints_with_or_without_limits_solve() {
    for joints in [1, 2, 3, 5, 16, 32] {
        let chain = RandomChain::new(3, joints, joints);
        let free = chain.robot.with_limits(|_, joint| {
            (joint.lower, joint.upper) = (f64::NEG_INFINITY, f64::INFINITY);
        });
        for arm in [&chain.robot, &free.unwrap()] {
            let goals = chain.robot.random_configurations(10, &mut rng::stream(4, 0)).unwrap();
            for goal in goals.chunks_exact(joints) {
                let solution = solved(arm, &pose_at(arm, goal), 0);
                assert_eq!(solution.status, Status::Solved, "{joints} joints: {}", solution.message());
            }
        }
    }
}

/// Number of restarts per target: the measure of the index. Random starts need 0.8 to 2.3.
#[test]
fn few_targets_need_a_second_start() {
    for (name, most) in [("iiwa14", 0.25), ("panda", 0.5), ("ur5e", 0.5), ("kr210", 0.35)] {
        let arm = robot(name);
        let goals = arm.random_configurations(500, &mut rng::stream(21, 0)).unwrap();
        let restarts = |(goal, seed)| {
            let solution = solved(&arm, &pose_at(&arm, goal), seed);
            assert_eq!(solution.status, Status::Solved, "{name}, target {seed}");
            solution.restarts
        };
        let mean = goals.chunks_exact(arm.dof()).zip(0..).map(restarts).sum::<usize>() as f64 / 500.0;
        assert!(mean < most, "{name}: {mean} restarts a target");
    }
}

#[test]
fn a_target_on_the_first_axis_has_starts_too() {
    let arm = robot("iiwa14");
    let upright = Target::Pose(arm.tip(&[0.0; 7]));
    let folded = Target::Pose(Frame { origin: [0.0, 0.0, 0.9], ..Frame::IDENTITY });
    for target in [upright, folded] {
        assert!(starts(&arm, &target, &box_of(&arm), 0, INDEXED).iter().flatten().all(|value| value.is_finite()));
        let solution = solved(&arm, &target, 0);
        assert_eq!(solution.status, Status::Solved, "{}", solution.message());
    }
}

#[test]
fn a_robot_copied_through_bytes_solves_to_the_same_bits() {
    let arm = robot("panda");
    let target = pose_at(&arm, &[0.2, -0.4, 0.3, -1.8, 0.1, 1.7, 0.6]);
    let copy = Robot::from_bytes(&arm.to_bytes().unwrap()).unwrap();
    assert_eq!(solved(&arm, &target, 3).q, solved(&copy, &target, 3).q);
}
