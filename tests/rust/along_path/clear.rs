//! Paths among obstacles: certified motions, error messages, and tasks that leave a part of the poses free.

use std::f64::consts::PI;

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::so3::norm;
use ikcore::obstacle::{Obstacle, Obstacles, Scene, Surroundings};
use ikcore::path::Waypoints;
use ikcore::planning::{AlongPathOptions, Cost, Plan, TipPath, Tpbso, plan_along_path};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{AnySolver, DifferentialEvolution, Monitor, Status, Stop, Unattended};
use ikcore::task::{Task, TaskKind};
use nalgebra::{Rotation3, Vector3};

use crate::common::cases;

const MARGIN: f64 = 2e-3;
const Q: [f64; 7] = [0.1, 0.2, 0.1, -2.2, 0.1, 2.4, 0.8];

fn arm(name: &str) -> Robot {
    Robot::named(name).unwrap().with_capsules_along_links(0.05).unwrap()
}

fn limits(robot: &Robot, jerk: f64) -> Limits {
    let fields = [(Field::Velocity, 2.0), (Field::Acceleration, 5.0), (Field::Jerk, jerk)];
    let given = fields.into_iter().filter(|(_, value)| value.is_finite());
    given.fold(Limits::of(robot), |limits, (field, value)| {
        limits.replace(field, vec![Profile::Constant(value); robot.dof()]).unwrap()
    })
}

/// Bent path with the orientation of the tip at `q`, that goes `along` in a row of points.
fn bent(robot: &Robot, q: &[f64], along: [f64; 3], rise: [f64; 3]) -> TipPath {
    const COUNT: usize = 30;
    let begin = robot.fk(q).unwrap();
    let point = |i: usize| -> [f64; 3] {
        let s = i as f64 / (COUNT - 1) as f64;
        std::array::from_fn(|k| begin.translation.vector[k] + s * along[k] + s * (1.0 - s) * rise[k])
    };
    let rotations = vec![*begin.rotation.matrix(); COUNT];
    TipPath::through(&Waypoints::new((0..COUNT).map(point).collect(), Some(rotations)).unwrap()).unwrap()
}

fn swing(robot: &Robot) -> TipPath {
    bent(robot, &Q, [0.0, 0.4, 0.0], [0.0, 0.0, 0.2])
}

fn among(obstacles: impl Into<Obstacles>) -> Surroundings {
    Surroundings { obstacles: Some(obstacles.into()), margin: Some(MARGIN), self_collision: None }
}

fn options(robot: &Robot, obstacles: impl Into<Obstacles>) -> AlongPathOptions {
    AlongPathOptions {
        limits: Some(limits(robot, f64::INFINITY)),
        surroundings: among(obstacles),
        ..AlongPathOptions::default()
    }
}

fn planned(robot: &Robot, tip_path: &TipPath, options: &AlongPathOptions) -> Plan {
    plan_along_path(robot, tip_path, options, &mut Unattended).unwrap()
}

fn refused(robot: &Robot, tip_path: &TipPath, options: &AlongPathOptions) -> String {
    plan_along_path(robot, tip_path, options, &mut Unattended).unwrap_err().to_string()
}

/// Configurations of a plan at many instants.
fn instants(plan: &Plan) -> impl Iterator<Item = Vec<f64>> {
    const COUNT: usize = 2000;
    (0..=COUNT).map(move |i| {
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; plan.trajectory.joints().len()]);
        let t = plan.trajectory.duration() * i as f64 / COUNT as f64;
        plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
        q
    })
}

fn smallest(robot: &Robot, obstacles: &[Shape], plan: &Plan) -> f64 {
    let scene = Scene::new(robot, obstacles).unwrap();
    instants(plan).map(|q| scene.clearance(&q).unwrap()).fold(f64::INFINITY, f64::min)
}

fn boxes(rng: &mut LazyRng, near: &TipPath) -> Vec<Shape> {
    let mut center = || {
        let point = near.positions()[rng.below(near.positions().len())];
        let toward_base = rng.uniform_in(0.4, 1.1);
        std::array::from_fn(|k| toward_base * point[k] + rng.uniform_in(-0.2, 0.2))
    };
    let centers: Vec<[f64; 3]> = (0..3).map(|_| center()).collect();
    let size = |rng: &mut LazyRng| std::array::from_fn(|_| rng.uniform_in(0.03, 0.15));
    centers.into_iter().map(|center| Shape::cuboid(center, size(rng), None).unwrap()).collect()
}

