//! Programs among torque limits: ways round configurations that cannot be held, and what is said where there is none.

use ikcore::Error;
use ikcore::dynamics::Inertia;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::planning::{JointGoal, Move, MoveKind, MovesOptions, Plan, plan_moves};
use ikcore::rng;
use ikcore::robot::{Motions, Robot};
use ikcore::solver::{Status, Unattended};

/// Rated accelerations of the Panda (rad/s^2).
const RATED: [f64; 7] = [15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0];

/// A Panda with 3 kg in the hand.
fn loaded() -> Robot {
    let robot = Robot::named("panda").unwrap();
    robot.with_payload(None, Inertia::point(3.0, [0.0, 0.0, 0.05])).unwrap()
}

/// A part of the torques of its motors.
fn motors(robot: &Robot, part: f64) -> Vec<f64> {
    robot.joints().iter().map(|joint| part * joint.rated_torque).collect()
}

fn options(robot: &Robot, part: f64) -> MovesOptions {
    let limits = Limits::of(robot)
        .replace(Field::Acceleration, RATED.map(Profile::Constant).to_vec())
        .unwrap()
        .with_torque_limit(motors(robot, part))
        .unwrap();
    MovesOptions { limits: Some(limits), ..MovesOptions::default() }
}

/// Part of its motors that limits an arm which goes round something.
const LIMITED: f64 = 0.7;

/// Largest part of these limits in a motion.
fn share(robot: &Robot, motions: &Motions<'_>) -> f64 {
    let torques = robot.torques_all(motions).unwrap();
    torques.iter().zip(motors(robot, LIMITED)).map(|(torque, limit)| torque.abs() / limit).fold(0.0, f64::max)
}

fn at_rest(robot: &Robot, q: &[f64]) -> f64 {
    share(robot, &Motions { q, qd: None, qdd: None, wrenches: None })
}

/// Two configurations that can be held, between which the straight line of the joints cannot.
fn across(robot: &Robot, seed: u64) -> [Vec<f64>; 2] {
    let mut rng = rng::stream(seed, 0);
    let mut held = || loop {
        let q: Vec<f64> = robot.joints().iter().map(|joint| rng.uniform_in(joint.lower, joint.upper)).collect();
        if at_rest(robot, &q) < 0.95 {
            return q;
        }
    };
    loop {
        let [from, to] = [held(), held()];
        let between = |x: f64| -> Vec<f64> { from.iter().zip(&to).map(|(from, to)| from + x * (to - from)).collect() };
        if (1..50).any(|i| at_rest(robot, &between(f64::from(i) / 50.0)) > 1.02) {
            return [from, to];
        }
    }
}

/// Largest part of a torque limit along a plan.
fn largest_share(robot: &Robot, plan: &Plan) -> f64 {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 7]);
    let at = |i: u32| {
        plan.trajectory.at(plan.trajectory.duration() * f64::from(i) / 1000.0, &mut q, &mut qd, &mut qdd).unwrap();
        share(robot, &Motions { q: &q, qd: Some(&qd), qdd: Some(&qdd), wrenches: None })
    };
    (0..=1000).map(at).fold(0.0, f64::max)
}

#[test]
fn joint_moves_go_round_what_cannot_be_held() {
    let robot = loaded();
    for seed in 0..6 {
        let [from, to] = across(&robot, seed);
        let there = robot.fk(&to).unwrap();
        for goal in [JointGoal::Configuration(to.clone()), JointGoal::Pose(there)] {
            let plan = plan_moves(
                &robot,
                &[Move::new(MoveKind::Joints(goal))],
                &from,
                &options(&robot, LIMITED),
                &mut Unattended,
            );
            let plan = plan.unwrap();
            assert_eq!(plan.status, Status::Solved);
            let share = largest_share(&robot, &plan);
            assert!(share <= 1.0 + 1e-9, "{share} with seed {seed}");
            let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 7]);
            plan.trajectory.at(plan.trajectory.duration(), &mut q, &mut qd, &mut qdd).unwrap();
            let end = robot.fk(&q).unwrap();
            assert!((end.translation.vector - there.translation.vector).norm() < 1e-5);
        }
    }
}

#[test]
fn errors_name_the_move_the_place_and_the_joint() {
    let robot = loaded();
    let start = [0.0, -0.5, 0.0, -2.2, 0.0, 1.8, 0.8];
    let planned =
        |moves: &[Move], start: &[f64]| plan_moves(&robot, moves, start, &options(&robot, 0.45), &mut Unattended);
    let ahead = |by: f64| {
        let mut pose = robot.fk(&start).unwrap();
        pose.translation.vector.x += by;
        Move { name: Some("reach".into()), ..Move::new(MoveKind::Line { pose, speed: None }) }
    };
    let home = Move::new(MoveKind::Joints(JointGoal::Configuration(vec![0.3, -0.5, 0.0, -2.2, 0.0, 1.8, 0.8])));
    let error = planned(&[home, ahead(0.3)], &start).unwrap_err();
    assert!(matches!(error, Error::NotFound { .. }), "{error}");
    let words = error.to_string();
    assert!(
        words.contains("a motion along move 1 'reach'") && words.contains(" m along it, joint 'panda_joint2' needs "),
        "{words}"
    );
    assert!(
        words.contains("N m to hold the arm, its limit is 39.15 N m; move the path, lighten the payload"),
        "{words}"
    );

    let stretched = vec![0.0, 1.5, 0.0, -0.3, 0.0, 1.8, 0.8];
    let there = Move::new(MoveKind::Joints(JointGoal::Configuration(stretched.clone())));
    let words = planned(&[there], &start).unwrap_err().to_string();
    assert!(words.starts_with("infeasible: at joint positions of move 0 joint 'panda_joint2' needs "), "{words}");
    let there = Move::new(MoveKind::Joints(JointGoal::Pose(robot.fk(&stretched).unwrap())));
    let words = planned(&[there], &start).unwrap_err().to_string();
    assert!(words.contains("move 0") && words.contains("needs") && words.contains("to hold the arm"), "{words}");
    let words = planned(&[ahead(0.1)], &stretched).unwrap_err().to_string();
    assert!(words.starts_with("infeasible: at start_q joint 'panda_joint2' needs "), "{words}");
}
