//! Straight lines at both ends of a motion, and starts in contact.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::Pose;
use ikcore::obstacle::{Obstacle, Obstacles, Scene, Surroundings};
use ikcore::planning::{
    Endpoint, Freed, LineContact, LineFrame, Plan, PointToPointOptions, StraightLine, plan_point_to_point,
};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Monitor, Status, Stop, Unattended};
use ikcore::task::{Target, Task, TaskKind};

const READY: [f64; 7] = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8];
/// Default margin (m).
const MARGIN: f64 = 1e-3;

fn panda() -> Robot {
    Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap()
}

fn limited(robot: &Robot, fields: &[(Field, f64)]) -> Limits {
    let replaced = |limits: Limits, (field, value): &(Field, f64)| {
        limits.replace(*field, vec![Profile::Constant(*value)]).unwrap()
    };
    fields.iter().fold(Limits::of(robot), replaced)
}

fn options(robot: &Robot) -> PointToPointOptions {
    PointToPointOptions { limits: Some(limited(robot, &[(Field::Acceleration, 5.0)])), ..Default::default() }
}

fn line(distance: f64) -> Option<StraightLine> {
    Some(StraightLine { distance, ..StraightLine::default() })
}

fn at(plan: &Plan, t: f64) -> [Vec<f64>; 3] {
    let n = plan.trajectory.joints().len();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
    plan.trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
    [q, qd, qdd]
}

/// Times at which the arm is at rest.
fn rests(plan: &Plan) -> Vec<f64> {
    let still = |t: &f64| at(plan, *t)[1].iter().all(|speed| speed.abs() < 1e-9);
    plan.trajectory.knots().iter().copied().filter(still).collect()
}

/// Checks that the tip moves along a line of this displacement, with constant orientation.
fn assert_straight(robot: &Robot, plan: &Plan, [from, to]: [f64; 2], displacement: [f64; 3]) {
    let first = robot.tip(&at(plan, from)[0]);
    for i in 0..=300 {
        let tip = robot.tip(&at(plan, from + (to - from) * f64::from(i) / 300.0)[0]);
        let moved: [f64; 3] = std::array::from_fn(|k| tip.origin[k] - first.origin[k]);
        let length = displacement.iter().map(|x| x * x).sum::<f64>();
        let fraction = (0..3).map(|k| moved[k] * displacement[k]).sum::<f64>() / length;
        assert!((-1e-4..1.0001).contains(&fraction));
        let off = (0..3).map(|k| (moved[k] - fraction * displacement[k]).powi(2)).sum::<f64>().sqrt();
        assert!(off < 1.1e-4, "{off} at {fraction}");
        let turned: f64 = (0..3).map(|a| (0..3).map(|k| tip.axes[a][k] * first.axes[a][k]).sum::<f64>()).sum();
        assert!(turned > 3.0 - 1e-7, "{turned}");
        assert!(i < 300 || (fraction - 1.0).abs() < 1e-4);
    }
}

#[test]
fn lines_are_straight_within_all_limits() {
    let ur: &[f64] = &[0.0, -1.2, 1.5, -1.9, -1.6, 0.0];
    for (name, near, fields) in [
        ("panda", &READY[..], &[(Field::Acceleration, 5.0)][..]),
        ("panda", &READY, &[(Field::Acceleration, 5.0), (Field::Jerk, 50.0)]),
        ("ur5e", ur, &[(Field::Velocity, 1.0)]),
        ("iiwa14", &[0.0, 0.6, 0.0, -1.2, 0.0, 1.2, 0.0], &[(Field::Acceleration, 10.0)]),
    ] {
        let robot = Robot::named(name).unwrap();
        let limits = limited(&robot, fields);
        let mut rng = rng::stream(2, 0);
        let mut planned = 0;
        for _ in 0..8 {
            let mut drawn = || -> Vec<f64> { near.iter().map(|q| q + rng.uniform_in(-0.5, 0.5)).collect() };
            let [start, end] = [drawn(), drawn()];
            let tip = robot.tip(&end);
            let [approach, retreat] = [0.08, 0.05].map(line);
            let options = PointToPointOptions {
                approach,
                retreat: retreat.map(|retreat| StraightLine {
                    direction: Some([0.0, 0.0, 2.0]),
                    frame: LineFrame::Base,
                    ..retreat
                }),
                limits: Some(limits.clone()),
                ..Default::default()
            };
            let ends = [Endpoint::from(Target::Pose(tip))];
            let start = Endpoint::Configuration(start);
            let plan = match plan_point_to_point(&robot, &start, &ends, &options, &mut Unattended) {
                Ok(plan) => plan,
                Err(error) => {
                    // An arm at the edge of its reach cannot leave along a line.
                    assert!(error.to_string().contains("no straight "), "{error}");
                    continue;
                }
            };
            planned += 1;
            assert_eq!((plan.status, plan.violations.len()), (Status::Solved, 0), "{name}: {}", plan.message());
            assert_eq!(plan.chosen_end, Some(0));
            let rests = rests(&plan);
            let [begin, away, .., back, end] = rests[..] else { panic!("{rests:?}") };
            assert_straight(&robot, &plan, [begin, away], [0.0, 0.0, 0.05]);
            assert_straight(&robot, &plan, [back, end], tip.axes[2].map(|entry| 0.08 * entry));
            let again = plan_point_to_point(&robot, &start, &ends, &options, &mut Unattended).unwrap();
            assert_eq!((again.trajectory, again.evaluations), (plan.trajectory, plan.evaluations));
        }
        assert!(planned >= 6, "{name}: {planned} of 8");
    }
}

