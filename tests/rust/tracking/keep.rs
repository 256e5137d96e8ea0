//! What a tracker keeps: at ticks and in between, during stops, beside obstacles, and as near to the target as that allows.

use crate::common::executed_curve::ExecutedCurve;
use ikcore::constraint::Keep;
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::math::{Pose, pose};
use ikcore::path::{Circle, Path, Plane};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::{NamedTask, Subject, Target, Task, TaskKind, Tolerance};
use ikcore::tracking::{Arrival, Session, TrackOptions, track};

use super::clear::{START, all_limits, panda, random_obstacles, surroundings};
use super::tips;

/// Samples of each tick.
const SAMPLES: u32 = 50;

const FREE: f64 = f64::INFINITY;

/// What a judge of its own says about a constraint: the largest error, less its tolerance with rounding.
type Judge = Box<dyn Fn(&Robot, &[f64]) -> f64>;

fn beyond(error: f64, tolerance: f64) -> f64 {
    error - tolerance * (1.0 + 1e-9) - 1e-9
}

fn keep(subject: Subject, kind: TaskKind, tolerance: &[f64], target: &Pose) -> Keep {
    let task = Task::new(kind, None, Some(tolerance), None).unwrap();
    Keep::new(&NamedTask { subject, task: Some(task), tolerance: Tolerance::default() }, &Target::from(target)).unwrap()
}

/// The axis of the tip within `tilt` of where it is at `home`.
fn upright(home: &Pose, tilt: f64) -> (Keep, Judge) {
    let kept = keep(Subject::Tip(0), TaskKind::Pointing { axis: [0.0, 0.0, 1.0] }, &[FREE, FREE, FREE, tilt], home);
    let axis = home.rotation.matrix().column(2).into_owned();
    let judge = move |robot: &Robot, q: &[f64]| {
        let here = robot.fk(q).unwrap().rotation.matrix().column(2).into_owned();
        beyond(here.cross(&axis).norm().atan2(here.dot(&axis)), tilt)
    };
    (kept, Box::new(judge))
}

/// The tip within `width` of a plane and `length` of a line in it, along the axes of `home`.
fn corridor(home: &Pose, width: f64, length: f64) -> (Keep, Judge) {
    let kept = keep(Subject::Tip(0), TaskKind::Pose, &[length, FREE, width, FREE, FREE, FREE], home);
    let inverse = home.inverse();
    let judge = move |robot: &Robot, q: &[f64]| {
        let apart = (inverse * robot.fk(q).unwrap()).translation.vector;
        beyond(apart.x.abs(), length).max(beyond(apart.z.abs(), width))
    };
    (kept, Box::new(judge))
}

fn session(robot: &Robot, start: &[f64], dt: f64, limits: Limits, keeps: Vec<Keep>) -> Session {
    let options = TrackOptions { limits: Some(limits), keeps, ..TrackOptions::default() };
    Session::new(robot, start, dt, &options).unwrap()
}

/// Tracks targets near the start, with stops, and judges the executed motion. Counts ticks on the target and held ones.
fn live(robot: &Robot, session: &mut Session, judges: &[Judge], rng: &mut LazyRng, ticks: usize) -> [usize; 2] {
    let mut curve = ExecutedCurve::of(session);
    let home = robot.fk(session.q()).unwrap();
    let (mut target, mut counts, mut stops) = (home, [0; 2], 0_usize);
    for tick in 0..ticks {
        if tick % 40 == 0 {
            let size = [0.0, 0.02, 0.1, 0.4][rng.below(4)];
            let moved = std::array::from_fn(|_| rng.uniform_in(-size, size));
            target = pose::from_rpy(std::array::from_fn(|_| rng.uniform_in(-size, size)), moved) * home;
        }
        stops = if stops == 0 && rng.below(60) == 0 { 15 } else { stops.saturating_sub(1) };
        let status = if stops > 0 {
            if stops == 15 {
                session.stop();
            }
            session.advance(None, &mut Unattended).unwrap().status
        } else {
            session.step(&Target::from(&target), &mut Unattended).unwrap().status
        };
        for (at, q) in curve.sampled_after(session.q(), SAMPLES) {
            let worst = judges.iter().map(|judge| judge(robot, &q)).fold(f64::NEG_INFINITY, f64::max);
            assert!(worst <= 0.0, "{worst} beyond at tick {at}, stops {stops}");
        }
        counts[0] += usize::from(status == Status::Solved);
        counts[1] += usize::from(status == Status::HeldByConstraint);
    }
    counts
}

