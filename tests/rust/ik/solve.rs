//! Solving: derivatives of the residuals, reachable and unreachable targets, starts, seeds and limits.

use std::f64::consts::PI;

use crate::common::{assert_derivative, bits, configurations, message, pose_at, position_at, robot};
use ikcore::ik::{Solution, SolveOptions, solve};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::load::{Dh, DhTable};
use ikcore::math::{Frame, pose};
use ikcore::nalgebra::{Point3, Rotation3, Vector3};
use ikcore::robot::{Joint, JointKind, Robot};
use ikcore::solver::{Algorithm, AnySolver, Bas, BasVariant, LevenbergMarquardt, Status, Stop, Unattended};
use ikcore::task::{Target, Tolerance};

fn solved(robot: &Robot, target: &Target, options: &SolveOptions) -> Solution {
    solve(robot, target, options, &mut Unattended).unwrap()
}

#[test]
fn position_residual_has_its_derivative() {
    for name in ["iiwa14", "ur5e", "planar5", "hydraulic3", "kr210"] {
        let robot = robot(name);
        for q in configurations(&robot, 5) {
            assert_derivative(&robot, &Target::Position([0.3, -0.2, 0.5]), Tolerance::default(), &q);
        }
    }
}

#[test]
fn pose_residual_has_its_derivative_up_to_three_radians_away() {
    for name in ["iiwa14", "panda", "ur5e", "kr210", "gen3", "hydraulic3"] {
        let robot = robot(name);
        for (q, axis) in configurations(&robot, 4).iter().zip([[1.0, 0.0, 0.0], [0.2, -0.8, 0.5], [0.0, 0.6, 0.8]]) {
            for angle in [0.0, 1e-9, 1e-4, 0.1, 1.0, 2.0, 2.9, 3.0] {
                let tip = robot.fk(q).unwrap();
                let turn = Rotation3::new(Vector3::from(axis).normalize() * angle);
                let target = pose::translation(0.1, 0.2, -0.3) * turn * tip;
                assert_derivative(&robot, &Target::from(&target), Tolerance::default(), q);
            }
        }
    }
}

#[test]
fn arms_of_six_joints_and_more_reach_what_is_reachable() {
    for robot in Robot::names().map(robot).filter(|robot| robot.dof() >= 6) {
        for (i, q) in configurations(&robot, 40).iter().enumerate() {
            let options = SolveOptions { seed: i as u64, ..SolveOptions::default() };
            let solution = solved(&robot, &pose_at(&robot, q), &options);
            assert_eq!(solution.status, Status::Solved, "{} target {i}: {}", robot.name(), solution.message());
            assert_honest(&robot, &pose_at(&robot, q), &solution);
        }
    }
}

#[test]
fn positions_are_reached_by_every_arm() {
    for robot in Robot::names().map(robot) {
        for (i, q) in configurations(&robot, 20).iter().enumerate() {
            let options = SolveOptions { seed: i as u64, ..SolveOptions::default() };
            let solution = solved(&robot, &position_at(&robot, q), &options);
            assert_eq!(solution.status, Status::Solved, "{} target {i}: {}", robot.name(), solution.message());
            assert!(solution.error.rotation.is_nan(), "nothing was asked of the orientation");
            assert_honest(&robot, &position_at(&robot, q), &solution);
        }
    }
}

/// Checks that the solution is inside the limits, and its errors are those of plain forward kinematics.
fn assert_honest(robot: &Robot, target: &Target, solution: &Solution) {
    for (value, joint) in solution.q.iter().zip(robot.joints()) {
        assert!(joint.lower <= *value && *value <= joint.upper, "{}: {value}", joint.name);
    }
    let tip = robot.fk(&solution.q).unwrap();
    let origin = target.position().unwrap();
    let distance = (tip.translation.vector - Vector3::from(origin)).norm();
    assert!((distance - solution.error.position).abs() < 1e-12, "{distance} {:?}", solution.error);
    if let Target::Pose(frame) = target {
        let wanted = ikcore::math::Pose::from(*frame).rotation;
        // |R - R_d| = 2 sqrt(2) sin(angle / 2)
        let chord = (tip.rotation.matrix() - wanted.matrix()).norm();
        let angle = 2.0 * (chord / 8.0_f64.sqrt()).asin();
        assert!((angle - solution.error.rotation).abs() < 1e-12, "{angle} {:?}", solution.error);
    }
}

