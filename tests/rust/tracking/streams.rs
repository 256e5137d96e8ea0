//! Tracking under acceleration and jerk limits: limits kept, noise, streams and stops.

use crate::common::{hostile, robot};
use ikcore::limits::{Field, LimitAt, Limits, Profile, Sinusoid};
use ikcore::math::Frame;
use ikcore::math::so3::{norm, rotated, rotation_between};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::task::{Target, Twist};
use ikcore::tracking::{Arrival, Idle, LowPass, OneEuro, Session, TargetFilter, TrackOptions};

const START: [f64; 7] = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];

/// Commands of a session, for finite differences.
struct Commands {
    q: Vec<Vec<f64>>,
    dt: f64,
}

impl Commands {
    /// Largest velocity, acceleration and jerk.
    fn largest(&self) -> [f64; 3] {
        let difference = |rows: &[Vec<f64>]| -> Vec<Vec<f64>> {
            rows.windows(2).map(|two| two[1].iter().zip(&two[0]).map(|(b, a)| (b - a) / self.dt).collect()).collect()
        };
        let largest = |rows: &[Vec<f64>]| rows.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let velocities = difference(&self.q);
        let accelerations = difference(&velocities);
        [largest(&velocities), largest(&accelerations), largest(&difference(&accelerations))]
    }

    /// Root mean square of the accelerations from row `first` on.
    fn shaking(&self, first: usize) -> f64 {
        let second = |rows: &[Vec<f64>], j: usize| (rows[2][j] - 2.0 * rows[1][j] + rows[0][j]) / self.dt.powi(2);
        let squares: Vec<f64> =
            self.q[first..].windows(3).flat_map(|rows| (0..rows[0].len()).map(|j| second(rows, j).powi(2))).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }
}

fn limits(arm: &Robot, fields: &[(Field, f64)]) -> Limits {
    fields.iter().fold(Limits::of(arm), |limits, (field, value)| {
        limits.replace(*field, vec![Profile::Constant(*value)]).unwrap()
    })
}

/// Limits of 1.5 rad/s, 5 rad/s^2 and, if it is finite, this jerk.
fn moderate(arm: &Robot, jerk: f64) -> Limits {
    limits(arm, &[(Field::Velocity, 1.5), (Field::Acceleration, 5.0), (Field::Jerk, jerk)])
}

fn session(arm: &Robot, limits: Limits, dt: f64) -> Session {
    Session::new(arm, &START, dt, &TrackOptions { limits: Some(limits), ..TrackOptions::default() }).unwrap()
}

