//! Tracking among obstacles: the margin is kept, at ticks and in between, and every stop is clear.

use std::f64::consts::TAU;

use crate::common::cases;
use crate::common::executed_curve::ExecutedCurve;
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::math::Pose;
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::path::{Circle, Path, Plane};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;
use ikcore::tracking::{Session, TrackOptions, track};

pub(super) const START: [f64; 7] = [0.0, -0.4, 0.0, -2.2, 0.0, 1.9, 0.78];
pub(super) const MARGIN: f64 = 0.005;

/// Rounding of a distance in the middle of a tick (m).
const ROUNDING: f64 = 1e-9;

pub(super) fn panda() -> Robot {
    Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap()
}

pub(super) fn surroundings(obstacles: Vec<Shape>) -> Surroundings {
    Surroundings { obstacles: Some(obstacles.into()), margin: Some(MARGIN), self_collision: None }
}

/// Shapes of several kinds that are clear of the start.
pub(super) fn random_obstacles(robot: &Robot, rng: &mut LazyRng) -> Vec<Shape> {
    let mut obstacles = vec![];
    while obstacles.len() < 10 {
        let center = [rng.uniform_in(0.1, 0.8), rng.uniform_in(-0.6, 0.6), rng.uniform_in(0.0, 0.9)];
        let size: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.04, 0.2));
        let shape = match obstacles.len() % 4 {
            0 | 1 => Shape::cuboid(center, size, None),
            2 => Shape::cylinder(center, size, size[0], 2.0 * size[1]),
            _ => Shape::point_cloud((0..9).map(|_| center.map(|x| x + rng.uniform_in(-0.1, 0.1))).collect(), 0.02),
        };
        let shape = shape.unwrap();
        if Scene::new(robot, std::slice::from_ref(&shape)).unwrap().clearance(&START).unwrap() > 0.02 {
            obstacles.push(shape);
        }
    }
    obstacles
}

fn limits(robot: &Robot, acceleration: Option<f64>, jerk: Option<f64>) -> Limits {
    let mut limits = Limits::of(robot).replace(Field::Velocity, vec![Profile::Constant(1.5); 7]).unwrap();
    for (field, value) in [(Field::Acceleration, acceleration), (Field::Jerk, jerk)] {
        if let Some(value) = value {
            limits = limits.replace(field, vec![Profile::Constant(value); 7]).unwrap();
        }
    }
    limits
}

/// Limits on velocity alone, with acceleration, and with jerk.
pub(super) fn all_limits(robot: &Robot) -> [Limits; 3] {
    [limits(robot, None, None), limits(robot, Some(5.0), None), limits(robot, Some(5.0), Some(50.0))]
}

/// Target on a circle, or one that jumps twice a second.
pub(super) fn target(robot: &Robot, tick: usize, dt: f64, jumps: &[[f64; 3]]) -> Target {
    let mut pose: Pose = robot.fk(&START).unwrap();
    let time = tick as f64 * dt;
    let moved = match jumps {
        [] => [0.0, 0.15 * (TAU * time / 2.0).sin(), 0.15 * ((TAU * time / 2.0).cos() - 1.0)],
        jumps => jumps[(2.0 * time) as usize % jumps.len()],
    };
    (0..3).for_each(|k| pose.translation.vector[k] += moved[k]);
    Target::from(&pose)
}

