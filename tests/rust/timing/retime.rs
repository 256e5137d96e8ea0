//! Jerk limits of plans, new limits for finished plans, and motions from a moving start.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::path::{Circle, Path, Plane, Polyline};
use ikcore::planning::{
    AlongPathOptions, Endpoint, Plan, PointToPointOptions, TipPath, Tpbso, plan_along_path, plan_point_to_point,
};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::trajectory::Trajectory;

const JERK: f64 = 50.0;

fn panda() -> Robot {
    Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap()
}

fn with_limits(robot: &Robot, fields: &[(Field, f64)]) -> Limits {
    let start = Limits::of(robot);
    fields.iter().fold(start, |limits, (field, value)| limits.replace(*field, vec![Profile::Constant(*value)]).unwrap())
}

fn a_box() -> Vec<Shape> {
    vec![Shape::cuboid([0.5, 0.0, 0.2], [0.2, 0.6, 0.4], None).unwrap()]
}

/// Configurations in front of the box and behind it.
fn pairs_around(robot: &Robot, obstacles: &[Shape], count: usize) -> Vec<[Vec<f64>; 2]> {
    let scene = Scene::new(robot, obstacles).unwrap();
    let mut rng = rng::stream(5, 0);
    let mut side = |behind: bool| loop {
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let [x, y, z]: [f64; 3] = robot.fk(&q).unwrap().translation.vector.into();
        let there = if behind { x > 0.62 && y.abs() < 0.3 } else { x.abs() < 0.35 && y > 0.35 };
        if there && (0.0..0.4).contains(&z) && scene.is_clear(&q, 0.002) {
            return q;
        }
    };
    (0..count).map(|_| [side(false), side(true)]).collect()
}

fn around(robot: &Robot, obstacles: &[Shape], [start, end]: &[Vec<f64>; 2], limits: Limits) -> Plan {
    let options = PointToPointOptions {
        limits: Some(limits),
        surroundings: Surroundings::among(obstacles),
        ..PointToPointOptions::default()
    };
    let [start, end] = [start, end].map(|q| Endpoint::Configuration(q.clone()));
    plan_point_to_point(robot, &start, &[end], &options, &mut Unattended).unwrap()
}

fn at(motion: &Trajectory, fraction: f64) -> Vec<f64> {
    let n = motion.joints().len();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
    motion.at(fraction * motion.duration(), &mut q, &mut qd, &mut qdd).unwrap();
    q
}

fn smallest_distance(scene: &Scene, motion: &Trajectory) -> f64 {
    let distance = |i: usize| scene.nearest(&at(motion, i as f64 / 2000.0)).unwrap().unwrap().distance;
    (0..=2000).map(distance).fold(f64::INFINITY, f64::min)
}