#[test]
fn what_is_kept_holds_between_ticks_and_during_stops() {
    let robot = Robot::named("panda").unwrap();
    let mut rng = rng::stream(71, 0);
    let mut counts = [0; 2];
    for trial in 0..12 {
        let home = robot.fk(&START).unwrap();
        let (tilt, width) = ([0.02, 0.1, 0.3][trial % 3], [0.003, 0.05][trial % 2]);
        for (limits, dt) in all_limits(&robot).into_iter().zip([[0.001, 0.01, 0.033], [0.033, 0.001, 0.01]][trial % 2])
        {
            let of_two = [upright(&home, tilt), corridor(&home, width, 0.15)].into_iter();
            let (keeps, judges): (Vec<Keep>, Vec<Judge>) = of_two.take(1 + trial / 4).unzip();
            let mut session = session(&robot, &START, dt, limits, keeps);
            let found = live(&robot, &mut session, &judges, &mut rng, 200);
            (0..2).for_each(|k| counts[k] += found[k]);
        }
    }
    assert!(counts[0] > 400 && counts[1] > 400, "{counts:?}");
}

#[test]
fn constraints_hold_beside_obstacles() {
    let robot = panda();
    let mut rng = rng::stream(72, 0);
    let home = robot.fk(&START).unwrap();
    for (limits, dt) in all_limits(&robot).into_iter().zip([0.01, 0.004, 0.01]) {
        let (keep, judge) = upright(&home, 0.1);
        let surroundings = surroundings(random_obstacles(&robot, &mut rng));
        let options = TrackOptions { limits: Some(limits), surroundings, keeps: vec![keep], ..TrackOptions::default() };
        let mut session = Session::new(&robot, &START, dt, &options).unwrap();
        live(&robot, &mut session, &[judge], &mut rng, 400);
    }
}

/// The relative pose of two hands stays within a tolerance while one of them is sent elsewhere.
#[test]
fn a_pair_of_tips_stays_within_a_tolerance() {
    let robot = tips::robot();
    let left = tips::forward([0.5, 0.25, 0.9], [0.0; 3]);
    let start = tips::start(&robot, &left);
    let [one, other] = ["left_tool", "right_tool"].map(|tip| robot.link_fk(tip, &start).unwrap());
    let tray = one.inverse() * other;
    for (limits, _) in tips::all_limits(&robot) {
        let kept = keep(Subject::Pair { from: 0, of: 1 }, TaskKind::Pose, &[0.01, 0.01, 0.01, 0.05, 0.05, 0.05], &tray);
        let mut session = session(&robot, &start, 0.02, limits, vec![kept]);
        let (mut curve, mut farthest) = (ExecutedCurve::of(&session), 0.0_f64);
        let mut target = one;
        for tick in 0..200 {
            target.translation.vector[tick / 70] += 0.002;
            let left = NamedTask { subject: Subject::Tip(0), task: None, tolerance: Tolerance::default() };
            let arrival: Arrival = [(left, Target::from(&target))].into_iter().collect();
            session.advance(Some(arrival), &mut Unattended).unwrap();
            for (at, q) in curve.sampled_after(session.q(), SAMPLES) {
                let [one, other] = ["left_tool", "right_tool"].map(|tip| robot.link_fk(tip, &q).unwrap());
                let away = tray.inverse() * one.inverse() * other;
                let position = away.translation.vector.amax();
                let rotation = away.rotation.scaled_axis().amax();
                assert!(beyond(position, 0.01).max(beyond(rotation, 0.05)) <= 0.0, "{position} {rotation} at {at}");
                farthest = farthest.max(position);
            }
        }
        assert!(farthest > 1e-3, "the hands kept together exactly: {farthest}");
    }
}