#[test]
fn no_tick_comes_nearer_than_the_margin_and_every_stop_is_clear() {
    let robot = panda();
    let mut rng = rng::stream(22, 0);
    let (mut solved, mut held) = (0, 0);
    for trial in 0..6 {
        let obstacles = random_obstacles(&robot, &mut rng);
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let jump = |rng: &mut LazyRng| [0.15, 0.3, 0.25].map(|most| rng.uniform_in(-most, most));
        let jumps: Vec<[f64; 3]> = if trial % 2 == 0 { vec![] } else { (0..5).map(|_| jump(&mut rng)).collect() };
        for (limits, dt) in all_limits(&robot).into_iter().zip([0.01, 0.004, 0.01]) {
            let surroundings = surroundings(obstacles.clone());
            let options = TrackOptions { limits: Some(limits), surroundings, ..TrackOptions::default() };
            let mut session = Session::new(&robot, &START, dt, &options).unwrap();
            let mut curve = ExecutedCurve::of(&session);
            for tick in 0..(2.0 / dt) as usize {
                let stops = tick % 100 > 70;
                let status = if stops {
                    if tick % 100 == 71 {
                        session.stop();
                    }
                    session.advance(None, &mut Unattended).unwrap().status
                } else {
                    session.step(&target(&robot, tick, dt, &jumps), &mut Unattended).unwrap().status
                };
                for (at, q) in curve.after(session.q()) {
                    let distance = scene.clearance(&q).unwrap();
                    assert!(distance >= MARGIN - ROUNDING, "trial {trial}, tick {at}, stops {stops}: {distance}");
                }
                assert_ne!(status, Status::InCollision);
                solved += usize::from(status == Status::Solved);
                held += usize::from(status == Status::HeldByObstacle);
            }
        }
    }
    assert!(solved > 400 && held > 400, "{solved} {held}");
}

#[test]
fn limits_are_kept_beside_obstacles() {
    let robot = panda();
    let (dt, acceleration, jerk) = (0.004, 5.0, 50.0);
    let obstacles = random_obstacles(&robot, &mut rng::stream(5, 0));
    let options = TrackOptions {
        limits: Some(limits(&robot, Some(acceleration), Some(jerk))),
        surroundings: surroundings(obstacles),
        ..TrackOptions::default()
    };
    let mut session = Session::new(&robot, &START, dt, &options).unwrap();
    let jumps = [[0.1, 0.3, -0.2], [0.0, -0.3, 0.1], [-0.1, 0.0, -0.3]];
    let mut last: Vec<Vec<f64>> = vec![START.to_vec(); 4];
    for tick in 0..1500 {
        session.step(&target(&robot, tick, dt, &jumps), &mut Unattended).unwrap();
        last.remove(0);
        last.push(session.q().to_vec());
        for j in 0..7 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| last[i][j]);
            assert!((d - c).abs() <= 1.5 * dt * (1.0 + 1e-9));
            assert!((d - 2.0 * c + b).abs() <= acceleration * dt.powi(2) * (1.0 + 1e-9), "tick {tick}, joint {j}");
            assert!((d - 3.0 * c + 3.0 * b - a).abs() <= jerk * dt.powi(3) * (1.0 + 1e-9), "tick {tick}, joint {j}");
        }
    }
}

#[test]
fn a_redundant_arm_keeps_its_tip_on_the_path_while_its_elbow_gives_way() {
    let robot = panda();
    // An arm that cannot change its velocity at once may lag by millimetres.
    for (limits, most) in all_limits(&robot).into_iter().zip([1e-9, 0.01, 0.01]) {
        let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
        let mut session = Session::new(&robot, &START, 0.002, &options).unwrap();
        // A post comes nearer, and pushes the elbow aside.
        let (speed, mut worst) = (0.04, 0.0_f64);
        for tick in 0..1500 {
            let y = -0.17 + speed * 0.002 * f64::from(tick);
            let post = Shape::cuboid([-0.12, y, 0.64], [0.1, 0.02, 0.1], None).unwrap();
            session.set_obstacles(Some(vec![post].into()), vec![[0.0, speed, 0.0]]).unwrap();
            let step = session.step(&target(&robot, 0, 0.002, &[[0.0; 3]]), &mut Unattended).unwrap();
            worst = worst.max(step.error.position);
            assert_ne!(step.status, Status::InCollision, "tick {tick}");
        }
        assert!(worst < most, "{worst}");
        let moved = START.iter().zip(session.q()).map(|(from, to)| (to - from).abs()).fold(0.0, f64::max);
        assert!(moved > 0.02, "{moved}");
    }
}

