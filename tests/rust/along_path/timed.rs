//! Redundancy and timing together: faster than in uniform time, with every limit kept.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::so3::{norm, rotation_between};
use ikcore::path::{Circle, Path, Plane, Polyline, Waypoints};
use ikcore::planning::{AlongPathOptions, Elbow, Plan, TipPath, Tpbso, plan_along_path};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{AnySolver, Pso, Status, Stop, Unattended};
use ikcore::task::Target;
use nalgebra::Matrix3;

const INTERVALS: usize = 50;

/// Corners of a pentagram about (1, 1) with straight edges between, the first one up.
fn pentagram(u: f64) -> [f64; 3] {
    let corner = |k: usize| {
        let angle = FRAC_PI_2 + TAU * (2 * k) as f64 / 5.0;
        [1.0 + 0.5 * angle.cos(), 1.0 + 0.5 * angle.sin()]
    };
    let edge = ((5.0 * u) as usize).min(4);
    let fraction = 5.0 * u - edge as f64;
    let (from, to) = (corner(edge), corner(edge + 1));
    [from[0] + fraction * (to[0] - from[0]), from[1] + fraction * (to[1] - from[1]), 0.0]
}

/// Trefoil r = 1 + 0.35 cos 3t about (1, 1), scaled to a largest radius of 0.6.
fn trefoil(u: f64) -> [f64; 3] {
    let t = TAU * u;
    let r = 0.6 / 1.35 * (1.0 + 0.35 * (3.0 * t).cos());
    [1.0 + r * t.cos(), 1.0 + r * t.sin(), 0.0]
}

fn tip_path(curve: fn(f64) -> [f64; 3]) -> TipPath {
    let points = (0..=INTERVALS).map(|i| curve(i as f64 / INTERVALS as f64)).collect();
    TipPath::through(&Waypoints::new(points, None).unwrap()).unwrap()
}

fn plan(tip_path: &TipPath, options: AlongPathOptions) -> Plan {
    let robot = Robot::planar(&[1.0; 3]).unwrap();
    let constant = |value: f64| vec![Profile::Constant(value)];
    let limits = Limits::of(&robot)
        .replace(Field::Lower, constant(f64::NEG_INFINITY))
        .and_then(|limits| limits.replace(Field::Upper, constant(f64::INFINITY)))
        .and_then(|limits| limits.replace(Field::Velocity, constant(PI)))
        .and_then(|limits| limits.replace(Field::Acceleration, constant(4.0 * PI)))
        .unwrap();
    plan_along_path(&robot, tip_path, &AlongPathOptions { limits: Some(limits), ..options }, &mut Unattended).unwrap()
}

/// Configurations of a plan at `count` instants.
fn instants(plan: &Plan, count: usize) -> impl Iterator<Item = Vec<f64>> {
    let n = plan.trajectory.joints().len();
    (0..=count).map(move |i| {
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
        plan.trajectory.at(plan.trajectory.duration() * i as f64 / count as f64, &mut q, &mut qd, &mut qdd).unwrap();
        q
    })
}

/// Largest distance of the tip from the path (m), at many instants.
fn farthest(robot: &Robot, tip_path: &TipPath, plan: &Plan) -> f64 {
    instants(plan, 20_000).map(|q| tip_path.distance(robot.tip_position(&q), 0.0, 1.0)).fold(0.0, f64::max)
}

#[test]
fn faster_than_the_optimum_in_uniform_time_by_what_was_measured() {
    // Durations of the optimum in uniform time, found by long searches, and the factor that must be beaten.
    for (curve, uniform, factor) in [(pentagram as fn(f64) -> [f64; 3], 5.501, 1.9), (trefoil, 3.234, 1.35)] {
        for seed in 0..3 {
            let plan = plan(&tip_path(curve), AlongPathOptions { seed, ..AlongPathOptions::default() });
            assert_eq!(plan.status, Status::Solved, "{}", plan.message());
            assert!(plan.violations.is_empty());
            assert!(uniform / plan.cost >= factor, "seed {seed}: {} s", plan.cost);
            assert!(plan.trajectory.max_velocity().iter().all(|v| *v <= PI * (1.0 + 1e-9)));
            assert!(plan.trajectory.max_acceleration().iter().all(|a| *a <= 4.0 * PI * (1.0 + 1e-9)));
        }
    }
}