#[test]
fn a_target_out_of_reach_is_approached_and_said_to_be() {
    let planar = robot("planar5");
    let options = SolveOptions { stop: Stop { max_evaluations: 5000, ..Stop::default() }, ..SolveOptions::default() };
    let solution = solved(&planar, &Target::Position([4.0, 4.0, 0.0]), &options);
    let shortfall = 32.0_f64.sqrt() - 5.0;
    assert_eq!(solution.status, Status::OutOfReach);
    assert!(solution.evaluations < 5000, "{}", solution.evaluations);
    let distance = solution.error.position;
    assert!((shortfall..1.01 * shortfall).contains(&distance), "{:?}", solution.error);
    let advice = "move or turn the target into reach, or move the base";
    let why = format!("out of reach by at least {shortfall:.4} m");
    assert_eq!(
        solution.message(),
        format!("out of reach, the nearest found is {distance:.4} m away ({why}): {advice}")
    );
}

#[test]
fn a_target_off_the_plane_of_a_planar_arm_is_said_to_be() {
    let planar = robot("planar5");
    let tilt = pose::from_parts([0.3, 0.2, 0.1], *Rotation3::from_euler_angles(0.3, -0.8, 0.1).matrix());
    let tilted = planar.with_base(tilt).unwrap();
    let place = |at: [f64; 3]| (tilt * Point3::from(at)).coords.into();
    for (robot, target) in [(&planar, [2.0, 1.0, 0.25]), (&tilted, place([2.0, 1.0, 0.25]))] {
        let solution = solved(robot, &Target::Position(target), &SolveOptions::default());
        let why = "out of reach by at least 0.2500 m, 0.2500 m off the plane that the tip moves in";
        let advice = "move or turn the target into reach, or move the base";
        assert_eq!(solution.message(), format!("out of reach, the nearest found is 0.2500 m away ({why}): {advice}"));
        assert!(solution.evaluations < 1000, "{}", solution.evaluations);
    }
    let solution = solved(&planar, &Target::Position([0.0, 6.0, 0.75]), &SolveOptions::default());
    let says = "(out of reach by at least 1.250 m, 0.7500 m off the plane that the tip moves in)";
    assert!(solution.message().contains(says), "{}", solution.message());
}

#[test]
fn an_orientation_off_parallel_axes_is_out_of_reach() {
    // A SCARA arm: two links, a slide along their axes and a wrist, with its tool upside down.
    let table = DhTable {
        kinds: vec![JointKind::Revolute, JointKind::Revolute, JointKind::Prismatic, JointKind::Revolute],
        lower: vec![-PI, -PI, 0.0, -PI],
        upper: vec![PI, PI, 0.3, PI],
        ..DhTable::new(Dh::Standard, vec![0.4, 0.3, 0.0, 0.0], vec![0.0, PI, 0.0, 0.0], vec![0.5, 0.0, 0.0, 0.0])
    };
    let scara = Robot::from_dh("scara", &table).unwrap();
    let reachable = scara.fk(&[0.3, -0.8, 0.1, 0.4]).unwrap();
    let asked = |turn: [f64; 3]| {
        let turn = *Rotation3::new(Vector3::from(turn)).matrix();
        let target = reachable * pose::from_parts([0.0; 3], turn);
        solved(&scara, &Target::from(&target), &SolveOptions::default())
    };
    assert_eq!(asked([0.0; 3]).status, Status::Solved);
    assert_eq!(asked([0.0, 0.0, 1.2]).status, Status::Solved);
    let leaning = asked([0.0, 0.125, 0.0]);
    assert_eq!(leaning.status, Status::RotationGivenUp, "{}", leaning.message());
    let says = " rad away (0.1250 rad off any orientation that the tip can have): turn the target";
    assert!(leaning.message().contains(says), "{}", leaning.message());
    assert!(leaning.error.rotation >= 0.125 - 1e-12);
    assert!(leaning.evaluations < 1000, "{}", leaning.evaluations);
    for name in Robot::names() {
        let robot = robot(name);
        let bounds: Vec<f64> = robot.joints().iter().map(|joint| joint.upper).collect();
        if let Some(fixed) = robot.reach(&bounds, &bounds).fixed_direction {
            for q in configurations(&robot, 50) {
                assert!(fixed.angle_to(&Frame::from(&robot.fk(&q).unwrap())) < 1e-9, "{name}");
            }
        }
    }
}

