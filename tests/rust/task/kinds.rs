//! Tasks of the tip: kinds, weights and tolerances by component, tools.

use crate::common::{assert_derivative, configurations, message, pose_at, robot};
use ikcore::ik::{SolveOptions, solve};
use ikcore::math::{Frame, Pose, pose};
use ikcore::nalgebra::{Rotation3, Vector3};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Components, Criterion, Target, Task, TaskKind, Tolerance};

const AXIS: [f64; 3] = [0.6, 0.0, 0.8];
const KINDS: [TaskKind; 4] =
    [TaskKind::Pose, TaskKind::Position, TaskKind::Orientation, TaskKind::Pointing { axis: AXIS }];

fn target(kind: TaskKind, pose: &Pose) -> Target {
    Task::from(kind).target(&Target::from(pose)).unwrap()
}

fn with(task: Task) -> SolveOptions {
    SolveOptions { task: Some(task), ..SolveOptions::default() }
}

/// Distance and angle between poses.
fn apart(a: &Pose, b: &Pose) -> (f64, f64) {
    (
        (a.translation.vector - b.translation.vector).norm(),
        2.0 * ((a.rotation.matrix() - b.rotation.matrix()).norm() / 8.0_f64.sqrt()).asin(),
    )
}

#[test]
fn every_kind_has_its_derivative_weighted_or_not() {
    let weights = Components { weights: [1.0, 0.5, 0.0, 2.0, 0.0, 0.3], tolerance: None };
    let turn = Rotation3::new(Vector3::new(0.3, -0.5, 0.8));
    for name in ["iiwa14", "ur5e", "hydraulic3"] {
        let robot = robot(name);
        for q in configurations(&robot, 3) {
            let wanted = pose::translation(0.1, 0.2, -0.3) * turn * robot.fk(&q).unwrap();
            for kind in KINDS {
                let target = target(kind, &wanted);
                assert_derivative(&robot, &target, Tolerance::default(), &q);
                let criterion = Criterion { components: Some(weights), ..Criterion::default() };
                assert_derivative(&robot, &target, criterion, &q);
            }
        }
    }
}

#[test]
fn every_kind_is_solved_and_leaves_the_rest_free() {
    for name in ["iiwa14", "panda", "ur5"] {
        let robot = robot(name);
        for q in configurations(&robot, 20) {
            let wanted = robot.fk(&q).unwrap();
            for kind in KINDS {
                let solution = solve(&robot, &Target::from(&wanted), &with(kind.into()), &mut Unattended).unwrap();
                assert_eq!(solution.status, Status::Solved, "{name} {kind:?}: {}", solution.message());
                let tip = robot.fk(&solution.q).unwrap();
                let (distance, angle) = apart(&tip, &wanted);
                let axis = Vector3::from(AXIS);
                let off_axis = (tip.rotation * axis).angle(&(wanted.rotation * axis));
                let (near, asked) = match kind {
                    TaskKind::Pose => (distance <= 1e-6 && angle <= 1e-6, (true, true)),
                    TaskKind::Position => (distance <= 1e-6, (true, false)),
                    TaskKind::Orientation => (angle <= 1e-6, (false, true)),
                    TaskKind::Pointing { .. } => (distance <= 1e-6 && off_axis <= 1.1e-6, (true, true)),
                };
                assert!(near, "{name} {kind:?}: {distance:.2e} m, {angle:.2e} rad, axis off by {off_axis:.2e} rad");
                let error = solution.error;
                assert_eq!((!error.position.is_nan(), !error.rotation.is_nan()), asked, "{kind:?}: {error:?}");
            }
        }
    }
}

#[test]
fn the_error_of_a_pointing_task_is_the_angle_between_the_axes() {
    let robot = robot("iiwa14");
    let q = [0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1];
    let tip = robot.fk(&q).unwrap();
    let criterion = Criterion::default();
    for angle in [0.0, 1e-7, 0.1, 1.5, 3.1] {
        // Turned about an axis square to the one that points, then spun about that one.
        let aside = Rotation3::from_axis_angle(&Vector3::y_axis(), angle);
        let wanted = tip * pose::from_parts([0.0; 3], aside.into_inner());
        let spin = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
        let spun = wanted * pose::from_parts([0.0; 3], spin.into_inner());
        let kind = TaskKind::Pointing { axis: [0.0, 0.0, 2.0] };
        for pose in [wanted, spun] {
            let squared = target(kind, &pose).assess(&robot, &q, &criterion).error.rotation.unwrap();
            assert!((squared.sqrt() - angle).abs() < 1e-8, "{angle}: {}", squared.sqrt());
        }
    }
}

