//! Obstacles that some links may touch.

use ikcore::ik::{SolveOptions, solve};
use ikcore::math::Frame;
use ikcore::obstacle::{ClearanceSweep, Edge, Neighbor, Obstacle, Obstacles, Scene, Surroundings};
use ikcore::planning::{Endpoint, PointToPointOptions, plan_point_to_point};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{LinkCapsule, Robot};
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;
use ikcore::{Error, Result};

use crate::common::cases;

const READY: [f64; 7] = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8];

/// Panda with a foot, capsules on its links and a box in its hand, but without the bodies of these links.
fn panda_without(links: &[String]) -> Robot {
    let along = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let mut capsules = along.capsules().to_vec();
    capsules.push(LinkCapsule { link: "base".into(), a: [0.0; 3], b: [0.1, 0.0, 0.0], radius: 0.08 });
    capsules.retain(|body| !links.contains(&body.link));
    let robot = along.with_capsules(capsules).unwrap();
    if links.contains(&"part".into()) {
        return robot;
    }
    let part = Shape::cuboid([0.0, 0.0, 0.1], [0.05, 0.3, 0.05], None).unwrap();
    robot.with_attached("flange", &part, &[], Some("part")).unwrap()
}

fn names(links: &[&str]) -> Vec<String> {
    links.iter().map(|link| (*link).to_owned()).collect()
}

fn random_obstacle(rng: &mut LazyRng) -> Obstacle {
    let center = std::array::from_fn(|_| rng.uniform_in(-0.6, 0.6));
    let size = std::array::from_fn(|_| rng.uniform_in(0.05, 0.2));
    let touch: &[&str] = match rng.uniform_in(0.0, 5.0) as usize {
        0 => &[],
        1 => &["base"],
        2 => &["link_3", "link_5"],
        3 => &["part", "link_4"],
        _ => &["link_1", "base", "link_6", "link_7", "part"],
    };
    Obstacle::new(Shape::cuboid(center, size, None).unwrap(), names(touch))
}

/// Smallest distance of each obstacle from the bodies that must not touch it, by robots without the other bodies.
fn distances(obstacles: &[Obstacle], q: &[f64]) -> Vec<f64> {
    let distance = |obstacle: &Obstacle| {
        let robot = panda_without(obstacle.touch());
        let alone = [obstacle.shape.clone()];
        Scene::new(&robot, &alone).unwrap().without_self_collision().clearance(q).unwrap()
    };
    obstacles.iter().map(distance).collect()
}

