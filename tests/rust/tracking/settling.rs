//! Arms that come no nearer to targets that stand still: they come to rest, and follow whatever changes.

use super::clear::{MARGIN, START, panda, random_obstacles, surroundings, target};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::obstacle::Scene;
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;
use ikcore::tracking::{Session, TrackOptions, Way};

/// Arms, time steps (s), and the time after which a held arm rests (s).
const ARMS: [&str; 4] = ["panda", "ur5e", "iiwa14", "gen3"];
const STEPS: [f64; 4] = [0.004, 0.01, 0.02, 1.0 / 30.0];
const RESTS_AFTER: f64 = 6.0;

/// Scene in which an arm moved on for more than nine seconds before arms settled.
const RESTLESS: [u64; 1] = [736];

/// Speed of an arm at rest (rad/s).
const REST: f64 = 1e-3;

fn fastest(session: &Session) -> f64 {
    session.qd().iter().fold(0.0, |fastest: f64, rate| fastest.max(rate.abs()))
}

fn limits(robot: &Robot, kind: usize) -> Limits {
    let values = [(Field::Velocity, 2.0), (Field::Acceleration, 10.0), (Field::Jerk, 100.0)];
    let add =
        |limits: Limits, (field, value)| limits.replace(field, vec![Profile::Constant(value); robot.dof()]).unwrap();
    values.into_iter().take(kind + 1).fold(Limits::of(robot), add)
}

/// Configuration within 3 rad.
fn drawn(robot: &Robot, rng: &mut LazyRng) -> Vec<f64> {
    let value = |(lower, upper): (f64, f64)| rng.uniform_in(lower.max(-3.0), upper.min(3.0));
    robot.joints().iter().map(|joint| joint.sampling_range()).map(value).collect()
}

/// Session of an arm among boxes and spheres, and a target that it may or may not reach; `None` where the start is not clear.
fn scene(seed: u64) -> Option<(Session, Target)> {
    let mut rng = rng::stream(31, seed);
    let robot = Robot::named(ARMS[seed as usize % 4]).unwrap().with_capsules_along_links(0.05).unwrap();
    let mut shape = |k: usize| {
        let center = [0.0, 0.0, 0.5].map(|middle| middle + rng.uniform_in(-0.8, 0.8));
        let size: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.05, 0.4));
        if k.is_multiple_of(2) { Shape::cuboid(center, size, None) } else { Shape::sphere(center, 0.5 * size[0]) }
            .unwrap()
    };
    let obstacles: Vec<Shape> = (0..6).map(&mut shape).collect();
    let [start, end] = [(); 2].map(|()| drawn(&robot, &mut rng));
    if Scene::new(&robot, &obstacles).unwrap().clearance(&start).unwrap() < 0.03 {
        return None;
    }
    let pose = robot.fk(&end).unwrap();
    let target = if rng.uniform_in(0.0, 1.0) < 0.5 {
        Target::from(&pose)
    } else {
        Target::Position(pose.translation.vector.into())
    };
    let (limits, surroundings) = (Some(limits(&robot, seed as usize / 4 % 3)), surroundings(obstacles));
    let options = TrackOptions { limits, surroundings, ..TrackOptions::default() };
    Some((Session::new(&robot, &start, STEPS[seed as usize / 12 % 4], &options).unwrap(), target))
}

#[test]
fn a_held_arm_rests_after_six_seconds_or_reaches_its_target() {
    let (mut held, mut late) = (0, vec![]);
    for seed in (0..72).chain(RESTLESS) {
        let Some((mut session, target)) = scene(seed) else { continue };
        let dt = session.dt();
        let ticks = |time: f64| (time / dt) as usize;
        let (mut worst, mut since): (f64, usize) = (0.0, 0);
        let mut status = Status::Improved;
        for tick in 0..ticks(RESTS_AFTER + 4.0) {
            let step = session.step(&target, &mut Unattended).unwrap();
            status = step.status;
            // A way back takes its time.
            since = if step.away.is_some_and(|away| away.way == Way::Taken) { tick } else { since };
            worst = if tick - since > ticks(RESTS_AFTER) { worst.max(fastest(&session)) } else { 0.0 };
            if status == Status::Solved && fastest(&session) < REST {
                break;
            }
        }
        if status != Status::Solved {
            held += 1;
            if worst > REST {
                late.push((seed, worst));
            }
        }
    }
    assert!(late.is_empty() && held >= 4, "{held} held, late: {late:?}");
}

