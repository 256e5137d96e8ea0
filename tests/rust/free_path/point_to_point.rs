//! Point-to-point motions: against the bound of planar arms, and around a box.

use std::f64::consts::TAU;

use ikcore::ik::{AllOptions, solve_all};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::planning::{Cost, Endpoint, Plan, PointToPointMethod, PointToPointOptions, Tpbso, plan_point_to_point};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Stop, Unattended};
use ikcore::task::{Target, Tolerance};

fn limits(robot: &Robot, velocity: Option<f64>, acceleration: f64) -> Limits {
    let limits = Limits::of(robot).replace(Field::Acceleration, vec![Profile::Constant(acceleration)]).unwrap();
    match velocity {
        Some(velocity) => limits.replace(Field::Velocity, vec![Profile::Constant(velocity)]).unwrap(),
        None => limits,
    }
}

fn position(x: f64, y: f64) -> Endpoint {
    Endpoint::from(Target::Position([x, y, 0.0]))
}

fn states(plan: &Plan, count: usize) -> impl Iterator<Item = Vec<f64>> {
    let n = plan.trajectory.joints().len();
    (0..=count).map(move |i| {
        let t = plan.trajectory.duration() * i as f64 / count as f64;
        let (mut q, mut qd, mut qdd) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
        q
    })
}

#[test]
fn plane_arms_come_near_the_time_of_bang_bang() {
    // Best over elbows and redundancy of max 2 sqrt(D / a): what no motion of this kind can beat.
    for (links, bound) in [(2, 0.7403), (3, 0.5912), (4, 0.5201), (5, 0.4702)] {
        let robot = Robot::planar(&vec![2.0 / links as f64; links]).unwrap();
        let limits = limits(&robot, Some(std::f64::consts::PI), TAU);
        let mut sum = 0.0;
        for seed in 0..20 {
            let options = PointToPointOptions { limits: Some(limits.clone()), seed, ..Default::default() };
            let plan =
                plan_point_to_point(&robot, &position(1.0, 0.0), &[position(0.5, 1.5)], &options, &mut Unattended);
            let plan = plan.unwrap();
            assert_eq!(plan.status, Status::Solved, "{}", plan.message());
            assert!(plan.trajectory.max_velocity().iter().all(|v| *v <= std::f64::consts::PI));
            assert!(plan.trajectory.max_acceleration().iter().all(|a| *a <= TAU));
            sum += plan.cost / 20.0;
        }
        assert!(sum <= 1.25 * bound, "{links} links: {sum} {bound}");
    }
}

#[test]
fn the_nearest_of_all_branches_and_turns_are_taken() {
    let robot = Robot::named("ur5e").unwrap();
    let limits = limits(&robot, None, 10.0);
    let options = PointToPointOptions { limits: Some(limits), ..Default::default() };
    let rest_to_rest =
        |j: usize, way: f64| (1.875 * way / robot.joints()[j].velocity).max((5.7736 * way / 10.0).sqrt());
    let qs = robot.random_configurations(12, &mut rng::stream(3, 0)).unwrap();
    let targets: Vec<Target> = qs.chunks(6).map(|q| Target::from(&robot.fk(q).unwrap())).collect();
    for pair in targets.windows(2) {
        let [starts, ends] = [0, 1].map(|i| {
            let found = solve_all(&robot, &pair[i], &AllOptions::default(), &mut Unattended).unwrap();
            found.solutions.iter().map(|solution| solution.q.to_vec()).collect::<Vec<_>>()
        });
        // A joint that turns once to either side can always take the shorter way round.
        let turns = |j: usize| if robot.joints()[j].upper >= TAU { 1.0 } else { 0.0 };
        let way = |j: usize, d: f64| (d - turns(j) * TAU * (d / TAU).round()).abs();
        let quintic = |a: &[f64], b: &[f64]| (0..6).map(|j| rest_to_rest(j, way(j, b[j] - a[j]))).fold(0.0, f64::max);
        let all = starts.iter().flat_map(|start| ends.iter().map(move |end| quintic(start, end)));
        let least = all.fold(f64::INFINITY, f64::min);
        let [start, end] = [0, 1].map(|i| Endpoint::from(pair[i]));
        let plan = plan_point_to_point(&robot, &start, &[end], &options, &mut Unattended).unwrap();
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        assert!(plan.cost <= least * (1.0 + 1e-3), "{} s, {least} s", plan.cost);
    }
}

