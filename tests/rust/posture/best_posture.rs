//! Best posture for a target, over all of its self-motion, against dense scans.

use std::f64::consts::PI;

use crate::common::{message, robot};
use ikcore::ik::{AllOptions, Prefer, SolveOptions, solve, solve_all};
use ikcore::manipulability::{Manipulability, Motion};
use ikcore::math::so3::rotation_between;

use ikcore::nalgebra::{DMatrix, DVector};
use ikcore::objective::Bounds;
use ikcore::posture::{Linkage, Measure};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{AnySolver, Status, Stop, Unattended};
use ikcore::task::{Goal, Goals, Target};

fn best(robot: &Robot, target: &Target, goal: Goal) -> ikcore::ik::Solution {
    let options = SolveOptions { goals: vec![goal], prefer: Prefer::Best, ..SolveOptions::default() };
    solve(robot, target, &options, &mut Unattended).unwrap()
}

/// Optima of SM_3 = pi w of the tip, and SM, with the tip at (0.5, 0.5): links of `length`; scan by 4e6 points (independent,
/// numpy).
#[test]
fn planar_optima_are_those_of_the_scan() {
    for (length, tip, overall) in [(0.3, 0.727905, 0.947446), (0.5, 1.720667, 2.488703), (1.0, 4.403020, 7.503629)] {
        let arm = Robot::planar(&[length; 3]).unwrap();
        let target = Target::Position([0.5, 0.5, 0.0]);
        let measure = Manipulability::of(&arm, Motion::Position);
        let motion = Motion::Position;
        let found = best(&arm, &target, Goal::Manipulability { motion, tip: None, weight: 1.0 });
        let index = PI * measure.index(&arm, &found.q);
        assert!((index / tip - 1.0).abs() < 1e-5, "{length}: {index} {tip}");
        let found = best(&arm, &target, Goal::LinkManipulability { motion, weight: 1.0 });
        let index = measure.link_indices(&arm, &found.q).sum();
        assert!((index / overall - 1.0).abs() < 1e-5, "{length}: {index} {overall}");
    }
}

/// Largest index over the self-motion: from many solutions, along the null space both ways, in steps of 0.01 rad, to the limits
/// or once round.
fn scan(robot: &Robot, target: &Target) -> f64 {
    let measure = Manipulability::of(robot, Motion::Pose);
    let options = AllOptions { limit: Some(200), separation: Some(0.3), ..AllOptions::default() };
    let found = solve_all(robot, target, &options, &mut Unattended).unwrap();
    let mut largest = 0.0_f64;
    for solution in found.solutions.iter() {
        for sign in [1.0, -1.0] {
            let mut q = DVector::from_row_slice(solution.q);
            let mut last: Option<DVector<f64>> = None;
            for _ in 0..1500 {
                let inside = |(j, q): (usize, &f64)| (robot.joints()[j].lower..=robot.joints()[j].upper).contains(q);
                if !q.iter().enumerate().all(inside) {
                    break;
                }
                largest = largest.max(measure.index(robot, q.as_slice()));
                let along = null_vector(robot, &q);
                let turn = last.as_ref().map_or(sign, |last| along.dot(last).signum());
                last = Some(turn * &along);
                q += 0.01 * turn * along;
                for _ in 0..2 {
                    q += back_to(robot, target, &q);
                }
            }
        }
    }
    largest
}

fn jacobian(robot: &Robot, q: &DVector<f64>) -> DMatrix<f64> {
    let jacobian = robot.jacobian(q.as_slice()).unwrap();
    DMatrix::from_fn(6, q.len(), |i, j| jacobian[(i, j)])
}

fn null_vector(robot: &Robot, q: &DVector<f64>) -> DVector<f64> {
    let j = jacobian(robot, q);
    let values = (j.transpose() * j).symmetric_eigen();
    values.eigenvectors.column(values.eigenvalues.imin()).into_owned()
}

/// Newton step back to the target.
fn back_to(robot: &Robot, target: &Target, q: &DVector<f64>) -> DVector<f64> {
    let Target::Pose(target) = target else { panic!("a pose") };
    let tip = robot.tip(q.as_slice());
    let turn = rotation_between(target, &tip);
    let residual = DVector::from_fn(6, |i, _| if i < 3 { tip.origin[i] - target.origin[i] } else { turn[i - 3] });
    let j = jacobian(robot, q);
    let normal = &j * j.transpose() + DMatrix::identity(6, 6) * 1e-9;
    -j.transpose() * normal.lu().solve(&residual).unwrap()
}

#[test]
fn seven_joint_arms_find_the_best_of_the_scan() {
    for name in ["iiwa14", "panda"] {
        let arm = robot(name);
        let measure = Manipulability::of(&arm, Motion::Pose);
        for q in arm.random_configurations(3, &mut rng::stream(5, 0)).unwrap().chunks(7) {
            let target = Target::from(&arm.fk(q).unwrap());
            let found = best(&arm, &target, Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 });
            assert_eq!(found.status, Status::Solved);
            let (index, scanned) = (measure.index(&arm, &found.q), scan(&arm, &target));
            assert!(index > 0.999 * scanned, "{name} {q:?}: {index} {scanned}");
        }
    }
}