#[test]
fn an_arm_that_starts_in_collision_moves_out() {
    let robot = panda();
    let tip = robot.tip_position(&START);
    let wall = Shape::cuboid([tip[0], tip[1] + 0.1, tip[2]], [0.3, 0.12, 0.6], None).unwrap();
    for limits in all_limits(&robot) {
        let obstacles = vec![wall.clone()];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let options = TrackOptions {
            limits: Some(limits),
            surroundings: surroundings(obstacles.clone()),
            ..TrackOptions::default()
        };
        let mut session = Session::new(&robot, &START, 0.004, &options).unwrap();
        let mut last = scene.clearance(&START).unwrap();
        assert!(last < 0.0);
        let first = session.step(&target(&robot, 0, 0.004, &[[0.0; 3]]), &mut Unattended).unwrap();
        assert_eq!(first.status, Status::InCollision);
        for tick in 0..1500 {
            session.step(&target(&robot, 0, 0.004, &[[0.0; 3]]), &mut Unattended).unwrap();
            let now = scene.clearance(session.q()).unwrap();
            // Where another side of the wall becomes the nearest, the depth has a kink.
            assert!(now >= last.min(MARGIN) - 1e-5, "tick {tick}: {last} {now}");
            last = now;
        }
        assert!(last >= MARGIN, "{last}");
    }
}

#[test]
fn an_arm_gets_out_of_what_is_put_deep_into_its_links() {
    let robot = panda();
    let mut rng = rng::stream(8, 0);
    let (mut tried, mut left) = (0, [0; 3]);
    while tried < 40 {
        let start = robot.random_configurations(1, &mut rng).unwrap();
        let tip = robot.tip_position(&start);
        let center = tip.map(|x| x + rng.uniform_in(-0.2, 0.2));
        let sizes: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.08, 0.2));
        let shape = if tried % 2 == 0 { Shape::sphere(center, sizes[0]) } else { Shape::cuboid(center, sizes, None) };
        let obstacles = vec![shape.unwrap()];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let [alone, among] = [&[][..], &obstacles].map(|shapes| Scene::new(&robot, shapes).unwrap().clearance(&start));
        // The base cannot get out of the way.
        let far_from_base = center[0].hypot(center[1]) > 0.35;
        if alone.unwrap() < 0.03 || !(-0.1..-0.04).contains(&among.unwrap()) || !far_from_base {
            continue;
        }
        tried += 1;
        let here = Target::from(&robot.fk(&start).unwrap());
        for (limits, left) in all_limits(&robot).into_iter().zip(&mut left) {
            let surroundings = surroundings(obstacles.clone());
            let options = TrackOptions { limits: Some(limits), surroundings, ..TrackOptions::default() };
            let mut session = Session::new(&robot, &start, 0.01, &options).unwrap();
            for _ in 0..400 {
                session.step(&here, &mut Unattended).unwrap();
            }
            *left += usize::from(scene.clearance(session.q()).unwrap() >= MARGIN - ROUNDING);
        }
    }
    // An axis through the middle of a sphere has no shortest way out.
    assert!(left.iter().all(|left| *left >= 37), "{left:?} of {tried}");
}