#[test]
fn plans_among_random_boxes_are_clear_at_every_instant() {
    let mut blocked = 0;
    for name in ["panda", "ur5e", "iiwa14"] {
        let robot = arm(name);
        let mut rng = rng::stream(11, 0);
        let mut clear = 0;
        for seed in 0..cases(9) as usize {
            let q = robot.random_configurations(1, &mut rng).unwrap();
            let mut step = || std::array::from_fn(|_| rng.uniform_in(-0.15, 0.15));
            let tip_path = bent(&robot, &q, step(), step());
            let obstacles = boxes(&mut rng, &tip_path);
            let pointing = TaskKind::Pointing { axis: [0.0, 0.0, 1.0] };
            let tolerance = [0.005, 0.005, 0.02, 0.1, 0.1, 0.5];
            let tasks =
                [Some(pointing.into()), Some(Task::new(TaskKind::Pose, None, Some(&tolerance), None).unwrap()), None];
            let options = AlongPathOptions {
                task: tasks[seed % 3],
                objective: if seed % 2 == 0 { Cost::Time } else { Cost::JointTravel },
                ..options(&robot, obstacles.clone())
            };
            // The path may leave the reach.
            let Ok(plan) = plan_along_path(&robot, &tip_path, &options, &mut Unattended) else { continue };
            let distance = smallest(&robot, &obstacles, &plan);
            let claimed = plan.clearance.as_ref().unwrap().distance;
            if plan.status == Status::Solved {
                assert!(distance >= MARGIN && claimed >= MARGIN, "{name} {seed}: {distance}, {claimed}");
                assert!(claimed <= distance.max(MARGIN) + 1e-9, "{name} {seed}: {claimed} for {distance}");
                clear += 1;
            } else {
                assert_eq!(plan.status, Status::InCollision, "{name} {seed}: {}", plan.message());
                assert!(plan.obstruction.is_some() && claimed < MARGIN && !plan.violations.is_empty());
                blocked += 1;
            }
        }
        assert!(clear > 1, "{name}: {clear} clear");
    }
    assert!(blocked > 0);
}

/// Box that the elbow of the arm hits unless obstacles are avoided.
fn beside_elbow(robot: &Robot) -> Shape {
    let free = AlongPathOptions { limits: Some(limits(robot, f64::INFINITY)), ..AlongPathOptions::default() };
    let plan = planned(robot, &swing(robot), &free);
    let q = instants(&plan).nth(1000).unwrap();
    let elbow = robot.link_poses(&q).unwrap()[4].translation.vector;
    Shape::sphere(elbow.into(), 0.05).unwrap()
}

#[test]
fn an_arm_that_would_collide_goes_round_by_its_self_motion() {
    let robot = arm("panda");
    let ball = beside_elbow(&robot);
    let free = planned(
        &robot,
        &swing(&robot),
        &AlongPathOptions { surroundings: Surroundings::default(), ..options(&robot, vec![]) },
    );
    assert!(smallest(&robot, std::slice::from_ref(&ball), &free) < 0.0 && free.clearance.is_none());
    for objective in [Cost::Time, Cost::JointTravel] {
        let options = AlongPathOptions { objective, ..options(&robot, vec![ball.clone()]) };
        let plan = planned(&robot, &swing(&robot), &options);
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        assert!(smallest(&robot, std::slice::from_ref(&ball), &plan) >= MARGIN);
        let clearance = plan.clearance.clone().unwrap();
        let nearest = clearance.nearest.unwrap();
        let distance = nearest.contact.distance;
        assert!((distance - clearance.distance).abs() < 1e-4 + 0.02 * distance, "{distance}");
        assert!(plan.message().contains(" m clear of everything"), "{}", plan.message());
        assert_eq!(plan, Plan { elapsed: plan.elapsed, ..planned(&robot, &swing(&robot), &options) });
    }
}

