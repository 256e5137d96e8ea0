//! Dynamics of random chains, of arms in two hands and of mobile and floating bases, against the energies that Jacobians of the links
//! give, and Lagrange's equations by finite differences.

use std::f64::consts::{FRAC_PI_2, PI};

use ikcore::dynamics::Inertia;
use ikcore::load::UrdfOptions;
use ikcore::nalgebra::{DMatrix, DVector, Matrix3, Matrix6xX, Rotation3, Vector3};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{BaseLimits, MobileBase, Motions, Robot};

use crate::common::arms::two_arms;
use crate::common::chains::RandomChain;
use crate::common::{message, robot};

/// Robots with an inertia of each link: random chains with mimic joints, alone, on a base that drives and on one that floats, and two
/// arms.
pub(super) fn robots() -> Vec<Robot> {
    let limits = |bound: &[f64]| BaseLimits {
        lower: bound.iter().map(|bound| -bound).collect(),
        upper: bound.to_vec(),
        velocity: vec![1.0; bound.len()],
        acceleration: vec![1.0; bound.len()],
    };
    let tips = ["left_tool", "right_tool"].map(str::to_owned).to_vec();
    let pair = Robot::from_urdf_with(&two_arms(), &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap();
    let mut robots = vec![pair];
    for seed in 0..16 {
        let chain = RandomChain::new(seed, 1 + seed as usize % 8, 14).robot;
        robots.push(match seed % 4 {
            2 => chain.with_mobile_base(MobileBase::Planar, &limits(&[3.0, 3.0, PI])).unwrap(),
            3 => chain.with_mobile_base(MobileBase::Floating, &limits(&[3.0, 3.0, 3.0, PI, PI, PI])).unwrap(),
            _ => chain,
        });
    }
    robots.iter().enumerate().map(|(seed, robot)| with_masses(robot, seed as u64)).collect()
}

fn with_masses(robot: &Robot, seed: u64) -> Robot {
    let mut rng = rng::stream(seed, 7);
    let links: Vec<String> = robot.all_link_names().map(str::to_owned).collect();
    let inertias: Vec<(&str, Inertia)> = links.iter().map(|link| (link.as_str(), inertia(&mut rng))).collect();
    robot.with_inertias(inertias).unwrap().with_gravity([0.3, -0.4, -9.81]).unwrap()
}

/// A body: three point masses on each side of its centre, along axes of no special direction.
fn inertia(rng: &mut LazyRng) -> Inertia {
    let mut number = |bound: f64| rng.uniform_in(-bound, bound);
    let center = [number(0.3), number(0.3), number(0.3)];
    let turn = Rotation3::from_euler_angles(number(3.0), number(1.5), number(3.0));
    let [x, y, z] = [number(0.2), number(0.2), number(0.2)].map(|length| length * length);
    let principal = Matrix3::from_diagonal(&Vector3::new(y + z, z + x, x + y));
    Inertia::turned(2.1 + number(2.0), center, turn.matrix(), &principal)
}

/// States of a robot: zeros, right angles and reals, mixed.
pub(super) fn states(robot: &Robot, seed: u64) -> Vec<[Vec<f64>; 3]> {
    let mut rng = rng::stream(seed, 8);
    let mut states = vec![];
    for round in [0.0, 0.5, 1.0] {
        let entry = |choices: [f64; 4], rng: &mut LazyRng| {
            let real = rng.uniform_in(-2.0, 2.0);
            let choice = choices[(rng.uniform() * 4.0) as usize % 4];
            if rng.uniform() < round { choice } else { real }
        };
        let q = (0..robot.dof()).map(|_| entry([0.0, FRAC_PI_2, -FRAC_PI_2, 1.0], &mut rng)).collect();
        let qd = (0..robot.dof()).map(|_| entry([0.0, 0.0, 1.0, -1.0], &mut rng)).collect();
        let qdd = (0..robot.dof()).map(|_| entry([0.0, 0.0, 1.0, -1.0], &mut rng)).collect();
        states.push([q, qd, qdd]);
    }
    states
}

fn mass_matrix(robot: &Robot, q: &[f64]) -> DMatrix<f64> {
    DMatrix::from_row_slice(q.len(), q.len(), &robot.mass_matrix_all(q).unwrap())
}

fn torques(robot: &Robot, [q, qd, qdd]: [&[f64]; 3]) -> DVector<f64> {
    DVector::from_vec(robot.torques_all(&Motions { q, qd: Some(qd), qdd: Some(qdd), wrenches: None }).unwrap())
}

/// Jacobian of the centre of a link (linear rows first), and its inertia matrix in base axes.
fn link_motion(robot: &Robot, link: &str, inertia: &Inertia, q: &[f64]) -> (Matrix6xX<f64>, Matrix3<f64>) {
    let mut jacobian = Matrix6xX::from_row_slice(&robot.link_jacobian_all(link, q).unwrap());
    let turn = *robot.link_fk(link, q).unwrap().rotation.matrix();
    let lever = turn * Vector3::from(inertia.center);
    for mut column in jacobian.column_iter_mut() {
        let swept = Vector3::new(column[3], column[4], column[5]).cross(&lever);
        (0..3).for_each(|k| column[k] += swept[k]);
    }
    (jacobian, turn * Matrix3::from(inertia.matrix) * turn.transpose())
}

#[test]
fn mass_matrix_has_the_kinetic_energy_of_all_links() {
    for (seed, robot) in robots().iter().enumerate() {
        for [q, ..] in states(robot, seed as u64) {
            let mut expected = DMatrix::zeros(q.len(), q.len());
            for known in robot.inertias() {
                let (jacobian, matrix) = link_motion(robot, &known.link, &known.inertia, &q);
                let (linear, angular) = (jacobian.fixed_rows::<3>(0), jacobian.fixed_rows::<3>(3));
                expected += known.inertia.mass * linear.transpose() * linear + angular.transpose() * matrix * angular;
            }
            let found = mass_matrix(robot, &q);
            assert!((&found - &expected).amax() <= 1e-12 * expected.amax(), "{}: {found} {expected}", robot.name());
            assert!((&found - found.transpose()).amax() == 0.0, "{}", robot.name());
        }
    }
}

#[test]
fn torques_satisfy_the_equations_of_lagrange() {
    let h = 1e-5;
    for (seed, robot) in robots().iter().enumerate() {
        for [q, qd, qdd] in states(robot, seed as u64) {
            let rates = DVector::from_column_slice(&qd);
            let moved = |direction: &dyn Fn(usize) -> f64, step: f64| -> Vec<f64> {
                q.iter().enumerate().map(|(i, q)| q + step * direction(i)).collect()
            };
            let along = |direction: &dyn Fn(usize) -> f64| {
                let [after, before] = [h, -h].map(|step| mass_matrix(robot, &moved(direction, step)));
                (after - before) / (2.0 * h)
            };
            let potential = |q: &[f64]| {
                let center = Vector3::from_column_slice(&robot.center_of_mass_all(q).unwrap());
                let mass: f64 = robot.inertias().iter().map(|known| known.inertia.mass).sum();
                -mass * center.dot(&Vector3::from(robot.gravity()))
            };
            // d/dt (M qd) - 1/2 qd' dM/dq qd + dU/dq.
            let mut expected = mass_matrix(robot, &q) * DVector::from_column_slice(&qdd) + along(&|i| qd[i]) * &rates;
            for i in 0..q.len() {
                let axis = |k: usize| f64::from(u8::from(k == i));
                let [after, before] = [h, -h].map(|step| potential(&moved(&axis, step)));
                expected[i] += (after - before) / (2.0 * h) - 0.5 * rates.dot(&(along(&axis) * &rates));
            }
            let found = torques(robot, [&q, &qd, &qdd]);
            assert!(
                (&found - &expected).amax() <= 1e-6 * (1.0 + expected.amax()),
                "{}: {found} {expected}",
                robot.name()
            );
        }
    }
}

#[test]
fn accelerations_undo_torques() {
    for (seed, robot) in robots().iter().enumerate() {
        for [q, qd, qdd] in states(robot, seed as u64) {
            let torques = torques(robot, [&q, &qd, &qdd]);
            let found = DVector::from_vec(robot.accelerations_all(&q, &qd, torques.as_slice()).unwrap());
            let condition = mass_matrix(robot, &q).singular_values();
            let condition = condition.max() / condition.min();
            let error = (found - DVector::from_column_slice(&qdd)).amax();
            assert!(error <= 1e-13 * condition.max(1e2), "{}: {error} {condition}", robot.name());
        }
    }
}

#[test]
fn torques_at_rest_are_those_of_motions_without_motion() {
    for (seed, robot) in robots().iter().enumerate() {
        for [q, ..] in states(robot, seed as u64) {
            let rest = vec![0.0; q.len()];
            let full = torques(robot, [&q, &rest, &rest]);
            let holding = Motions { q: &q, qd: None, qdd: None, wrenches: None };
            let holding = DVector::from_vec(robot.torques_all(&holding).unwrap());
            assert!((&full - holding).amax() <= 1e-12 * (1.0 + full.amax()), "{}", robot.name());
        }
    }
}

#[test]
fn a_wrench_at_the_tip_takes_its_share_by_the_jacobian() {
    let wrench = [1.0, -2.0, 3.0, 0.5, 0.25, -0.125];
    for (seed, robot) in robots().iter().enumerate().filter(|(_, robot)| robot.tip_count() == 1) {
        for [q, qd, qdd] in states(robot, seed as u64) {
            let motions = Motions { q: &q, qd: Some(&qd), qdd: Some(&qdd), wrenches: Some(&wrench) };
            let found = DVector::from_vec(robot.torques_all(&motions).unwrap());
            let share = robot.jacobian(&q).unwrap().transpose() * DVector::from_column_slice(&wrench);
            let expected = torques(robot, [&q, &qd, &qdd]) - share;
            assert!((found - &expected).amax() <= 1e-11 * (1.0 + expected.amax()), "{}", robot.name());
        }
    }
}

#[test]
fn a_payload_is_a_link_more() {
    let arm = with_masses(&robot("panda"), 3);
    let payload = inertia(&mut rng::stream(3, 9));
    let carried = arm.with_payload(None, payload).unwrap();
    let q = [0.1, -0.2, 0.3, -1.5, 0.5, 1.7, 0.8];
    let tip = arm.link_names().last().unwrap().to_owned();
    let (jacobian, matrix) = link_motion(&arm, &tip, &payload, &q);
    let (linear, angular) = (jacobian.fixed_rows::<3>(0), jacobian.fixed_rows::<3>(3));
    let more = payload.mass * linear.transpose() * linear + angular.transpose() * matrix * angular;
    let difference = mass_matrix(&carried, &q) - mass_matrix(&arm, &q);
    assert!((difference - more).amax() < 1e-12);
    assert_eq!(carried.with_payload(None, Inertia::point(0.0, [0.0; 3])).unwrap(), arm);
}

#[test]
fn robots_without_masses_say_what_is_missing() {
    let arm = robot("kr210");
    assert_eq!(
        message(arm.torques_all(&Motions { q: &[0.0; 6], qd: None, qdd: None, wrenches: None })),
        "robot 'kr210' has no dynamics: no link has a mass: give its links inertias"
    );
    let first = arm.all_link_names().nth(1).unwrap().to_owned();
    let partly = arm.with_inertias([(first.as_str(), Inertia::point(1.0, [0.0; 3]))]).unwrap();
    assert_eq!(
        message(partly.mass_matrix_all(&[0.0; 6])),
        "robot 'kr210' has no dynamics: joint 'joint_a2' moves no mass: give its links inertias"
    );
}
