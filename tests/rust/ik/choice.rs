//! Choice of a solution: the nearest, all of them, the best by a goal; and messages for targets without one.

use std::f64::consts::{PI, TAU};

use crate::common::{bits, configurations, message, pose_at, robot};
use ikcore::ik::{AllOptions, Prefer, Solution, SolveOptions, nearest_miss, solve, solve_all};
use ikcore::limits::LimitAt;
use ikcore::load::{Dh, DhTable};
use ikcore::manipulability::{self, Motion};
use ikcore::math::pose;
use ikcore::path::{Path, Reference};
use ikcore::robot::{JointKind, Robot};
use ikcore::solver::{Status, Stop, Unattended};
use ikcore::task::{Goal, Target, TaskKind};
use ikcore::tracking::{TrackOptions, track};

fn solved(robot: &Robot, target: &Target, options: &SolveOptions) -> Solution {
    let solution = solve(robot, target, options, &mut Unattended).unwrap();
    assert_eq!(solution.status, Status::Solved, "{}: {}", robot.name(), solution.message());
    solution
}

fn near(start: &[f64]) -> SolveOptions {
    SolveOptions { start: Some(start.to_vec()), prefer: Prefer::Nearest, ..SolveOptions::default() }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[test]
fn the_nearest_is_never_farther_than_any_and_often_much_nearer() {
    for name in ["panda", "iiwa14", "ur5e", "kr210"] {
        let robot = robot(name);
        let qs = configurations(&robot, 40);
        let (mut any_sum, mut nearest_sum) = (0.0, 0.0);
        for (q, start) in qs.iter().zip(qs.iter().rev()) {
            let target = pose_at(&robot, q);
            let any = solved(&robot, &target, &SolveOptions { start: Some(start.clone()), ..SolveOptions::default() });
            let nearest = solved(&robot, &target, &near(start));
            assert!(distance(&nearest.q, start) <= distance(&any.q, start) + 1e-6, "{name}");
            assert!(distance(&nearest.q, start) <= distance(q, start) * 1.5, "{name}: far from what is known");
            any_sum += distance(&any.q, start);
            nearest_sum += distance(&nearest.q, start);
        }
        // Of an arm with six joints, the closed form finds the nearest anyway.
        assert!(robot.dof() == 6 || nearest_sum < 0.9 * any_sum, "{name}: {nearest_sum} {any_sum}");
    }
}

#[test]
fn whole_turns_inside_the_limits_are_counted() {
    // The joints of a UR turn by two turns: a solution is nearer when its joints are on the same turn as the start.
    let robot = robot("ur5");
    let start = [5.5, -1.0, 1.2, -4.0, -1.6, 6.0];
    let moved: Vec<f64> = start.iter().map(|angle| angle + 0.02).collect();
    let wrapped: Vec<f64> = moved.iter().map(|angle| (angle + PI).rem_euclid(TAU) - PI).collect();
    let nearest = solved(&robot, &pose_at(&robot, &wrapped), &near(&start));
    assert!(distance(&nearest.q, &start) <= distance(&moved, &start) + 1e-6, "{:?}", nearest.q);
}

#[test]
fn nearest_finds_a_solution_known_to_be_near() {
    for name in ["ur3e", "ur5e", "ur10"] {
        let robot = robot(name);
        for (i, start) in configurations(&robot, 150).iter().enumerate() {
            let aside = |j: usize| 0.5 * (1.7 * i as f64 + 2.3 * j as f64).sin();
            let inside = |j: usize, angle: f64| angle.clamp(robot.joints()[j].lower, robot.joints()[j].upper);
            let known: Vec<f64> = start.iter().enumerate().map(|(j, angle)| inside(j, angle + aside(j))).collect();
            let nearest = solved(&robot, &pose_at(&robot, &known), &near(start));
            assert!(distance(&nearest.q, start) <= distance(&known, start) + 1e-4, "{name} {i}: {:?}", nearest.q);
        }
    }
}

#[test]
fn nearest_is_a_minimum_along_the_self_motion() {
    let robot = robot("iiwa14");
    for q in configurations(&robot, 10) {
        let inside: Vec<f64> = q.iter().map(|angle| 0.8 * angle).collect();
        let start: Vec<f64> = inside.iter().map(|angle| angle + 0.05).collect();
        let nearest = solved(&robot, &pose_at(&robot, &inside), &near(&start));
        let null_vector = null_space(&robot, &nearest.q);
        let along: f64 = null_vector.iter().zip(&nearest.q).zip(&start).map(|((n, q), s)| n * (q - s)).sum();
        assert!(along.abs() < 5e-3, "{along:.2e}: a little along the self-motion would be nearer");
        assert!(distance(&nearest.q, &start) <= distance(&inside, &start) + 1e-6);
    }
}

/// Unit vector of the null space: joint motion that leaves the tip in place.
fn null_space(robot: &Robot, q: &[f64]) -> Vec<f64> {
    let jacobian = robot.jacobian(q).unwrap();
    let square = jacobian.transpose() * &jacobian;
    let eigen = square.symmetric_eigen();
    let least = eigen.eigenvalues.imin();
    eigen.eigenvectors.column(least).iter().copied().collect()
}

#[test]
fn goals_move_along_the_self_motion_to_where_they_are_best() {
    let robot = robot("panda");
    let range = |j: usize| (robot.joints()[j].lower, robot.joints()[j].upper);
    let centring = |q: &[f64]| -> f64 {
        let off = |(j, q): (usize, &f64)| ((q - 0.5 * (range(j).0 + range(j).1)) / (range(j).1 - range(j).0)).powi(2);
        q.iter().enumerate().map(off).sum()
    };
    let singularity = |q: &[f64]| -manipulability::manipulability(&robot, Motion::Pose, q).unwrap().ln();
    let posture = [0.0, -0.5, 0.0, -2.0, 0.0, 1.6, 0.8];
    let to_posture = |q: &[f64]| distance(q, &posture).powi(2);
    type Cost<'a> = &'a dyn Fn(&[f64]) -> f64;
    let goals: [(Goal, Cost<'_>); 3] = [
        (Goal::Centring { weight: 1.0 }, &centring),
        (Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 }, &singularity),
        (Goal::Posture { posture: posture.to_vec(), weight: 2.0 }, &to_posture),
    ];
    for (goal, cost) in goals {
        for q in configurations(&robot, 15) {
            let target = pose_at(&robot, &q);
            let plain = solved(&robot, &target, &SolveOptions::default());
            let best = solved(&robot, &target, &SolveOptions { goals: vec![goal.clone()], ..SolveOptions::default() });
            assert!(cost(&best.q) <= cost(&plain.q) + 1e-12, "{goal:?}: {} {}", cost(&best.q), cost(&plain.q));
            // At a minimum inside the limits nothing is gained by a small step along the self-motion.
            let inside = best.q.iter().enumerate().all(|(j, q)| range(j).0 + 1e-3 < *q && *q < range(j).1 - 1e-3);
            let along = null_space(&robot, &best.q);
            let stepped = |step: f64| cost(&best.q.iter().zip(&along).map(|(q, n)| q + step * n).collect::<Vec<_>>());
            let slope = (stepped(1e-4) - stepped(-1e-4)) / 2e-4;
            assert!(!inside || slope.abs() < 2e-3 * (1.0 + cost(&best.q).abs()), "{goal:?}: slope {slope:.2e}");
        }
    }
}

#[test]
fn all_solutions_of_a_six_joint_arm_are_found() {
    // A spherical wrist and three joints before it: eight solutions where limits allow all of them.
    let robot = robot("ur5e");
    let mut counts = vec![];
    for q in configurations(&robot, 10) {
        let target = pose_at(&robot, &q);
        let options =
            AllOptions { each: SolveOptions { start: Some(q.clone()), ..Default::default() }, ..AllOptions::default() };
        let found = solve_all(&robot, &target, &options, &mut Unattended).unwrap();
        assert!(
            found.miss.is_none() && found.solutions.get(0).unwrap().q.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-6)
        );
        let distances: Vec<f64> = found.solutions.iter().map(|solution| distance(solution.q, &q)).collect();
        assert!(distances.is_sorted(), "{distances:?}");
        for (i, a) in found.solutions.iter().enumerate() {
            assert!(a.error.position <= 1e-6 && a.error.rotation <= 1e-6);
            for b in found.solutions.iter().take(i) {
                let apart = a.q.iter().zip(b.q).any(|(a, b)| ((a - b + PI).rem_euclid(TAU) - PI).abs() >= 0.1);
                assert!(apart, "the same twice");
            }
        }
        counts.push(found.solutions.len());
    }
    assert!(counts.iter().all(|count| count % 2 == 0 && *count <= 8), "{counts:?}");
    assert!(counts.iter().filter(|count| **count == 8).count() >= 5, "{counts:?}");
}

