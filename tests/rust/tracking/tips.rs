//! Tracking with several tips: pairs held under all kinds of limits, whatever the other targets are, and during stops.

use ikcore::ik::{SolveOptions, solve_tips};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::load::UrdfOptions;
use ikcore::math::{Pose, pose};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::task::{Goal, NamedTask, Subject, Target, Tolerance};
use ikcore::tracking::{Arrival, Session, TrackOptions};

use crate::common::arms::two_arms;

const DT: f64 = 0.02;
const PAIR: Subject = Subject::Pair { from: 0, of: 1 };

pub(super) fn robot() -> Robot {
    let tips = vec!["left_tool".into(), "right_tool".into()];
    Robot::from_urdf_with(&two_arms(), &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap()
}

/// Pose of the right hand relative to the left one.
fn tray() -> Pose {
    pose::from_rpy([0.0; 3], [0.0, -0.5, 0.0])
}

fn task(subject: Subject) -> NamedTask {
    NamedTask { subject, task: None, tolerance: Tolerance::default() }
}

/// Targets of the left hand at `left`, and of the tray.
pub(super) fn targets(left: &Pose) -> Vec<(NamedTask, Target)> {
    vec![(task(Subject::Tip(0)), Target::from(left)), (task(PAIR), Target::from(&tray()))]
}

pub(super) fn start(robot: &Robot, left: &Pose) -> Vec<f64> {
    let (tips, wanted): (Vec<NamedTask>, Vec<Target>) = targets(left).into_iter().unzip();
    let tight = Tolerance { position: 1e-9, rotation: 1e-9 };
    let tips = tips.into_iter().map(|task| NamedTask { tolerance: tight, ..task }).collect();
    let options = SolveOptions { tips, goals: vec![Goal::Centring { weight: 1.0 }], ..SolveOptions::default() };
    solve_tips(robot, &wanted, &options, &mut Unattended).unwrap().q.to_vec()
}

/// Error of the tray relative to the right hand (m, rad).
fn slip(robot: &Robot, q: &[f64]) -> f64 {
    let [left, right] = ["left_tool", "right_tool"].map(|tip| robot.link_fk(tip, q).unwrap());
    let away = tray().inverse() * left.inverse() * right;
    // The angle of a rotation is known to the root of the rounding only; this is its sine, times the root of 2.
    let turn = away.rotation.matrix() - away.rotation.matrix().transpose();
    away.translation.vector.norm().max(0.5 * turn.norm())
}

/// Limits on velocity alone, with acceleration, and with jerk.
pub(super) fn all_limits(robot: &Robot) -> [(Limits, [f64; 3]); 3] {
    let none = f64::INFINITY;
    [[1.0, none, none], [1.0, 4.0, none], [1.0, 4.0, 40.0]].map(|values| {
        let mut limits = Limits::of(robot);
        for (field, value) in [Field::Velocity, Field::Acceleration, Field::Jerk].into_iter().zip(values) {
            if value.is_finite() {
                limits = limits.replace(field, vec![Profile::Constant(value); robot.dof()]).unwrap();
            }
        }
        (limits, values)
    })
}

pub(super) fn session(robot: &Robot, q: &[f64], limits: Limits) -> Session {
    let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
    Session::new(robot, q, DT, &options).unwrap()
}

pub(super) fn forward(position: [f64; 3], rpy: [f64; 3]) -> Pose {
    pose::from_rpy(rpy, position) * pose::from_rpy([0.0, std::f64::consts::FRAC_PI_2, 0.0], [0.0; 3])
}

#[test]
fn a_tray_stays_in_both_hands_wherever_they_are_sent() {
    let robot = robot();
    let home = forward([0.5, 0.25, 0.9], [0.0; 3]);
    let q = start(&robot, &home);
    assert!(slip(&robot, &q) < 1e-8);
    for (limits, [velocity, acceleration, jerk]) in all_limits(&robot) {
        let (mut session, mut draws) = (session(&robot, &q, limits), rng::stream(1, 0));
        let mut target = home;
        let mut rows = vec![q.clone(); 3];
        for tick in 0..600 {
            if tick % 60 == 0 {
                let position = [0.5, 0.25, 0.9].map(|x| x + draws.uniform_in(-0.3, 0.3));
                target = forward(position, [(); 3].map(|()| draws.uniform_in(-0.5, 0.5)));
            }
            if tick == 500 {
                session.stop();
            }
            let arrival = (tick < 500).then(|| targets(&target).into_iter().collect::<Arrival>());
            session.advance(arrival, &mut Unattended).unwrap();
            let slip = slip(&robot, session.q());
            assert!(slip < 1e-9, "tick {tick}: slips by {slip:.1e}, {acceleration} {jerk}");
            rows.push(session.q().to_vec());
            let [a, b, c, d] = rows.last_chunk().unwrap();
            for j in 0..robot.dof() {
                let (step, before, first) = (d[j] - c[j], c[j] - b[j], b[j] - a[j]);
                assert!(step.abs() <= velocity * DT * (1.0 + 1e-9), "tick {tick}, joint {j}");
                assert!((step - before).abs() <= acceleration * DT.powi(2) * (1.0 + 1e-6), "tick {tick}, joint {j}");
                assert!(
                    (step - 2.0 * before + first).abs() <= jerk * DT.powi(3) * (1.0 + 1e-6),
                    "tick {tick}, joint {j}"
                );
            }
        }
        let [.., before, last] = &rows[..] else { panic!("there are rows") };
        assert!(before.iter().zip(last).all(|(before, last)| (before - last).abs() < 1e-7), "the stop has ended");
    }
}

#[test]
fn a_tray_stops_in_the_time_that_is_said() {
    let robot = robot();
    let home = forward([0.5, 0.25, 0.9], [0.0; 3]);
    let q = start(&robot, &home);
    for (limits, _) in all_limits(&robot) {
        let (mut session, mut draws) = (session(&robot, &q, limits), rng::stream(5, 0));
        for stop in 0..12 {
            let target = forward([0.5, 0.25, 0.9].map(|x| x + draws.uniform_in(-0.3, 0.3)), [0.0; 3]);
            for _ in 0..10 + 2 * stop {
                let arrival: Arrival = targets(&target).into_iter().collect();
                session.advance(Some(arrival), &mut Unattended).unwrap();
            }
            let said = session.stop();
            let ticks = (said / DT).round() as usize;
            for tick in 0..ticks + 50 {
                let left = session.stop();
                assert!(
                    (left - (said - tick as f64 * DT).max(0.0)).abs() < 1e-9,
                    "the time left is that of the same stop"
                );
                session.advance(None, &mut Unattended).unwrap();
                let still = session.qd().iter().all(|rate| rate.abs() * DT < 1e-12);
                assert!(still || tick < ticks, "stop {stop}: it takes longer than {said} s");
            }
        }
    }
}

#[test]
fn a_tray_stands_after_a_stop_with_little_jerk_in_a_tick() {
    let robot = robot();
    let home = forward([0.5, 0.25, 0.9], [0.0; 3]);
    let q = start(&robot, &home);
    let constant = |value| vec![Profile::Constant(value); robot.dof()];
    for jerk in [0.8, 8.0] {
        let limits = Limits::of(&robot).replace(Field::Acceleration, constant(1.0)).unwrap();
        let options = TrackOptions {
            limits: Some(limits.replace(Field::Jerk, constant(jerk)).unwrap()),
            ..TrackOptions::default()
        };
        for ticks in 1..12 {
            let mut session = Session::new(&robot, &q, 1e-3, &options).unwrap();
            for _ in 0..3 * ticks {
                let arrival: Arrival = targets(&forward([0.6, 0.1, 1.0], [0.0; 3])).into_iter().collect();
                session.advance(Some(arrival), &mut Unattended).unwrap();
            }
            let said = (session.stop() / 1e-3).round() as usize;
            for tick in 0..said + 60 {
                session.advance(None, &mut Unattended).unwrap();
                let fastest = session.qd().iter().fold(0.0, |fastest: f64, rate| fastest.max(rate.abs()));
                assert!(tick <= said || fastest < 1e-12, "{fastest} rad/s, {} ticks too late", tick - said);
            }
        }
    }
}

#[test]
fn a_pair_that_is_apart_comes_together_and_then_stays() {
    let robot = robot();
    let home = forward([0.5, 0.25, 0.9], [0.0; 3]);
    let mut apart = start(&robot, &home);
    apart[8..].iter_mut().zip([0.2, -0.3, 0.1, 0.3, -0.2, 0.2, 0.4]).for_each(|(q, by)| *q += by);
    assert!(slip(&robot, &apart) > 0.1);
    for (limits, _) in all_limits(&robot) {
        let mut session = session(&robot, &apart, limits);
        let mut joined = None;
        for tick in 0..400 {
            let arrival: Arrival = targets(&home).into_iter().collect();
            session.advance(Some(arrival), &mut Unattended).unwrap();
            let slip = slip(&robot, session.q());
            match joined {
                None if slip < 1e-7 => joined = Some(tick),
                Some(since) => assert!(slip < 1e-6, "joined in tick {since}, slips by {slip:.1e} in tick {tick}"),
                None => {}
            }
        }
        assert!(joined.is_some(), "they never come together");
    }
}

#[test]
fn the_same_targets_give_the_same_bits() {
    let robot = robot();
    let home = forward([0.5, 0.25, 0.9], [0.0; 3]);
    let q = start(&robot, &home);
    for (limits, _) in all_limits(&robot) {
        let run = || {
            let mut session = session(&robot, &q, limits.clone());
            for tick in 0..50 {
                let left = forward([0.5 + 0.004 * f64::from(tick), 0.25, 0.9], [0.0; 3]);
                let arrival: Arrival = targets(&left).into_iter().collect();
                session.advance(Some(arrival), &mut Unattended).unwrap();
            }
            session.q().to_vec()
        };
        assert_eq!(run(), run());
    }
}
