//! Programs whose task leaves a part of the poses free. The judge knows lines and uniform turns by formulas of its own, and the arm by its
//! forward kinematics alone.

use std::f64::consts::FRAC_PI_2;

use crate::common::{arms::arm, robot};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::Pose;
use ikcore::nalgebra::{Rotation3, Translation3, Vector3};
use ikcore::planning::{JointGoal, Move, MoveKind, MovesOptions, Plan, plan_moves};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{First, Region, Task, TaskKind};
use ikcore::{Error, Result};

const ARMS: [(&str, &[f64]); 4] = [
    ("ur5e", &[0.0, -1.5, 1.8, -1.9, -1.57, 0.3]),
    ("panda", &[0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.7]),
    ("iiwa14", &[0.0, 0.6, 0.0, -1.5, 0.0, 0.9, 0.0]),
    ("kr210", &[0.0, -0.6, 0.9, 0.0, 1.0, 0.0]),
];
const SAMPLES: usize = 10_000;

/// Distance (m) from a line, angle (rad) beyond a task, and error of a speed relative to it.
const OFF_LINE: f64 = 1e-5;
const OFF_TASK: f64 = 1e-4;
const SPEED: f64 = 1e-3;

fn pointing(axis: [f64; 3], tolerance: Option<f64>) -> Task {
    let tolerance = tolerance.map(|angle| [1.0, 1.0, 1.0, angle]);
    Task::new(TaskKind::Pointing { axis }, None, tolerance.as_ref().map(<[f64; 4]>::as_slice), None).unwrap()
}

fn within(tolerance: [f64; 3]) -> Task {
    let [x, y, z] = tolerance;
    Task::new(TaskKind::Pose, None, Some(&[1.0, 1.0, 1.0, x, y, z]), None).unwrap()
}

fn planned(arm: &Robot, start: &[f64], moves: &[Move], jerk: Option<f64>, task: Option<Task>) -> Result<Plan> {
    let constant = |value: f64| vec![Profile::Constant(value); arm.dof()];
    let mut limits = Limits::of(arm).replace(Field::Acceleration, constant(5.0)).unwrap();
    if let Some(jerk) = jerk {
        limits = limits.replace(Field::Jerk, constant(jerk)).unwrap();
    }
    let options = MovesOptions { limits: Some(limits), task, ..MovesOptions::default() };
    plan_moves(arm, moves, start, &options, &mut Unattended)
}

fn line(pose: Pose, speed: Option<f64>, blend: f64) -> Move {
    Move { blend, ..Move::new(MoveKind::Line { pose, speed }) }
}

fn moved(pose: &Pose, by: [f64; 3], turn: [f64; 3]) -> Pose {
    let place = Translation3::from(pose.translation.vector + Vector3::from(by));
    Pose::from_parts(place, Rotation3::new(Vector3::from(turn)) * pose.rotation)
}

fn at(plan: &Plan, t: f64) -> Vec<f64> {
    let n = plan.trajectory.joints().len();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
    plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
    q
}

fn end(plan: &Plan) -> Vec<f64> {
    at(plan, plan.trajectory.duration())
}

/// What a judge says of an orientation and the one that is due (rad).
type Beyond = fn(&Rotation3<f64>, &Rotation3<f64>) -> f64;

fn axis_turned(tip: &Rotation3<f64>, due: &Rotation3<f64>) -> f64 {
    (tip * Vector3::z()).angle(&(due * Vector3::z()))
}

const TOLERANCE: f64 = 0.1;

fn all_tasks() -> [(Task, Beyond); 5] {
    let spin = Task::new(TaskKind::Pose, Some(&[1.0, 1.0, 1.0, 1.0, 1.0, 0.0]), None, None).unwrap();
    [
        (pointing([0.0, 0.0, 2.0], None), axis_turned),
        (spin, axis_turned),
        (pointing([0.0, 0.0, 1.0], Some(TOLERANCE)), |tip, due| (axis_turned(tip, due) - TOLERANCE).max(0.0)),
        (within([TOLERANCE; 3]), |tip, due| {
            ((due.inverse() * tip).scaled_axis().abs() - Vector3::repeat(TOLERANCE)).map(|off| off.max(0.0)).norm()
        }),
        (TaskKind::Position.into(), |_, _| 0.0),
    ]
}