/// Poses behind the box that the arm reaches without contact.
fn poses_behind(robot: &Robot, obstacles: &[Shape], count: usize) -> Vec<Endpoint> {
    let scene = Scene::new(robot, obstacles).unwrap();
    let mut rng = rng::stream(11, 0);
    let mut found = vec![];
    while found.len() < count {
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let tip = robot.fk(&q).unwrap();
        let [x, y, z] = tip.translation.vector.into();
        if x > 0.62 && y.abs() < 0.3 && (0.0..0.4).contains(&z) && scene.is_clear(&q, 0.002) {
            found.push(Endpoint::from(Target::from(&tip)));
        }
    }
    found
}

#[test]
fn arms_find_their_way_around_a_box() {
    let obstacles = vec![Shape::cuboid([0.5, 0.0, 0.2], [0.2, 0.6, 0.4], None).unwrap()];
    for name in ["panda", "iiwa14"] {
        let robot = Robot::named(name).unwrap().with_capsules_along_links(0.06).unwrap();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let start: Vec<f64> = robot.joints().iter().map(|joint| 0.5 * (joint.lower + joint.upper)).collect();
        let mut solved = 0;
        for end in poses_behind(&robot, &obstacles, 20) {
            let ends = [end];
            let options = PointToPointOptions {
                limits: Some(limits(&robot, None, 10.0)),
                surroundings: Surroundings::among(obstacles.clone()),
                ..Default::default()
            };
            let plan =
                plan_point_to_point(&robot, &Endpoint::Configuration(start.clone()), &ends, &options, &mut Unattended);
            let plan = plan.unwrap();
            if plan.status == Status::Solved {
                solved += 1;
                let nearest = |q: Vec<f64>| scene.nearest(&q).unwrap().unwrap().distance;
                let sampled = states(&plan, 500).map(nearest).fold(f64::INFINITY, f64::min);
                let clearance = plan.clearance.as_ref().unwrap().distance;
                assert!(0.001 <= clearance && clearance <= sampled + 1e-9, "{clearance} {sampled}");
                let reached = states(&plan, 1).last().unwrap();
                if let [Endpoint::Targets { targets, .. }] = &ends {
                    let error = ikcore::task::TipError::from(
                        targets[0].assess(&robot, &reached, &Tolerance::default().into()).error,
                    );
                    assert!(error.position < 2e-6 && error.rotation < 2e-6, "{error}");
                }
            } else {
                assert!(!plan.violations.is_empty());
            }
        }
        assert!(solved >= 19, "{name}: {solved} of 20");
    }
}

#[test]
fn a_way_around_a_wall_is_found_and_smooth() {
    // Between the two ends stands a wall that no straight motion passes.
    let obstacles = vec![Shape::cuboid([0.55, 0.0, 0.3], [0.5, 0.05, 0.6], None).unwrap()];
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let side = |turn: f64| Endpoint::Configuration(vec![turn, 0.8, 0.0, -1.6, 0.0, 2.4, 0.8]);
    for seed in 0..5 {
        let options = PointToPointOptions {
            limits: Some(limits(&robot, None, 10.0)),
            surroundings: Surroundings::among(obstacles.clone()),
            seed,
            ..Default::default()
        };
        let plan = plan_point_to_point(&robot, &side(-0.7), &[side(0.7)], &options, &mut Unattended).unwrap();
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        assert!(plan.trajectory.max_acceleration().iter().all(|a| *a <= 10.0));
        // Velocity and acceleration go on across every knot.
        let knots = plan.trajectory.knots();
        for knot in &knots[1..knots.len() - 1] {
            let state = |t: f64| {
                let (mut q, mut qd, mut qdd) = (vec![0.0; 7], vec![0.0; 7], vec![0.0; 7]);
                plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
                (qd, qdd)
            };
            let (before, after) = (state(knot - 1e-9), state(*knot));
            for j in 0..7 {
                assert!((before.0[j] - after.0[j]).abs() < 1e-6 && (before.1[j] - after.1[j]).abs() < 1e-4);
            }
        }
        let again = plan_point_to_point(&robot, &side(-0.7), &[side(0.7)], &options, &mut Unattended).unwrap();
        assert_eq!(again.trajectory, plan.trajectory);
    }
}

