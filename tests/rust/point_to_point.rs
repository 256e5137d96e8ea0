//! Point to point: against the bound of the plane's arms, and around a box.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::pose;
use ikcore::obstacle::{Obstacle, Scene};
use ikcore::planning::{End, Plan, PointToPointOptions, plan_point_to_point};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;

fn limits(robot: &Robot, velocity: Option<f64>, acceleration: f64) -> Limits {
    let limits = Limits::of(robot).replace(Field::Acceleration, vec![Profile::Constant(acceleration)]).unwrap();
    match velocity {
        Some(velocity) => limits.replace(Field::Velocity, vec![Profile::Constant(velocity)]).unwrap(),
        None => limits,
    }
}

fn position(x: f64, y: f64) -> End {
    End::Target(Target::Position([x, y, 0.0]))
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
        let limits = limits(&robot, Some(std::f64::consts::PI), std::f64::consts::TAU);
        let mut sum = 0.0;
        let mut slowest = 0.0_f64;
        for seed in 0..20 {
            let options = PointToPointOptions { limits: Some(limits.clone()), seed, ..Default::default() };
            let plan = plan_point_to_point(&robot, &position(1.0, 0.0), &position(0.5, 1.5), &options, &mut Unattended);
            let plan = plan.unwrap();
            assert_eq!(plan.status, Status::Solved, "{}", plan.message());
            assert!(plan.trajectory.max_velocity().iter().all(|v| *v <= std::f64::consts::PI));
            assert!(plan.trajectory.max_acceleration().iter().all(|a| *a <= std::f64::consts::TAU));
            sum += plan.cost / 20.0;
            slowest = slowest.max(plan.elapsed.as_secs_f64());
        }
        println!(
            "{links} links: {sum:.4} s = {:.3} times the bound, slowest plan {:.2} ms",
            sum / bound,
            1e3 * slowest
        );
        assert!(sum <= 1.25 * bound, "{links} links: {sum} {bound}");
    }
}

/// A pose behind the box that the arm reaches without touching anything.
fn poses_behind(robot: &Robot, obstacles: &[Obstacle], count: usize) -> Vec<End> {
    let scene = Scene::new(robot, obstacles).unwrap();
    let mut rng = rng::stream(11, 0);
    let mut found = vec![];
    while found.len() < count {
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let tip = robot.fk(&q).unwrap();
        let [x, y, z] = tip.translation.vector.into();
        if x > 0.62 && y.abs() < 0.3 && (0.0..0.4).contains(&z) && scene.is_clear(&q, 0.002) {
            found.push(End::Target(Target::from(&tip)));
        }
    }
    found
}

#[test]
fn arms_find_their_way_around_a_box() {
    let obstacles = vec![Obstacle::cuboid([0.5, 0.0, 0.2], [0.2, 0.6, 0.4], None).unwrap()];
    for name in ["panda", "iiwa14"] {
        let robot = Robot::named(name).unwrap().with_capsules_along_links(0.06).unwrap();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let start: Vec<f64> = robot.joints().iter().map(|joint| 0.5 * (joint.lower + joint.upper)).collect();
        let mut solved = 0;
        for (i, end) in poses_behind(&robot, &obstacles, 20).iter().enumerate() {
            let options = PointToPointOptions {
                limits: Some(limits(&robot, None, 10.0)),
                obstacles: obstacles.clone(),
                ..Default::default()
            };
            let plan = plan_point_to_point(&robot, &End::Configuration(start.clone()), end, &options, &mut Unattended);
            let plan = plan.unwrap();
            println!(
                "{name} {i}: {:?} {:.3} s, clearance {:?}, {:.1} ms, {} knots, {}",
                plan.status,
                plan.cost,
                plan.clearance,
                1e3 * plan.elapsed.as_secs_f64(),
                plan.trajectory.knots().len(),
                plan.message()
            );
            if plan.status == Status::Solved {
                solved += 1;
                let nearest = |q: Vec<f64>| scene.nearest(&q).unwrap().unwrap().distance;
                let sampled = states(&plan, 500).map(nearest).fold(f64::INFINITY, f64::min);
                let clearance = plan.clearance.unwrap();
                assert!(0.001 <= clearance && clearance <= sampled + 1e-9, "{clearance} {sampled}");
                let reached = states(&plan, 1).last().unwrap();
                if let End::Target(target) = end {
                    let error = ikcore::task::TipError::from(target.error(&robot, &reached));
                    assert!(error.position < 2e-6 && error.rotation < 2e-6, "{error}");
                }
            } else {
                assert!(!plan.violations.is_empty());
            }
        }
        println!("{name}: {solved} of 20");
        assert!(solved >= 19, "{name}: {solved} of 20");
    }
    let _ = pose::translation(0.0, 0.0, 0.0);
}