#[test]
fn accuracy_is_that_of_the_whole_motion_and_kept() {
    let robot = Robot::planar(&[1.0; 3]).unwrap();
    let star = Polyline::pentagram(&Plane::xy([1.0, 1.0, 0.0]).unwrap(), 0.5, 5.0).unwrap();
    let circle = Circle::new(Plane::xy([1.2, 1.0, 0.0]).unwrap(), 0.8, 3.0).unwrap();
    for (path, accuracies) in [(Path::new(star), [0.03, 1e-3, 1e-5]), (Path::new(circle), [0.01, 1e-4, 1e-5])] {
        let tip_path = TipPath::along(&path).unwrap();
        for asked in accuracies {
            let plan = plan(&tip_path, AlongPathOptions { accuracy: Some(asked), stop: few(), ..Default::default() });
            assert_eq!(plan.status, Status::Solved, "{}", plan.message());
            let (told, found) = (plan.accuracy.unwrap(), farthest(&robot, &tip_path, &plan));
            assert!(told <= asked, "{told} of {asked} m");
            assert!(0.98 * told <= found + 1e-9 && found <= 1.01 * told + 1e-9, "{found} m, told {told} m");
        }
    }
}

/// Budget that suffices for a plan, but not for the fastest.
fn few() -> Option<Stop> {
    Some(Stop { max_evaluations: 150, ..Stop::default() })
}

#[test]
fn corners_of_a_path_are_reached() {
    let robot = Robot::planar(&[1.0; 3]).unwrap();
    let points = vec![[1.0, 1.0, 0.0], [1.31, 1.0, 0.0], [1.31, 1.27, 0.0], [1.05, 1.3, 0.0]];
    let tip_path = TipPath::through(&Waypoints::new(points.clone(), None).unwrap()).unwrap();
    let plan = plan(&tip_path, AlongPathOptions { stop: few(), ..Default::default() });
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    let tips: Vec<[f64; 3]> = instants(&plan, 20_000).map(|q| robot.tip_position(&q)).collect();
    for point in points {
        let nearest = tips.iter().map(|tip| (tip[0] - point[0]).hypot(tip[1] - point[1])).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-4, "{nearest} m from {point:?}");
    }
}