#[test]
fn a_larger_budget_finds_no_worse_plan() {
    let obstacles = vec![Shape::cuboid([0.55, 0.0, 0.3], [0.5, 0.05, 0.6], None).unwrap()];
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let side = |turn: f64| Endpoint::Configuration(vec![turn, 0.8, 0.0, -1.6, 0.0, 2.4, 0.8]);
    for seed in 0..3 {
        for objective in [Cost::Time, Cost::JointTravel, Cost::TipTravel] {
            let plan = |stop: Option<Stop>| {
                let limits = Some(limits(&robot, None, 10.0));
                let obstacles = obstacles.clone();
                let options = PointToPointOptions {
                    limits,
                    surroundings: Surroundings::among(obstacles),
                    seed,
                    objective,
                    stop,
                    ..Default::default()
                };
                plan_point_to_point(&robot, &side(-0.7), &[side(0.7)], &options, &mut Unattended).unwrap()
            };
            let (first, better) = (plan(None), plan(Some(Stop { max_evaluations: 100_000, ..Stop::default() })));
            assert!(first.status == Status::Solved && better.status == Status::Solved);
            assert!(better.cost <= first.cost, "{} after {}", better.cost, first.cost);
            let (costs, last) = (better.history.windows(2), better.history.last().unwrap());
            assert!(costs.into_iter().all(|pair| pair[1].cost < pair[0].cost) && last.cost == better.cost);
            assert!(better.evaluations > 100_000 && better.evaluations < 150_000, "{}", better.evaluations);
        }
    }
}

/// Plan of a planar arm whose first link would have to pass through a wall.
fn cut_off(end: Endpoint, stop: Stop) -> Plan {
    let robot = Robot::planar(&[1.0, 1.0]).unwrap().with_capsules_along_links(0.02).unwrap();
    let constant = |value: f64| vec![Profile::Constant(value)];
    let within = limits(&robot, Some(1.0), 10.0).replace(Field::Lower, constant(-2.0)).unwrap();
    let options = PointToPointOptions {
        limits: Some(within.replace(Field::Upper, constant(2.0)).unwrap()),
        surroundings: Surroundings::among(vec![Shape::cuboid([1.2, 0.0, 0.0], [2.0, 0.02, 1.0], None).unwrap()]),
        stop: Some(stop),
        ..Default::default()
    };
    let start = Endpoint::Configuration(vec![-0.8, 0.0]);
    plan_point_to_point(&robot, &start, &[end], &options, &mut Unattended).unwrap()
}

#[test]
fn a_plan_without_a_way_says_how_far_the_search_came() {
    let stop = Stop { max_evaluations: 5000, ..Stop::default() };
    let plan = cut_off(Endpoint::Configuration(vec![0.8, 0.0]), stop);
    assert_eq!(plan.status, Status::BudgetSpent);
    let message = plan.message();
    let start = "no clear plan for the way from start to end: none found in ";
    assert!(message.starts_with(start) && message.contains(" configurations; what was reached from both ends stays "));
    assert!(
        message.contains(" rad apart; on the straight way link 'link")
            && message.contains(" m inside obstacle 0 (Box); try ")
    );
    assert!(!plan.violations.is_empty() && plan.clearance.is_some_and(|clearance| clearance.nearest.is_some()));
}

#[test]
fn a_plan_to_a_blocked_end_says_what_is_in_the_way() {
    let plan = cut_off(position(1.5, 0.0), Stop::default());
    assert_eq!(plan.status, Status::Stalled);
    let message = plan.message();
    let start =
        "no clear plan for end: no configuration was found that is clear of everything; at the clearest one link 'link";
    assert!(message.starts_with(start) && message.contains(" m inside obstacle 0 (Box); try "), "{message}");
}

#[test]
fn plans_reported_free_are_free_at_every_sample() {
    let robots = [
        Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap(),
        Robot::planar(&[0.5, 0.4, 0.3]).unwrap().with_capsules_along_links(0.0).unwrap(),
    ];
    let mut rng = rng::stream(21, 0);
    let (mut free, mut around) = (0, 0);
    for case in 0..200 {
        let robot = &robots[case % 2];
        let flat = case % 2 == 1;
        let obstacles: Vec<Shape> = (0..1 + case % 3)
            .map(|k| {
                let [x, y, z] = std::array::from_fn(|_| rng.uniform_in(-0.8, 0.8));
                let sizes: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.03, 0.2));
                match (flat, (case + k) % 5) {
                    (true, _) => Shape::ellipse([x, y], [sizes[0], sizes[1]], z),
                    (_, 0) => Shape::sphere([x, y, z], sizes[0]),
                    (_, 1) => Shape::cuboid([x, y, z], sizes, None),
                    (_, 2) => Shape::capsule([x, y, z], [x + sizes[0], y, z], sizes[1]),
                    (_, 3) => Shape::ellipsoid([x, y, z], sizes, None),
                    _ => Shape::convex_mesh(&std::array::from_fn::<_, 6, _>(|_| {
                        std::array::from_fn(|axis| [x, y, z][axis] + rng.uniform_in(-0.2, 0.2))
                    })),
                }
                .unwrap()
            })
            .collect();
        let n = robot.dof();
        let ends = robot.random_configurations(2, &mut rng).unwrap();
        let [start, end] = [&ends[..n], &ends[n..]].map(|q| Endpoint::Configuration(q.to_vec()));
        let options = PointToPointOptions {
            limits: Some(limits(robot, Some(1.0), 5.0)),
            surroundings: Surroundings::among(obstacles.clone()),
            stop: Some(Stop { max_evaluations: 4000, ..Stop::default() }),
            ..Default::default()
        };
        let Ok(plan) = plan_point_to_point(robot, &start, &[end], &options, &mut Unattended) else { continue };
        if plan.status != Status::Solved {
            assert!(!plan.violations.is_empty(), "{}", plan.message());
            continue;
        }
        free += 1;
        around += usize::from(plan.trajectory.knots().len() > 4);
        let scene = Scene::new(robot, &obstacles).unwrap();
        let hit = states(&plan, 2000).find(|q| !scene.is_clear(q, 0.001));
        assert!(hit.is_none(), "case {case}: {hit:?}");
    }
    assert!(free > 60 && around > 10, "{free} {around}");
}