/// A start, and lines from it with turns, as whole poses.
struct Lines {
    start: Vec<f64>,
    poses: Vec<Pose>,
    moves: Vec<Move>,
    jerk: Option<f64>,
}

impl Lines {
    fn drawn(arm: &Robot, home: &[f64], rng: &mut LazyRng) -> Self {
        let start: Vec<f64> = home.iter().map(|q| q + rng.uniform_in(-0.2, 0.2)).collect();
        let mut poses = vec![arm.fk(&start).unwrap()];
        let mut moves = vec![];
        for _ in 0..3 {
            let mut vector = |size: f64| [(); 3].map(|()| rng.uniform_in(-size, size));
            let (by, turn) = (vector(0.1), vector(0.3));
            let pose = moved(&poses[poses.len() - 1], by, turn);
            let speed = [None, Some(0.03), Some(0.2)][rng.below(3)];
            let blend = [0.0, 0.002][rng.below(2)];
            moves.push(line(pose, speed, blend));
            poses.push(pose);
        }
        let jerk = (rng.uniform() < 0.3).then_some(80.0);
        Self { start, poses, moves, jerk }
    }

    fn planned(&self, arm: &Robot, task: Option<Task>) -> Result<Plan> {
        planned(arm, &self.start, &self.moves, self.jerk, task)
    }

    /// Judges a plan by samples.
    fn judge(&self, arm: &Robot, plan: &Plan, beyond: Beyond, what: &str) {
        assert_eq!(plan.status, Status::Solved, "{what}: {}", plan.message());
        let duration = plan.trajectory.duration();
        for i in 0..=SAMPLES {
            let t = duration * i as f64 / SAMPLES as f64;
            let tip = arm.fk(&at(plan, t)).unwrap();
            let k = plan.moves.iter().position(|report| t <= report.end).unwrap_or(self.moves.len() - 1);
            let [from, to] = [self.poses[k], self.poses[k + 1]];
            let blend = |k: usize| if k == self.moves.len() - 1 { 0.0 } else { self.moves[k].blend };
            let radii = [k.checked_sub(1).map_or(0.0, blend), blend(k)];
            let near = [from, to].map(|end| (tip.translation.vector - end.translation.vector).norm());
            if near[0] < radii[0] || near[1] < radii[1] {
                continue;
            }
            let way = to.translation.vector - from.translation.vector;
            let part = (tip.translation.vector - from.translation.vector).dot(&way) / way.norm_squared();
            let off = (tip.translation.vector - from.translation.vector - part * way).norm();
            assert!(off <= OFF_LINE, "{what}: move {k} is {off} m off its line at {t} s");
            let turn = (to.rotation * from.rotation.inverse()).scaled_axis();
            let angle = beyond(&tip.rotation, &(Rotation3::new(part * turn) * from.rotation));
            assert!(angle <= OFF_TASK, "{what}: move {k} is {angle} rad beyond its task at {t} s");
            self.judge_speed(arm, plan, k, t, what);
        }
    }

    fn judge_speed(&self, arm: &Robot, plan: &Plan, k: usize, t: f64, what: &str) {
        const STEP: f64 = 1e-6;
        let report = &plan.moves[k];
        let MoveKind::Line { speed: Some(asked), .. } = self.moves[k].kind else { return };
        if t < report.start + 2.0 * STEP || t > report.end - 2.0 * STEP {
            return;
        }
        let [behind, ahead] = [-STEP, STEP].map(|by| Vector3::from(arm.tip_position(&at(plan, t + by))));
        let ratio = (ahead - behind).norm() / (2.0 * STEP) / asked;
        let is_explained = report.bound_by.iter().any(|bound| bound.start <= t && t <= bound.end);
        assert!(ratio <= 1.0 + SPEED, "{what}: move {k} runs at {ratio} of its speed at {t} s");
        assert!(is_explained || ratio >= 1.0 - 1.5 * SPEED, "{what}: move {k} runs at {ratio} of its speed at {t} s");
    }
}