fn largest(values: Vec<f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// Largest jump of the acceleration at a knot, from and to rest included.
fn largest_jump(motion: &Trajectory) -> f64 {
    let n = motion.joints().len();
    let acceleration = |t: f64| {
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
        motion.at(t, &mut q, &mut qd, &mut qdd).unwrap();
        qdd
    };
    let mut jump = largest([acceleration(0.0), acceleration(motion.duration())].concat());
    for t in &motion.knots()[1..motion.knots().len() - 1] {
        let [before, after] = [acceleration(t * (1.0 - 1e-14)), acceleration(*t)];
        jump = before.iter().zip(&after).map(|(a, b)| (a - b).abs()).fold(jump, f64::max);
    }
    jump
}

#[test]
fn retimed_plans_around_a_box_keep_path_and_clearance() {
    let (robot, obstacles) = (panda(), a_box());
    let scene = Scene::new(&robot, &obstacles).unwrap();
    let without = with_limits(&robot, &[(Field::Acceleration, 10.0)]);
    let with = with_limits(&robot, &[(Field::Acceleration, 10.0), (Field::Jerk, JERK)]);
    for ends in &pairs_around(&robot, &obstacles, 10) {
        let plan = around(&robot, &obstacles, ends, without.clone());
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        let retimed = plan.retime(&robot, Some(&with)).unwrap();
        assert!(retimed.violations.is_empty() && retimed.status == Status::Solved);
        assert_eq!((retimed.cost, &retimed.clearance), (retimed.trajectory.duration(), &plan.clearance));
        assert!(largest(retimed.trajectory.max_jerk()) <= JERK && largest_jump(&retimed.trajectory) < 1e-6);
        assert!(smallest_distance(&scene, &retimed.trajectory) >= 0.001 - 1e-9);
        for i in 0..=100 {
            let fraction = f64::from(i) / 100.0;
            for (one, other) in at(&plan.trajectory, fraction).iter().zip(at(&retimed.trajectory, fraction)) {
                assert!((one - other).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn plans_around_a_box_keep_jerk_limits_and_clearance() {
    let (robot, obstacles) = (panda(), a_box());
    let scene = Scene::new(&robot, &obstacles).unwrap();
    let limits = with_limits(&robot, &[(Field::Acceleration, 10.0), (Field::Jerk, JERK)]);
    for ends in &pairs_around(&robot, &obstacles, 10) {
        let plan = around(&robot, &obstacles, ends, limits.clone());
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        assert!(largest(plan.trajectory.max_jerk()) <= JERK * (1.0 + 1e-9));
        assert!(largest(plan.trajectory.max_acceleration()) <= 10.0 * (1.0 + 1e-9));
        assert!(largest_jump(&plan.trajectory) < 1e-6);
        assert!(smallest_distance(&scene, &plan.trajectory) >= 0.001 - 1e-9);
    }
}

#[test]
fn a_straight_line_under_jerk_takes_the_known_time() {
    // The joint that needs longest is as fast as its jerk allows: 4 (d / 2 J)^(1/3).
    let robot = Robot::planar(&[1.0, 1.0]).unwrap();
    let ends = [vec![0.0, 0.5], vec![0.3, 0.2]];
    let plan = around(&robot, &[], &ends, with_limits(&robot, &[(Field::Jerk, JERK)]));
    let expected = 4.0 * (0.3 / (2.0 * JERK)).cbrt();
    assert!((plan.cost / expected - 1.0).abs() < 1e-9, "{} instead of {expected}", plan.cost);
    assert!(plan.trajectory.duration() > around(&robot, &[], &ends, with_limits(&robot, &[(Field::Jerk, 60.0)])).cost);
}

#[test]
fn plans_along_a_path_keep_jerk_limits_with_corners_and_without() {
    let robot = Robot::named("ur5e").unwrap();
    let circle = Path::new(Circle::new(Plane::xy([0.4, 0.2, 0.4]).unwrap(), 0.2, 5.0).unwrap());
    let corner = Path::new(Polyline::new(&[[0.4, 0.1, 0.4], [0.4, 0.3, 0.4], [0.5, 0.3, 0.4]], 1.0).unwrap());
    let fast = [(Field::Velocity, 2.0), (Field::Acceleration, 8.0)];
    let smooth = [(Field::Velocity, 2.0), (Field::Acceleration, 8.0), (Field::Jerk, 80.0)];
    for path in [circle, corner] {
        let tip_path = TipPath::along(&path).unwrap();
        let plan = |fields: &[(Field, f64)]| {
            let options = AlongPathOptions { limits: Some(with_limits(&robot, fields)), ..AlongPathOptions::default() };
            plan_along_path(&robot, &tip_path, &options, &mut Unattended).unwrap()
        };
        let quick = plan(&fast);
        let retimed = quick.retime(&robot, Some(&with_limits(&robot, &smooth))).unwrap();
        for motion in [&plan(&smooth), &retimed] {
            assert_eq!(motion.status, Status::Solved, "{}", motion.message());
            assert!(largest(motion.trajectory.max_jerk()) <= 80.0 && largest_jump(&motion.trajectory) < 1e-3);
            assert!(motion.cost > quick.cost && motion.cost < 2.0 * quick.cost, "{} {}", motion.cost, quick.cost);
            let accuracy = motion.accuracy.unwrap();
            for i in 0..=1000 {
                let tip = robot.fk(&at(&motion.trajectory, f64::from(i) / 1000.0)).unwrap().translation.vector.into();
                let distance = tip_path.distance(tip, 0.0, 1.0);
                assert!(distance <= accuracy + 1e-6, "{distance} of {accuracy}");
            }
        }
        let back = retimed.retime(&robot, Some(&with_limits(&robot, &fast))).unwrap();
        assert!((back.cost / quick.cost - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_plan_can_begin_at_a_velocity() {
    let (robot, obstacles) = (panda(), a_box());
    let limits = with_limits(&robot, &[(Field::Acceleration, 10.0), (Field::Jerk, 200.0)]);
    let scene = Scene::new(&robot, &obstacles).unwrap();
    let velocity = vec![0.3, -0.2, 0.1, 0.2, -0.3, 0.1, 0.4];
    let mut stopped = 0;
    for [start, end] in &pairs_around(&robot, &obstacles, 10) {
        let options = PointToPointOptions {
            limits: Some(limits.clone()),
            surroundings: Surroundings::among(obstacles.clone()),
            start_velocity: Some(velocity.clone()),
            ..PointToPointOptions::default()
        };
        let [from, to] = [start, end].map(|q| Endpoint::Configuration(q.clone()));
        let Ok(plan) = plan_point_to_point(&robot, &from, &[to], &options, &mut Unattended) else { continue };
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 7]);
        plan.trajectory.at(0.0, &mut q, &mut qd, &mut qdd).unwrap();
        let near = |one: &[f64], other: &[f64]| one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(&q, start) && near(&qd, &velocity), "{q:?} {qd:?}");
        plan.trajectory.at(plan.trajectory.duration(), &mut q, &mut qd, &mut qdd).unwrap();
        assert!(q.iter().zip(end).all(|(q, end)| (q - end).abs() < 1e-9) && qd.iter().all(|qd| qd.abs() < 1e-9));
        assert!(smallest_distance(&scene, &plan.trajectory) >= 0.001 - 1e-9);
        assert!(largest(plan.trajectory.max_jerk()) <= 200.0 * (1.0 + 1e-9));
        stopped += 1;
    }
    assert!(stopped >= 8, "{stopped} of 10");
}

#[test]
fn an_arm_without_a_shape_can_begin_at_a_velocity_too() {
    let robot = Robot::named("ur5e").unwrap();
    let options = PointToPointOptions {
        limits: Some(with_limits(&robot, &[(Field::Acceleration, 5.0)])),
        start_velocity: Some(vec![0.5; 6]),
        ..PointToPointOptions::default()
    };
    let [from, to] = [[0.0; 6], [0.4; 6]].map(|q| Endpoint::Configuration(q.to_vec()));
    let plan = plan_point_to_point(&robot, &from, &[to], &options, &mut Unattended).unwrap();
    // From 0.5 rad/s at 5 rad/s^2 over 0.4 rad: up to sqrt(0.125 + 2) rad/s, and down.
    let expected = (2.0 * 2.125_f64.sqrt() - 0.5) / 5.0;
    assert!((plan.cost - expected).abs() < 1e-9 && plan.clearance.is_none(), "{}", plan.cost);
}

#[test]
fn errors_name_the_reason_and_the_remedy() {
    let robot = Robot::planar(&[1.0, 1.0]).unwrap();
    let ends = [vec![0.0, 0.5], vec![0.3, 0.2]];
    let plan = around(&robot, &[], &ends, with_limits(&robot, &[(Field::Velocity, 1.0)]));
    assert_eq!(
        plan.message(),
        format!(
            "planned with a duration of {:.4} s; without an acceleration limit joint 'joint_2' accelerates with up to \
             {:.3} rad/s^2",
            plan.cost,
            plan.trajectory.max_acceleration()[0]
        )
    );
    let narrow = Limits::of(&robot)
        .replace(Field::Upper, vec![Profile::Constant(0.2)])
        .and_then(|limits| limits.replace(Field::Velocity, vec![Profile::Constant(1.0)]))
        .unwrap();
    let error = plan.retime(&robot, Some(&narrow)).unwrap_err().to_string();
    assert!(
        error.starts_with("infeasible: the path of the plan leaves the limits: highest position of joint"),
        "{error}"
    );
    let start = |velocity: Vec<f64>, fields: &[(Field, f64)], method: Option<Tpbso>| {
        let options = PointToPointOptions {
            limits: Some(with_limits(&robot, fields)),
            start_velocity: Some(velocity),
            method: method.map(Into::into).unwrap_or_default(),
            ..PointToPointOptions::default()
        };
        let [from, to] = [&ends[0], &ends[1]].map(|q| Endpoint::Configuration(q.clone()));
        plan_point_to_point(&robot, &from, &[to], &options, &mut Unattended).unwrap_err().to_string()
    };
    let fields = [(Field::Velocity, 1.0), (Field::Acceleration, 2.0)];
    assert_eq!(start(vec![0.1], &fields, None), "start velocity: expected 2 joints, got 1");
    assert_eq!(
        start(vec![0.1, 0.0], &fields[..1], None),
        "infeasible: without an acceleration or jerk limit the velocity of joint 'joint_1' may jump, and start \
         velocity means nothing: give an acceleration limit"
    );
    assert_eq!(
        start(vec![0.1, 1.5], &fields, None),
        "start velocity of joint 'joint_2' must be at most its velocity limit 1, got 1.5"
    );
    assert_eq!(
        start(vec![0.1, 0.5], &fields, Some(Tpbso::default())),
        "start velocity is kept by the method 'minmax': the method 'tpbso' begins at rest"
    );
}

#[test]
fn a_velocity_of_zero_plans_around_what_is_in_the_way() {
    let (robot, obstacles) = (panda(), a_box());
    let pair = &pairs_around(&robot, &obstacles, 1)[0];
    let options = PointToPointOptions {
        limits: Some(with_limits(&robot, &[(Field::Acceleration, 5.0), (Field::Jerk, JERK)])),
        surroundings: Surroundings::among(obstacles.clone()),
        start_velocity: Some(vec![0.0; 7]),
        ..PointToPointOptions::default()
    };
    let [start, end] = [0, 1].map(|i| Endpoint::Configuration(pair[i].clone()));
    let plan = plan_point_to_point(&robot, &start, &[end], &options, &mut Unattended).unwrap();
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    assert!(smallest_distance(&Scene::new(&robot, &obstacles).unwrap(), &plan.trajectory) >= 1e-3 - 1e-9);
}

#[test]
fn short_phases_late_in_a_motion_are_retimed_within_limits() {
    let robot = Robot::named("panda").unwrap();
    let start = vec![0.0, 1.397_937_058_730_536_6, 2.056_5, -0.178_8, 0.504_56, 1.286_6, 0.0];
    let end = vec![-2.1, -1.6, 1.6, -2.4, -0.9, 0.1, -1.2];
    for acceleration in [500.0, 2000.0] {
        let slow = with_limits(&robot, &[(Field::Velocity, 0.002), (Field::Acceleration, acceleration)]);
        let plan = around(&robot, &[], &[start.clone(), end.clone()], slow);
        let limits = with_limits(&robot, &[(Field::Velocity, 0.5), (Field::Acceleration, 20.0), (Field::Jerk, 20.0)]);
        let motion = plan.retime(&robot, Some(&limits)).unwrap().trajectory;
        assert!(largest(motion.max_jerk()) <= 20.0 * (1.0 + 1e-8), "{:?}", motion.max_jerk());
    }
}