#[test]
fn a_given_start_is_kept() {
    let robot = arm("panda");
    let options = AlongPathOptions { start: Some(Q.to_vec()), ..options(&robot, vec![beside_elbow(&robot)]) };
    let plan = planned(&robot, &swing(&robot), &options);
    let first = instants(&plan).next().unwrap();
    assert!(first.iter().zip(Q).all(|(q, given)| (q - given).abs() < 1e-12), "{first:?}");
    assert!(plan.status != Status::Solved || smallest(&robot, &[beside_elbow(&robot)], &plan) >= MARGIN);
}

#[test]
fn a_free_rotation_avoids_what_a_pose_cannot() {
    let robot = arm("ur5e");
    let tip_path = bent(&robot, &[0.3, -1.6, 1.8, -1.7, -1.5, 0.2], [0.0, 0.25, 0.0], [0.0; 3]);
    let task = |kind: TaskKind| AlongPathOptions { task: Some(kind.into()), ..options(&robot, vec![]) };
    let axis = [0.0, 0.0, 2.0];
    let durations = [TaskKind::Pose, TaskKind::Pointing { axis }, TaskKind::Position].map(|kind| {
        let plan = planned(&robot, &tip_path, &task(kind));
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        let accuracy = plan.accuracy.unwrap();
        for q in instants(&plan) {
            let tip = robot.fk(&q).unwrap();
            assert!(tip_path.distance(tip.translation.vector.into(), 0.0, 1.0) <= accuracy + 1e-9);
            let wanted = robot.fk(&[0.3, -1.6, 1.8, -1.7, -1.5, 0.2]).unwrap();
            let apart = tip.rotation.matrix().column(2) - wanted.rotation.matrix().column(2);
            assert!(kind == TaskKind::Position || norm(&apart.into()) < 1e-3, "{kind:?}");
        }
        plan.cost
    });
    // Freedom costs nothing beyond the accuracy of the search.
    assert!(durations[1] <= 1.02 * durations[0] && durations[2] <= 1.02 * durations[1], "{durations:?}");
}

#[test]
fn a_joint_that_winds_begins_where_its_limits_let_it_end() {
    let robot = arm("ur5e");
    let q = [2.5, -1.6, 1.8, -1.7, -1.5, 0.2];
    let begin = robot.fk(&q).unwrap();
    // Once and a quarter round the base.
    let turned = (0..=100).map(|i| Rotation3::from_axis_angle(&Vector3::z_axis(), 2.5 * PI * f64::from(i) / 100.0));
    let (positions, rotations) = turned
        .map(|turn| {
            let position: [f64; 3] = (turn * begin.translation.vector).into();
            (position, *(turn * begin.rotation).matrix())
        })
        .unzip();
    let tip_path = TipPath::through(&Waypoints::new(positions, Some(rotations)).unwrap()).unwrap();
    let plan = planned(&robot, &tip_path, &options(&robot, vec![]));
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    let [low, high] = [0, 2000].map(|i| instants(&plan).nth(i).unwrap()[0]);
    assert!((high - low - 2.5 * PI).abs() < 1e-2 && low < -PI, "{low} to {high}");
}

#[test]
fn what_is_in_the_way_is_named() {
    let robot = arm("panda");
    let tip_path = swing(&robot);
    let said = |obstacles: Vec<Shape>, margin: f64| {
        let surroundings = Surroundings { margin: Some(margin), ..among(obstacles) };
        let plan = planned(&robot, &tip_path, &AlongPathOptions { surroundings, ..options(&robot, vec![]) });
        assert!(plan.status == Status::InCollision && !plan.violations.is_empty());
        plan.message()
    };
    let on_path = tip_path.positions()[12];
    let advice = "move the path or what is in the way, lower the margin, leave a part of the poses free by a task, or breaks, which let \
                  the tool leave the path there and go on";
    let hand = said(vec![Shape::sphere(on_path, 0.04).unwrap()], 0.0);
    assert!(hand.starts_with("no clear plan for ") && hand.ends_with(advice), "{hand}");
    assert!(
        hand.contains(" inside obstacle 0 (Sphere) whatever the arm does: the hand itself is in the way; "),
        "{hand}"
    );
    let base = said(vec![Shape::sphere([0.0, 0.0, 0.1], 3.0).unwrap()], 0.0);
    assert!(base.contains(" inside obstacle 0 (Sphere)"), "{base}");
    let wide = said(vec![], 0.5);
    assert!(wide.contains(" (of a margin of 0.5000 m) from link '"), "{wide}");

    let ur5e = arm("ur5e");
    let q = [0.3, -1.6, 1.8, -1.7, -1.5, 0.2];
    let elbows = ur5e.link_poses(&q).unwrap();
    let around = elbows[2].translation.vector + 0.5 * (elbows[3].translation.vector - elbows[2].translation.vector);
    let ball = Shape::sphere([0.3 * around.x, 0.3 * around.y, 0.45], 0.3).unwrap();
    let ball = Obstacles::from_iter([Obstacle::new(ball, vec!["link_1".into()])]);
    let plan = planned(&ur5e, &bent(&ur5e, &q, [0.0, 0.1, 0.0], [0.0; 3]), &options(&ur5e, ball));
    assert!(plan.message().contains(" postures, and there are no others; "), "{}", plan.message());
}