#[test]
fn a_line_keeps_what_the_task_asks_for() {
    let robot = panda();
    let start = Endpoint::Configuration(READY.to_vec());
    let mut tool = Pose::identity();
    tool.translation.vector.z = 0.1;
    for (kind, tool) in [(TaskKind::Pointing { axis: [0.0, 0.0, 1.0] }, None), (TaskKind::Pose, Some(tool))] {
        let task = Task::new(kind, None, None, tool).unwrap();
        let options = PointToPointOptions { task: Some(task), approach: line(0.1), ..options(&robot) };
        let held = task.robot(&robot).unwrap().unwrap_or_else(|| robot.clone());
        let tip = held.tip(&[0.9, 0.5, 0.2, -1.3, 0.1, 1.6, 0.3]);
        let ends = [Endpoint::from(Target::Pose(tip))];
        let plan = plan_point_to_point(&robot, &start, &ends, &options, &mut Unattended).unwrap();
        assert_eq!(plan.status, Status::Solved, "{}", plan.message());
        let [.., back, end] = rests(&plan)[..] else { panic!("no line") };
        for (t, fraction) in [(back, -1.0), (end, 0.0)] {
            let reached = held.tip(&at(&plan, t)[0]);
            let off = |k: usize| reached.origin[k] - tip.origin[k] - fraction * 0.1 * tip.axes[2][k];
            assert!((0..3).all(|k| off(k).abs() < 3e-6), "{kind:?}");
        }
    }
}

#[test]
fn contacts_are_allowed_on_the_line_alone() {
    let robot = panda();
    let scene = |obstacles: &Obstacles, q: &[f64]| Scene::new(&robot, obstacles).unwrap().clearance(q).unwrap();
    let end = vec![0.6, 0.5, 0.1, -1.7, 0.0, 2.0, 0.8];
    let tip = robot.tip(&end);
    let ahead = std::array::from_fn(|k| tip.origin[k] + 0.04 * tip.axes[2][k]);
    let ball = Obstacles::from_iter([Shape::sphere(ahead, 0.05).unwrap()]);
    let start = Endpoint::Configuration(READY.to_vec());
    let touch = vec![LineContact { obstacle: Some(0), links: vec!["link_7".into(), "link_6".into()] }];
    let approach = StraightLine { distance: 0.12, touch: touch.clone(), ..StraightLine::default() };
    let ends = [Endpoint::Configuration(end)];
    let with = |approach| PointToPointOptions {
        approach: Some(approach),
        surroundings: Surroundings::among(ball.clone()),
        ..options(&robot)
    };
    let plan = plan_point_to_point(&robot, &start, &ends, &with(approach.clone()), &mut Unattended).unwrap();
    assert_eq!(plan.status, Status::Solved, "{}", plan.message());
    let [.., back, _] = rests(&plan)[..] else { panic!("no line") };
    let touched = Obstacles::from_iter([Obstacle::new(ball[0].shape.clone(), touch[0].links.clone())]);
    for i in 0..=1000 {
        let t = plan.trajectory.duration() * f64::from(i) / 1000.0;
        let q = &at(&plan, t)[0];
        assert!(scene(&touched, q) >= MARGIN && (t > back || scene(&ball, q) >= MARGIN), "at {t} s");
    }
    assert!(scene(&ball, &at(&plan, plan.trajectory.duration())[0]) < 0.0);
    assert!(plan.clearance.as_ref().unwrap().distance >= MARGIN);
    let said = |line| plan_point_to_point(&robot, &start, &ends, &with(line), &mut Unattended).unwrap_err().to_string();
    let untouched = said(StraightLine { touch: vec![], ..approach.clone() });
    assert!(
        untouched.starts_with("end_q cannot be reached: no straight approach of 0.1200 m: link 'link_7' is 0.0"),
        "{untouched}"
    );
    let unknown = vec![LineContact { obstacle: None, links: vec!["hand".into()] }];
    let unknown = said(StraightLine { touch: unknown, ..approach.clone() });
    assert!(unknown.starts_with("touch of obstacle 0 (Sphere): robot 'panda' has no link 'hand'"), "{unknown}");
    let short = said(StraightLine { distance: 0.01, ..approach });
    assert!(short.contains("at its other end link 'link_") && short.ends_with(": give a longer line"), "{short}");
}