#[test]
fn an_arm_gets_out_of_the_way_of_a_sphere_no_faster_than_said() {
    let robot = panda();
    let speed = 0.3;
    for limits in all_limits(&robot) {
        for x in [0.3, 0.45, 0.6] {
            let options = TrackOptions { limits: Some(limits.clone()), ..TrackOptions::default() };
            let mut session = Session::new(&robot, &START, 0.004, &options).unwrap();
            for tick in 0..1000 {
                let center = [x, 0.7 - speed * 0.004 * f64::from(tick), 0.45];
                let sphere = vec![Shape::sphere(center, 0.1).unwrap()];
                session.set_obstacles(Some(sphere.clone().into()), vec![[0.0, -speed, 0.0]]).unwrap();
                session.step(&target(&robot, 0, 0.004, &[[0.0; 3]]), &mut Unattended).unwrap();
                let clear = Scene::new(&robot, &sphere).unwrap().clearance(session.q()).unwrap();
                assert!(clear >= 1e-3, "x {x}, tick {tick}: {clear}");
            }
            session.set_obstacles(None, vec![]).unwrap();
            let mut step = || session.step(&target(&robot, 0, 0.004, &[[0.0; 3]]), &mut Unattended).unwrap();
            let last = (0..500).map(|_| step()).last().unwrap();
            assert_eq!(last.status, Status::Solved, "x {x}: {}", last.message());
        }
    }
}

#[test]
fn an_arm_between_a_wall_and_a_sphere_that_comes_gets_aside() {
    let robot = panda();
    let (tip, dt, margin) = (robot.tip_position(&START), 0.01, 0.01);
    let wall = Shape::cuboid([tip[0], tip[1] + 0.12, tip[2]], [0.4, 0.04, 0.6], None).unwrap();
    for limits in all_limits(&robot) {
        for (x, z, speed) in [(0.0, 0.05, 0.2), (-0.05, 0.1, 0.3), (0.0, 0.1, 0.3)] {
            let surroundings = Surroundings { margin: Some(margin), ..surroundings(vec![wall.clone()]) };
            let options = TrackOptions { limits: Some(limits.clone()), surroundings, ..TrackOptions::default() };
            let mut session = Session::new(&robot, &START, dt, &options).unwrap();
            let mut curve = ExecutedCurve::of(&session);
            // Straight at the hand: ahead of it there is the wall.
            let sphere =
                |time: f64| Shape::sphere([tip[0] + x, tip[1] - 0.5 + speed * time, tip[2] + z], 0.08).unwrap();
            for tick in 0..400 {
                let time = dt * f64::from(tick);
                let now = vec![wall.clone(), sphere(time)];
                session.set_obstacles(Some(now.into()), vec![[0.0; 3], [0.0, speed, 0.0]]).unwrap();
                session.step(&target(&robot, 0, dt, &[[0.0; 3]]), &mut Unattended).unwrap();
                for (at, q) in curve.after(session.q()) {
                    let then = [wall.clone(), sphere(dt * at)];
                    let clear = Scene::new(&robot, &then).unwrap().clearance(&q).unwrap();
                    assert!(clear >= margin - ROUNDING, "{x} {z}, {speed} m/s, tick {at}: {clear}");
                }
            }
        }
    }
}

#[test]
fn the_motion_between_ticks_is_clear() {
    let robot = panda();
    let tip = robot.tip_position(&START);
    let wall = Shape::cuboid([tip[0] - 0.1, tip[1] + 0.12, tip[2]], [0.3, 0.04, 0.6], None).unwrap();
    let obstacles = vec![wall];
    let plane = Plane::xy([tip[0] - 0.1, tip[1], tip[2]]).unwrap();
    let reference = Path::new(Circle::new(plane, 0.2, 4.0).unwrap()).sample(0.02).unwrap();
    for limits in all_limits(&robot) {
        let options = TrackOptions {
            limits: Some(limits),
            surroundings: surroundings(obstacles.clone()),
            ..TrackOptions::default()
        };
        let record = track(&robot, &reference, Some(&START), &options, &mut Unattended).unwrap();
        assert_eq!(record.status, Status::Lost);
        assert!(record.message().contains("an obstacle or another link held the arm back"), "{}", record.message());
        assert!(record.clearance.iter().all(|clear| *clear >= MARGIN));
        let trajectory = record.trajectory((0..7).map(|j| format!("joint_{j}")).collect()).unwrap();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let [mut q, mut qd, mut qdd] = [[0.0; 7]; 3];
        for i in 0..1600 {
            trajectory.at(f64::from(i) * 0.0025, &mut q, &mut qd, &mut qdd).unwrap();
            let clear = scene.clearance(&q).unwrap();
            assert!(clear >= MARGIN - ROUNDING, "at {} s: {clear}", f64::from(i) * 0.0025);
        }
    }
}