#[test]
fn joints_without_room_are_said_to_be() {
    let stiff = robot("planar5").with_limits(|_, joint| (joint.lower, joint.upper) = (0.5, 0.5)).unwrap();
    let solution = solved(&stiff, &Target::Position([2.0, 1.0, 0.0]), &SolveOptions::default());
    let why = "(joint 'joint_1' locked by equal limits, joint 'joint_2' locked by";
    assert!(solution.message().contains(why), "{}", solution.message());
}

#[test]
fn a_pose_out_of_reach_is_approached_too() {
    let iiwa = robot("iiwa14");
    let target = Target::from(&pose::translation(3.0, 0.0, 0.36));
    let options = SolveOptions { stop: Stop { max_evaluations: 5000, ..Stop::default() }, ..SolveOptions::default() };
    let solution = solved(&iiwa, &target, &options);
    // Stretched out, the tip lies 0.946 m from the shoulder.
    let shortfall = 3.0 - 0.946;
    assert_eq!(solution.status, Status::OutOfReach);
    assert!((shortfall - 1e-9..1.2 * shortfall).contains(&solution.error.position), "{:?}", solution.error);
}

#[test]
fn one_start_alone_stalls_with_advice() {
    let solver = AnySolver::Single(Algorithm::LevenbergMarquardt(LevenbergMarquardt::default()));
    let options = SolveOptions { solver: Some(solver), start: Some(vec![0.1; 5]), ..SolveOptions::default() };
    let solution = solved(&robot("planar5"), &Target::Position([0.0, 7.0, 0.0]), &options);
    assert_eq!((solution.status, solution.restarts), (Status::Stalled, 0));
    let advice = "try another start or seed, or MultiStart; the target may be out of reach";
    assert_eq!(
        solution.message(),
        format!("no further progress, 2.000 m away (out of reach by at least 2.000 m): {advice}")
    );
}

#[test]
fn a_start_that_is_solved_comes_back_as_it_is() {
    let iiwa = robot("iiwa14");
    let start = vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
    let options = SolveOptions { start: Some(start.clone()), ..SolveOptions::default() };
    let solution = solved(&iiwa, &pose_at(&iiwa, &start), &options);
    assert_eq!((solution.q.to_vec(), solution.evaluations, solution.iterations), (start, 1, 0));
    assert_eq!(solution.message(), "solved to 0 m and 0 rad");
}

#[test]
fn a_start_nearby_is_used() {
    let iiwa = robot("iiwa14");
    let goal = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
    let options = SolveOptions { start: Some(goal.map(|q| q + 0.01).to_vec()), ..SolveOptions::default() };
    let solution = solved(&iiwa, &pose_at(&iiwa, &goal), &options);
    assert_eq!((solution.status, solution.restarts), (Status::Solved, 0));
    assert!(solution.q.iter().zip(goal).all(|(q, goal)| (q - goal).abs() < 0.05), "{:?}", solution.q);
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    let ur = robot("ur5e");
    let target = pose_at(&ur, &[0.4, -1.0, 1.2, -0.5, 0.9, 0.2]);
    // The default solver seldom comes to a draw; a beetle draws at every step.
    for (solver, draws) in
        [(AnySolver::default(), false), (AnySolver::Single(Algorithm::from(Bas::of(BasVariant::Star))), true)]
    {
        let q = |seed| {
            bits(
                &solved(&ur, &target, &SolveOptions { solver: Some(solver.clone()), seed, ..SolveOptions::default() })
                    .q,
            )
        };
        assert_eq!(q(5), q(5), "{solver:?}");
        assert_eq!(q(5) != q(6), draws, "{solver:?}");
    }
}

