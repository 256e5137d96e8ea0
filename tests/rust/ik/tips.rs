//! Robots with several tips: chains over one joint vector, targets of tips and pairs, starts, obstacles between the arms, and
//! errors.

use std::sync::LazyLock;

use crate::common::arms::two_arms;
use ikcore::batch::{BatchOptions, Targets, solve_batch};
use ikcore::error::Error;
use ikcore::ik::{AllOptions, Prefer, SolveOptions, solve, solve_all_tips, solve_tips, tip_errors};
use ikcore::load::UrdfOptions;
use ikcore::manipulability::Motion;
use ikcore::math::{Pose, pose};
use ikcore::nalgebra::Matrix4;
use ikcore::obstacle::Surroundings;
use ikcore::planning::{Endpoint, PointToPointOptions, plan_point_to_point};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Goal, NamedTask, Subject, Target, Task, TaskKind, Tolerance};

static PAIR: LazyLock<Robot> = LazyLock::new(|| load(&["left_tool", "right_tool"]).unwrap());

fn load(tips: &[&str]) -> ikcore::Result<Robot> {
    let tips = tips.iter().map(|tip| (*tip).to_owned()).collect();
    Robot::from_urdf_with(&two_arms(), &UrdfOptions { tips, ..UrdfOptions::default() })
}

fn random(count: usize) -> Vec<Vec<f64>> {
    let all = PAIR.random_configurations(count, &mut rng::stream(5, 0)).unwrap();
    all.chunks_exact(PAIR.dof()).map(<[f64]>::to_vec).collect()
}

fn tip(name: &str, q: &[f64]) -> Pose {
    PAIR.link_fk(name, q).unwrap()
}

fn task(subject: Subject) -> NamedTask {
    NamedTask { subject, task: None, tolerance: Tolerance::default() }
}

const LEFT: Subject = Subject::Tip(0);
const RIGHT: Subject = Subject::Tip(1);
const TRAY: Subject = Subject::Pair { from: 0, of: 1 };

/// Options for targets from random configurations, at which links may be inside each other.
fn options(subjects: &[Subject]) -> SolveOptions {
    let surroundings = Surroundings { self_collision: Some(false), ..Surroundings::default() };
    SolveOptions {
        tips: subjects.iter().map(|subject| task(*subject)).collect(),
        surroundings,
        ..SolveOptions::default()
    }
}

fn both(q: &[f64]) -> [Target; 2] {
    [Target::from(&tip("left_tool", q)), Target::from(&tip("right_tool", q))]
}

fn far(a: &Pose, b: &Pose) -> f64 {
    (a.to_homogeneous() - b.to_homogeneous()).amax()
}

#[test]
fn q_holds_the_joints_of_all_chains_shared_ones_once() {
    let names: Vec<&str> = PAIR.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names.len(), 15);
    assert_eq!((names[0], names[1], names[8]), ("lift", "left_joint_0", "right_joint_0"));
    assert_eq!(PAIR.tips().collect::<Vec<_>>(), ["left_tool", "right_tool"]);
    assert!(PAIR.held_joints().is_empty());
}

#[test]
fn tips_and_jacobians_are_those_of_each_chain_alone() {
    for (number, name) in ["left_tool", "right_tool"].iter().enumerate() {
        let alone = load(&[name]).unwrap();
        let entries: Vec<usize> = alone
            .joints()
            .iter()
            .map(|joint| PAIR.joints().iter().position(|other| other.name == joint.name).unwrap())
            .collect();
        for q in random(20) {
            let own: Vec<f64> = entries.iter().map(|entry| q[*entry]).collect();
            let poses = PAIR.tips_fk_all(&q).unwrap();
            let rows = Matrix4::from_row_slice(&poses[16 * number..16 * (number + 1)]);
            let pose = pose::from_matrix("tip", &rows).unwrap();
            assert!(far(&pose, &alone.fk(&own).unwrap()) < 1e-15, "{name}");
            let jacobians = PAIR.tips_jacobian_all(&q).unwrap();
            let jacobian = alone.jacobian(&own).unwrap();
            for row in 0..6 {
                for j in 0..15 {
                    let expected = entries.iter().position(|entry| *entry == j).map_or(0.0, |own| jacobian[(row, own)]);
                    assert_eq!(jacobians[number * 90 + row * 15 + j], expected, "{name}, row {row}, joint {j}");
                }
            }
        }
    }
}

