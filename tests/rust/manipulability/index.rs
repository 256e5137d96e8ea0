//! Yoshikawa's index, its gradient, the ellipsoid, and the indices of the links.

use std::f64::consts::PI;

use crate::common::chains::RandomChain;
use crate::common::{message, robot};
use ikcore::manipulability::{Manipulability, Motion, manipulability, manipulability_all};
use ikcore::math::pose;
use ikcore::nalgebra::Vector6;
use ikcore::rng;
use ikcore::robot::Robot;

const MOTIONS: [Motion; 3] = [Motion::Pose, Motion::Position, Motion::Rotation];

/// Thirty chains of 1 to 10 joints with prismatic and mimic joints, and four built-in arms; each with a configuration.
fn arms() -> impl Iterator<Item = (Robot, Vec<f64>)> {
    let random = (0..30).map(|seed| RandomChain::new(seed, 1 + seed as usize % 10, 14).robot);
    let named = ["iiwa14", "panda", "ur5e", "hydraulic3"].map(robot);
    let planar = Robot::planar(&[0.5, 0.4, 0.3, 0.2])
        .unwrap()
        .with_base(pose::from_rpy([0.1, 0.2, 0.3], [0.4, 1.0, 2.0]))
        .unwrap();
    random.chain(named).chain([planar]).enumerate().map(|(i, robot)| {
        let mut rng = rng::stream(i as u64, 7);
        let q = (0..robot.dof()).map(|_| rng.uniform_in(-1.5, 1.5)).collect();
        (robot, q)
    })
}

/// Central differences of `f` with respect to q.
fn differences(q: &[f64], mut f: impl FnMut(&[f64]) -> f64) -> Vec<f64> {
    let h = 1e-6;
    let mut moved = q.to_vec();
    let mut difference = |j: usize| {
        moved[j] = q[j] + h;
        let after = f(&moved);
        moved[j] = q[j] - h;
        let before = f(&moved);
        moved[j] = q[j];
        (after - before) / (2.0 * h)
    };
    (0..q.len()).map(&mut difference).collect()
}

#[track_caller]
fn assert_near(actual: &[f64], expected: &[f64], scale: f64, what: &str) {
    let error = actual.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(error <= 2e-7 * scale.max(1.0), "{what}: off by {error:.3e}\n{actual:?}\n{expected:?}");
}

#[test]
fn the_gradient_is_that_of_finite_differences() {
    for (robot, q) in arms() {
        for motion in MOTIONS {
            let measure = Manipulability::of(&robot, motion);
            let mut gradient = vec![f64::NAN; q.len()];
            let index = measure.gradient(&robot, &q, &mut gradient);
            assert!((index - measure.index(&robot, &q)).abs() <= 1e-12 * index.max(1.0), "{} {motion}", robot.name());
            let expected = differences(&q, |q| measure.index(&robot, q));
            assert_near(&gradient, &expected, index, &format!("{} {motion}", robot.name()));
        }
    }
}

#[test]
fn the_gradient_of_the_sum_is_that_of_finite_differences() {
    for (robot, q) in arms() {
        let measure = Manipulability::of(&robot, Motion::Position);
        let mut gradient = vec![f64::NAN; q.len()];
        let sum = measure.overall_gradient(&robot, &q, &mut gradient);
        assert!((sum - measure.link_indices(&robot, &q).sum()).abs() <= 1e-12 * sum.max(1.0), "{}", robot.name());
        let expected = differences(&q, |q| measure.link_indices(&robot, q).sum());
        assert_near(&gradient, &expected, sum, robot.name());
    }
}

#[test]
fn the_index_is_the_root_of_the_determinant() {
    for name in ["iiwa14", "panda", "ur5e"] {
        let robot = robot(name);
        let q: Vec<f64> = (0..robot.dof()).map(|i| 0.3 + 0.2 * i as f64).collect();
        let jacobian = robot.jacobian(&q).unwrap();
        let rows = |from: usize, count: usize| {
            let part = jacobian.rows(from, count);
            (part * part.transpose()).determinant().sqrt()
        };
        for (motion, expected) in MOTIONS.into_iter().zip([rows(0, 6), rows(0, 3), rows(3, 3)]) {
            let index = manipulability(&robot, motion, &q).unwrap();
            assert!((index - expected).abs() < 1e-12, "{name} {motion}: {index} {expected}");
            assert_eq!(manipulability_all(&robot, motion, &q.repeat(2)).unwrap(), [index, index]);
        }
    }
}