/// A target beyond what is kept is approached as far as that allows: here up to a plane.
#[test]
fn an_arm_comes_as_near_as_what_is_kept_allows() {
    let robot = Robot::named("panda").unwrap();
    let home = robot.fk(&START).unwrap();
    for limits in all_limits(&robot) {
        let (keep, _) = corridor(&home, 0.02, 1e3);
        let mut session = session(&robot, &START, 0.01, limits, vec![keep]);
        let mut target = home;
        let side = home.rotation.matrix().column(2) * 0.1 + home.rotation.matrix().column(1) * 0.05;
        target.translation.vector += side;
        let mut last = None;
        for _ in 0..500 {
            last = Some(session.step(&Target::Position(target.translation.vector.into()), &mut Unattended).unwrap());
        }
        let step = last.unwrap();
        assert_eq!(step.status, Status::HeldByConstraint);
        assert!((step.error.position - 0.08).abs() < 1e-3, "{}", step.error.position);
        let message = step.message().to_string();
        assert!(message.starts_with("held back by what is to be kept, "), "{message}");
    }
}

/// At its tolerance an arm can leave it, under limits of all orders.
#[test]
fn an_arm_that_starts_at_a_tolerance_gets_away_from_it() {
    let robot = Robot::named("panda").unwrap();
    let home = robot.fk(&START).unwrap();
    for limits in all_limits(&robot) {
        for dt in [0.001, 0.033] {
            let mut plane = home;
            plane.translation.vector.z += 0.02;
            let kept = keep(Subject::Tip(0), TaskKind::Position, &[FREE, FREE, 0.02], &plane);
            let mut session = session(&robot, &START, dt, limits.clone(), vec![kept]);
            let mut target = home;
            target.translation.vector.z += 0.01;
            let wanted = Target::from(&target);
            let arrived = (0..2000).any(|_| session.step(&wanted, &mut Unattended).unwrap().status == Status::Solved);
            assert!(arrived, "dt {dt}: {:?}", session.step(&wanted, &mut Unattended));
        }
    }
}

#[test]
fn a_start_that_breaks_a_constraint_is_refused_with_its_error() {
    let robot = Robot::named("panda").unwrap();
    let home = robot.fk(&START).unwrap();
    let tilted = home * pose::from_rpy([0.25, 0.0, 0.0], [0.0; 3]);
    let options = TrackOptions { keeps: vec![upright(&tilted, 0.1).0], ..TrackOptions::default() };
    let error = Session::new(&robot, &START, 0.01, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "start_q: what is to be kept on the way does not hold there: tilt 0.2500 rad of at most 0.1000"
    );
    let mut session = session(&robot, &START, 0.01, Limits::of(&robot), vec![upright(&home, 0.1).0]);
    let mut away = START;
    away[5] += 0.5;
    let error = session.reset(&away, None, None).unwrap_err().to_string();
    assert_eq!(error, "q: what is to be kept on the way does not hold there: tilt 0.5000 rad of at most 0.1000");
}

#[test]
fn limits_that_vary_are_refused_with_constraints() {
    let robot = Robot::named("panda").unwrap();
    let home = robot.fk(&START).unwrap();
    let sinusoid = Sinusoid { mean: 2.8, amplitude: 0.1, angular_frequency: 1.0, phase: 0.0 };
    let limits = Limits::of(&robot).replace(Field::Upper, vec![Profile::Sinusoid(sinusoid); 7]).unwrap();
    let options = TrackOptions { limits: Some(limits), keeps: vec![upright(&home, 0.1).0], ..TrackOptions::default() };
    let error = Session::new(&robot, &START, 0.01, &options).unwrap_err().to_string();
    assert!(error.contains("tracking with constraints"), "{error}");
}

/// Without a start, one is found on the path where all holds.
#[test]
fn a_start_is_found_where_all_holds() {
    let robot = Robot::named("panda").unwrap();
    let home = robot.fk(&START).unwrap();
    let center: [f64; 3] = home.translation.vector.into();
    let path = Path::new(Circle::new(Plane::xy(center).unwrap(), 0.1, 4.0).unwrap()).sample(0.01).unwrap();
    let (keep, judge) = upright(&home, 0.05);
    let options = TrackOptions { keeps: vec![keep], ..TrackOptions::default() };
    let record = track(&robot, &path, None, &options, &mut Unattended).unwrap();
    let worst = record.q.chunks(7).map(|q| judge(&robot, q)).fold(f64::NEG_INFINITY, f64::max);
    assert!(worst <= 0.0 && record.status == Status::Solved, "{worst} {}", record.message());
}