#[test]
fn random_pairs_of_poses_are_reached_by_all_joints_together() {
    for q in random(100) {
        let found = solve_tips(&PAIR, &both(&q), &options(&[LEFT, RIGHT]), &mut Unattended).unwrap();
        assert_eq!(found.status, Status::Solved, "{}", found.message());
        assert!(far(&tip("left_tool", &found.q), &tip("left_tool", &q)) < 3e-6);
        assert!(far(&tip("right_tool", &found.q), &tip("right_tool", &q)) < 3e-6);
        let errors = tip_errors(&PAIR, |_| both(&q).into_iter().collect(), &options(&[LEFT, RIGHT]), &found.q).unwrap();
        assert_eq!(found.error.position, errors[0].position.max(errors[1].position));
        assert_eq!(found.error.rotation, errors[0].rotation.max(errors[1].rotation));
    }
}

#[test]
fn a_tray_is_the_second_tip_seen_from_the_first_and_a_tip_left_out_is_free() {
    let mut q = random(1).remove(0);
    q[8..].copy_from_slice(&[0.3; 7]);
    let seen = tip("left_tool", &q).inverse() * tip("right_tool", &q);
    let targets = [Target::from(&tip("left_tool", &q)), Target::from(&seen)];
    let found = solve_tips(&PAIR, &targets, &options(&[LEFT, TRAY]), &mut Unattended).unwrap();
    assert_eq!(found.status, Status::Solved, "{}", found.message());
    assert!(far(&(tip("left_tool", &found.q).inverse() * tip("right_tool", &found.q)), &seen) < 3e-6);
    // The pair alone, and one tip alone.
    let found = solve_tips(&PAIR, &targets[1..], &options(&[TRAY]), &mut Unattended).unwrap();
    assert_eq!(found.status, Status::Solved, "{}", found.message());
    assert!(far(&(tip("left_tool", &found.q).inverse() * tip("right_tool", &found.q)), &seen) < 3e-6);
    let found = solve_tips(&PAIR, &targets[..1], &options(&[LEFT]), &mut Unattended).unwrap();
    assert_eq!(found.status, Status::Solved);
    assert!(far(&tip("left_tool", &found.q), &tip("left_tool", &q)) < 3e-6);
}

#[test]
fn each_tip_has_its_own_task_tolerance_and_tool() {
    let q = random(3).remove(2);
    let tool = pose::from_rpy([0.1, -0.4, 0.2], [0.05, 0.0, 0.15]);
    let with_tool = tip("left_tool", &q) * tool;
    let asked = SolveOptions {
        tips: vec![
            NamedTask { task: Some(Task { tool: Some(tool), ..TaskKind::Pose.into() }), ..task(LEFT) },
            NamedTask {
                task: Some(TaskKind::Position.into()),
                tolerance: Tolerance { position: 1e-3, rotation: 1e-6 },
                ..task(RIGHT)
            },
        ],
        ..SolveOptions::default()
    };
    let targets = [Target::from(&with_tool), Target::from(&tip("right_tool", &q))];
    let found = solve_tips(&PAIR, &targets, &asked, &mut Unattended).unwrap();
    assert_eq!(found.status, Status::Solved, "{}", found.message());
    assert!(far(&(tip("left_tool", &found.q) * tool), &with_tool) < 3e-6);
    let off = tip("right_tool", &found.q).translation.vector - tip("right_tool", &q).translation.vector;
    assert!(off.norm() <= 1e-3);
    let errors = tip_errors(&PAIR, |_| targets.into_iter().collect(), &asked, &found.q).unwrap();
    assert!(errors[1].rotation.is_nan() && errors[0].rotation <= 1e-6);
}

#[test]
fn batches_are_bit_identical_to_single_solves_for_any_number_of_threads() {
    let qs = random(40);
    let rows = |name: &str| -> Vec<[f64; 16]> { qs.iter().map(|q| pose::rows(&tip(name, q))).collect() };
    let (left, right) = (rows("left_tool"), rows("right_tool"));
    let targets = [Targets::Poses(&left), Targets::Poses(&right)];
    let each = options(&[LEFT, RIGHT]);
    let run = |threads| {
        let options = BatchOptions { each: each.clone(), threads: Some(threads), ..BatchOptions::default() };
        solve_batch(&PAIR, Targets::Tips(&targets), &options, &mut Unattended).unwrap()
    };
    let (one, two) = (run(1), run(2));
    assert_eq!(one.q, two.q);
    assert!(one.items.iter().all(|item| item.status == Status::Solved), "{}", one.message());
    let first = solve_tips(&PAIR, &Targets::Tips(&targets).read(0), &each, &mut Unattended).unwrap();
    assert_eq!(first.q[..], one.q[..15]);
    let uneven = [Targets::Poses(&left), Targets::Poses(&right[1..])];
    let refused =
        solve_batch(&PAIR, Targets::Tips(&uneven), &BatchOptions { each, ..BatchOptions::default() }, &mut Unattended);
    assert!(matches!(refused, Err(Error::WrongLength { .. })));
}