#[test]
fn a_planar_arm_has_the_directions_of_its_plane() {
    let arm = Robot::planar(&[0.7, 0.4]).unwrap().with_base(pose::from_rpy([0.0; 3], [0.3, 0.8, 0.1])).unwrap();
    let measure = Manipulability::of(&arm, Motion::Position);
    assert_eq!(measure.rank(), 2);
    // Yoshikawa 1985: w = l1 l2 |sin q2|.
    assert!((measure.index(&arm, &[0.4, 0.9]) - 0.28 * 0.9_f64.sin()).abs() < 1e-14);
    assert_eq!(Manipulability::of(&arm, Motion::Rotation).rank(), 1);
    assert_eq!(Manipulability::of(&arm, Motion::Pose).rank(), 2);
}

#[test]
fn link_indices_of_three_links_are_the_formulas_of_the_paper() {
    let arm = Robot::planar(&[0.5, 0.5, 0.5]).unwrap();
    let q = [0.3, 1.1, -0.7];
    let measure = Manipulability::of(&arm, Motion::Position);
    let indices = measure.link_indices(&arm, &q);
    // SM_1: one joint moves the first tip along a line, no ellipse; SM_2 = pi l^2 |sin q2|.
    assert_eq!(indices.values()[0], 0.0);
    assert!((indices.values()[1] - PI * 0.25 * 1.1_f64.sin()).abs() < 1e-14);
    let jacobian = arm.jacobian(&q).unwrap();
    let j = jacobian.rows(0, 2);
    assert!((indices.values()[2] - PI * (j * j.transpose()).determinant().sqrt()).abs() < 1e-13);
    assert_eq!(indices.sum(), indices.values().iter().sum::<f64>());
}

#[test]
fn the_ellipsoid_bounds_the_velocities_of_unit_joint_speeds() {
    for (robot, q) in arms() {
        for motion in MOTIONS {
            let ellipsoid = Manipulability::of(&robot, motion).ellipsoid(&robot, &q);
            let jacobian = robot.jacobian(&q).unwrap();
            for (length, axis) in ellipsoid.lengths.iter().zip(&ellipsoid.axes) {
                // J' u has the length of the semi-axis.
                let along = jacobian.transpose() * Vector6::from_row_slice(axis);
                assert!((along.norm() - length).abs() < 1e-12, "{} {motion}", robot.name());
            }
            assert!(ellipsoid.lengths.is_sorted_by(|a, b| a >= b));
            assert!((0.0..=1.0 + 1e-12).contains(&ellipsoid.isotropy()), "{}", ellipsoid.isotropy());
            assert!(ellipsoid.condition() >= 1.0);
        }
    }
}

#[test]
fn a_stretched_arm_has_lost_a_direction() {
    let arm = Robot::planar(&[1.0, 1.0, 1.0]).unwrap();
    let measure = Manipulability::of(&arm, Motion::Position);
    let ellipsoid = measure.ellipsoid(&arm, &[0.4, 0.0, 0.0]);
    assert_eq!((ellipsoid.index(), ellipsoid.condition(), ellipsoid.isotropy()), (0.0, f64::INFINITY, 0.0));
    let mut gradient = [f64::NAN; 3];
    measure.gradient(&arm, &[0.4, 0.0, 0.0], &mut gradient);
    assert!(gradient.iter().all(|entry| entry.is_finite()), "{gradient:?}");
}

#[test]
fn unit_balls_have_their_volumes() {
    let volume = |name: &str, motion| Manipulability::of(&robot(name), motion).unit_ball();
    assert_eq!(volume("hydraulic3", Motion::Position), PI);
    assert!((volume("iiwa14", Motion::Position) - 4.0 / 3.0 * PI).abs() < 1e-15);
    assert!((volume("iiwa14", Motion::Pose) - PI.powi(3) / 6.0).abs() < 1e-14);
}

#[test]
fn wrong_words_and_wrong_numbers_are_named() {
    let error = message("speed".parse::<Motion>());
    assert_eq!(error, "motion must be one of 'pose', 'position', 'rotation', got 'speed'");
    let error = message(manipulability(&robot("iiwa14"), Motion::Pose, &[0.0; 6]));
    assert_eq!(error, "joint angles of robot 'iiwa14': expected 7 joints, got 6");
}
