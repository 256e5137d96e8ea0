//! Programs for two arms on a lift: each move leads the tip that it names, while the other one stays.

use std::sync::LazyLock;

use crate::common::arms::two_arms;
use crate::common::robot;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::load::UrdfOptions;
use ikcore::math::Pose;
use ikcore::nalgebra::{Translation3, Vector3};
use ikcore::obstacle::Surroundings;
use ikcore::planning::{JointGoal, Move, MoveKind, MovesOptions, Plan, plan_moves};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Task, TaskKind};
use ikcore::{Error, Result};

const SAMPLES: usize = 4000;

/// Distance (m) by which a tip on a line may be off it, and by which one that stays may move.
const OFF_LINE: f64 = 1e-5;
const STILL: f64 = 1e-12;

const TIPS: [&str; 2] = ["left_tool", "right_tool"];

static PAIR: LazyLock<Robot> = LazyLock::new(|| load(&TIPS));

/// Joint positions of the lift, the left arm and the right one.
const HOME: [f64; 15] = [0.2, 0.3, 0.8, 0.2, -1.0, 0.3, 0.7, 0.1, -0.3, 0.8, -0.2, -1.0, 0.3, 0.7, 0.1];

fn load(tips: &[&str]) -> Robot {
    let tips = tips.iter().map(|tip| (*tip).to_owned()).collect();
    Robot::from_urdf_with(&two_arms(), &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap()
}

fn options(arm: &Robot) -> MovesOptions {
    let constant = |value: f64| vec![Profile::Constant(value); arm.dof()];
    let limits = Limits::of(arm).replace(Field::Acceleration, constant(5.0)).unwrap();
    let limits = limits.replace(Field::Jerk, constant(100.0)).unwrap();
    MovesOptions { limits: Some(limits), ..MovesOptions::default() }
}

fn planned(moves: &[Move], options: &MovesOptions) -> Result<Plan> {
    plan_moves(&PAIR, moves, &HOME, options, &mut Unattended)
}

fn tip(name: &str, q: &[f64]) -> Pose {
    PAIR.link_fk(name, q).unwrap()
}

fn moved(pose: &Pose, by: [f64; 3]) -> Pose {
    Pose::from_parts(Translation3::from(pose.translation.vector + Vector3::from(by)), pose.rotation)
}

fn leading(name: &str, kind: MoveKind) -> Move {
    Move { tip: Some(name.into()), ..Move::new(kind) }
}

fn line(name: &str, pose: Pose, blend: f64) -> Move {
    Move { blend, ..leading(name, MoveKind::Line { pose, speed: Some(0.05) }) }
}

fn at(plan: &Plan, t: f64) -> Vec<f64> {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; PAIR.dof()]);
    plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
    q
}