#[test]
fn limit_keeps_the_nearest_and_a_miss_is_returned() {
    let robot = robot("iiwa14");
    let q = [0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1];
    let each = SolveOptions { start: Some(q.to_vec()), ..SolveOptions::default() };
    let options = AllOptions { each, limit: Some(3), ..AllOptions::default() };
    let found = solve_all(&robot, &pose_at(&robot, &q), &options, &mut Unattended).unwrap();
    assert_eq!((found.solutions.len(), found.message()), (3, "3 distinct solutions".into()));
    let far = Target::from(&pose::translation(3.0, 0.0, 0.5));
    let found = solve_all(&robot, &far, &options, &mut Unattended).unwrap();
    assert!(found.solutions.is_empty() && found.complete, "{}", found.message());
    assert!(found.message().starts_with("no solution (out of reach by at least 2.057 m): move"), "{}", found.message());
    let miss = nearest_miss(&robot, &far, &options, &mut Unattended).unwrap();
    assert!(miss.message().starts_with("out of reach, the nearest found is "), "{}", miss.message());
    let zero = AllOptions { limit: Some(0), ..options.clone() };
    assert_eq!(message(solve_all(&robot, &far, &zero, &mut Unattended)), "limit must be at least 1, got 0");
    let negative = AllOptions { separation: Some(-1.0), ..options };
    let says = message(solve_all(&robot, &far, &negative, &mut Unattended));
    assert_eq!(says, "separation must be positive and finite, got -1");
}