/// Poses with their best posture on a short arc between joint limits, or on a curve, which random starts seldom meet: the index
/// of a dense scan in closed form over the last joint (independent, numpy).
#[test]
fn the_best_is_found_where_limits_cut_it_off() {
    let panda = robot("panda");
    let measure = Manipulability::of(&panda, Motion::Pose);
    for (stream, row, scanned) in
        [(1, 99, 0.040158), (2, 17, 0.051907), (2, 147, 0.058874), (3, 25, 0.063266), (3, 47, 0.106714)]
    {
        let all = panda.random_configurations(150, &mut rng::stream(5, stream)).unwrap();
        let target = Target::from(&panda.fk(&all[7 * row..7 * (row + 1)]).unwrap());
        let found = best(&panda, &target, Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 });
        let index = measure.index(&panda, &found.q);
        assert!(index > 0.999 * scanned, "row {row} of stream {stream}: {index} {scanned}");
        assert!(found.evaluations < 2500, "row {row} of stream {stream}: {}", found.evaluations);
    }
}

/// Arms with isolated solutions, all of which are known.
#[test]
fn six_joint_arms_find_the_best_of_all_solutions() {
    for name in ["ur5e", "kr210"] {
        let arm = robot(name);
        let measure = Manipulability::of(&arm, Motion::Pose);
        for q in arm.random_configurations(8, &mut rng::stream(5, 0)).unwrap().chunks(6) {
            let target = Target::from(&arm.fk(q).unwrap());
            let found = best(&arm, &target, Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 });
            let all = solve_all(&arm, &target, &AllOptions::default(), &mut Unattended).unwrap();
            let largest = all.solutions.iter().map(|each| measure.index(&arm, each.q)).fold(0.0, f64::max);
            assert!(measure.index(&arm, &found.q) > (1.0 - 1e-5) * largest, "{name} {q:?}");
        }
    }
}

/// Solutions that form surfaces: against a grid over the directions of the first two links.
#[test]
fn a_planar_arm_of_four_links_finds_the_best_of_a_grid() {
    let arm = Robot::planar(&[0.5, 0.4, 0.3, 0.2]).unwrap();
    let measure = Manipulability::of(&arm, Motion::Position);
    let mut scratch = vec![0.0; 4];
    for target in [[0.3, 0.2, 0.0], [-0.5, 0.6, 0.0], [0.05, -0.9, 0.0]] {
        let linkage = Linkage::new(&arm, &target, Measure::Tip, None).unwrap();
        let heading = |i: i32| f64::from(i) * PI / 60.0;
        let grid = (0..120).flat_map(|i| (0..120).map(move |k| [heading(i), heading(k)]));
        let postures = grid.flat_map(|headings| [1.0, -1.0].map(|side| linkage.close(&headings, side)));
        let indices = postures.flatten().filter_map(|points| linkage.index(&points, &mut scratch));
        let largest = indices.fold(0.0, f64::max);
        let motion = Motion::Position;
        let found = best(&arm, &Target::Position(target), Goal::Manipulability { motion, tip: None, weight: 1.0 });
        assert!(measure.index(&arm, &found.q) > (1.0 - 1e-6) * largest, "{target:?}");
    }
}

/// Goals beside manipulability, also on arms with continuous joints: never worse than a descent from any solution.
#[test]
fn the_best_is_at_least_as_good_as_any() {
    for name in ["iiwa14", "gen3"] {
        let arm = robot(name);
        let (lower, upper): (Vec<f64>, Vec<f64>) = arm.joints().iter().map(|joint| (joint.lower, joint.upper)).unzip();
        let bounds = Bounds::new(&lower, &upper).unwrap();
        let goals = vec![Goal::Centring { weight: 1.0 }];
        let mut gained = 0.0;
        for q in arm.random_configurations(5, &mut rng::stream(5, 0)).unwrap().chunks(7) {
            let target = Target::from(&arm.fk(q).unwrap());
            let cost = |prefer, solver| {
                let options = SolveOptions { goals: goals.clone(), prefer, solver, ..SolveOptions::default() };
                let found = solve(&arm, &target, &options, &mut Unattended).unwrap();
                Goals::new(&goals, &arm, &bounds).cost(&arm, None, &found.q, &mut [0.0; 7])
            };
            let (any, best) = (cost(Prefer::Any, None), cost(Prefer::Best, None));
            assert!(best <= any + 1e-9, "{name}: {best} {any}");
            // The closed form begins near the middle already.
            gained += cost(Prefer::Any, Some(AnySolver::default())) - best;
        }
        assert!(gained > 0.01, "{name}: {gained}");
    }
}

#[test]
fn budgets_are_exact() {
    let arm = robot("panda");
    let q = arm.random_configurations(1, &mut rng::stream(5, 0)).unwrap();
    let target = Target::from(&arm.fk(&q).unwrap());
    let goals = vec![Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 }];
    for max_evaluations in (20..400).step_by(7) {
        let stop = Stop { max_evaluations, ..Stop::default() };
        let options = SolveOptions { goals: goals.clone(), prefer: Prefer::Best, stop, ..SolveOptions::default() };
        let found = solve(&arm, &target, &options, &mut Unattended).unwrap();
        assert!(found.evaluations <= max_evaluations, "{max_evaluations}: {}", found.evaluations);
    }
}

#[test]
fn the_best_needs_to_know_for_what() {
    let options = SolveOptions { prefer: Prefer::Best, ..SolveOptions::default() };
    let error = message(solve(&robot("iiwa14"), &Target::Position([0.4, 0.0, 0.5]), &options, &mut Unattended));
    assert_eq!(error, "the preference 'best' needs goals to compare solutions by");
}

#[test]
fn a_target_beyond_the_reach_is_a_status() {
    let goal = Goal::Manipulability { motion: Motion::Position, tip: None, weight: 1.0 };
    let found = best(&Robot::planar(&[0.5; 3]).unwrap(), &Target::Position([2.0, 0.0, 0.0]), goal);
    assert_eq!(found.status, Status::OutOfReach, "{}", found.message());
}