#[test]
fn a_settled_arm_follows_a_target_that_moves_again() {
    let robot = panda();
    let wall = Shape::cuboid([0.75, 0.0, 0.5], [0.05, 2.0, 2.0], None).unwrap();
    for kind in 0..3 {
        let options = TrackOptions {
            limits: Some(limits(&robot, kind)),
            surroundings: surroundings(vec![wall.clone()]),
            ..TrackOptions::default()
        };
        let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
        let beyond = target(&robot, 0, 0.01, &[[0.6, 0.0, 0.0]]);
        for _ in 0..600 {
            session.step(&beyond, &mut Unattended).unwrap();
        }
        assert!(fastest(&session) < 1e-9, "limits {kind}: {}", fastest(&session));
        let home = target(&robot, 0, 0.01, &[]);
        for _ in 0..300 {
            session.step(&home, &mut Unattended).unwrap();
        }
        let step = session.step(&home, &mut Unattended).unwrap();
        assert_eq!(step.status, Status::Solved, "limits {kind}: {:?}", step.error);
    }
}

#[test]
fn a_settled_arm_goes_on_when_its_obstacle_is_taken_away() {
    let robot = panda();
    let wall = Shape::cuboid([0.75, 0.0, 0.5], [0.05, 2.0, 2.0], None).unwrap();
    let options = TrackOptions {
        limits: Some(limits(&robot, 2)),
        surroundings: surroundings(vec![wall.clone()]),
        ..TrackOptions::default()
    };
    let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
    let beyond = target(&robot, 0, 0.01, &[[0.2, 0.0, 0.0]]);
    for _ in 0..600 {
        // The same obstacles again and again change nothing.
        session.set_obstacles(Some(vec![wall.clone()].into()), vec![]).unwrap();
        session.step(&beyond, &mut Unattended).unwrap();
    }
    assert!(fastest(&session) < 1e-9, "{}", fastest(&session));
    session.set_obstacles(None, vec![]).unwrap();
    for _ in 0..200 {
        session.step(&beyond, &mut Unattended).unwrap();
    }
    assert_eq!(session.step(&beyond, &mut Unattended).unwrap().status, Status::Solved);
}

#[test]
fn a_settled_arm_still_gives_way_to_an_obstacle() {
    let robot = panda();
    let options =
        TrackOptions { limits: Some(limits(&robot, 1)), surroundings: surroundings(vec![]), ..TrackOptions::default() };
    let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
    let home = target(&robot, 0, 0.01, &[]);
    for _ in 0..300 {
        session.step(&home, &mut Unattended).unwrap();
    }
    let tip = robot.fk(&START).unwrap().translation.vector;
    for tick in 0..250 {
        let x = tip[0] + 0.6 - 0.2 * 0.01 * f64::from(tick);
        let ball = Shape::sphere([x, tip[1], tip[2]], 0.08).unwrap();
        session.set_obstacles(Some(vec![ball.clone()].into()), vec![[-0.2, 0.0, 0.0]]).unwrap();
        session.step(&home, &mut Unattended).unwrap();
        let clearance = Scene::new(&robot, &[ball]).unwrap().clearance(session.q()).unwrap();
        assert!(clearance > MARGIN - 1e-9, "tick {tick}: {clearance} m");
    }
}

#[test]
fn random_obstacles_are_given_again_without_a_change() {
    let robot = panda();
    let mut rng = rng::stream(32, 0);
    let obstacles = random_obstacles(&robot, &mut rng);
    let run = |again: bool| {
        let options = TrackOptions {
            limits: Some(limits(&robot, 1)),
            surroundings: surroundings(obstacles.clone()),
            ..TrackOptions::default()
        };
        let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
        let wanted = target(&robot, 0, 0.01, &[[0.2, 0.3, -0.3]]);
        for _ in 0..200 {
            if again {
                session.set_obstacles(Some(obstacles.clone().into()), vec![]).unwrap();
            }
            session.step(&wanted, &mut Unattended).unwrap();
        }
        session.q().to_vec()
    };
    assert_eq!(run(true), run(false));
}
