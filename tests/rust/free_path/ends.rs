//! Alternative ends of a motion, and tasks that leave a part of them free.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::{Frame, Pose};
use ikcore::obstacle::Surroundings;
use ikcore::planning::{Cost, Endpoint, Plan, PointToPointOptions, Tpbso, plan_point_to_point};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Region, Target, Task, TaskKind};

const READY: [f64; 7] = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8];

fn panda() -> Robot {
    Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap()
}

fn options(robot: &Robot) -> PointToPointOptions {
    let limits = Limits::of(robot).replace(Field::Acceleration, vec![Profile::Constant(5.0)]).unwrap();
    PointToPointOptions { limits: Some(limits), ..Default::default() }
}

fn ready() -> Endpoint {
    Endpoint::Configuration(READY.to_vec())
}

fn planned(robot: &Robot, ends: &[Endpoint], options: &PointToPointOptions) -> Plan {
    let plan = plan_point_to_point(robot, &ready(), ends, options, &mut Unattended).unwrap();
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    plan
}

fn refused(robot: &Robot, ends: &[Endpoint], options: &PointToPointOptions) -> String {
    plan_point_to_point(robot, &ready(), ends, options, &mut Unattended).unwrap_err().to_string()
}

fn last_of(plan: &Plan) -> Vec<f64> {
    let n = plan.trajectory.joints().len();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
    plan.trajectory.at(plan.trajectory.duration(), &mut q, &mut qd, &mut qdd).unwrap();
    q
}

/// Configurations at random distances from [`READY`].
fn configurations(robot: &Robot, count: usize) -> Vec<Vec<f64>> {
    let drawn = robot.random_configurations(count, &mut rng::stream(7, 0)).unwrap();
    drawn.chunks(7).map(<[f64]>::to_vec).collect()
}

#[test]
fn the_cheapest_of_several_configurations_is_taken() {
    let robot = panda();
    let ends: Vec<Endpoint> = configurations(&robot, 12).into_iter().map(Endpoint::Configuration).collect();
    for (objective, self_collision) in [(Cost::Time, false), (Cost::JointTravel, false), (Cost::Time, true)] {
        let options = PointToPointOptions {
            objective,
            surroundings: Surroundings { self_collision: Some(self_collision), ..Surroundings::default() },
            ..options(&robot)
        };
        let plan = planned(&robot, &ends, &options);
        let chosen = plan.chosen_end.unwrap();
        let Endpoint::Configuration(q) = &ends[chosen] else { panic!("a configuration was given") };
        assert!(last_of(&plan).iter().zip(q).all(|(reached, wanted)| (reached - wanted).abs() < 1e-9));
        if self_collision {
            continue;
        }
        let alone = |end| planned(&robot, std::slice::from_ref(end), &options).cost;
        let costs: Vec<f64> = ends.iter().map(alone).collect();
        let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(costs[chosen] == least && plan.cost == least, "{} {costs:?}", plan.cost);
    }
}

#[test]
fn the_cheapest_of_several_poses_is_taken() {
    let robot = panda();
    let poses: Vec<Target> = configurations(&robot, 6).iter().map(|q| Target::from(&robot.fk(q).unwrap())).collect();
    let ends: Vec<Endpoint> = poses.iter().copied().map(Endpoint::from).collect();
    let options = PointToPointOptions {
        surroundings: Surroundings { self_collision: Some(false), ..Surroundings::default() },
        ..options(&robot)
    };
    let plan = planned(&robot, &ends, &options);
    let alone: Vec<f64> = ends.iter().map(|end| planned(&robot, std::slice::from_ref(end), &options).cost).collect();
    let least = alone.iter().copied().fold(f64::INFINITY, f64::min);
    // Fewer pairs are tried for each end than if it were the only one.
    assert!(plan.cost <= 1.1 * least, "{} {alone:?}", plan.cost);
    let Target::Pose(wanted) = poses[plan.chosen_end.unwrap()] else { panic!("a pose was given") };
    let reached = robot.tip(&last_of(&plan));
    assert!((0..3).all(|k| (reached.origin[k] - wanted.origin[k]).abs() < 2e-6));
    assert_eq!(planned(&robot, &ends, &options).trajectory, plan.trajectory);
}

#[test]
fn ends_that_cannot_be_reached_are_passed_over_unless_all_are() {
    let robot = panda();
    let ball = Shape::sphere([0.5, 0.0, 0.3], 0.1).unwrap();
    let among = PointToPointOptions { surroundings: Surroundings::among(vec![ball]), ..options(&robot) };
    let far = |x: f64| Endpoint::from(Target::Position([x, 0.0, 0.0]));
    let beyond = Endpoint::Configuration(vec![9.0; 7]);
    let hitting = Endpoint::Configuration(vec![0.0, 0.9, 0.0, -1.6, 0.0, 2.4, 0.8]);
    let good = Endpoint::Configuration(vec![0.9, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8]);
    for options in [&options(&robot), &among] {
        let plan = planned(&robot, &[far(3.0), beyond.clone(), good.clone()], options);
        assert_eq!(plan.chosen_end, Some(2));
        let said = refused(&robot, &[far(3.0), beyond.clone()], options);
        assert!(
            said.starts_with("none of the 2 ends can be reached: end[0]: the nearest configuration found stays 2.1")
                && said.ends_with(
                    "away; end_q[1]: joint 'panda_joint1' at 9 is outside its limits [-2.8973, 2.8973] by 6.103 rad: \
                                   whole turns taken off bring it inside"
                ),
            "{said}"
        );
        assert!(refused(&robot, &[far(3.0)], options).starts_with("end cannot be reached: the nearest"));
    }
    let plan = planned(&robot, &[hitting.clone(), good], &among);
    assert_eq!(plan.chosen_end, Some(1));
    let said = refused(&robot, &[hitting.clone(), hitting.clone()], &among);
    let one = refused(&robot, &[hitting], &among);
    assert!(one.starts_with("end_q: link '"), "{one}");
    assert_eq!(
        said,
        format!(
            "none of the 2 ends can be reached: {}; {}",
            one.replacen("end_q", "end_q[0]", 1),
            one.replacen("end_q", "end_q[1]", 1)
        )
    );
}