#[test]
fn the_tip_never_leaves_the_reach() {
    for name in Robot::names() {
        let robot = robot(name);
        let lower: Vec<f64> = robot.joints().iter().map(|joint| joint.lower).collect();
        let upper: Vec<f64> = robot.joints().iter().map(|joint| joint.upper).collect();
        let reach = robot.reach(&lower, &upper);
        let farthest =
            configurations(&robot, 2000).iter().map(|q| reach.excess(&robot.tip_position(q))).fold(-9.0, f64::max);
        assert!(farthest <= 1e-12, "{name}: {farthest} m beyond");
        assert!(farthest > -0.4 * reach.radius, "{name}: the ball is far too large: {reach:?} {farthest}");
    }
}

#[test]
fn arms_with_parallel_axes_stay_in_a_plane() {
    // The second axis points the other way: its offset of 0.2 m along it leads down.
    let table = DhTable::new(Dh::Standard, vec![0.5, 0.4, 0.3], vec![PI, 0.0, PI], vec![0.3, 0.2, 0.1]);
    let folded = Robot::from_dh("folded", &table).unwrap();
    let reach = folded.reach(&[-PI; 3], &[PI; 3]);
    assert!((reach.radius - 1.2).abs() < 1e-12, "{reach:?}");
    for q in configurations(&folded, 100) {
        assert!(reach.off_plane(&folded.tip_position(&q)).abs() < 1e-12, "{reach:?}");
    }
    assert!((reach.excess(&[0.1, 0.1, 1.0]) - 1.0).abs() < 1e-12, "{reach:?}");
    assert_eq!(robot("ur5e").reach(&[-PI; 6], &[PI; 6]).normal, None);
}

