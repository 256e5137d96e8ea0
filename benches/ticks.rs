//! Times of a million ticks of a tracker: median, 99.99th percentile and largest, in ns.
//!
//! Under limits of each order and of torques, with targets that jump every half second and have 1 mm of noise. A mean says nothing about a control
//! loop; the largest time is mostly that of the operating system.

use std::time::Instant;

use ikcore::limits::{Field, Limits, Profile};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::task::Target;
use ikcore::tracking::{Session, TrackOptions};

const TICKS: usize = 1_000_000;
const START: [f64; 7] = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];

fn main() {
    let arm = Robot::named("panda").expect("a built-in robot");
    let constant = |value: f64| vec![Profile::Constant(value)];
    let velocity = Limits::of(&arm).replace(Field::Velocity, constant(1.5)).expect("limits");
    let acceleration = velocity.clone().replace(Field::Acceleration, constant(5.0)).expect("limits");
    let jerk = acceleration.clone().replace(Field::Jerk, constant(50.0)).expect("limits");
    let torques: Vec<f64> = arm.joints().iter().map(|joint| 0.6 * joint.rated_torque).collect();
    let hard = velocity.clone().replace(Field::Acceleration, constant(15.0)).expect("limits");
    let torque = hard.with_torque_limit(torques).expect("limits");
    println!("{:>14} {:>8} {:>8} {:>8} {:>8}", "limits up to", "noise", "p50", "p99.99", "max");
    for (name, limits) in [("velocity", velocity), ("acceleration", acceleration), ("jerk", jerk), ("torque", torque)] {
        for noise in [0.0, 1e-3] {
            let times = times(&arm, &limits, noise);
            let at = |fraction: f64| times[((TICKS - 1) as f64 * fraction) as usize];
            println!("{name:>14} {noise:>8} {:>8} {:>8} {:>8}", at(0.5), at(0.9999), at(1.0));
        }
    }
}

/// Times of all ticks, sorted (ns).
#[allow(clippy::disallowed_methods)] // The library itself reads clocks only in `solver/stopwatch.rs`.
fn times(arm: &Robot, limits: &Limits, noise: f64) -> Vec<u128> {
    let options = TrackOptions { limits: Some(limits.clone()), ..TrackOptions::default() };
    let mut session = Session::new(arm, &START, 0.001, &options).expect("a session");
    let tip = arm.tip_position(&START);
    let mut draws = rng::stream(0, 0);
    let mut times = Vec::with_capacity(TICKS);
    for tick in 0..TICKS {
        let side = if (tick / 500) % 2 == 0 { 0.1 } else { -0.1 };
        let mut target = tip.map(|x| x + noise * draws.normal_pair()[0]);
        target[1] += side;
        let watch = Instant::now();
        session.step(&Target::Position(target), &mut Unattended).expect("a step");
        times.push(watch.elapsed().as_nanos());
    }
    times.sort_unstable();
    times
}
