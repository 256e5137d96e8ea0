//! Tolerances and free components along a path: kept at every instant, and used.

use std::f64::consts::{FRAC_PI_2, TAU};

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::so3::rotation_between;
use ikcore::math::{Frame, Pose, pose};
use ikcore::nalgebra::{Rotation3, Vector3};
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::path::Waypoints;
use ikcore::planning::{AlongPathOptions, Cost, Plan, TipPath, plan_along_path};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Stop, Unattended};
use ikcore::task::{Region, Task, TaskKind};

const FREE: f64 = f64::INFINITY;
const UR5E: [f64; 6] = [0.3, -1.6, 1.8, -1.7, -1.5, 0.2];
const POINTING: TaskKind = TaskKind::Pointing { axis: [0.0, 0.0, 1.0] };

fn limits(robot: &Robot) -> Limits {
    let constant = |value: f64| vec![Profile::Constant(value); robot.dof()];
    Limits::of(robot)
        .replace(Field::Velocity, constant(2.0))
        .and_then(|limits| limits.replace(Field::Acceleration, constant(5.0)))
        .unwrap()
}

/// Row of poses from the tip pose at `q` on, with this total displacement and rotation (m, rad).
fn poses(robot: &Robot, q: &[f64], along: [f64; 3], turn: [f64; 3]) -> Vec<Pose> {
    const COUNT: usize = 30;
    let begin = robot.fk(q).unwrap();
    let pose = |i: usize| {
        let s = i as f64 / (COUNT - 1) as f64;
        let mut pose = Rotation3::new(s * Vector3::from(turn)) * begin;
        pose.translation.vector = begin.translation.vector + s * Vector3::from(along);
        pose
    };
    (0..COUNT).map(pose).collect()
}

fn tip_path(poses: &[Pose]) -> TipPath {
    let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
    let rotations = poses.iter().map(|pose| *pose.rotation.matrix()).collect();
    TipPath::through(&Waypoints::new(positions, Some(rotations)).unwrap()).unwrap()
}

fn task(kind: TaskKind, tolerance: &[f64]) -> Task {
    Task::new(kind, None, Some(tolerance), None).unwrap()
}

fn options(robot: &Robot, task: Task) -> AlongPathOptions {
    AlongPathOptions {
        task: Some(task),
        limits: Some(limits(robot)),
        stop: Some(Stop { max_evaluations: 300, ..Stop::default() }),
        ..AlongPathOptions::default()
    }
}

fn planned(robot: &Robot, poses: &[Pose], options: &AlongPathOptions) -> Plan {
    plan_along_path(robot, &tip_path(poses), options, &mut Unattended).unwrap()
}

fn refused(robot: &Robot, poses: &[Pose], options: &AlongPathOptions) -> String {
    plan_along_path(robot, &tip_path(poses), options, &mut Unattended).unwrap_err().to_string()
}

fn instants(plan: &Plan) -> impl Iterator<Item = Vec<f64>> {
    const COUNT: usize = 300;
    (0..=COUNT).map(move |i| {
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; plan.trajectory.joints().len()]);
        let t = plan.trajectory.duration() * f64::from(i as u32) / COUNT as f64;
        plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
        q
    })
}

/// Largest error of a component of `tip` relative to its tolerance: as `Task` defines it, computed independently.
fn off(task: &Task, wanted: &Pose, tip: &Pose) -> f64 {
    let apart = tip.translation.vector - wanted.translation.vector;
    let apart = if task.kind == TaskKind::Position { apart } else { wanted.rotation.inverse() * apart };
    let turn = rotation_between(&Frame::from(wanted), &Frame::from(tip));
    let turn = wanted.rotation.inverse() * Vector3::from(turn);
    let angle = wanted.rotation.matrix().column(2).dot(&tip.rotation.matrix().column(2)).clamp(-1.0, 1.0).acos();
    let components: Vec<f64> = match task.kind {
        TaskKind::Pose => apart.iter().chain(&turn).copied().collect(),
        TaskKind::Position => apart.iter().copied().collect(),
        TaskKind::Orientation => turn.iter().copied().collect(),
        TaskKind::Pointing { .. } => apart.iter().copied().chain([angle]).collect(),
    };
    let (weights, tolerance) = (task.weights().unwrap(), task.tolerance().unwrap());
    let counted = components.iter().zip(&tolerance).zip(&weights).filter(|(_, weight)| **weight > 0.0);
    counted.map(|((component, tolerance), _)| component.abs() / tolerance).fold(0.0, f64::max)
}