/// Planar arm of two links with an unreadable mesh.
const MESH: &str = r#"<robot name="arm"><link name="base"/>
  <link name="upper"><collision><geometry><mesh filename="upper.stl"/></geometry></collision></link>
  <link name="fore"/><link name="tip"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1"/></joint>
  <joint name="b" type="revolute"><parent link="upper"/><child link="fore"/><axis xyz="0 0 1"/><origin xyz="1 0 0"/>
    <limit lower="-3" upper="3" velocity="1"/></joint>
  <joint name="c" type="fixed"><parent link="fore"/><child link="tip"/><origin xyz="1 0 0"/></joint></robot>"#;

#[test]
fn an_arm_of_unknown_shape_plans_only_without_obstacles() {
    let arm = Robot::from_urdf(MESH, None, None).unwrap();
    for method in [PointToPointMethod::MinMax, Tpbso::default().into()] {
        let options = |obstacles: Vec<Shape>| PointToPointOptions {
            method: method.clone(),
            surroundings: Surroundings::among(obstacles),
            limits: Some(limits(&arm, None, 1.0)),
            ..Default::default()
        };
        let (start, end) = (position(1.0, 1.0), position(-0.5, 1.2));
        let plan =
            plan_point_to_point(&arm, &start, std::slice::from_ref(&end), &options(vec![]), &mut Unattended).unwrap();
        assert_eq!(plan.status, Status::Solved, "{method:?}: {}", plan.message());
        let ball = Shape::sphere([5.0, 0.0, 0.0], 0.1).unwrap();
        let says = refused(&arm, &start, &end, options(vec![ball]));
        assert!(says.starts_with("robot 'arm' has collision shapes that cannot be read (a mesh of link"), "{says}");
    }
}

fn refused(robot: &Robot, start: &Endpoint, end: &Endpoint, options: PointToPointOptions) -> String {
    plan_point_to_point(robot, start, std::slice::from_ref(end), &options, &mut Unattended).unwrap_err().to_string()
}