#[test]
fn a_wrong_end_is_named_by_its_index() {
    let robot = panda();
    let options = options(&robot);
    let good = Endpoint::Configuration(vec![0.1; 7]);
    let at = |y: f64| Endpoint::from(Target::Position([0.5, y, 0.5]));
    for (ends, expected) in [
        (vec![], "no end was given: give at least one"),
        (vec![at(0.1), at(f64::NAN)], "end[1] must be finite, but coordinate y is NaN"),
        (vec![at(f64::INFINITY)], "end must be finite, but coordinate y is inf"),
        (
            vec![good.clone(), Endpoint::Configuration(vec![0.0; 6])],
            "end_q[1] of robot 'panda': expected 7 joints, got 6",
        ),
        (
            vec![good, Endpoint::Configuration([&[0.0; 6][..], &[f64::NAN]].concat())],
            "end_q[1] must be finite, but joint 'panda_joint7' is NaN",
        ),
    ] {
        assert_eq!(refused(&robot, &ends, &options), expected);
    }
    let published = PointToPointOptions { method: Tpbso::default().into(), ..options.clone() };
    assert_eq!(
        refused(&robot, &[at(0.1), at(0.2)], &published),
        "several ends are taken by the method 'minmax': the method 'tpbso' plans to one"
    );
    let published = PointToPointOptions { task: Some(TaskKind::Position.into()), ..published };
    assert_eq!(
        refused(&robot, &[at(0.1)], &published),
        "task is kept by the method 'minmax': the method 'tpbso' reaches whole targets"
    );
    let pointing = PointToPointOptions { task: Some(TaskKind::Pointing { axis: [0.0, 0.0, 1.0] }.into()), ..options };
    assert_eq!(refused(&robot, &[at(0.1)], &pointing), "task Pointing needs a target pose (4, 4), got a position (3,)");
}

#[test]
fn a_task_leaves_a_part_of_the_end_to_the_planner() {
    let robot = panda();
    let end = robot.tip(&[0.9, 0.5, 0.2, -1.3, 0.1, 1.6, 0.3]);
    let ends = [Endpoint::from(Target::Pose(end))];
    let pointing = TaskKind::Pointing { axis: [0.0, 0.0, 1.0] };
    let mut tool = Pose::identity();
    tool.translation.vector.z = 0.1;
    let whole = planned(&robot, &ends, &options(&robot));
    for obstacles in [vec![], vec![Shape::sphere([0.6, 0.3, 0.5], 0.05).unwrap()]] {
        for (kind, tool) in [(pointing, None), (TaskKind::Position, None), (pointing, Some(tool))] {
            let task = Task::new(kind, None, None, tool).unwrap();
            let options = PointToPointOptions {
                task: Some(task),
                surroundings: Surroundings::among(obstacles.clone()),
                ..options(&robot)
            };
            let plan = planned(&robot, &ends, &options);
            let held = task.robot(&robot).unwrap().unwrap_or_else(|| robot.clone());
            let Frame { origin, axes } = held.tip(&last_of(&plan));
            assert!((0..3).all(|k| (origin[k] - end.origin[k]).abs() < 2e-6), "{kind:?} {origin:?}");
            let aligned: f64 = (0..3).map(|k| axes[2][k] * end.axes[2][k]).sum();
            assert!(kind == TaskKind::Position || aligned > 1.0 - 1e-9, "{aligned}");
            if tool.is_none() && obstacles.is_empty() {
                assert!(plan.cost <= whole.cost + 1e-9, "{} {}", plan.cost, whole.cost);
            }
        }
    }
}

#[test]
fn an_end_is_anywhere_in_a_region() {
    let robot = panda();
    let (lower, upper) = ([0.3, 0.3, 0.2], [0.5, 0.5, 0.4]);
    let height = Task::new(TaskKind::Position, Some(&[0.0, 0.0, 1.0]), None, None).unwrap();
    let task = height.within(Region::new(lower, upper).unwrap()).unwrap();
    let ends = [Endpoint::from(Target::Position([0.0, 0.0, 0.3]))];
    for obstacles in [vec![], vec![Shape::sphere([0.6, 0.3, 0.5], 0.05).unwrap()]] {
        let options =
            PointToPointOptions { task: Some(task), surroundings: Surroundings::among(obstacles), ..options(&robot) };
        let tip = robot.tip_position(&last_of(&planned(&robot, &ends, &options)));
        assert!((0..3).all(|k| lower[k] < tip[k] && tip[k] < upper[k]), "{tip:?}");
        assert!((tip[2] - 0.3).abs() < 2e-6, "{tip:?}");
    }
}

#[test]
fn a_motion_that_begins_at_a_velocity_ends_at_one_of_several() {
    let robot = panda();
    let ends: Vec<Endpoint> =
        [1.2, 0.4, -1.2].map(|turn| Endpoint::Configuration(vec![turn, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8])).into();
    let mut velocity = vec![0.0; 7];
    velocity[0] = 0.5;
    let options = PointToPointOptions { start_velocity: Some(velocity), ..options(&robot) };
    assert_eq!(planned(&robot, &ends, &options).chosen_end, Some(1));
}