/// Largest [`off`] of a motion from the nearest of densely interpolated poses, which it has to pass in order.
fn farthest(robot: &Robot, poses: &[Pose], task: &Task, plan: &Plan) -> f64 {
    const BETWEEN: usize = 60;
    let between = |pair: &[Pose]| -> Vec<Pose> {
        let [from, to] = [pair[0], pair[1]];
        let turn = (to.rotation * from.rotation.inverse()).scaled_axis();
        let place = |i: usize| {
            let s = i as f64 / BETWEEN as f64;
            let position = from.translation.vector.lerp(&to.translation.vector, s);
            pose::translation(position.x, position.y, position.z) * (Rotation3::new(s * turn) * from.rotation)
        };
        (0..=BETWEEN).map(place).collect()
    };
    let dense: Vec<Pose> = poses.windows(2).flat_map(between).collect();
    let mut at = 0;
    let mut farthest: f64 = 0.0;
    for q in instants(plan) {
        let tip = robot.fk(&q).unwrap();
        let ahead = &dense[at..(at + 4 * BETWEEN).min(dense.len())];
        let offs = ahead.iter().map(|wanted| off(task, wanted, &tip)).enumerate();
        let (steps, least) = offs.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        at += steps.min(BETWEEN);
        farthest = farthest.max(least);
    }
    farthest
}

#[test]
fn tolerances_hold_at_every_instant_and_save_time() {
    let tasks = [
        task(TaskKind::Pose, &[0.002, 0.004, 0.01, 0.1, 0.2, 0.4]),
        task(TaskKind::Pose, &[0.001, 0.001, 0.001, 0.002, 0.002, FREE]),
        task(TaskKind::Position, &[0.01, 0.001, 0.005]),
        task(POINTING, &[0.001, 0.001, 0.001, 0.3]),
        task(TaskKind::Orientation, &[0.05, 0.05, 0.01]),
        Task::new(TaskKind::Pose, Some(&[1.0, 1.0, 0.0, 1.0, 1.0, 0.0]), Some(&[0.002; 6]), None).unwrap(),
    ];
    for name in ["ur5e", "panda"] {
        let robot = Robot::named(name).unwrap();
        let q = robot.random_configurations(1, &mut rng::stream(5, 0)).unwrap();
        let q = if name == "ur5e" { UR5E.to_vec() } else { q };
        let poses = poses(&robot, &q, [0.05, 0.15, -0.05], [0.3, 0.0, 0.5]);
        let exact = planned(&robot, &poses, &options(&robot, TaskKind::Pose.into()));
        assert_eq!(exact.status, Status::Solved, "{name}: {}", exact.message());
        for task in tasks {
            let plan = planned(&robot, &poses, &options(&robot, task));
            assert_eq!(plan.status, Status::Solved, "{name} {task:?}: {}", plan.message());
            let off = farthest(&robot, &poses, &task, &plan);
            assert!(off <= 1.02, "{name} {task:?}: {off} of the tolerance");
            assert!(plan.cost <= 1.02 * exact.cost, "{name} {task:?}: {} for {} s", plan.cost, exact.cost);
        }
    }
}

#[test]
fn a_tolerance_avoids_what_the_exact_path_cannot() {
    let robot = Robot::named("ur5e").unwrap().with_capsules_along_links(0.05).unwrap();
    let poses = poses(&robot, &UR5E, [0.0, 0.25, 0.0], [0.0; 3]);
    // The hand would be a centimetre deep in the ball, half way.
    let aside = poses[15].rotation * Vector3::y();
    let ball = Shape::sphere((poses[15].translation.vector + 0.07 * aside).into(), 0.03).unwrap();
    let among = |task: Task| AlongPathOptions {
        surroundings: Surroundings {
            obstacles: Some(vec![ball.clone()].into()),
            margin: Some(0.002),
            self_collision: None,
        },
        ..options(&robot, task)
    };
    let exact = planned(&robot, &poses, &among(TaskKind::Pose.into()));
    let wide = task(TaskKind::Pose, &[0.001, 0.04, 0.001, 0.01, 0.01, 0.01]);
    let plan = planned(&robot, &poses, &among(wide));
    assert_eq!(exact.status, Status::InCollision, "{}", exact.message());
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    assert!(farthest(&robot, &poses, &wide, &plan) <= 1.02);
    let scene = Scene::new(&robot, &[ball]).unwrap();
    assert!(instants(&plan).all(|q| scene.clearance(&q).unwrap() >= 0.002));
}