#[test]
fn mistakes_are_named() {
    let arm = Robot::planar(&[1.0, 1.0]).unwrap();
    let thin = arm.with_capsules_along_links(0.01).unwrap();
    let (here, there) = (Endpoint::Configuration(vec![0.0, 0.0]), Endpoint::Configuration(vec![1.0, 0.0]));
    let with = |obstacles: Vec<Shape>, arm: &Robot| PointToPointOptions {
        surroundings: Surroundings::among(obstacles),
        limits: Some(limits(arm, Some(1.0), 1.0)),
        ..Default::default()
    };
    let ball = Shape::sphere([1.0, 0.0, 0.0], 0.25).unwrap();
    let advice = "load its URDF with shapes fitted to its meshes, or give it capsules";
    let bare = Robot::named("panda").unwrap();
    let rest = Endpoint::Configuration(vec![0.0, 0.0, 0.0, -1.5, 0.0, 1.5, 0.0]);
    assert_eq!(
        refused(&bare, &rest, &rest, with(vec![ball.clone()], &bare)),
        format!("robot 'panda' has no capsules, so that nothing is known of the room it takes up: {advice}")
    );
    assert_eq!(
        refused(&thin, &here, &there, with(vec![ball.clone()], &thin)),
        "start_q: link 'link_1' is 0.2600 m inside obstacle 0 (Sphere); free_start moves out first"
    );
    assert_eq!(
        refused(&thin, &there, &here, with(vec![ball.clone()], &thin)),
        "end_q: link 'link_1' is 0.2600 m inside obstacle 0 (Sphere)"
    );
    assert_eq!(
        refused(&arm, &here, &position(3.0, 0.0), with(vec![], &arm)),
        "end cannot be reached: the nearest configuration found stays 1.000 m away"
    );
    assert_eq!(
        refused(&arm, &here, &there, PointToPointOptions::default()),
        "joints 'joint_1', 'joint_2' have neither a velocity nor an acceleration limit, so that nothing sets their pace: \
         give a velocity limit"
    );
    assert_eq!(
        Shape::sphere([0.0; 3], 0.0).unwrap_err().to_string(),
        "radius of the sphere must be positive and finite, got 0"
    );
    assert_eq!(
        Shape::cuboid([0.0; 3], [1.0, 0.0, 1.0], None).unwrap_err().to_string(),
        "size of the box along y must be positive and finite, got 0"
    );
    assert_eq!(
        Shape::sphere([0.0, f64::NAN, 0.0], 1.0).unwrap_err().to_string(),
        "center must be finite, but coordinate y is NaN"
    );
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    assert_eq!(
        Shape::convex_mesh(&square).unwrap_err().to_string(),
        "the points of a convex mesh lie in a plane: it needs at least 4 that do not"
    );
    let panda = Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap();
    let oval = Shape::ellipse([0.5, 0.0], [0.1, 0.2], 0.0).unwrap();
    assert_eq!(
        refused(&panda, &rest, &rest, with(vec![oval], &panda)),
        "obstacle 0 is an Ellipse, which lies in the plane z = 0, and robot 'panda' leaves that plane: use an Ellipsoid"
    );
}

/// Plan of a planar arm past a pillar.
fn around_a_pillar(objective: Cost, stop: Option<Stop>) -> Plan {
    let robot = Robot::planar(&[0.5, 0.4, 0.3]).unwrap().with_capsules_along_links(0.01).unwrap();
    let options = PointToPointOptions {
        limits: Some(limits(&robot, Some(1.0), 5.0)),
        surroundings: Surroundings::among(vec![Shape::ellipse([0.75, 0.0], [0.12, 0.12], 0.0).unwrap()]),
        objective,
        stop,
        ..Default::default()
    };
    let [start, end] = [-0.5, 0.5].map(|y| Endpoint::from(Target::Position([0.8, y, 0.0])));
    plan_point_to_point(&robot, &start, &[end], &options, &mut Unattended).unwrap()
}

#[test]
fn plans_among_obstacles_minimise_their_objective() {
    let [time, joints, tip] = [Cost::Time, Cost::JointTravel, Cost::TipTravel].map(|cost| around_a_pillar(cost, None));
    for plan in [&time, &joints, &tip] {
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    }
    let travel = |plan: &Plan| -> f64 {
        let all: Vec<Vec<f64>> = states(plan, 2000).collect();
        all.windows(2).flat_map(|pair| pair[0].iter().zip(&pair[1])).map(|(a, b)| (b - a).abs()).sum()
    };
    let robot = Robot::planar(&[0.5, 0.4, 0.3]).unwrap();
    let tip_travel = |plan: &Plan| -> f64 {
        let tips: Vec<[f64; 3]> = states(plan, 2000).map(|q| robot.tip_position(&q)).collect();
        tips.windows(2).map(|pair| (0..3).map(|k| (pair[1][k] - pair[0][k]).powi(2)).sum::<f64>().sqrt()).sum()
    };
    // One motion may be the best for all three; tests/python/test_obstacles.py has scenes where they differ. Each is refined by random
    // changes, so that another may be better by a little.
    let most = 1.02;
    assert!(time.cost <= most * joints.trajectory.duration() && time.cost <= most * tip.trajectory.duration());
    assert!(joints.cost <= most * travel(&time) && joints.cost <= most * travel(&tip), "{}", joints.cost);
    assert!(tip.cost <= most * tip_travel(&time) && tip.cost <= most * tip_travel(&joints), "{}", tip.cost);
}

#[test]
fn time_that_is_up_ends_a_plan_among_obstacles() {
    let whole = around_a_pillar(Cost::Time, None);
    let none_left = Stop { max_time: Some(std::time::Duration::ZERO), ..Stop::default() };
    let cut_short = around_a_pillar(Cost::Time, Some(none_left));
    assert_eq!(cut_short.status, Status::BudgetSpent, "{}", cut_short.message());
    assert!(cut_short.evaluations < whole.evaluations / 2, "{} of {}", cut_short.evaluations, whole.evaluations);
    assert!(!cut_short.violations.is_empty());
}