#[test]
fn limits_that_vary_over_time_are_refused() {
    let robot = panda();
    let wave = Sinusoid { mean: 4.0, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 };
    let limits = Limits::of(&robot).replace(Field::Acceleration, vec![Profile::Sinusoid(wave)]).unwrap();
    let options = TrackOptions { limits: Some(limits), surroundings: surroundings(vec![]), ..TrackOptions::default() };
    let error = Session::new(&robot, &START, 0.01, &options).unwrap_err().to_string();
    assert!(error.contains("tracking among obstacles") && error.contains("leave the obstacles out"), "{error}");
}

#[test]
fn velocities_of_obstacles_are_checked() {
    let robot = panda();
    let mut session = Session::new(&robot, &START, 0.01, &TrackOptions::default()).unwrap();
    let sphere = vec![Shape::sphere([0.5, 0.5, 0.5], 0.1).unwrap()];
    let error = session.set_obstacles(Some(sphere.clone().into()), vec![[0.0; 3]; 2]).unwrap_err().to_string();
    assert!(error.contains("velocities") && error.contains('2'), "{error}");
    let error = session.set_obstacles(Some(sphere.into()), vec![[f64::NAN, 0.0, 0.0]]).unwrap_err().to_string();
    assert!(error.contains("velocities"), "{error}");
    assert!(session.space().is_none());
}

#[test]
fn the_same_stream_gives_the_same_bits() {
    let robot = panda();
    let obstacles = random_obstacles(&robot, &mut rng::stream(9, 0));
    let run = || {
        let options = TrackOptions {
            limits: Some(limits(&robot, Some(5.0), None)),
            surroundings: surroundings(obstacles.clone()),
            ..TrackOptions::default()
        };
        let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
        for tick in 0..300 {
            session.step(&target(&robot, tick, 0.01, &[]), &mut Unattended).unwrap();
        }
        session.q().to_vec()
    };
    assert_eq!(run(), run());
}

#[test]
fn an_arm_that_is_held_comes_to_rest() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let start = [0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8];
    let table = Shape::cuboid([0.5, 0.0, 0.15], [0.5, 0.8, 0.1], None).unwrap();
    let mut below = robot.fk(&start).unwrap();
    below.translation.z -= 0.45;
    for limits in all_limits(&robot) {
        let options = TrackOptions {
            surroundings: surroundings(vec![table.clone()]),
            limits: Some(limits),
            ..TrackOptions::default()
        };
        let mut session = Session::new(&robot, &start, 1.0 / 60.0, &options).unwrap();
        for _ in 0..600 {
            session.step(&Target::from(&below), &mut Unattended).unwrap();
        }
        assert_eq!(session.step(&Target::from(&below), &mut Unattended).unwrap().status, Status::HeldByObstacle);
        let fastest = session.qd().iter().fold(0.0, |fastest: f64, rate| fastest.max(rate.abs()));
        assert!(fastest < 1e-6, "{fastest} rad/s");
    }
}

fn fastest(session: &Session) -> f64 {
    session.qd().iter().fold(0.0, |fastest: f64, rate| fastest.max(rate.abs()))
}

/// Delay of the stop (ticks): moves on without targets until the stop that takes `said` seconds should have ended, and for a
/// second more.
fn late(session: &mut Session, said: f64) -> usize {
    let ticks = (said / session.dt()).round() as usize;
    let moves = |_| {
        session.advance(None, &mut Unattended).unwrap();
        fastest(session) > 1e-9
    };
    (0..ticks + 100)
        .map(moves)
        .collect::<Vec<bool>>()
        .iter()
        .rposition(|moves| *moves)
        .map_or(0, |last| (last + 1).saturating_sub(ticks))
}