#[test]
fn a_start_within_the_tolerance_is_kept_and_one_beyond_refused() {
    let robot = Robot::named("panda").unwrap();
    let q = [0.1, 0.2, 0.1, -2.2, 0.1, 2.4, 0.8];
    let poses = poses(&robot, &q, [0.0, 0.3, 0.1], [0.0; 3]);
    let task = task(TaskKind::Pose, &[0.02, 0.02, 0.02, 0.2, 0.2, 0.5]);
    let mut start = q;
    start[6] += 0.4;
    let given = |start: [f64; 7], task: Task| AlongPathOptions { start: Some(start.to_vec()), ..options(&robot, task) };
    let plan = planned(&robot, &poses, &given(start, task));
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    assert!(instants(&plan).next().unwrap().iter().zip(start).all(|(q, given)| (q - given).abs() < 1e-12));
    assert!(farthest(&robot, &poses, &task, &plan) <= 1.02);
    start[6] += 0.4;
    let says = refused(&robot, &poses, &given(start, task));
    assert!(says.starts_with("infeasible: start_q turns the tip 0.3") && says.ends_with(" rad"), "{says}");
    start[6] -= 0.8;
    start[1] += 0.2;
    let says = refused(&robot, &poses, &given(start, task));
    assert!(says.starts_with("infeasible: start_q has the tip 0.0"), "{says}");
}

#[test]
fn the_shortest_motion_within_the_tolerance_is_shorter() {
    // A zigzag of 4 mm that a tolerance of 10 mm lets the tip cut straight through.
    let robot = Robot::named("iiwa14").unwrap();
    let q = [0.2, 0.5, -0.3, -1.3, 0.4, 0.9, 0.1];
    let mut poses = poses(&robot, &q, [0.0, 0.3, 0.0], [0.0; 3]);
    poses.iter_mut().step_by(2).for_each(|pose| pose.translation.vector.z += 0.004);
    let by = |task: Task| {
        let plan = planned(&robot, &poses, &AlongPathOptions { objective: Cost::JointTravel, ..options(&robot, task) });
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        plan.cost
    };
    let (exact, tolerant) = (by(TaskKind::Position.into()), by(task(TaskKind::Position, &[0.01; 3])));
    assert!(tolerant < 0.8 * exact, "{tolerant} rad for {exact} rad");
}

#[test]
fn what_cannot_be_asked_for_is_named() {
    let robot = Robot::named("panda").unwrap();
    let poses = poses(&robot, &[0.1, 0.2, 0.1, -2.2, 0.1, 2.4, 0.8], [0.0, 0.3, 0.0], [0.0; 3]);
    let region = Region::new([-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]).unwrap();
    let within = Task::from(TaskKind::Pose).within(region).unwrap();
    assert_eq!(
        refused(&robot, &poses, &options(&robot, within)),
        "along a path the task takes no region: its weights and tolerance say how far the tip may be off"
    );
    let narrow = task(TaskKind::Position, &[0.01, 1e-4, 0.01]);
    let coarse = AlongPathOptions { accuracy: Some(1e-3), ..options(&robot, narrow) };
    assert_eq!(
        refused(&robot, &poses, &coarse),
        "accuracy 0.001000 is more than the smallest tolerance of the task, 1.000e-4"
    );
    let says = refused(&robot, &poses, &options(&robot, TaskKind::Orientation.into()));
    assert_eq!(
        says,
        "path: the task leaves the tip so free that the arm need not move from point 0 of the path to the path between points 0 and \
         1: ask for more of the pose, or for smaller tolerances"
    );
    let positions = poses.iter().map(|pose| pose.translation.vector.into()).collect();
    let bare = TipPath::through(&Waypoints::new(positions, None).unwrap()).unwrap();
    let turned = options(&robot, task(TaskKind::Orientation, &[0.1; 3]));
    let says = plan_along_path(&robot, &bare, &turned, &mut Unattended).unwrap_err().to_string();
    assert_eq!(says, "task Orientation needs a target pose (4, 4), got a position (3,)");
}

#[test]
fn a_wider_tolerance_is_no_worse() {
    let robot = Robot::named("ur5e").unwrap();
    let upright = Rotation3::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
    let on_ring = |i: usize| {
        let angle = TAU * i as f64 / 40.0;
        pose::translation(0.6, 0.2 * angle.cos(), 0.5 + 0.2 * angle.sin()) * upright
    };
    let ring: Vec<Pose> = (0..=40).map(on_ring).collect();
    let mut least = planned(&robot, &ring, &options(&robot, TaskKind::Pose.into())).cost;
    for angle in [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 2.0] {
        // The last one lets the arm stay where it is.
        let near = if angle == 2.0 { 1.0 } else { 0.002 };
        let task = task(TaskKind::Pose, &[near, near, near, angle, angle, angle]);
        let plan = planned(&robot, &ring, &options(&robot, task));
        assert_eq!(plan.status, Status::Solved, "{angle}: {}", plan.message());
        println!("{angle}: {} for {least}", plan.cost);
        assert!(plan.cost <= 1.05 * least, "{angle} rad: {} s for {least} s", plan.cost);
        assert!(farthest(&robot, &ring, &task, &plan) <= 1.02);
        least = least.min(plan.cost);
    }
}