#[test]
fn starts_in_contact_move_out_and_never_deeper() {
    let robot = panda();
    let mut rng = rng::stream(5, 0);
    let (mut freed, mut stuck) = (0, 0);
    for case in 0..60 {
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let tip = robot.tip_position(&q);
        let center: [f64; 3] = std::array::from_fn(|k| tip[k] + rng.uniform_in(-0.1, 0.1));
        let shape = if case % 2 == 0 {
            Shape::sphere(center, 0.04).unwrap()
        } else {
            Shape::cuboid(center, [0.05, 0.1, 0.04], None).unwrap()
        };
        let obstacles = vec![shape];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let begun = scene.clearance(&q).unwrap();
        if begun >= MARGIN {
            continue;
        }
        let end = loop {
            let end = robot.random_configurations(1, &mut rng).unwrap();
            if scene.is_clear(&end, 0.01) {
                break end;
            }
        };
        let with = |free_start| PointToPointOptions {
            free_start,
            surroundings: Surroundings::among(obstacles.clone()),
            ..options(&robot)
        };
        let (start, ends) = (Endpoint::Configuration(q), [Endpoint::Configuration(end)]);
        let refused = plan_point_to_point(&robot, &start, &ends, &with(false), &mut Unattended).unwrap_err();
        assert!(refused.to_string().ends_with("; free_start moves out first"), "{refused}");
        let plan = match plan_point_to_point(&robot, &start, &ends, &with(true), &mut Unattended) {
            Ok(plan) => plan,
            Err(error) => {
                let expected = "; free_start found no way out on which nothing comes nearer";
                assert!(error.to_string().ends_with(expected), "{error}");
                stuck += 1;
                continue;
            }
        };
        let Some(Freed { clearance, until }) = plan.freed else { panic!("it began in contact") };
        assert!((clearance - begun).abs() < 1e-6);
        freed += 1;
        if plan.status != Status::Solved {
            continue;
        }
        for i in 0..=2000 {
            let t = plan.trajectory.duration() * f64::from(i) / 2000.0;
            let distance = scene.clearance(&at(&plan, t)[0]).unwrap();
            let least = if t >= until { MARGIN } else { begun - 1e-4 };
            assert!(distance >= least, "case {case}: {distance} m at {t} s, began at {begun} m, free after {until} s");
        }
        assert!(plan.violations.is_empty() && plan.clearance.as_ref().unwrap().distance >= begun - 1e-3);
    }
    assert!(freed >= 20 && stuck <= freed / 4, "{freed} freed, {stuck} stuck");
}

struct Never;

impl Monitor for Never {
    fn keep_going(&mut self) -> bool {
        false
    }
}

#[test]
fn pieces_end_with_the_time_and_the_monitor() {
    let robot = panda();
    let end = robot.tip(&[0.9, 0.5, 0.2, -1.3, 0.1, 1.6, 0.3]);
    let ends = [Endpoint::from(Target::Pose(end))];
    let start = Endpoint::Configuration(READY.to_vec());
    let with = |stop| PointToPointOptions { approach: line(0.1), retreat: line(0.05), stop, ..options(&robot) };
    let nothing_left = Stop { max_time: Some(std::time::Duration::ZERO), ..Stop::default() };
    let plan = plan_point_to_point(&robot, &start, &ends, &with(Some(nothing_left)), &mut Unattended);
    assert!(plan.is_ok(), "{plan:?}");
    assert!(plan_point_to_point(&robot, &start, &ends, &with(None), &mut Never).is_err());
}

#[test]
fn lines_begin_and_end_with_joints_at_their_limits() {
    let robot = panda();
    let mut rng = rng::stream(11, 0);
    let [lower, upper] = [robot.joints()[6].lower, robot.joints()[6].upper];
    let mut found = 0;
    for i in 0..60 {
        let mut q = robot.random_configurations(1, &mut rng).unwrap();
        q[6] = if i % 2 == 0 { upper } else { lower };
        let options = PointToPointOptions { retreat: line(0.02), ..options(&robot) };
        let [start, end] = [q, READY.to_vec()].map(Endpoint::Configuration);
        match plan_point_to_point(&robot, &start, &[end], &options, &mut Unattended) {
            Ok(plan) => {
                let (low, high) = plan.trajectory.position_range()[6];
                assert!(low >= lower - 1e-9 && high <= upper + 1e-9, "{low} and {high}");
                found += 1;
            }
            Err(error) => assert!(!error.to_string().contains("position of joint"), "{error}"),
        }
    }
    assert!(found >= 40, "{found} of 60");
}
