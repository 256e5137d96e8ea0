//! Planners of Wang et al. (2019): their trajectories, limits, obstacles, and quality.

use std::f64::consts::PI;

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::Frame;
use ikcore::obstacle::Surroundings;
use ikcore::path::{Path, Plane, Polyline, Waypoints};
use ikcore::planning::{
    AlongPathOptions, Cost, Elbow, Endpoint, Plan, PlanarArm, PointToPointMethod, PointToPointOptions, TipPath, Tpbso,
    plan_along_path, plan_point_to_point,
};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::TrialUpdate;
use ikcore::solver::{AnySolver, DerivativeFree, DifferentialEvolution, Schedule, Status, Stop, Unattended};
use ikcore::task::Target;

/// Arm of the paper with `k` links of 2 m in all, at pi rad/s and `acceleration` rad/s^2, turning freely.
fn arm(k: usize, acceleration: f64) -> (Robot, Limits) {
    let robot = Robot::planar(&vec![2.0 / k as f64; k]).expect("valid input");
    (robot.clone(), limits(&robot, acceleration))
}

fn limits(robot: &Robot, acceleration: f64) -> Limits {
    let constant = |value: f64| vec![Profile::Constant(value)];
    let limits = Limits::of(robot).replace(Field::Velocity, constant(PI)).expect("valid input");
    let limits = limits.replace(Field::Acceleration, constant(acceleration)).expect("valid input");
    let limits = limits.replace(Field::Lower, constant(f64::NEG_INFINITY)).expect("valid input");
    limits.replace(Field::Upper, constant(f64::INFINITY)).expect("valid input")
}

fn at(x: f64, y: f64) -> Endpoint {
    Endpoint::from(Target::Position([x, y, 0.0]))
}

/// Motion of the paper, from (1, 0) to (0.5, 1.5), by the paper's method unless `options` name another search.
fn plan(k: usize, options: PointToPointOptions) -> Plan {
    let (robot, limits) = arm(k, 2.0 * PI);
    let method = match options.method {
        PointToPointMethod::MinMax => Tpbso::default().into(),
        given @ PointToPointMethod::Tpbso(_) => given,
    };
    let options = PointToPointOptions { method, limits: Some(limits), ..options };
    plan_point_to_point(&robot, &at(1.0, 0.0), &[at(0.5, 1.5)], &options, &mut Unattended).expect("valid input")
}

fn by_evolution() -> PointToPointMethod {
    let standard = DifferentialEvolution::default();
    let schedule = Schedule { population: 40, stall_generations: usize::MAX, ..standard.schedule };
    searched_by(DifferentialEvolution { schedule, update: TrialUpdate::Immediate, ..standard }.into())
}

fn searched_by(solver: DerivativeFree) -> PointToPointMethod {
    Tpbso { solver: Some(AnySolver::Single(solver)), ..Tpbso::default() }.into()
}

/// Mean cost over seeds, with all plans checked.
fn mean(seeds: u64, plan: impl Fn(u64) -> Plan) -> f64 {
    let cost = |seed| {
        let plan = plan(seed);
        assert_eq!(plan.status, Status::Solved, "seed {seed}: {}", plan.message());
        assert!(plan.violations.is_empty());
        plan.cost
    };
    (0..seeds).map(cost).sum::<f64>() / seeds as f64
}

#[test]
fn beetle_swarm_is_as_quick_as_measured_before() {
    for (k, bound) in (2..).zip([1.40, 1.41, 1.51, 1.65]) {
        let mean = mean(5, |seed| plan(k, PointToPointOptions { seed, ..Default::default() }));
        assert!(mean <= bound, "{k} links: {mean} s");
    }
}

#[test]
fn beetle_swarm_turns_as_little_as_measured_before() {
    for (k, bound) in (3..).zip([2.49, 2.68, 3.27]) {
        let objective = Cost::JointTravel;
        let mean = mean(5, |seed| plan(k, PointToPointOptions { seed, objective, ..Default::default() }));
        assert!(mean <= bound, "{k} links: {mean} rad");
    }
}

#[test]
fn two_links_leave_nothing_to_choose() {
    let options = PointToPointOptions { objective: Cost::JointTravel, ..Default::default() };
    assert!((plan(2, options).cost - 2.41346).abs() < 1e-4);
}

#[test]
fn differential_evolution_is_as_quick_as_measured_before() {
    for (k, bound) in (2..).zip([1.27, 1.02, 0.96, 0.95]) {
        let mean = mean(5, |seed| plan(k, PointToPointOptions { seed, method: by_evolution(), ..Default::default() }));
        assert!(mean <= bound, "{k} links: {mean} s");
    }
}

