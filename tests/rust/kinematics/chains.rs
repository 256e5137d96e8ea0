//! Forward kinematics, Jacobians and storage of generated chains, against plain matrix products and finite differences.

use crate::common::chains::RandomChain;
use crate::common::{bits, message, robot};
use ikcore::math::{Columns, pose};
use ikcore::nalgebra::{Matrix4, Matrix6xX, Rotation3, Vector3};
use ikcore::objective::{Objective, Score};
use ikcore::problem::Problem;
use ikcore::rng;
use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};
use ikcore::task::{Aims, Target, Tolerance};

/// Forty chains of 1 to 12 joints, up to 16 of them moving with their mimics, and five of 30 to 50, up to 64 of them moving;
/// each with a configuration up to a turn and a half from zero.
fn chains() -> impl Iterator<Item = (RandomChain, Vec<f64>)> {
    let short = (0..40).map(|seed| (seed, 1 + seed as usize % 12, 16));
    short.chain((0..5).map(|seed| (seed, 30 + 5 * seed as usize, 64))).map(|(seed, joints, moving)| {
        let chain = RandomChain::new(seed, joints, moving);
        let mut rng = rng::stream(seed, 99);
        let q = (0..chain.robot.dof()).map(|_| rng.uniform_in(-9.0, 9.0)).collect();
        (chain, q)
    })
}

#[track_caller]
fn assert_near(actual: &Matrix4<f64>, expected: &Matrix4<f64>, what: &str) {
    let error = (actual - expected).amax();
    assert!(error <= 1e-12, "{what}: off by {error:.3e}");
}

#[test]
fn tip_is_the_product_of_all_matrices() {
    for (chain, q) in chains() {
        let (robot, expected) = (&chain.robot, chain.fk(&q));
        assert_near(&robot.fk(&q).unwrap().to_homogeneous(), &expected, robot.name());
        let position = Vector3::from(robot.tip_position(&q));
        assert!((position - expected.fixed_view::<3, 1>(0, 3)).amax() <= 1e-12, "{}", robot.name());
    }
}

#[test]
fn every_link_is_the_product_up_to_it() {
    for (chain, q) in chains() {
        let (robot, expected) = (&chain.robot, chain.link_poses(&q));
        let poses = robot.link_poses(&q).unwrap();
        assert_eq!((poses.len(), robot.link_names().count()), (expected.len(), expected.len()));
        for ((name, pose), expected) in robot.link_names().zip(&poses).zip(&expected) {
            assert_near(&pose.to_homogeneous(), expected, name);
        }
        let (tip, last) = (robot.fk(&q).unwrap(), poses.last().unwrap() * robot.tool());
        assert_near(&tip.to_homogeneous(), &last.to_homogeneous(), "tip");
    }
}

/// Central differences of the tip: of its position, and of its rotation in base coordinates, R' R^T = [w]x.
fn differences(robot: &Robot, q: &[f64]) -> Matrix6xX<f64> {
    let h = 1e-6;
    let mut jacobian = Matrix6xX::zeros(q.len());
    for j in 0..q.len() {
        let at = |step: f64| {
            let mut moved = q.to_vec();
            moved[j] += step;
            robot.fk(&moved).unwrap()
        };
        let (ahead, behind) = (at(h), at(-h));
        let linear = (ahead.translation.vector - behind.translation.vector) / (2.0 * h);
        let rate = (ahead.rotation.matrix() - behind.rotation.matrix()) / (2.0 * h);
        let w = rate * at(0.0).rotation.matrix().transpose();
        let angular = 0.5 * Vector3::new(w.m32 - w.m23, w.m13 - w.m31, w.m21 - w.m12);
        jacobian.fixed_view_mut::<3, 1>(0, j).copy_from(&linear);
        jacobian.fixed_view_mut::<3, 1>(3, j).copy_from(&angular);
    }
    jacobian
}

#[test]
fn jacobian_is_the_derivative_of_the_tip() {
    for (chain, q) in chains() {
        let jacobian = chain.robot.jacobian(&q).unwrap();
        let error = (&jacobian - differences(&chain.robot, &q)).amax();
        assert!(error <= 1e-8 * jacobian.amax().max(1.0), "{}: off by {error:.3e}", chain.robot.name());
    }
}

#[test]
fn jacobian_pass_meets_the_same_tip() {
    for (chain, q) in chains() {
        let mut columns = Columns::default();
        assert_eq!(chain.robot.tip_and_jacobian(&q, &mut columns), chain.robot.tip(&q));
    }
}

#[test]
fn side_by_side_gives_the_bits_of_one_by_one() {
    for (chain, _) in chains() {
        let robot = &chain.robot;
        // Every way in which a count splits into fours, a pair and a single one.
        for count in 0..=11 {
            let qs = robot.random_configurations(count, &mut rng::stream(3, count as u64)).unwrap();
            let mut side_by_side = vec![];
            robot.tip_positions(&qs, |tip| side_by_side.push(bits(&tip)));
            let one_by_one: Vec<_> = qs.chunks_exact(robot.dof()).map(|q| bits(&robot.tip_position(q))).collect();
            assert_eq!(side_by_side, one_by_one, "{}, {count} configurations", robot.name());
        }
    }
}