#[test]
fn beetles_solve_positions() {
    let iiwa = robot("iiwa14");
    for variant in [BasVariant::Star, BasVariant::Chain, BasVariant::Greedy] {
        // A beetle gains unevenly from pass to pass: it is given more patience than a descent.
        let solver = AnySolver::MultiStart(Algorithm::from(Bas::of(variant)).into_multi_start());
        let mut reached = 0;
        for (i, q) in configurations(&iiwa, 50).iter().enumerate() {
            let options = SolveOptions { solver: Some(solver.clone()), seed: i as u64, ..SolveOptions::default() };
            let solution = solved(&iiwa, &position_at(&iiwa, q), &options);
            assert_honest(&iiwa, &position_at(&iiwa, q), &solution);
            assert!(solution.error.position < 0.01, "{variant} target {i}: {}", solution.message());
            reached += usize::from(solution.status == Status::Solved);
        }
        assert!(reached >= 45, "{variant} reached {reached} of 50 targets");
    }
}

#[test]
fn given_limits_replace_those_of_the_robot() {
    let iiwa = robot("iiwa14");
    let limits = Limits::of(&iiwa).replace(Field::Lower, vec![Profile::Constant(-0.5)]).unwrap();
    let limits = limits.replace(Field::Upper, vec![Profile::Constant(0.9)]).unwrap();
    let options = SolveOptions { limits: Some(limits), ..SolveOptions::default() };
    let solution = solved(&iiwa, &pose_at(&iiwa, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]), &options);
    assert_eq!(solution.status, Status::Solved);
    assert!(solution.q.iter().all(|q| (-0.5..=0.9).contains(q)), "{:?}", solution.q);
}

#[test]
fn limits_that_a_single_configuration_cannot_have_are_refused() {
    let iiwa = robot("iiwa14");
    let target = Target::Position([0.4, 0.3, 1.0]);
    let refused = |field, profile: Profile| {
        let limits = Limits::of(&iiwa).replace(field, vec![profile]).unwrap();
        let options = SolveOptions { limits: Some(limits), ..SolveOptions::default() };
        message(solve(&iiwa, &target, &options, &mut Unattended))
    };
    assert_eq!(
        refused(Field::Acceleration, Profile::Constant(1.0)),
        "solve cannot honour acceleration limits: a single configuration has no motion; leave it out"
    );
    let swinging = Sinusoid { mean: 2.0, amplitude: 0.1, angular_frequency: 1.0, phase: 0.0 };
    assert_eq!(
        refused(Field::Upper, Profile::Sinusoid(swinging)),
        "solve cannot honour time-varying upper limits: one configuration has no time; give numbers"
    );
}

#[test]
fn limits_beyond_a_million_turns_count_as_none() {
    let arm = robot("iiwa14");
    let names: Vec<String> = arm.joints().iter().map(|joint| joint.name.clone()).collect();
    for size in [1e12, 1e15, 1e300, f64::MAX] {
        let wide = |sign: f64| vec![Profile::Constant(sign * size); 7];
        let limits = Limits::none(names.clone()).replace(Field::Lower, wide(-1.0)).unwrap();
        let limits = limits.replace(Field::Upper, wide(1.0)).unwrap();
        let options = SolveOptions { limits: Some(limits), ..SolveOptions::default() };
        for q in configurations(&arm, 20) {
            let solution = solved(&arm, &pose_at(&arm, &q), &options);
            assert_eq!(solution.status, Status::Solved, "{size}: {}", solution.error.position);
        }
        let joint = Joint::new("wide", JointKind::Revolute).with_range(-size, size);
        assert_eq!(joint.sampling_range(), (-PI, PI));
        let half = Joint::new("half", JointKind::Revolute).with_range(-1.0, size);
        assert_eq!(half.sampling_range(), (-1.0, 2.0 * PI - 1.0));
    }
    let named = Joint::new("turns", JointKind::Revolute).with_range(-6e6, 6e6);
    assert_eq!(named.sampling_range(), (-6e6, 6e6));
}