#[test]
fn goals_act_on_all_joints_and_manipulability_names_its_tip() {
    let q = random(1).remove(0);
    let posture = |q: &[f64]| SolveOptions {
        goals: vec![Goal::Posture { posture: q.to_vec(), weight: 1.0 }],
        ..options(&[LEFT, RIGHT])
    };
    let away: Vec<f64> = q.iter().map(|q| 0.9 * q).collect();
    let from = SolveOptions { start: Some(q.clone()), ..options(&[LEFT, RIGHT]) };
    let near = SolveOptions { start: Some(q.clone()), ..posture(&away) };
    let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let plain = solve_tips(&PAIR, &both(&q), &from, &mut Unattended).unwrap();
    let moved = solve_tips(&PAIR, &both(&q), &near, &mut Unattended).unwrap();
    assert_eq!(moved.status, Status::Solved);
    assert!(
        distance(&moved.q, &away) < 0.99 * distance(&plain.q, &away),
        "{} {}",
        distance(&moved.q, &away),
        distance(&plain.q, &away)
    );
    let nearest = SolveOptions { prefer: Prefer::Nearest, ..from.clone() };
    let kept = solve_tips(&PAIR, &both(&q), &nearest, &mut Unattended).unwrap();
    assert!(distance(&kept.q, &q) < 1e-9, "{}", distance(&kept.q, &q));

    let of = |tip: Option<&str>| SolveOptions {
        goals: vec![Goal::Manipulability { motion: Motion::Pose, tip: tip.map(str::to_owned), weight: 1.0 }],
        ..from.clone()
    };
    let better = solve_tips(&PAIR, &both(&q), &of(Some("right_tool")), &mut Unattended).unwrap();
    assert_eq!(better.status, Status::Solved);
    let error = solve_tips(&PAIR, &both(&q), &of(None), &mut Unattended).unwrap_err().to_string();
    let expected = "the goal Manipulability without its tip takes robots with one tip; this one has left_tool and right_tool: \
                    load the robot with one of them as its tip";
    assert_eq!(error, expected);
    let error = solve_tips(&PAIR, &both(&q), &of(Some("rigth_tool")), &mut Unattended).unwrap_err().to_string();
    assert_eq!(
        error,
        "robot 'pair' has no tip 'rigth_tool' (did you mean 'right_tool'?); its tips: left_tool, right_tool"
    );
}

#[test]
fn the_arms_keep_clear_of_each_other() {
    let asked = SolveOptions {
        surroundings: Surroundings { self_collision: Some(true), margin: Some(0.02), ..Surroundings::default() },
        ..options(&[LEFT, RIGHT])
    };
    let pairs = PAIR.collision_pairs();
    assert!(pairs.iter().any(|[one, other]| one.starts_with("left") != other.starts_with("left")), "{pairs:?}");
    let mut solved = 0;
    for q in random(30) {
        let found = solve_tips(&PAIR, &both(&q), &asked, &mut Unattended).unwrap();
        match found.status {
            Status::Solved => {
                solved += 1;
                assert!(found.clearance() >= 0.02, "{}", found.clearance());
                assert!(far(&tip("right_tool", &found.q), &tip("right_tool", &q)) < 3e-6);
            }
            Status::InCollision => assert!(found.message().contains("link '"), "{}", found.message()),
            status => panic!("{status:?}: {}", found.message()),
        }
    }
    assert!(solved >= 20, "{solved} of 30");
}

#[test]
fn distinct_solutions_are_searched_for() {
    let q = random(1).remove(0);
    let all = AllOptions { each: options(&[LEFT, RIGHT]), limit: Some(4), ..AllOptions::default() };
    let found = solve_all_tips(&PAIR, &both(&q), &all, &mut Unattended).unwrap();
    assert!(found.solutions.len() == 4 && !found.complete, "{}", found.message());
    for one in found.solutions.iter() {
        assert!(far(&tip("left_tool", one.q), &tip("left_tool", &q)) < 3e-6);
    }
}