#[test]
fn any_number_of_points_scores_as_one_by_one() {
    for (chain, q) in chains().take(12) {
        let target = Target::Position(chain.robot.tip_position(&q));
        let task = Tolerance::default().into();
        let mut problem = Problem::new(&chain.robot, Aims::of_one(&task, &target));
        for count in 1..=9 {
            let qs = chain.robot.random_configurations(count, &mut rng::stream(4, 0)).unwrap();
            let mut scores = vec![Score { value: f64::NAN, solved: false }; count];
            problem.evaluate_all(&qs, &mut scores);
            let one_by_one: Vec<Score> = qs.chunks_exact(q.len()).map(|q| problem.evaluate(q)).collect();
            assert_eq!(scores, one_by_one, "{} with {count} points", chain.robot.name());
        }
    }
}

/// Chain of `joints` unit links in the x-y plane.
fn planar_builder(joints: usize) -> ChainBuilder {
    let mut chain = ChainBuilder::new("snake", "base");
    for j in 0..joints {
        let joint = chain.add_joint(Joint::new(format!("joint_{j}"), JointKind::Continuous));
        chain.moving(joint, JointKind::Continuous, Vector3::z(), Drive::DIRECT);
        chain.fixed(pose::translation(1.0, 0.0, 0.0));
        chain.link(format!("link_{j}"));
    }
    chain
}

#[test]
fn every_number_of_joints_up_to_the_largest_works() {
    for joints in 1..=64 {
        let robot = planar_builder(joints).build().unwrap();
        let q: Vec<f64> = (0..joints).map(|j| 0.1 * (j as f64 - 3.0)).collect();
        let (mut angle, mut expected) = (0.0_f64, [0.0; 2]);
        for turn in &q {
            angle += turn;
            expected = [expected[0] + angle.cos(), expected[1] + angle.sin()];
        }
        let tip = robot.fk(&q).unwrap();
        let error = (tip.translation.x - expected[0]).abs().max((tip.translation.y - expected[1]).abs());
        assert!(error <= 1e-13 * joints as f64, "{joints} joints: off by {error:.3e}");
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        assert!((tip.rotation.matrix() - turned.matrix()).amax() < 1e-13, "{joints} joints");
        let jacobian = robot.jacobian(&q).unwrap();
        assert_eq!(jacobian.ncols(), joints);
        assert!((jacobian - differences(&robot, &q)).amax() < 1e-7, "{joints} joints");
    }
}

#[test]
fn one_joint_more_is_too_many() {
    let problem = "65 moving joints between base and tip; at most 64 are supported";
    assert_eq!(message(planar_builder(65).build()), format!("robot 'snake': {problem}"));
}

#[test]
fn bytes_bring_back_an_equal_robot() {
    for (chain, q) in chains() {
        let restored = Robot::from_bytes(&chain.robot.to_bytes().unwrap()).unwrap();
        assert_eq!(restored, chain.robot);
        assert_eq!(restored.tip(&q), chain.robot.tip(&q));
    }
}

#[test]
fn bytes_of_something_else_are_refused() {
    let mut bytes = robot("iiwa14").to_bytes().unwrap();
    assert_eq!(message(Robot::from_bytes(&[])), "cannot restore robot: no bytes");
    assert!(message(Robot::from_bytes(&bytes[..40])).starts_with("cannot restore robot: "));
    bytes[0] = 200;
    let expected = "cannot restore robot: it was stored in format 200 by a later version of beetle-ik, and this one reads \
                    format 3: make it anew";
    assert_eq!(message(Robot::from_bytes(&bytes)), expected);
}

#[test]
fn robots_are_equal_when_everything_is() {
    let iiwa = robot("iiwa14");
    assert_eq!(iiwa, robot("iiwa14"));
    assert_ne!(iiwa, robot("iiwa7"));
    assert_ne!(iiwa, iiwa.with_tool(pose::translation(0.0, 0.0, 0.1)).unwrap());
    assert_ne!(iiwa, iiwa.with_base(pose::translation(0.0, 0.0, 0.1)).unwrap());
    assert_ne!(iiwa, iiwa.with_limits(|_, joint| joint.velocity = 1.0).unwrap());
}

#[test]
fn configurations_are_drawn_inside_the_limits_and_repeat() {
    for name in Robot::names() {
        let robot = robot(name);
        let draw = |seed| robot.random_configurations(200, &mut rng::stream(seed, 0)).unwrap();
        assert_eq!(bits(&draw(1)), bits(&draw(1)));
        assert_ne!(draw(1), draw(2));
        for q in draw(1).chunks_exact(robot.dof()) {
            for (value, joint) in q.iter().zip(robot.joints()) {
                assert!(joint.lower <= *value && *value <= joint.upper, "{name}, {}: {value}", joint.name);
            }
        }
    }
}

#[test]
fn joints_without_limits_are_drawn_from_a_finite_range() {
    let (inf, pi) = (f64::INFINITY, std::f64::consts::PI);
    let range = |kind, lower, upper| Joint::new("j", kind).with_range(lower, upper).sampling_range();
    assert_eq!(range(JointKind::Continuous, -inf, inf), (-pi, pi));
    assert_eq!(range(JointKind::Revolute, 1.0, inf), (1.0, 1.0 + 2.0 * pi));
    assert_eq!(range(JointKind::Prismatic, -inf, inf), (-1.0, 1.0));
    assert_eq!(range(JointKind::Prismatic, -inf, 0.5), (-1.5, 0.5));
}