/// Distance of a point from a segment.
fn off(point: &Vector3<f64>, [from, to]: [&Pose; 2]) -> f64 {
    let [from, to] = [from, to].map(|pose| pose.translation.vector);
    let way = to - from;
    let fraction = ((point - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (point - from - fraction * way).norm()
}

/// Largest distance (m) of a tip from where `due` says that it is at a configuration, in the time of move `index`.
fn largest(plan: &Plan, index: usize, name: &str, due: impl Fn(&Vector3<f64>) -> f64) -> f64 {
    let (start, end) = (plan.moves[index].start, plan.moves[index].end);
    let times = (0..=SAMPLES).map(|i| start + (end - start) * i as f64 / SAMPLES as f64);
    times.map(|t| due(&tip(name, &at(plan, t)).translation.vector)).fold(0.0, f64::max)
}

#[test]
fn each_line_leads_its_tip_and_the_other_one_stays() {
    let [left, right] = TIPS.map(|name| tip(name, &HOME));
    let corner = moved(&left, [0.0, 0.0, -0.1]);
    let ends = [corner, moved(&corner, [-0.1, 0.0, 0.0]), moved(&right, [0.0, 0.05, -0.1])];
    let moves = [line("left_tool", ends[0], 0.02), line("left_tool", ends[1], 0.0), line("right_tool", ends[2], 0.0)];
    let plan = planned(&moves, &options(&PAIR)).unwrap();
    assert_eq!(plan.status, Status::Solved);
    let stays = |index: usize, name: &str, pose: &Pose| {
        largest(&plan, index, name, |point| (point - pose.translation.vector).norm())
    };
    assert!(stays(0, "right_tool", &right).max(stays(1, "right_tool", &right)) < STILL);
    assert!(stays(2, "left_tool", &ends[1]) < OFF_LINE);
    assert!(largest(&plan, 2, "right_tool", |point| off(point, [&right, &ends[2]])) < OFF_LINE);
    let rounded = |index: usize| {
        largest(&plan, index, "left_tool", |point| {
            let in_ball = (point - corner.translation.vector).norm() <= 0.02;
            let on_line = off(point, [&left, &corner]).min(off(point, [&corner, &ends[1]]));
            if in_ball { 0.0 } else { on_line }
        })
    };
    assert!(rounded(0).max(rounded(1)) < OFF_LINE);
    for report in &plan.moves {
        assert!((report.speed - 0.05).abs() < 1e-4, "{}", report.speed);
    }
}

#[test]
fn configurations_are_chosen_for_both_arms_together() {
    // Of the left arm's configurations at the start of its first line, some leave no way along the second one, which begins after the right
    // arm has moved.
    let [left, right] = TIPS.map(|name| tip(name, &HOME));
    let [begin, middle, end] = [[-0.3, 0.1, 0.1], [-0.3, 0.1, -0.25], [0.1, 0.1, -0.25]].map(|by| moved(&left, by));
    let moves = [
        leading("left_tool", MoveKind::Joints(JointGoal::Pose(begin))),
        line("left_tool", middle, 0.0),
        leading("right_tool", MoveKind::Joints(JointGoal::Pose(moved(&right, [0.05, -0.1, 0.0])))),
        line("right_tool", moved(&right, [0.05, -0.1, -0.2]), 0.0),
        line("left_tool", end, 0.0),
    ];
    let plan = planned(&moves, &options(&PAIR)).unwrap();
    assert_eq!(plan.status, Status::Solved);
    let last = at(&plan, plan.trajectory.duration());
    assert!(off(&tip("left_tool", &last).translation.vector, [&end, &middle]) < OFF_LINE);
    assert!(largest(&plan, 4, "left_tool", |point| off(point, [&middle, &end])) < OFF_LINE);
    assert!(largest(&plan, 3, "left_tool", |point| (point - middle.translation.vector).norm()) < OFF_LINE);
}

#[test]
fn a_way_around_an_obstacle_leaves_the_other_arm() {
    let [left, right] = TIPS.map(|name| tip(name, &HOME));
    let goal = moved(&left, [0.0, 0.35, -0.2]);
    let between = moved(&left, [0.0, 0.175, -0.1]);
    let ball = Shape::sphere(between.translation.vector.into(), 0.05).unwrap();
    let surroundings = Surroundings::among(vec![ball]);
    let moves = [leading("left_tool", MoveKind::Joints(JointGoal::Pose(goal)))];
    let plan = planned(&moves, &MovesOptions { surroundings, ..options(&PAIR) }).unwrap();
    assert_eq!(plan.status, Status::Solved);
    assert!(largest(&plan, 0, "right_tool", |point| (point - right.translation.vector).norm()) < STILL);
    let last = at(&plan, plan.trajectory.duration());
    assert!((tip("left_tool", &last).translation.vector - goal.translation.vector).norm() < OFF_LINE);
    // The way is no straight line of the joints, which would lead through the ball.
    let way: Vec<f64> = last.iter().zip(&HOME).map(|(end, start)| end - start).collect();
    let squared: f64 = way.iter().map(|way| way * way).sum();
    let off_line = |t: f64| {
        let gone: Vec<f64> = at(&plan, t).iter().zip(&HOME).map(|(q, start)| q - start).collect();
        let along = gone.iter().zip(&way).map(|(gone, way)| gone * way).sum::<f64>() / squared;
        gone.iter().zip(&way).map(|(gone, way)| (gone - along * way).abs()).fold(0.0, f64::max)
    };
    let duration = plan.trajectory.duration();
    assert!((0..=SAMPLES).any(|i| off_line(duration * i as f64 / SAMPLES as f64) > 0.01));
}

#[test]
fn a_task_of_one_tip_frees_that_one() {
    let [left, right] = TIPS.map(|name| tip(name, &HOME));
    let tool = Pose::from_parts(Translation3::new(0.0, 0.0, 0.1), left.rotation);
    let tool = Pose::from_parts(tool.translation, Pose::identity().rotation);
    let position = Task { tool: Some(tool), ..Task::new(TaskKind::Position, None, None, None).unwrap() };
    let ends = [left, right].map(|pose| moved(&(pose * tool), [0.05, 0.0, -0.1]));
    let moves = [line("left_tool", ends[0], 0.0), line("right_tool", moved(&right, [0.05, 0.0, -0.1]), 0.0)];
    let freed = MovesOptions { tip_tasks: vec![(0, Some(position))], ..options(&PAIR) };
    let plan = planned(&moves, &freed).unwrap();
    let last = at(&plan, plan.trajectory.duration());
    let at_tool = tip("left_tool", &last) * tool;
    assert!((at_tool.translation.vector - ends[0].translation.vector).norm() < OFF_LINE);
    assert!((tip("left_tool", &last).rotation.angle_to(&left.rotation)) > 1e-3);
    assert!((tip("right_tool", &last).rotation.angle_to(&right.rotation)) < 1e-4);
}

#[test]
fn an_arm_with_one_tip_may_name_it() {
    let arm = robot("ur5e");
    let start = [0.0, -1.5, 1.8, -1.9, -1.57, 0.3];
    let pose = moved(&arm.fk(&start).unwrap(), [0.0, 0.1, -0.1]);
    let plain = Move::new(MoveKind::Line { pose, speed: Some(0.1) });
    let named = Move { tip: arm.tips().next().map(str::to_owned), ..plain.clone() };
    let [plain, named] =
        [plain, named].map(|each| plan_moves(&arm, &[each], &start, &options(&arm), &mut Unattended).unwrap());
    assert_eq!(plain.trajectory, named.trajectory);
}

#[test]
fn wrong_tips_are_named() {
    let [left, right] = TIPS.map(|name| tip(name, &HOME));
    let near = moved(&left, [0.0, 0.0, -0.05]);
    let said = |moves: &[Move], robot: &Robot| {
        plan_moves(robot, moves, &HOME, &options(robot), &mut Unattended).map(|_| ()).unwrap_err()
    };
    let none = said(&[Move::new(MoveKind::Line { pose: near, speed: None })], &PAIR);
    let words = "move 0: it names no tip of robot 'pair', which has several: name one of left_tool and right_tool";
    assert_eq!(none.to_string(), words);
    let unknown = said(&[line("left_tol", near, 0.0)], &PAIR);
    assert!(matches!(&unknown, Error::UnknownTip { name, .. } if name == "left_tol"), "{unknown}");
    let superfluous = said(&[leading("left_tool", MoveKind::Joints(JointGoal::Configuration(HOME.into())))], &PAIR);
    assert_eq!(
        superfluous.to_string(),
        "move 0: it leads no tip to a pose, but names tip 'left_tool': leave the tip out"
    );
    let other =
        said(&[line("left_tool", near, 0.01), line("right_tool", moved(&right, [0.0, 0.0, -0.05]), 0.0)], &PAIR);
    assert_eq!(
        other.to_string(),
        "move 0: its blend of 0.01 m leads into move 1, a move of another tip, before which the arm stops: give no blend"
    );
    let with_camera = load(&["left_tool", "right_tool", "camera"]);
    let stuck = said(&[line("camera", near, 0.0)], &with_camera);
    assert_eq!(
        stuck.to_string(),
        "move 0: no joint moves tip 'camera' alone, and joints that move other tips too stay where they are: give a joint move to a \
         configuration"
    );
    let far = said(&[line("left_tool", moved(&left, [2.0, 0.0, 0.0]), 0.0)], &PAIR);
    assert!(far.to_string().contains("; joints that move another tip too stay where they are"), "{far}");
}