fn normal(draws: &mut LazyRng) -> f64 {
    (0..12).map(|_| draws.uniform_in(-0.5, 0.5)).sum()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Settling time of a Panda after a jump of 0.2 m of a target with `noise` (m), and its commands.
fn settle(noise: f64, jerk: f64, dt: f64) -> (f64, Commands) {
    let arm = robot("panda");
    let mut session = session(&arm, moderate(&arm, jerk), dt);
    let from = arm.tip_position(&START);
    let goal = [from[0] - 0.1, from[1] + 0.15, from[2] - 0.0866];
    let (mut draws, mut settled) = (rng::stream(5, 0), 0.0);
    let mut commands = Commands { q: vec![START.to_vec(); 3], dt };
    for tick in 1..=(4.0 / dt) as usize {
        let target = goal.map(|x| x + noise * normal(&mut draws));
        let step = session.step(&Target::Position(target), &mut Unattended).unwrap();
        assert!(step.inside_limits);
        commands.q.push(session.q().to_vec());
        if distance(arm.tip_position(session.q()), goal) > 2e-3_f64.max(3.0 * noise) {
            settled = tick as f64 * dt;
        }
    }
    (settled, commands)
}

#[test]
fn noise_neither_delays_nor_shakes() {
    for jerk in [f64::INFINITY, 50.0] {
        for dt in [0.002, 0.01] {
            let (alone, _) = settle(0.0, jerk, dt);
            for noise in [1e-6, 1e-5, 1e-4, 1e-3] {
                let (settled, commands) = settle(noise, jerk, dt);
                let name = format!("noise {noise} jerk {jerk} dt {dt}");
                assert!(settled <= 1.3 * alone, "{name}: {settled} s against {alone} s");
                let shaking = commands.shaking(commands.q.len() / 2);
                assert!(shaking < 0.1, "{name}: {shaking} rad/s^2");
                let [velocity, acceleration, largest_jerk] = commands.largest();
                assert!(velocity <= 1.5 && acceleration <= 5.0 && largest_jerk <= jerk, "{name}: {largest_jerk}");
            }
        }
    }
}

#[test]
fn noise_leaves_the_self_motion_at_rest() {
    let arm = robot("panda");
    let mut rng = rng::stream(9, 0);
    for trial in 0..12 {
        let start: Vec<f64> = START.iter().map(|q| q + rng.uniform_in(-0.5, 0.5)).collect();
        let goal: Vec<f64> = start.iter().map(|q| q + rng.uniform_in(-0.3, 0.3)).collect();
        let (goal, noise, dt) = (arm.tip(&goal), 5e-3, if trial % 2 == 0 { 0.001 } else { 0.005 });
        let options = TrackOptions { limits: Some(moderate(&arm, f64::INFINITY)), ..TrackOptions::default() };
        let mut session = Session::new(&arm, &start, dt, &options).unwrap();
        for tick in 0..(4.0 / dt) as usize {
            let mut draw = || noise * normal(&mut rng);
            let turn = [draw(), draw(), draw()];
            let axes = goal.axes.map(|axis| rotated(&axis, &turn));
            let target = Target::Pose(Frame { axes, origin: goal.origin.map(|x| x + draw()) });
            session.step(&target, &mut Unattended).unwrap();
            if tick as f64 * dt > 2.5 {
                let away = distance(arm.tip_position(session.q()), goal.origin);
                let fastest = session.qd().iter().fold(0.0_f64, |most, qd| most.max(qd.abs()));
                assert!(away < 3.0 * noise && fastest < 0.3, "trial {trial} tick {tick}: {away} m, {fastest} rad/s");
            }
        }
    }
}

#[test]
fn a_smooth_target_is_followed_without_lag() {
    let arm = robot("panda");
    for (jerk, most) in [(f64::INFINITY, 1e-8), (200.0, 1e-7), (50.0, 1e-7)] {
        let mut session = session(&arm, moderate(&arm, jerk), 0.002);
        let from = arm.tip_position(&START);
        for tick in 1..2000 {
            let angle = 0.002 * f64::from(tick);
            let goal = [from[0] + 0.1 * (angle.cos() - 1.0), from[1] + 0.1 * angle.sin(), from[2]];
            let step = session.step(&Target::Position(goal), &mut Unattended).unwrap();
            let error = step.error.position;
            assert!(tick < 1000 || error < most, "jerk {jerk} tick {tick}: {error}");
        }
    }
}

#[test]
fn a_falling_velocity_limit_is_braked_for() {
    let arm = robot("panda");
    let wave = Sinusoid { mean: 0.8, amplitude: 0.7, angular_frequency: 9.0, phase: 0.0 };
    let falling = moderate(&arm, 80.0).replace(Field::Velocity, vec![Profile::Sinusoid(wave)]).unwrap();
    let dt = 0.004;
    let mut session = session(&arm, falling, dt);
    let from = arm.tip_position(&START);
    let mut before = START.to_vec();
    for tick in 0..1500 {
        // The target jumps to and fro, so that the arm is as fast as it may be.
        let side = if (tick / 150) % 2 == 0 { 0.25 } else { -0.25 };
        session.step(&Target::Position([from[0] - 0.1, from[1] + side, from[2]]), &mut Unattended).unwrap();
        let begin = dt * f64::from(tick);
        let limit = Profile::Sinusoid(wave).smallest(begin, begin + dt).1;
        for (q, before) in session.q().iter().zip(&before) {
            let velocity = (q - before).abs() / dt;
            assert!(velocity <= limit * (1.0 + 1e-9), "tick {tick}: {velocity} > {limit}");
        }
        before = session.q().to_vec();
    }
}

#[test]
fn no_target_makes_the_arm_break_a_limit_and_it_can_always_stop() {
    let arm = robot("panda");
    let mut draws = rng::stream(11, 0);
    for run in 0..25 {
        let (dt, jerk) = ([0.001, 0.004, 0.02][run % 3], [f64::INFINITY, 40.0, 400.0, 8.0][run % 4]);
        let mut session = session(&arm, moderate(&arm, jerk), dt);
        let from = arm.tip_position(&START);
        let mut commands = Commands { q: vec![START.to_vec(); 3], dt };
        let length = 200 + 37 * run;
        for tick in 0..length {
            let target = hostile(run % 5, tick, from, &mut draws);
            let arrival = Arrival::from(Target::Position(target));
            let arrival = (tick % 13 != 5).then_some(arrival);
            let step = session.advance(arrival, &mut Unattended).unwrap();
            assert!(step.inside_limits, "run {run} tick {tick}");
            commands.q.push(session.q().to_vec());
        }
        let time = session.stop();
        for _ in 0..(time / dt).round() as usize {
            session.advance(None, &mut Unattended).unwrap();
            commands.q.push(session.q().to_vec());
        }
        session.advance(None, &mut Unattended).unwrap();
        assert!(session.qd().iter().all(|velocity| velocity.abs() < 1e-9), "run {run}: {:?}", session.qd());
        let [velocity, acceleration, largest_jerk] = commands.largest();
        assert!(velocity <= 1.5 * (1.0 + 1e-9) && acceleration <= 5.0 && largest_jerk <= jerk, "run {run}");
        for (j, joint) in arm.joints().iter().enumerate() {
            assert!(commands.q.iter().all(|q| joint.lower <= q[j] && q[j] <= joint.upper), "run {run}: {}", joint.name);
        }
    }
}

#[test]
fn a_stop_takes_the_time_that_it_names() {
    let arm = robot("panda");
    let mut session = session(&arm, moderate(&arm, 50.0), 0.002);
    assert_eq!(session.stop(), 0.0);
    for _ in 0..100 {
        session.step(&Target::Position([0.2, 0.5, 0.5]), &mut Unattended).unwrap();
    }
    let fastest = session.qd().iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let time = session.stop();
    assert!(time >= fastest / 5.0 && time <= fastest / 5.0 + 0.25, "{time} s from {fastest} rad/s");
    for _ in 0..(time / 0.002).round() as usize - 1 {
        session.advance(None, &mut Unattended).unwrap();
    }
    assert!(session.qd().iter().any(|velocity| velocity.abs() > 1e-6), "not before");
    session.advance(None, &mut Unattended).unwrap();
    let there = session.q().to_vec();
    session.advance(None, &mut Unattended).unwrap();
    assert!(session.q().iter().zip(&there).all(|(q, there)| (q - there).abs() < 1e-12));
}

#[test]
fn without_targets_the_arm_stops_after_the_timeout() {
    let arm = robot("panda");
    let limits = moderate(&arm, 50.0);
    let options = TrackOptions { limits: Some(limits), timeout: Some(0.1), ..TrackOptions::default() };
    let mut session = Session::new(&arm, &START, 0.002, &options).unwrap();
    for _ in 0..60 {
        session.step(&Target::Position([0.2, 0.5, 0.5]), &mut Unattended).unwrap();
    }
    let speed = |session: &Session| session.qd().iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    for _ in 0..49 {
        session.advance(None, &mut Unattended).unwrap();
    }
    assert!(speed(&session) > 0.3, "it goes on towards the last target");
    for _ in 0..250 {
        session.advance(None, &mut Unattended).unwrap();
    }
    assert!(speed(&session) < 1e-12, "{}", speed(&session));
    session.step(&Target::Position([0.2, 0.5, 0.5]), &mut Unattended).unwrap();
    assert!(speed(&session) > 0.0, "a target ends the stop");
}

#[test]
fn an_arm_without_a_target_says_so() {
    let arm = robot("panda");
    let options = TrackOptions { limits: Some(moderate(&arm, 50.0)), timeout: Some(0.1), ..TrackOptions::default() };
    let mut session = Session::new(&arm, &START, 0.01, &options).unwrap();
    let said = |session: &mut Session, ticks: usize| {
        let steps = (0..ticks).map(|_| session.advance(None, &mut Unattended).unwrap());
        let last = steps.last().unwrap();
        (last.idle, last.message().to_string())
    };
    let waits = "no target yet: the arm comes to rest and waits for one";
    assert_eq!(said(&mut session, 1), (Some(Idle::NoTarget), waits.into()));
    assert_eq!(said(&mut session, 30), (Some(Idle::NoTarget), waits.into()), "a timeout before the first target");
    let target = Target::Position([0.2, 0.5, 0.5]);
    let step = session.step(&target, &mut Unattended).unwrap();
    assert_eq!(step.idle, None);
    let (idle, late) = said(&mut session, 100);
    assert_eq!(idle, Some(Idle::TimedOut(0.1)));
    assert!(late.starts_with("no target for 0.1000 s, ") && !late.contains("NaN"), "{late}");
    assert!(late.ends_with(" m away from the last target: the arm comes to rest and waits for the next one"), "{late}");
    session.step(&target, &mut Unattended).unwrap();
    session.stop();
    let (idle, stopped) = said(&mut session, 100);
    assert_eq!(idle, Some(Idle::Stopped));
    assert!(stopped.starts_with("stopped by stop(), "), "{stopped}");
    assert!(stopped.ends_with(" m away from the last target: the next target makes it go on"), "{stopped}");
    session.reset(&START, None, None).unwrap();
    session.stop();
    assert_eq!(said(&mut session, 1).1, "stopped by stop(): the next target makes it go on");
}

#[test]
fn rare_late_targets_are_followed_smoothly() {
    let arm = robot("panda");
    let (dt, latency) = (0.002, 0.05);
    let mut session = session(&arm, moderate(&arm, 100.0), dt);
    let from = arm.tip_position(&START);
    let path = |time: f64| [from[0], from[1] + 0.15 * (1.2 * time).sin(), from[2] - 0.05 * (1.2 * time).cos()];
    let (mut worst, mut commands) = (0.0_f64, Commands { q: vec![], dt });
    for tick in 1..2500 {
        let now = dt * f64::from(tick);
        // 62.5 Hz, 50 ms late.
        let stamp = (tick % 8 == 0 && now > latency).then_some(now - latency);
        let arrival = stamp.map(|stamp| Arrival { stamp: Some(stamp), ..Target::Position(path(stamp)).into() });
        session.advance(arrival, &mut Unattended).unwrap();
        if tick > 1000 {
            worst = worst.max(distance(arm.tip_position(session.q()), path(now)));
            commands.q.push(session.q().to_vec());
        }
    }
    // Without extrapolation it would lag by 9 mm.
    assert!(worst < 5e-4, "{worst}");
    assert!(commands.largest()[1] < 1.0, "{:?}", commands.largest());
}

/// Root mean square error (m) behind a circle whose position comes every 8 ticks with `noise` (m). Between, the loop repeats
/// the last target if it is `held`, and has none otherwise.
fn stream_error(noise: f64, jerk: f64, held: bool) -> f64 {
    let arm = robot("panda");
    let mut session = session(&arm, moderate(&arm, jerk), 0.002);
    let from = arm.tip_position(&START);
    let path = |tick: i32| {
        let angle = 0.002 * 1.57 * f64::from(tick);
        [from[0], from[1] + 0.08 * angle.sin(), from[2] + 0.08 * (1.0 - angle.cos())]
    };
    let (mut draws, mut sum, mut last) = (rng::stream(7, 0), 0.0, from);
    for tick in 1..=4000 {
        let arrives = tick % 8 == 0;
        if arrives {
            last = path(tick).map(|x| x + noise * normal(&mut draws));
        }
        let arrival = Arrival::from(Target::Position(last));
        session.advance((arrives || held).then_some(arrival), &mut Unattended).unwrap();
        if tick > 2000 {
            sum += distance(arm.tip_position(session.q()), path(tick)).powi(2) / 2000.0;
        }
    }
    sum.sqrt()
}

#[test]
fn slow_streams_are_followed_whether_the_loop_repeats_targets_or_not() {
    for jerk in [f64::INFINITY, 50.0] {
        for held in [false, true] {
            let error = stream_error(0.0, jerk, held);
            assert!(error < 1e-4, "jerk {jerk} held {held}: {error}");
            let error = stream_error(1e-3, jerk, held);
            assert!(error < 6e-3, "noise, jerk {jerk} held {held}: {error}");
        }
    }
}

#[test]
fn a_target_that_is_no_number_leaves_the_tracker_usable() {
    let arm = robot("panda");
    let [mut spoiled, mut clean] = [(); 2].map(|()| session(&arm, moderate(&arm, 50.0), 0.002));
    for _ in 0..50 {
        let target = Target::Position([0.3, 0.4, 0.5]);
        assert!(spoiled.step(&Target::Position([f64::NAN, 0.0, 0.5]), &mut Unattended).is_err());
        spoiled.step(&target, &mut Unattended).unwrap();
        clean.step(&target, &mut Unattended).unwrap();
        assert_eq!(spoiled.q(), clean.q());
    }
}

#[test]
fn a_reset_in_motion_goes_on_from_there() {
    let arm = robot("panda");
    let mut session = session(&arm, moderate(&arm, 50.0), 0.002);
    let (qd, qdd) = ([0.4, 0.0, 0.0, -0.2, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    session.reset(&START, Some(&qd), Some(&qdd)).unwrap();
    assert!(session.qd().iter().zip(&qd).all(|(a, b)| (a - b).abs() < 1e-12));
    session.step(&Target::Position([0.3, 0.4, 0.5]), &mut Unattended).unwrap();
    let changes = session.qd().iter().zip(&qd).map(|(a, b)| (a - b) / 0.002).collect::<Vec<_>>();
    assert!(changes.iter().zip(&qdd).all(|(a, b)| (a - b).abs() <= 50.0 * 0.002), "{changes:?}");

    let error = session.reset(&START, Some(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.6]), None).unwrap_err().to_string();
    let says = "joint 'panda_joint7' at 0.8000 with velocity 1.600 and acceleration 0 cannot stop inside its limits; start \
                slower or farther inside";
    assert!(error.ends_with(&says["joint 'panda_joint7'".len()..]), "{error}");
    let mut near_its_limit = START;
    near_its_limit[6] = 2.85;
    assert!(session.reset(&near_its_limit, Some(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), None).is_err());
    assert!(session.reset(&near_its_limit, Some(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]), None).is_ok());
}

#[test]
fn stamps_may_be_closer_than_ticks() {
    let arm = robot("panda");
    let mut session = session(&arm, moderate(&arm, 50.0), 0.01);
    let (from, mut draws) = (arm.tip_position(&START), rng::stream(9, 0));
    for tick in 1..400 {
        let stamp = 0.002 * f64::from(tick);
        let target = [from[0], from[1] + 0.1 * stamp.sin() + 1e-4 * normal(&mut draws), from[2]];
        let arrival = Arrival { stamp: Some(stamp), ..Target::Position(target).into() };
        assert!(session.advance(Some(arrival), &mut Unattended).unwrap().inside_limits);
    }
    assert!(distance(arm.tip_position(session.q()), from) < 0.12);
}

#[test]
fn stamps_are_checked() {
    let arm = robot("panda");
    let target = Target::Position([0.3, 0.4, 0.5]);
    let stamped = |stamp: f64| Some(Arrival { stamp: Some(stamp), ..target.into() });
    let mut limited = session(&arm, moderate(&arm, 50.0), 0.01);
    let error = limited.advance(stamped(0.5), &mut Unattended).unwrap_err().to_string();
    let clock = "the clock of the tracker (its time advances by dt in each step; leave stamp out, or give the time of \
                 measurement on this clock)";
    assert_eq!(error, format!("stamp must be at most 0.01, the end of the tick (s) on {clock}, got 0.5"));
    assert!(limited.advance(stamped(f64::NAN), &mut Unattended).is_err());
    limited.advance(stamped(0.005), &mut Unattended).unwrap();
    let mut free = session(&arm, limits(&arm, &[]), 0.01);
    let error = free.advance(stamped(0.0), &mut Unattended).unwrap_err().to_string();
    assert_eq!(
        error,
        "a stamp is used by the library's own rule under acceleration or jerk limits; give such limits, or leave stamp out"
    );
}

/// Lag (s) of the tip behind a target that moves and turns steadily, for positions and rotations.
fn delay(filter: TargetFilter, speed: f64) -> [f64; 2] {
    let arm = robot("panda");
    let limits = limits(&arm, &[(Field::Velocity, 3.0), (Field::Acceleration, 40.0)]);
    let options = TrackOptions { limits: Some(limits), target_filter: Some(filter), ..TrackOptions::default() };
    let mut session = Session::new(&arm, &START, 0.001, &options).unwrap();
    let begin = arm.tip(&START);
    let twist = Twist { linear: [0.0, speed, 0.0], angular: [0.0, 0.0, speed] };
    let mut error = [0.0; 2];
    for tick in 1..1500 {
        let target = Target::Pose(begin).moved(&twist, 0.001 * f64::from(tick));
        session.step(&target, &mut Unattended).unwrap();
        let Target::Pose(exact) = target else { panic!("a pose stays a pose") };
        let tip = arm.tip(session.q());
        error = [distance(tip.origin, exact.origin), norm(&rotation_between(&exact, &tip))];
    }
    error.map(|error| error / speed)
}

#[test]
fn filters_delay_as_documented() {
    let tau = std::f64::consts::TAU;
    for (filter, speed, expected) in [
        (TargetFilter::LowPass(LowPass { cutoff: 5.0 }), 0.1, 1.0 / (tau * 5.0)),
        (TargetFilter::OneEuro(OneEuro { min_cutoff: 2.0, beta: 20.0 }), 0.1, 1.0 / (tau * 4.0)),
    ] {
        let found = delay(filter, speed);
        assert!(found.iter().all(|delay| (delay - expected).abs() < 0.05 * expected), "{found:?} {expected}");
    }
}

#[test]
fn settings_of_filters_are_checked() {
    let arm = robot("panda");
    let bad = TargetFilter::OneEuro(OneEuro { min_cutoff: 1.0, beta: -1.0 });
    let options = TrackOptions { target_filter: Some(bad), limit_at: LimitAt::Start, ..TrackOptions::default() };
    let error = Session::new(&arm, &START, 0.01, &options).unwrap_err().to_string();
    assert_eq!(error, "beta must be at least 0, got -1");
}
