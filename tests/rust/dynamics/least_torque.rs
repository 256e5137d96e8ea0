//! Cost and gradient of the goal LeastTorque, on random chains, arms in two hands and bases that drive and float.

use ikcore::objective::Bounds;
use ikcore::rng;
use ikcore::robot::{Motions, Robot};
use ikcore::task::{Goal, Goals};

use super::laws::{robots, states};
use crate::common::robot;

/// What torques are compared with: reals, and infinity for some joints.
fn scales(robot: &Robot, seed: u64) -> Vec<f64> {
    let mut rng = rng::stream(seed, 9);
    let scale = |_| if rng.uniform() < 0.2 { f64::INFINITY } else { rng.uniform_in(1.0, 100.0) };
    let mut scales: Vec<f64> = (0..robot.dof()).map(scale).collect();
    scales[robot.dof() - 1] = 30.0;
    scales
}

fn goals(robot: &Robot, relative_to: Option<Vec<f64>>) -> Goals {
    let goal = Goal::LeastTorque { relative_to, weight: 0.7 };
    goal.validate(robot, false).unwrap();
    let bounds = Bounds::new(&vec![-9.0; robot.dof()], &vec![9.0; robot.dof()]).unwrap();
    Goals::new(&[goal], robot, &bounds)
}

fn holding(robot: &Robot, q: &[f64]) -> Vec<f64> {
    robot.torques_all(&Motions { q, qd: None, qdd: None, wrenches: None }).unwrap()
}

/// The joints of a base that floats have no motors.
fn floats(robot: &Robot, joint: usize) -> bool {
    robot.joints()[5].name == "base_rz" && joint < 6
}

#[test]
fn the_cost_is_that_of_the_torques_at_rest() {
    for (seed, robot) in robots().iter().enumerate() {
        let scale = scales(robot, seed as u64);
        let mut goals = goals(robot, Some(scale.clone()));
        for [q, ..] in states(robot, seed as u64) {
            let share = |(j, (torque, scale)): (usize, (&f64, &f64))| {
                if robot.dof() > 6 && floats(robot, j) { 0.0 } else { (torque / scale).powi(2) }
            };
            let right: f64 = 0.7 * holding(robot, &q).iter().zip(&scale).enumerate().map(share).sum::<f64>();
            let cost = goals.cost(robot, None, &q, &mut vec![0.0; q.len()]);
            assert!((cost - right).abs() < 1e-12 * (1.0 + right), "{seed}: {cost} {right}");
        }
    }
}

#[test]
fn the_gradient_is_that_of_finite_differences() {
    for (seed, robot) in robots().iter().enumerate() {
        let mut goals = goals(robot, Some(scales(robot, seed as u64)));
        for [q, ..] in states(robot, seed as u64) {
            let mut gradient = vec![0.0; q.len()];
            let cost = goals.cost(robot, None, &q, &mut gradient);
            for (j, slope) in gradient.iter().enumerate() {
                let mut aside = |step: f64| {
                    let mut moved = q.clone();
                    moved[j] += step;
                    goals.cost(robot, None, &moved, &mut vec![0.0; q.len()])
                };
                // Fourth order.
                let near = (aside(1e-3) - aside(-1e-3)) / 2e-3;
                let far = (aside(2e-3) - aside(-2e-3)) / 4e-3;
                let right = (4.0 * near - far) / 3.0;
                assert!((slope - right).abs() < 1e-8 * (1.0 + cost), "{seed}, joint {j}: {slope} {right}");
            }
        }
    }
}

#[test]
fn torques_are_relative_to_the_rated_ones_by_default() {
    let panda = robot("panda");
    let rated: Vec<f64> = panda.joints().iter().map(|joint| joint.rated_torque).collect();
    let q = [0.1, -0.5, 0.3, -2.0, 0.2, 1.5, 0.8];
    let cost = |relative_to| goals(&panda, relative_to).cost(&panda, None, &q, &mut [0.0; 7]);
    assert_eq!(cost(None).to_bits(), cost(Some(rated)).to_bits());
}

#[test]
fn joints_without_rated_torques_count_alike() {
    for (seed, robot) in robots()
        .iter()
        .enumerate()
        .filter(|(_, robot)| robot.joints().iter().all(|joint| joint.rated_torque.is_infinite()))
    {
        let [q, ..] = states(robot, seed as u64).remove(2);
        let [mut found, mut right] = [vec![0.0; q.len()], vec![0.0; q.len()]];
        goals(robot, None).cost(robot, None, &q, &mut found);
        goals(robot, Some(vec![10.0; q.len()])).cost(robot, None, &q, &mut right);
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length(&right) == 0.0 {
            assert_eq!(length(&found), 0.0, "{seed}");
            continue;
        }
        let scale = length(&found) / length(&right);
        assert!(scale > 0.0 && found.iter().zip(&right).all(|(a, b)| (a - scale * b).abs() < 1e-12 * length(&found)));
    }
}