#[test]
fn a_link_that_may_touch_an_obstacle_is_not_kept_from_it() {
    let robot = panda_without(&[]);
    let mut rng = rng::stream(31, 0);
    let mut seen = [0; 2];
    for case in 0..cases(24) {
        // Many obstacles are found by a tree.
        let count = if case % 6 == 5 { 30 } else { 1 + case % 4 };
        let obstacles: Obstacles = (0..count).map(|_| random_obstacle(&mut rng)).collect();
        let scene = Scene::new(&robot, &obstacles).unwrap().without_self_collision();
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let each = distances(&obstacles, &q);
        let expected = each.iter().copied().fold(f64::INFINITY, f64::min);
        let found = scene.nearest(&q).unwrap().unwrap();
        assert!((found.distance - expected).abs() < 1e-6, "case {case}: {found:?} {expected}");
        let Neighbor::Obstacle(i, _) = found.other else { panic!("{found:?}") };
        assert!(!obstacles[i].touch().contains(&found.link), "{found:?}");
        for margin in [0.0, (expected - 1e-3).max(0.0), expected.max(0.0) + 1e-3] {
            let clear = expected >= margin;
            assert_eq!(scene.is_clear(&q, margin), clear, "case {case}: {expected} {margin}");
            assert_eq!(scene.which_are_clear(&[&q[..], &q].concat(), margin).unwrap(), [clear; 2]);
            let standing = Edge { from: &q, to: &q };
            assert_eq!(ClearanceSweep::new(&scene).check(&standing, [0.0, 1.0], margin).is_ok(), clear);
            seen[usize::from(clear)] += 1;
        }
        let given = |obstacles: Obstacles| Surroundings {
            obstacles: Some(obstacles),
            margin: Some(0.0),
            self_collision: Some(false),
        };
        let nearness = |robot: &Robot, obstacles: Obstacles| {
            given(obstacles).clear_space(robot).unwrap().unwrap().nearness(&q, 0.1, 1.0, &mut [0.0; 7])
        };
        let alone = |obstacle: &Obstacle| {
            nearness(&panda_without(obstacle.touch()), Obstacles::from_iter([obstacle.shape.clone()]))
        };
        let sum: f64 = obstacles.iter().map(alone).sum();
        assert!((nearness(&robot, obstacles) - sum).abs() < 1e-4 * (1.0 + sum), "case {case}");
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn four_configurations_side_by_side_are_judged_as_one() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let mut rng = rng::stream(32, 0);
    let touch = [&["link_1"][..], &["link_3", "link_7"], &["link_5"], &["link_7"], &["link_6", "link_7"], &[]];
    let boxes = touch.map(|links| {
        let angle = rng.uniform_in(-3.0, 3.0);
        let center = [0.5 * f64::cos(angle), 0.5 * f64::sin(angle), rng.uniform_in(0.2, 0.7)];
        Obstacle::new(Shape::cuboid(center, [0.25; 3], None).unwrap(), names(links))
    });
    let strict_boxes = boxes.clone().map(|obstacle| obstacle.shape);
    let scene = Scene::new(&robot, Obstacles::from_iter(boxes)).unwrap();
    let strict = Scene::new(&robot, &strict_boxes).unwrap();
    let qs = robot.random_configurations(403, &mut rng).unwrap();
    let (clear, strictly) = (scene.which_are_clear(&qs, 0.0).unwrap(), strict.which_are_clear(&qs, 0.0).unwrap());
    for (q, found) in qs.chunks(7).zip(&clear) {
        assert_eq!(*found, scene.is_clear(q, 0.0));
    }
    assert!(clear.iter().zip(&strictly).all(|(loose, strict)| *loose || !strict));
    let count = |all: &[bool]| all.iter().filter(|clear| **clear).count();
    assert!(count(&clear) > count(&strictly) + 3 && count(&clear) < 400, "{} {}", count(&clear), count(&strictly));
}

/// Solution on a floor at `height`.
fn on_floor(robot: &Robot, height: f64, touch: &[&str]) -> Result<ikcore::ik::Solution> {
    let target = Target::Pose(Frame::from(&robot.fk(&READY).unwrap()));
    let floor = Obstacle::new(Shape::half_space([0.0, 0.0, 1.0], height).unwrap(), names(touch));
    let surroundings = Surroundings::among(Obstacles::from_iter([floor]));
    solve(robot, &target, &SolveOptions { surroundings, ..SolveOptions::default() }, &mut Unattended)
}

#[test]
fn a_robot_stands_on_a_floor_that_its_base_may_touch() {
    let robot = panda_without(&names(&["part"]));
    let said = |touch: &[&str]| on_floor(&robot, 0.0, touch).unwrap().message();
    for (touch, link, depth) in [(&[][..], "base", "0.08000"), (&["base"], "link_1", "0.06000")] {
        let message = said(touch);
        let expected = format!(
            "but link '{link}' is {depth} m inside obstacle 0 (HalfSpace) whatever the arm does; if the robot stands \
             there, put '{link}' into the obstacle's touch: "
        );
        assert!(message.contains(&expected), "{message}");
    }
    let stands = on_floor(&robot, 0.0, &["link_1", "base"]).unwrap();
    assert_eq!(stands.status, Status::Solved, "{}", stands.message());
    let Neighbor::Obstacle(..) = stands.report.nearest.unwrap().clearance.nearest.unwrap().contact.other else {
        return;
    };
    // A floor above the hand stays in the way of the other links.
    let sunk = on_floor(&robot, 0.8, &["link_1", "base"]).unwrap();
    assert_eq!(sunk.status, Status::InCollision);
    assert!(!sunk.message().contains("touch"), "{}", sunk.message());
}

#[test]
fn plans_take_an_obstacle_that_a_link_may_touch() {
    let robot = panda_without(&names(&["part"]));
    let to: Vec<f64> = READY.iter().map(|x| x + 0.3).collect();
    let plan = |touch: &[&str]| {
        let floor = Obstacle::new(Shape::half_space([0.0, 0.0, 1.0], 0.0).unwrap(), names(touch));
        let options = PointToPointOptions {
            surroundings: Surroundings::among(Obstacles::from_iter([floor])),
            ..PointToPointOptions::default()
        };
        let [start, end] = [READY.to_vec(), to.clone()].map(Endpoint::Configuration);
        plan_point_to_point(&robot, &start, &[end], &options, &mut Unattended)
    };
    assert_eq!(
        plan(&["link_1"]).unwrap_err().to_string(),
        "start_q: link 'base' is 0.08000 m inside obstacle 0 (HalfSpace); if the robot stands there, put 'base' \
         into the obstacle's touch"
    );
    assert!(plan(&["base", "link_1"]).unwrap().violations.is_empty());
}

#[test]
fn a_link_without_a_body_cannot_be_named() {
    let robot = panda_without(&[]);
    let bodies = "links with bodies: link_1, link_3, link_4, link_5, link_6, link_7, base, part";
    for (link, problem) in [
        ("link_2", "link 'link_2' of robot 'panda' has no body"),
        ("bse", "robot 'panda' has no link 'bse' (did you mean 'base'?)"),
    ] {
        let error = on_floor(&robot, 0.0, &[link]).unwrap_err();
        assert!(matches!(error, Error::InvalidObstacle { .. }));
        assert_eq!(error.to_string(), format!("touch of obstacle 0 (HalfSpace): {problem}; {bodies}"));
    }
}

#[test]
fn an_attached_shape_may_touch_the_links_that_are_named() {
    let robot = panda_without(&names(&["part"]));
    let rod = Shape::capsule([0.0; 3], [0.0, 0.0, 0.2], 0.05).unwrap();
    let tested = |rod: &Shape, touch: &[&str]| {
        let carrying = robot.with_attached("flange", rod, touch, Some("rod")).unwrap();
        let pairs: Vec<String> = carrying.collision_pairs().iter().map(|pair| pair.join(" ")).collect();
        pairs
    };
    let allowed = tested(&rod, &["link_3"]);
    assert!(tested(&rod, &[]).len() == allowed.len() + 1, "{allowed:?}");
}