#[test]
fn weight_zero_frees_a_component_in_the_target_frame() {
    let robot = robot("iiwa14");
    // Anywhere along the z axis of the target, with any spin about it.
    let components = Components { weights: [1.0, 1.0, 0.0, 1.0, 1.0, 0.0], tolerance: None };
    for q in configurations(&robot, 20) {
        let wanted = robot.fk(&q).unwrap() * pose::translation(0.0, 0.0, 3.0);
        let task = Task { components: Some(components), ..TaskKind::Pose.into() };
        let solution = solve(&robot, &Target::from(&wanted), &with(task), &mut Unattended).unwrap();
        assert_eq!(solution.status, Status::Solved, "{}", solution.message());
        let seen = wanted.inverse() * robot.fk(&solution.q).unwrap();
        assert!(seen.translation.x.hypot(seen.translation.y) <= 1e-6, "{seen}");
        let tilt = (seen.rotation * Vector3::z()).angle(&Vector3::z());
        assert!(tilt <= 1.1e-6, "{tilt:.2e}");
        assert!(seen.translation.z < -0.5, "three metres away it cannot be reached");
    }
}

#[test]
fn tolerances_by_component_decide_what_is_solved() {
    let robot = robot("iiwa14");
    let q = [0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1];
    let tip = robot.fk(&q).unwrap();
    let wanted = tip * pose::translation(0.004, 0.0, -0.02);
    let target = Target::from(&wanted);
    let solved = |tolerance: [f64; 6]| {
        let components = Some(Components { weights: [1.0; 6], tolerance: Some(tolerance) });
        target.assess(&robot, &q, &Criterion { components, ..Criterion::default() }).score.solved
    };
    assert!(solved([0.005, 1e-9, 0.021, 1e-9, 1e-9, 1e-9]));
    assert!(!solved([0.003, 1e-9, 0.021, 1e-9, 1e-9, 1e-9]));
    assert!(!solved([0.005, 1e-9, 0.019, 1e-9, 1e-9, 1e-9]));
}

#[test]
fn a_tool_is_what_reaches_the_target() {
    let robot = robot("panda");
    let tool = pose::translation(0.05, 0.0, 0.1) * Rotation3::new(Vector3::new(0.2, 0.1, -0.3));
    for kind in KINDS {
        for q in configurations(&robot, 5) {
            let wanted = robot.fk(&q).unwrap() * tool;
            let task = Task { tool: Some(tool), ..kind.into() };
            let solution = solve(&robot, &Target::from(&wanted), &with(task), &mut Unattended).unwrap();
            assert_eq!(solution.status, Status::Solved, "{}", solution.message());
            let (distance, angle) = apart(&(robot.fk(&solution.q).unwrap() * tool), &wanted);
            let near = match kind {
                TaskKind::Pose => distance <= 1e-6 && angle <= 1e-6,
                TaskKind::Orientation => angle <= 1e-6,
                _ => distance <= 1e-6,
            };
            assert!(near, "{kind:?}: {distance:.2e} m, {angle:.2e} rad");
        }
    }
}

#[test]
fn a_tool_stands_behind_the_robots_own() {
    let own = pose::translation(0.0, 0.0, 0.2);
    let more = pose::translation(0.1, 0.0, 0.0);
    let bare = robot("iiwa14");
    let with_own = bare.with_tool(own).unwrap();
    let q = [0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1];
    let task = Task { tool: Some(more), ..TaskKind::Position.into() };
    let both: Robot = task.robot(&with_own).unwrap().unwrap();
    let (distance, _) = apart(&both.fk(&q).unwrap(), &(bare.fk(&q).unwrap() * own * more));
    assert!(distance < 1e-15);
}

#[test]
fn what_is_wrong_with_a_task_is_named() {
    let robot = robot("iiwa14");
    let pose = pose_at(&robot, &[0.1; 7]);
    let says = |task: Task, target: &Target| message(solve(&robot, target, &with(task), &mut Unattended));
    let point = Target::Position([0.3, 0.3, 0.5]);
    for (kind, name) in [(TaskKind::Pose, "Pose"), (TaskKind::Orientation, "Orientation"), (KINDS[3], "Pointing")] {
        let expected = format!("task {name} needs a target pose (4, 4), got a position (3,)");
        assert_eq!(says(kind.into(), &point), expected);
    }
    let pointing = |axis| Task::from(TaskKind::Pointing { axis });
    assert_eq!(says(pointing([0.0; 3]), &pose), "the length of axis must be positive, got 0");
    assert_eq!(says(pointing([0.0, f64::NAN, 1.0]), &pose), "axis must be finite, but entry 1 is NaN");
    let weighted =
        |weights, tolerance| Task { components: Some(Components { weights, tolerance }), ..TaskKind::Pose.into() };
    assert_eq!(
        says(weighted([1.0, -1.0, 1.0, 1.0, 1.0, 1.0], None), &pose),
        "weights[1] must be zero or more, and finite, got -1"
    );
    assert_eq!(says(weighted([0.0; 6], None), &pose), "the largest of weights must be positive, got 0");
    let tolerance = Some([1e-3, 1e-3, 0.0, 1e-3, 1e-3, 1e-3]);
    assert_eq!(says(weighted([1.0; 6], tolerance), &pose), "tolerance[2] must be positive, got 0");
}

#[test]
fn a_position_task_takes_the_position_of_a_pose() {
    let frame = Frame::from(&pose::translation(0.1, 0.2, 0.3));
    assert_eq!(Task::from(TaskKind::Position).target(&Target::Pose(frame)).unwrap(), Target::Position([0.1, 0.2, 0.3]));
}