#[test]
fn targets_out_of_reach_and_contradictions_are_said() {
    let q = random(1).remove(0);
    let mut far_away = both(&q);
    far_away[1] = Target::from(&pose::translation(9.0, 0.0, 0.0));
    let found = solve_tips(&PAIR, &far_away, &options(&[LEFT, RIGHT]), &mut Unattended).unwrap();
    assert_eq!(found.status, Status::OutOfReach);
    assert!(found.message().contains("tip 'right_tool': out of reach by at least"), "{}", found.message());

    let seen = tip("left_tool", &q).inverse() * tip("right_tool", &q);
    let [left, right] = both(&q);
    let consistent = [left, right, Target::from(&seen)];
    let all = options(&[LEFT, RIGHT, TRAY]);
    assert_eq!(solve_tips(&PAIR, &consistent, &all, &mut Unattended).unwrap().status, Status::Solved);
    let off = [left, right, Target::from(&(seen * pose::translation(0.1, 0.0, 0.0)))];
    let error = solve_tips(&PAIR, &off, &all, &mut Unattended).unwrap_err().to_string();
    let expected = "the targets of 'left_tool' and 'right_tool' contradict that of ('left_tool', 'right_tool'), from which they are 0.10000 m and ";
    assert!(error.starts_with(expected), "{error}");

    let twice = solve_tips(&PAIR, &[left, left], &options(&[LEFT, LEFT]), &mut Unattended).unwrap_err();
    assert_eq!(twice.to_string(), "tip 'left_tool' has two targets");
    let backwards = Subject::Pair { from: 1, of: 0 };
    let twice = solve_tips(&PAIR, &[left, left], &options(&[TRAY, backwards]), &mut Unattended).unwrap_err();
    assert_eq!(twice.to_string(), "the pair of tips 'right_tool' and 'left_tool' has two targets: leave one out");
    let plain = solve(&PAIR, &left, &SolveOptions::default(), &mut Unattended).unwrap_err();
    assert!(plain.to_string().starts_with("a plain target takes robots with one tip"), "{plain}");
}

#[test]
fn tips_on_one_chain_are_refused() {
    let message = |tips: &[&str]| load(tips).unwrap_err().to_string();
    let on_chain = "robot 'pair': tip 'left_3' lies on the chain to tip 'left_tool': take one of them";
    assert_eq!(message(&["left_tool", "left_3"]), on_chain);
    assert_eq!(message(&["left_3", "left_tool"]), on_chain);
    assert_eq!(
        message(&["left_tool", "left_tool"]),
        "robot 'pair': tip 'left_tool' lies on the chain to tip 'left_tool': take one of them"
    );
    assert_eq!(
        message(&["left_tool", "left_badge"]),
        "robot 'pair': no joint moves tip 'left_badge' relative to tip 'left_tool': take one of them"
    );
    // A tip may stand on what others share.
    assert_eq!(load(&["left_tool", "camera"]).unwrap().dof(), 8);
}

#[test]
fn robots_with_several_tips_survive_storing_and_copies() {
    let stored = Robot::from_bytes(&PAIR.to_bytes().unwrap()).unwrap();
    assert_eq!(stored, *PAIR);
    let q = random(1).remove(0);
    assert_eq!(stored.tips_fk_all(&q).unwrap(), PAIR.tips_fk_all(&q).unwrap());
    let base = pose::from_rpy([0.0, 0.0, 1.0], [1.0, 2.0, 0.0]);
    let placed = PAIR.with_base(base).unwrap();
    assert!(far(&placed.link_fk("right_tool", &q).unwrap(), &(base * tip("right_tool", &q))) < 1e-14);
    let fk = placed.tips_fk_all(&q).unwrap();
    assert!(pose::rows(&(base * tip("right_tool", &q))).iter().zip(&fk[16..]).all(|(a, b)| (a - b).abs() < 1e-14));
}

#[test]
fn motions_join_configurations_of_all_tips() {
    let options = PointToPointOptions::default();
    let space = Surroundings { self_collision: Some(true), ..Surroundings::default() };
    let space = space.clear_space(&*PAIR).unwrap().unwrap();
    let clear: Vec<Vec<f64>> = random(40).into_iter().filter(|q| space.holds(q)).collect();
    let (first, second) = (&clear[0], &clear[1]);
    let start = Endpoint::Configuration(first.clone());
    let end = Endpoint::Targets { tips: [LEFT, RIGHT].map(task).to_vec(), targets: both(second).into_iter().collect() };
    let plan = plan_point_to_point(&PAIR, &start, &[end], &options, &mut Unattended).unwrap();
    assert_eq!((plan.status, plan.chosen_end), (Status::Solved, Some(0)), "{}", plan.message());
    let at = |t: f64| {
        let mut state = [const { [0.0; 15] }; 3];
        let [q, qd, qdd] = &mut state;
        plan.trajectory.at(t, q, qd, qdd).unwrap();
        state[0]
    };
    let duration = plan.trajectory.duration();
    for i in 0..=100 {
        assert!(space.holds(&at(duration * f64::from(i) / 100.0)));
    }
    let q = at(duration);
    assert!(far(&tip("right_tool", &q), &tip("right_tool", second)) < 3e-6);
    let short = Endpoint::Configuration(vec![0.0; 3]);
    let ends = [Endpoint::Configuration(second.clone())];
    let error = plan_point_to_point(&PAIR, &short, &ends, &options, &mut Unattended).unwrap_err().to_string();
    assert_eq!(error, "start_q of robot 'pair': expected 15 joints, got 3");
}