#[test]
fn a_target_out_of_reach_is_approached_and_told() {
    // A stretched iiwa: 0.36 m to the shoulder, 0.946 m from there to the flange of this model.
    let robot = robot("iiwa14");
    let zero: Vec<f64> = vec![0.0; 7];
    let (lower, upper): (Vec<f64>, Vec<f64>) = robot.joints().iter().map(|joint| (joint.lower, joint.upper)).unzip();
    let reach = robot.reach(&lower, &upper);
    let stretched = robot.tip_position(&zero)[2];
    assert!((reach.center[2] + reach.radius - stretched).abs() < 1e-12);
    let target = Target::Position([0.0, (reach.radius + 0.21) * 0.6, reach.center[2] + (reach.radius + 0.21) * 0.8]);
    let solution = solve(&robot, &target, &SolveOptions::default(), &mut Unattended).unwrap();
    assert_eq!(solution.status, Status::OutOfReach);
    assert!((solution.error.position - 0.21).abs() < 0.01 * 0.21, "{}", solution.message());
    let end = ": move or turn the target into reach, or move the base";
    let message = solution.message();
    assert!(message.starts_with("out of reach, the nearest found is 0.21") && message.ends_with(end), "{message}");
    assert!(message.contains(" m away (out of reach by at least 0.2100 m"), "{message}");
    assert!(solution.evaluations < 2000, "{}", solution.evaluations);
}

#[test]
fn a_joint_that_stands_in_the_way_is_named() {
    // The elbow of a planar arm may fold by half a radian only: near the base there is no solution.
    let robot = Robot::planar(&[1.0, 1.0]).unwrap().with_limits(|j, joint| {
        (joint.lower, joint.upper) = if j == 1 { (-0.5, 0.5) } else { (-3.0, 3.0) };
        joint.kind = JointKind::Revolute;
    });
    let robot = robot.unwrap();
    let solution =
        solve(&robot, &Target::Position([0.5, 0.2, 0.0]), &SolveOptions::default(), &mut Unattended).unwrap();
    assert_eq!(solution.status, Status::BudgetSpent);
    let miss = |first: f64| {
        let tip = robot.tip_position(&[first, 0.5]);
        (tip[0] - 0.5).hypot(tip[1] - 0.2)
    };
    let least = (0..=60_000).map(|i| miss(f64::from(i) * 1e-4 - 3.0)).fold(f64::INFINITY, f64::min);
    assert!(solution.error.position <= 1.01 * least, "{} {least}", solution.error.position);
    let name = &robot.joints()[1].name;
    assert!(solution.message().contains(&format!("(joint '{name}' at its ")), "{}", solution.message());
    assert!(solution.evaluations <= Stop::default().max_evaluations);
}

#[test]
fn best_misses_of_poses_are_as_near_as_a_long_search_finds() {
    let robot = robot("ur5e");
    let mut worst = 0.0_f64;
    for q in configurations(&robot, 8) {
        // Half a metre farther out along the line from the base: mostly beyond reach, always beyond the ball's middle.
        let tip = robot.fk(&q).unwrap();
        let away = tip.translation.vector.normalize() * 0.5;
        let target = Target::from(&(pose::translation(away.x, away.y, away.z) * tip));
        let value = |solution: &Solution| solution.error.position.powi(2) + solution.error.rotation.powi(2);
        let found = solve(&robot, &target, &SolveOptions::default(), &mut Unattended).unwrap();
        if found.status == Status::Solved {
            continue;
        }
        let stop = Stop { max_evaluations: 300_000, ..Stop::default() };
        let long = solve(&robot, &target, &SolveOptions { stop, seed: 5, ..SolveOptions::default() }, &mut Unattended)
            .unwrap();
        worst = worst.max(value(&found) / value(&long));
    }
    assert!(worst > 0.5 && worst < 1.02, "{worst}");
}

#[test]
fn goals_act_along_a_path_without_leaving_it() {
    let robot = robot("iiwa14");
    let start = [0.3, 0.8, -0.4, -1.2, 0.3, 0.9, 0.1];
    let tip = robot.fk(&start).unwrap();
    let here: [f64; 3] = tip.translation.vector.into();
    let rest = Reference::new(0.01, vec![here; 501], Some(vec![tip.rotation.into_inner(); 501])).unwrap();
    let posture = vec![0.3, 0.8, 0.4, -1.2, 0.3, 0.9, 0.1];
    let options = TrackOptions {
        goals: vec![Goal::Posture { posture: posture.clone(), weight: 1.0 }],
        limit_at: LimitAt::Interval,
        ..TrackOptions::default()
    };
    let record = track(&robot, &rest, Some(&start), &options, &mut Unattended).unwrap();
    assert_eq!((record.status, record.max_violation), (Status::Solved, 0.0), "{}", record.message());
    let end = &record.q[record.q.len() - 7..];
    assert!(distance(end, &posture) < 0.9 * distance(&start, &posture), "{end:?}");
    // Where the self-motion alone can go, and no farther.
    let pull: f64 = null_space(&robot, end).iter().zip(end).zip(&posture).map(|((n, q), p)| n * (q - p)).sum();
    assert!(pull.abs() < 1e-3, "{pull}");
    // The same without goals stands still.
    let still = track(&robot, &rest, Some(&start), &TrackOptions::default(), &mut Unattended).unwrap();
    assert!(distance(&still.q[still.q.len() - 7..], &start) < 1e-9);
}