#[test]
fn lines_meet_what_the_task_fixes_and_are_never_slower() {
    let mut kept = 0;
    for case in 0..crate::common::cases(8) {
        let mut rng = rng::stream(43, u64::from(case));
        let (name, home) = ARMS[case as usize % ARMS.len()];
        let arm = robot(name);
        let lines = Lines::drawn(&arm, home, &mut rng);
        let whole = lines.planned(&arm, None).map(|plan| plan.trajectory.duration());
        if let Err(Error::InvalidMove { .. }) = whole {
            continue;
        }
        for (number, (task, beyond)) in all_tasks().into_iter().enumerate() {
            let what = format!("case {case} on {name}, task {number}");
            let plan = match (lines.planned(&arm, Some(task)), &whole) {
                (Ok(plan), _) => plan,
                (Err(error), Ok(_)) => panic!("{what}: whole poses are planned, but {error}"),
                (Err(_), Err(_)) => continue,
            };
            lines.judge(&arm, &plan, beyond, &what);
            if let Ok(whole) = whole {
                assert!(plan.trajectory.duration() <= whole, "{what}: {} > {whole} s", plan.trajectory.duration());
            }
            kept += 1;
        }
    }
    assert!(kept > 10);
}

#[test]
fn free_spin_needs_no_turns_of_the_last_joint() {
    let (name, home) = ARMS[0];
    let arm = robot(name);
    let down = moved(&arm.fk(home).unwrap(), [0.0; 3], [0.0; 3]);
    let down = Pose::from_parts(down.translation, Rotation3::from_euler_angles(std::f64::consts::PI, 0.0, 0.0));
    let mut moves = vec![Move::new(MoveKind::Joints(JointGoal::Pose(down)))];
    let mut pose = down;
    for quarter in 0..10 {
        let by = [[0.05, 0.0], [0.0, 0.05], [-0.05, 0.0], [0.0, -0.05]][quarter % 4];
        pose = moved(&pose, [by[0], by[1], 0.0], [0.0, 0.0, FRAC_PI_2]);
        moves.push(line(pose, Some(0.05), 0.0));
    }
    let whole = planned(&arm, home, &moves, None, None);
    assert!(matches!(whole, Err(Error::NotFound { .. })), "{whole:?}");
    let free = planned(&arm, home, &moves, None, Some(pointing([0.0, 0.0, 1.0], None))).unwrap();
    assert_eq!(free.status, Status::Solved);
    assert!(free.moves[1..].iter().all(|report| (report.speed - 0.05).abs() < 1e-4));
    let last: Vec<f64> = (0..=100).map(|i| at(&free, free.trajectory.duration() * f64::from(i) / 100.0)[5]).collect();
    let travel: f64 = last.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    assert!(travel < 6.0, "the last joint travels {travel} rad");
}

#[test]
fn five_joints_follow_lines_with_free_spin() {
    // The arm of a UR5e without its last joint: it meets no whole pose beside its own.
    let rows = [[0.0, FRAC_PI_2, 0.1625], [-0.425, 0.0, 0.0], [-0.3922, 0.0, 0.0], [0.0, FRAC_PI_2, 0.1333]];
    let five = arm("five", [rows[0], rows[1], rows[2], rows[3], [0.0, -FRAC_PI_2, 0.0997]])
        .with_limits(|_, joint| joint.velocity = 2.0)
        .unwrap();
    let start = [0.0, -1.5, 1.8, -1.9, -1.57];
    let pose = five.fk(&start).unwrap();
    let there = moved(&pose, [0.05, 0.1, -0.1], [0.1, 0.0, 0.0]);
    let back = Move::new(MoveKind::Joints(JointGoal::Pose(pose)));
    let moves = [line(there, Some(0.05), 0.0), back, line(there, None, 0.0)];
    for axis in [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]] {
        let task = Some(pointing(axis, None));
        let Ok(plan) = planned(&five, &start, &moves, None, task) else { continue };
        assert_eq!(plan.status, Status::Solved);
        let tip = five.fk(&end(&plan)).unwrap();
        assert!((tip.translation.vector - there.translation.vector).norm() < 1e-6);
        let axis = Vector3::from(axis);
        assert!((tip.rotation * axis).angle(&(there.rotation * axis)) < 1e-6);
        return;
    }
    panic!("neither axis can be led along the line");
}

#[test]
fn positions_alone_leave_a_planar_arm_free() {
    let arm = robot("planar5");
    let start = [0.3, 0.4, 0.4, 0.4, 0.4];
    let pose = arm.fk(&start).unwrap();
    let there = moved(&pose, [-0.5, 0.4, 0.0], [0.0; 3]);
    let moves = [line(there, Some(0.2), 0.0), Move::new(MoveKind::Joints(JointGoal::Pose(pose)))];
    let plan = planned(&arm, &start, &moves, None, Some(TaskKind::Position.into())).unwrap();
    assert_eq!(plan.status, Status::Solved);
    assert!((plan.moves[0].speed - 0.2).abs() < 1e-6);
    assert!((arm.fk(&end(&plan)).unwrap().translation.vector - pose.translation.vector).norm() < 1e-6);
}