#[test]
fn cost_is_that_of_the_trajectory_and_history_leads_to_it() {
    for objective in [Cost::Time, Cost::JointTravel, Cost::TipTravel] {
        let plan = plan(3, PointToPointOptions { objective, ..Default::default() });
        let last = plan.history.last().unwrap();
        assert!((last.cost - plan.cost).abs() < 1e-3 * plan.cost, "{objective}: {} and {}", last.cost, plan.cost);
        assert!(
            plan.history
                .windows(2)
                .all(|pair| { pair[1].cost < pair[0].cost && pair[1].evaluations > pair[0].evaluations })
        );
        assert_eq!(plan.evaluations, 50 * (3 * 200 + 1));
    }
}

#[test]
fn same_seed_same_bits() {
    let plan = |seed| plan(4, PointToPointOptions { seed, ..Default::default() }).trajectory;
    assert_eq!(plan(3), plan(3));
    assert_ne!(plan(3), plan(4));
}

#[test]
fn any_solver_serves() {
    for solver in DerivativeFree::all() {
        let name = format!("{solver:?}");
        let stop = Some(Stop { max_evaluations: 4000, ..Stop::default() });
        let options = PointToPointOptions { method: searched_by(solver), stop, ..Default::default() };
        let plan = plan(3, options);
        assert!(plan.evaluations <= 4000, "{name}");
        assert_eq!(plan.violations.is_empty(), plan.status == Status::Solved, "{name}");
    }
}

#[test]
fn obstacle_is_passed_at_its_margin() {
    let (robot, _) = arm(4, 2.0 * PI);
    let shape = PlanarArm::of(&robot).unwrap();
    let plan = |seed| {
        let obstacles = vec![Shape::ellipse([0.8, 0.8], [0.3, 0.2], 0.0).unwrap()];
        let objective = Cost::TipTravel;
        let margin = Some(0.005);
        let method = by_evolution();
        plan(
            4,
            PointToPointOptions {
                objective,
                surroundings: Surroundings { margin, ..Surroundings::among(obstacles) },
                seed,
                method,
                ..Default::default()
            },
        )
    };
    let mean = mean(3, |seed| {
        let plan = plan(seed);
        assert!(plan.clearance.as_ref().unwrap().distance >= 0.005);
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 4]);
        for i in 0..=4000 {
            plan.trajectory.at(plan.cost.max(10.0) * f64::from(i) / 4000.0, &mut q, &mut qd, &mut qdd).unwrap();
            let corners: Vec<_> = shape.corners(&q).collect();
            assert!(corners.windows(2).all(|link| !meets_ellipse(link[0], link[1])), "seed {seed}, sample {i}");
        }
        plan
    });
    // The shortest way round is 1.64757 m: straight, along the ellipse, and straight.
    assert!((1.6475..=1.75).contains(&mean), "{mean} m");
}

/// Whether any of many points of a link is in the obstacle of the paper's size: independent of the planner's test.
fn meets_ellipse(a: [f64; 2], b: [f64; 2]) -> bool {
    (0..=50).any(|i| {
        let fraction = f64::from(i) / 50.0;
        let [x, y] = [a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1])];
        ((x - 0.8) / 0.3).powi(2) + ((y - 0.8) / 0.2).powi(2) < 1.0
    })
}

#[test]
fn robots_in_space_reach_both_poses() {
    for name in ["panda", "ur5e"] {
        let robot = Robot::named(name).unwrap();
        let acceleration = vec![Profile::Constant(10.0)];
        let limits = Some(Limits::of(&robot).replace(Field::Acceleration, acceleration).unwrap());
        let qs = robot.random_configurations(2, &mut rng::stream(5, 0)).unwrap();
        let poses: Vec<Frame> = qs.chunks(robot.dof()).map(|q| robot.tip(q)).collect();
        let ends = poses.iter().map(|pose| Endpoint::from(Target::Pose(*pose))).collect::<Vec<_>>();
        let options = PointToPointOptions { method: by_evolution(), limits, ..Default::default() };
        let plan = plan_point_to_point(&robot, &ends[0], &ends[1..], &options, &mut Unattended).unwrap();
        assert_eq!(plan.status, Status::Solved, "{name}: {}", plan.message());
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; robot.dof()]);
        for (t, pose) in [(0.0, poses[0]), (plan.trajectory.duration(), poses[1])] {
            plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
            let tip = robot.tip(&q);
            assert!((0..3).all(|k| (tip.origin[k] - pose.origin[k]).abs() < 2e-6), "{name}");
            assert!(qd.iter().all(|v| v.abs() < 1e-9));
        }
    }
}