#[test]
fn rotations_are_kept_between_points_too() {
    let robot = Robot::named("iiwa14").unwrap();
    let down = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
    let plane = Plane::new([0.6, 0.0, 0.5], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
    let circle = Path::new(Circle::new(plane, 0.4, 5.0).unwrap()).with_orientation(down).unwrap();
    let tip_path = TipPath::along(&circle).unwrap();
    let limits = Limits::of(&robot).replace(Field::Acceleration, vec![Profile::Constant(5.0)]).unwrap();
    let options = AlongPathOptions { limits: Some(limits), accuracy: Some(1e-4), stop: few(), ..Default::default() };
    let plan = plan_along_path(&robot, &tip_path, &options, &mut Unattended).unwrap();
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    let Target::Pose(wanted) = tip_path.target(0.3) else { panic!("a path of poses") };
    for q in instants(&plan, 2000) {
        assert!(norm(&rotation_between(&wanted, &robot.tip(&q))) <= 1e-4);
    }
}

#[test]
fn what_cannot_be_kept_is_told() {
    // Two links that reach 1 m.
    let robot = Robot::planar(&[0.5, 0.5]).unwrap();
    let limits = Limits::of(&robot).replace(Field::Acceleration, vec![Profile::Constant(5.0)]).unwrap();
    let options = AlongPathOptions { limits: Some(limits), ..Default::default() };
    let error = |points: &[[f64; 2]]| {
        let points = Waypoints::new(points.iter().map(|[x, y]| [*x, *y, 0.0]).collect(), None).unwrap();
        let tip_path = TipPath::through(&points).unwrap();
        plan_along_path(&robot, &tip_path, &options, &mut Unattended).unwrap_err().to_string()
    };
    let nearest = "of the path cannot be reached: the nearest configurations found within the limits stay up to";
    let one = error(&[[0.0, 0.99], [0.99, 0.99], [0.99, 0.0]]);
    assert!(one.starts_with(&format!("point 1 {nearest} 0.4001 m")), "{one}");
    let two = error(&[[0.9, 0.0], [1.1, 0.0], [1.2, 0.0], [1.2, 0.2], [0.8, 0.2], [0.8, 0.7], [0.6, 0.6]]);
    assert!(two.starts_with(&format!("points 1 to 3 and 5 {nearest} 0.2166 m")), "{two}");
    // Both ends are in reach, but the line between them passes the hole about the base.
    let short = Robot::planar(&[0.7, 0.3]).unwrap();
    let points = Waypoints::new(vec![[-0.6, 0.1, 0.0], [0.6, 0.1, 0.0]], None).unwrap();
    let through = TipPath::through(&points).unwrap();
    let error = plan_along_path(&short, &through, &options, &mut Unattended).unwrap_err().to_string();
    let not_found =
        "a configuration for the path between points 0 and 1 was not found: the nearest of 30000 evaluations";
    assert!(error.starts_with(not_found), "{error}");
}

#[test]
fn along_a_path_tpbso_has_one_elbow_and_a_search_of_its_own() {
    let robot = Robot::planar(&[0.5, 0.5]).unwrap();
    let points = Waypoints::new(vec![[0.4, 0.4, 0.0], [0.5, 0.4, 0.0]], None).unwrap();
    let tip_path = TipPath::through(&points).unwrap();
    let refused = |options: AlongPathOptions| {
        let limits = Limits::of(&robot).replace(Field::Velocity, vec![Profile::Constant(1.0)]).unwrap();
        let options = AlongPathOptions { limits: Some(limits), ..options };
        plan_along_path(&robot, &tip_path, &options, &mut Unattended).unwrap_err().to_string()
    };
    let bent = Tpbso { elbows: [Elbow::Positive, Elbow::Negative], ..Tpbso::default() };
    assert_eq!(
        refused(AlongPathOptions { method: bent.into(), ..Default::default() }),
        "elbows is (1, -1), but along a path the arm keeps one elbow: give one sign twice"
    );
    let solver = Some(AnySolver::Single(Pso::default().into()));
    assert_eq!(
        refused(AlongPathOptions { method: Tpbso::default().into(), solver, ..Default::default() }),
        "solver is the search of the method 'timed': give the method 'tpbso' its own"
    );
}

#[test]
fn courses_know_their_corners_and_places() {
    let square = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let tip_path = TipPath::through(&Waypoints::new(square.clone(), None).unwrap()).unwrap();
    let corners: Vec<f64> = tip_path.corners().collect();
    assert!(corners.len() == 2 && (corners[0] - 1.0 / 3.0).abs() < 1e-15 && (corners[1] - 2.0 / 3.0).abs() < 1e-15);
    assert_eq!(tip_path.place(corners[0]), "point 1 of the path");
    assert_eq!(tip_path.place(0.5), "the path between points 1 and 2");
    assert_eq!(tip_path.place(1.0), "point 3 of the path");
    assert_eq!(tip_path.coarseness(), 0.0);
    assert!((tip_path.distance([0.5, 0.2, 0.0], 0.0, 0.3) - 0.2).abs() < 1e-15);
    let timed = TipPath::along(&Path::new(Polyline::new(&square, 6.0).unwrap())).unwrap();
    assert_eq!(timed.corners().count(), 2);
    assert_eq!(timed.place(0.5), "the path at t = 3.000 s");
    assert_eq!(timed.points().len(), 51);
    // A circle has none; its chords stand for arcs.
    let circle = course_of_circle(51);
    assert_eq!(circle.corners().count(), 0);
    assert!((circle.coarseness() / (1.0 - (PI / 50.0).cos()) - 1.0).abs() < 1e-3, "{}", circle.coarseness());
}

#[test]
fn sampled_corners_are_told_from_measurement_noise() {
    let mut rng = rng::stream(4, 0);
    let noisy = |i: usize| {
        let angle = 3.0 * i as f64 / 4000.0;
        let radius = 0.3 + rng.uniform_in(-1e-4, 1e-4);
        [radius * angle.cos(), radius * angle.sin(), 0.0]
    };
    let points = Waypoints::new((0..=4000).map(noisy).collect(), None).unwrap();
    assert_eq!(TipPath::through(&points).unwrap().corners().count(), 0);
    // A corner between two looks.
    let times = TipPath::times(1.0, &[]);
    let bent = times.iter().map(|t| [t.min(0.50042), (t - 0.50042).max(0.0), 0.0]).collect();
    let corners: Vec<f64> = TipPath::sampled(times, bent, None).unwrap().corners().collect();
    assert!(corners.len() == 1 && (corners[0] - 0.5).abs() < 1e-3, "{corners:?}");
}

fn course_of_circle(points: usize) -> TipPath {
    let angle = |i: usize| TAU * i as f64 / (points - 1) as f64;
    let points = (0..points).map(|i| [angle(i).cos(), angle(i).sin(), 0.0]).collect();
    TipPath::through(&Waypoints::new(points, None).unwrap()).unwrap()
}

#[test]
fn a_pause_is_ignored_and_a_path_of_one_point_refused() {
    let times = TipPath::times(1.0, &[]);
    let paused: Vec<[f64; 3]> = times.iter().map(|t| [t.clamp(0.3, 0.6), 0.0, 0.0]).collect();
    let tip_path = TipPath::sampled(times.clone(), paused, None).unwrap();
    assert!((tip_path.positions().len() as f64 - 301.0).abs() <= 1.0);
    let error = TipPath::sampled(times.clone(), vec![[1.0; 3]; times.len()], None).unwrap_err();
    assert_eq!(error.to_string(), "path: it must lead somewhere, but it is 0 m long");
}