#[test]
fn mistakes_along_a_path_are_named() {
    let robot = arm("panda");
    let tip_path = swing(&robot);
    let ball = || vec![Shape::sphere([0.0, 0.0, 0.6], 0.3).unwrap()];
    let start = AlongPathOptions { start: Some(Q.to_vec()), ..options(&robot, ball()) };
    let says = refused(&robot, &tip_path, &start);
    assert!(says.starts_with("start_q: link '") && says.ends_with(" m inside obstacle 0 (Sphere)"), "{says}");
    let bare = Robot::named("panda").unwrap();
    let says = refused(&bare, &tip_path, &options(&bare, ball()));
    assert!(
        says.starts_with("robot 'panda' has no capsules, so that nothing is known of the room it takes up: "),
        "{says}"
    );
    let lonely = Surroundings { margin: Some(0.1), ..Surroundings::default() };
    assert_eq!(
        refused(&robot, &tip_path, &AlongPathOptions { surroundings: lonely, ..options(&robot, vec![]) }),
        "a margin needs obstacles (perhaps none) or self-collision"
    );
    let by_swarm = AlongPathOptions { method: Tpbso::default().into(), ..options(&robot, vec![]) };
    assert_eq!(
        refused(&robot, &tip_path, &by_swarm),
        "along a path a task, obstacles and self-collision need the method 'timed'"
    );
}

#[test]
fn a_plan_keeps_its_margin_with_other_limits() {
    let robot = arm("panda");
    let ball = beside_elbow(&robot);
    let plan = planned(&robot, &swing(&robot), &options(&robot, vec![ball.clone()]));
    let slower = plan.retime(&robot, Some(&limits(&robot, 50.0))).unwrap();
    assert!(slower.trajectory.duration() > plan.trajectory.duration());
    assert!(
        smallest(&robot, std::slice::from_ref(&ball), &slower) >= MARGIN
            && slower.clearance.as_ref().unwrap().distance >= MARGIN
    );
    let back = slower.retime(&robot, Some(&limits(&robot, f64::INFINITY))).unwrap();
    assert_eq!(back.trajectory, plan.trajectory);
    let smooth = AlongPathOptions { limits: Some(limits(&robot, 50.0)), ..options(&robot, vec![ball.clone()]) };
    let smooth = planned(&robot, &swing(&robot), &smooth);
    assert_eq!(smooth.status, Status::Solved, "{}", smooth.message());
    assert!(smallest(&robot, &[ball], &smooth) >= MARGIN);
}

/// Monitor that stops the search at its first report.
struct Impatient;

impl Monitor for Impatient {
    fn progress(&mut self, _done: usize, _total: usize) {}

    fn keep_going(&mut self) -> bool {
        false
    }
}

#[test]
fn a_stopped_search_returns_a_clear_motion_and_says_so() {
    let robot = arm("panda");
    let ball = beside_elbow(&robot);
    let stop = Some(Stop { max_evaluations: 100_000, ..Stop::default() });
    // Pattern search would have ended by itself before the first report.
    let solver = Some(AnySolver::Single(DifferentialEvolution::default().into()));
    let options = AlongPathOptions { stop, solver, ..options(&robot, vec![ball.clone()]) };
    let plan = plan_along_path(&robot, &swing(&robot), &options, &mut Impatient).unwrap();
    assert_eq!(plan.status, Status::Interrupted);
    assert!(smallest(&robot, &[ball], &plan) >= MARGIN);
}