/// Star of the paper about (1, 1), and a closed curve of three lobes there, at 51 points.
fn paths() -> [TipPath; 2] {
    let star = Polyline::pentagram(&Plane::xy([1.0, 1.0, 0.0]).expect("valid input"), 0.5, 1.0).expect("valid input");
    let lobes = (0..=50).map(|i| {
        let angle = 2.0 * PI * f64::from(i) / 50.0;
        let radius = (1.0 + 0.35 * (3.0 * angle).cos()) * 0.6 / 1.35;
        [1.0 + radius * angle.cos(), 1.0 + radius * angle.sin(), 0.0]
    });
    let lobes = Waypoints::new(lobes.collect(), None).expect("valid input");
    [TipPath::along(&Path::new(star)).expect("valid input"), TipPath::through(&lobes).expect("valid input")]
}

fn follow(path: &TipPath, options: AlongPathOptions) -> Plan {
    let robot = Robot::planar(&[1.0, 1.0, 1.0]).expect("valid input");
    let limits = Some(limits(&robot, 4.0 * PI));
    let stop = Some(Stop { max_evaluations: 50 * 301, ..Stop::default() });
    let options = AlongPathOptions { method: Tpbso::default().into(), limits, stop, ..options };
    plan_along_path(&robot, path, &options, &mut Unattended).expect("valid input")
}

#[test]
fn paths_are_followed_as_quickly_as_measured_before() {
    for (path, accuracy, bound) in
        paths().iter().zip([0.04, 0.02]).zip([6.14, 3.72]).map(|((path, accuracy), bound)| (path, accuracy, bound))
    {
        let mean =
            mean(4, |seed| follow(path, AlongPathOptions { accuracy: Some(accuracy), seed, ..Default::default() }));
        assert!(mean <= bound, "{mean} s");
    }
}

#[test]
fn tpbso_passes_every_second_point_within_the_accuracy() {
    let robot = Robot::planar(&[1.0, 1.0, 1.0]).unwrap();
    let tip_path = &paths()[0];
    let plan = follow(tip_path, AlongPathOptions { accuracy: Some(0.04), ..Default::default() });
    let tip = |fraction: f64| {
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 3]);
        plan.trajectory.at(plan.trajectory.duration() * fraction, &mut q, &mut qd, &mut qdd).unwrap();
        robot.tip_position(&q)
    };
    for i in (0..=50).step_by(2) {
        let (tip, point) = (tip(f64::from(i) / 50.0), tip_path.points().position(i as usize));
        assert!((tip[0] - point[0]).hypot(tip[1] - point[1]) <= 1e-9, "point {i}");
    }
    let farthest = (0..=5000).map(|i| tip_path.distance(tip(f64::from(i) / 5000.0), 0.0, 1.0)).fold(0.0, f64::max);
    let accuracy = plan.accuracy.unwrap();
    assert!(0.99 * accuracy <= farthest && farthest <= accuracy && accuracy <= 0.04, "{farthest} m, {accuracy} m");
    assert_eq!(plan.redundancy.len(), 51);
    for free in plan.redundancy.iter().flatten() {
        assert!(free.lowest - 1e-12 <= free.value && free.value <= free.highest + 1e-12);
    }
}

#[test]
fn a_path_is_begun_where_asked() {
    let arm = PlanarArm::of(&Robot::planar(&[1.0, 1.0, 1.0]).unwrap()).unwrap();
    let path = &paths()[1];
    let [x, y, _] = path.points().position(0);
    let mut start = [0.0; 3];
    arm.solve([x, y], &[0.9], Elbow::Negative, &mut start).unwrap();
    let plan = follow(path, AlongPathOptions { start: Some(start.to_vec()), ..Default::default() });
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 3]);
    plan.trajectory.at(0.0, &mut q, &mut qd, &mut qdd).unwrap();
    assert!((0..3).all(|j| (q[j] - start[j]).abs() < 1e-9), "{q:?} for {start:?}");
}

#[test]
fn planar_arms_are_told_from_others() {
    assert!(PlanarArm::of(&Robot::named("panda").unwrap()).is_none());
    let mut rng = rng::stream(1, 0);
    let tool = ikcore::math::pose::translation(0.3, 0.2, 0.1);
    let robot = Robot::planar(&[0.5, 0.4, 0.3, 0.2]).unwrap().with_tool(tool).unwrap();
    let robot = robot.with_base(ikcore::math::pose::translation(1.0, -2.0, 0.5)).unwrap();
    let arm = PlanarArm::of(&robot).unwrap();
    for q in robot.random_configurations(50, &mut rng).unwrap().chunks(4) {
        let tip = robot.tip(q);
        let place = arm.planar_target(&Target::Pose(tip)).unwrap();
        let mut orientations = arm.orientations(q).split_off(2);
        assert!((orientations[1] - place.orientation.unwrap()).sin().abs() < 1e-9);
        orientations[1] = place.orientation.unwrap();
        let mut solved = [0.0; 4];
        arm.solve(place.position, &orientations, arm.elbow(q), &mut solved).unwrap();
        assert!((0..4).all(|j| ((solved[j] - q[j]) / 2.0).sin().abs() < 1e-7), "{solved:?} for {q:?}");
    }
}