#[test]
fn a_path_may_ask_for_less_than_it_says() {
    let robot = robot("iiwa14");
    let start = [0.3, 0.8, -0.4, -1.2, 0.3, 0.9, 0.1];
    let tip = robot.fk(&start).unwrap();
    let plane = ikcore::path::Plane::xy([0.4, 0.2, 0.7]).unwrap();
    let circle = ikcore::path::Circle::new(plane, 0.1, 5.0).unwrap();
    let path = Path::new(circle).with_orientation(tip.rotation.into_inner()).unwrap();
    for kind in [TaskKind::Position, TaskKind::Pointing { axis: [0.0, 0.0, 1.0] }, TaskKind::Pose] {
        let goals = vec![Goal::Centring { weight: 1.0 }];
        let options = TrackOptions { task: Some(kind.into()), goals, ..TrackOptions::default() };
        let record = track(&robot, &path.sample(0.01).unwrap(), None, &options, &mut Unattended).unwrap();
        assert_eq!(record.status, Status::Solved, "{kind:?}: {}", record.message());
        assert_eq!(record.rotation_error[5].is_nan(), kind == TaskKind::Position, "{kind:?}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    let robot = robot("panda");
    let qs = configurations(&robot, 2);
    let target = pose_at(&robot, &qs[0]);
    let once = || solved(&robot, &target, &near(&qs[1])).q;
    assert_eq!(bits(&once()), bits(&once()));
}

#[test]
fn options_that_do_not_go_together_are_told() {
    let robot = robot("iiwa14");
    let target = pose_at(&robot, &[0.1; 7]);
    let says = |options: SolveOptions| message(solve(&robot, &target, &options, &mut Unattended));
    let nearest = SolveOptions { prefer: Prefer::Nearest, ..SolveOptions::default() };
    assert_eq!(says(nearest), "the preference 'nearest' needs a start to measure distances from");
    let goals = vec![Goal::Centring { weight: 1.0 }];
    assert_eq!(
        says(SolveOptions { goals, ..near(&[0.0; 7]) }),
        "the preference 'nearest' takes no goals: the distance to the start is its goal"
    );
    let weighted = |start: Option<Vec<f64>>, goals: Vec<Goal>, weight: f64| {
        let mut weights = vec![1.0; 7];
        weights[3] = weight;
        says(SolveOptions { start, goals, joint_weights: Some(weights), ..SolveOptions::default() })
    };
    assert_eq!(weighted(None, vec![], 2.0), "weights of joints need a start to measure motions from");
    assert_eq!(
        weighted(Some(vec![0.0; 7]), vec![Goal::Centring { weight: 1.0 }], 2.0),
        "weights of joints take no goals: the weighted distance to the start is their goal; a Posture at the start, with a weight \
         for each joint, may stand beside other goals"
    );
    assert_eq!(
        weighted(Some(vec![0.0; 7]), vec![], 0.0),
        "joint_weights[3] must be positive and finite (a joint that must not move is locked by its limits), got 0"
    );
    let goals = vec![Goal::Centring { weight: 0.0 }];
    assert_eq!(
        says(SolveOptions { goals, ..SolveOptions::default() }),
        "weight of a goal must be positive and finite, got 0"
    );
    let goals = vec![Goal::Posture { posture: vec![0.0; 6], weight: 1.0 }];
    assert_eq!(
        says(SolveOptions { goals, ..SolveOptions::default() }),
        "posture of robot 'iiwa14': expected 7 joints, got 6"
    );
}