#[test]
fn a_stop_among_obstacles_takes_as_long_as_it_says() {
    let robot = panda();
    for (seed, limits) in all_limits(&robot).into_iter().cycle().take(cases(4) as usize).enumerate() {
        let mut rng = rng::stream(21, seed as u64);
        let obstacles = random_obstacles(&robot, &mut rng);
        let around = surroundings(obstacles.clone());
        let options = TrackOptions { limits: Some(limits), surroundings: around, ..TrackOptions::default() };
        let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
        for stop in 0..20 {
            let jumps = [[(); 3].map(|()| rng.uniform_in(-0.4, 0.4))];
            for tick in 0..10 + stop {
                session.step(&target(&robot, tick, 0.01, &jumps), &mut Unattended).unwrap();
            }
            match stop % 3 {
                0 => session.set_obstacles(Some(random_obstacles(&robot, &mut rng).into()), vec![]).unwrap(),
                1 => session.set_obstacles(Some(obstacles.clone().into()), vec![[0.0, -0.3, 0.1]; 10]).unwrap(),
                _ => {}
            }
            let said = session.stop();
            assert!(late(&mut session, said) <= 1, "seed {seed}, stop {stop}: {said} s said");
        }
    }
}

#[test]
fn after_a_stop_an_arm_stands_even_if_something_comes() {
    let robot = panda();
    let tip = robot.tip(&START).origin;
    for limits in all_limits(&robot) {
        let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
        let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
        session.step(&target(&robot, 0, 0.01, &[]), &mut Unattended).unwrap();
        let said = session.stop();
        let sphere = |x: f64| Shape::sphere([tip[0] + x, tip[1], tip[2]], 0.1).unwrap();
        session.set_obstacles(Some(vec![sphere(0.4)].into()), vec![[-0.5, 0.0, 0.0]]).unwrap();
        assert!(late(&mut session, said) <= 1);
        let before = session.q().to_vec();
        session.set_obstacles(Some(vec![sphere(0.1)].into()), vec![[-0.5, 0.0, 0.0]]).unwrap();
        session.advance(None, &mut Unattended).unwrap();
        assert_eq!(session.q(), before);
        session.step(&target(&robot, 0, 0.01, &[]), &mut Unattended).unwrap();
        assert_ne!(session.q(), before, "a target ends the stop");
    }
}

#[test]
fn an_arm_that_cannot_come_nearer_comes_to_rest() {
    let robot = panda();
    let (mut held, mut late) = (0, vec![]);
    for (i, limits) in all_limits(&robot).into_iter().enumerate() {
        for seed in 0..12 {
            let mut rng = rng::stream(22, seed);
            let around = surroundings(random_obstacles(&robot, &mut rng));
            let options =
                TrackOptions { limits: Some(limits.clone()), surroundings: around, ..TrackOptions::default() };
            let mut session = Session::new(&robot, &START, 0.01, &options).unwrap();
            let wanted = target(&robot, 0, 0.01, &[[(); 3].map(|()| rng.uniform_in(-0.4, 0.4))]);
            let mut errors = vec![];
            for tick in 0..450 {
                let step = session.step(&wanted, &mut Unattended).unwrap();
                errors.push([step.error.position, step.error.rotation]);
                held += usize::from(tick >= 400 && step.status == Status::HeldByObstacle);
            }
            let on_its_way = (0..2).any(|k| errors[449][k] < 0.9 * errors[349][k]);
            if !on_its_way && fastest(&session) > 1e-3 {
                late.push((i, seed, fastest(&session)));
            }
        }
    }
    assert!(late.is_empty() && held > 200, "{held} {late:?}");
}