#[test]
fn turns_that_the_task_leaves_free_take_no_time() {
    let (name, home) = ARMS[0];
    let arm = robot(name);
    let start = arm.fk(home).unwrap();
    let spun = start * Rotation3::from_axis_angle(&Vector3::z_axis(), 0.5);
    let by = moved(&spun, [0.0, 0.1, 0.0], [0.0; 3]);
    let moves = [line(spun, None, 0.0), line(by, Some(0.05), 0.0)];
    for task in [pointing([0.0, 0.0, 1.0], None), pointing([0.0, 0.0, 1.0], Some(0.2)), TaskKind::Position.into()] {
        let plan = planned(&arm, home, &moves, None, Some(task)).unwrap();
        assert_eq!(plan.moves[0].end, 0.0);
        let tip = arm.fk(&end(&plan)).unwrap();
        assert!((tip.translation.vector - by.translation.vector).norm() < 1e-6);
    }
    // Within a tolerance the arm need not turn, and there is no path to follow: it turns as without.
    let turn = [line(moved(&start, [0.0; 3], [0.05, 0.0, 0.0]), None, 0.0)];
    let exact = planned(&arm, home, &turn, None, None).unwrap();
    let plan = planned(&arm, home, &turn, None, Some(within([0.1; 3]))).unwrap();
    assert_eq!(plan.trajectory.duration(), exact.trajectory.duration());
}

#[test]
fn the_tool_of_the_task_follows_the_lines() {
    let (name, home) = ARMS[0];
    let arm = robot(name);
    let tool = Pose::from_parts(Translation3::new(0.05, 0.0, 0.2), Rotation3::from_euler_angles(0.0, 0.5, 0.0));
    let with_tool = arm.with_tool(tool).unwrap();
    let there = moved(&with_tool.fk(home).unwrap(), [0.1, -0.1, 0.05], [0.1, 0.1, 0.0]);
    for kind in [TaskKind::Pose, TaskKind::Pointing { axis: [0.0, 0.0, 1.0] }] {
        let task = Task::new(kind, None, None, Some(tool)).unwrap();
        let plan = planned(&arm, home, &[line(there, Some(0.1), 0.0)], None, Some(task)).unwrap();
        let tip = with_tool.fk(&end(&plan)).unwrap();
        assert!((tip.translation.vector - there.translation.vector).norm() < 1e-6);
        assert!((plan.moves[0].speed - 0.1).abs() < 1e-4);
    }
}

#[test]
fn tasks_that_no_line_can_keep_are_refused() {
    let (name, home) = ARMS[0];
    let arm = robot(name);
    let moves = [line(moved(&arm.fk(home).unwrap(), [0.0, 0.1, 0.0], [0.0; 3]), None, 0.0)];
    let said = |task: Task| planned(&arm, home, &moves, None, Some(task)).map(|_| ()).unwrap_err().to_string();
    let free_x = Task::new(TaskKind::Pose, Some(&[0.0, 1.0, 1.0, 1.0, 1.0, 1.0]), None, None).unwrap();
    for (task, name) in [(TaskKind::Orientation.into(), "Orientation"), (free_x, "Pose")] {
        let expected = format!(
            "the task of a program leaves the position free (task {name}), but a line or an arc is a path of positions: ask for x, y and \
             z, or give joint moves to configurations"
        );
        assert_eq!(said(task), expected);
    }
    let region = Region::new([-1.0; 3], [1.0; 3]).unwrap();
    assert_eq!(
        said(Task::from(TaskKind::Position).within(region).unwrap()),
        "the task of a program takes no region: the tip stays on its lines and arcs"
    );
    assert_eq!(
        said(Task::from(TaskKind::Pose).with_first(First::Position).unwrap()),
        "the task of a program takes no order of its parts ('position' first): the tip stays on its lines and arcs"
    );
    assert_eq!(
        said(within([0.1, 1e-5, 0.1])),
        "tolerance[4] of the task must be at least the 5.000e-5 rad to which a path is kept, got 0.00001"
    );
}
