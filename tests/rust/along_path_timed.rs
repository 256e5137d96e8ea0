//! Redundancy and timing together: how much faster than in uniform time, and that every limit is kept.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ikcore::limits::{Field, Limits, Profile};
use ikcore::path::Reference;
use ikcore::planning::{AlongPathOptions, Plan, plan_along_path};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};

const INTERVALS: usize = 50;

/// Corners of a pentagram about (1, 1) with straight edges between, the first one up.
fn pentagram(u: f64) -> [f64; 3] {
    let corner = |k: usize| {
        let angle = FRAC_PI_2 + TAU * (2 * k) as f64 / 5.0;
        [1.0 + 0.5 * angle.cos(), 1.0 + 0.5 * angle.sin()]
    };
    let edge = ((5.0 * u) as usize).min(4);
    let share = 5.0 * u - edge as f64;
    let (from, to) = (corner(edge), corner(edge + 1));
    [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]), 0.0]
}

/// r = 1 + 0.35 cos 3t about (1, 1), scaled to a largest radius of 0.6.
fn trefoil(u: f64) -> [f64; 3] {
    let t = TAU * u;
    let r = 0.6 / 1.35 * (1.0 + 0.35 * (3.0 * t).cos());
    [1.0 + r * t.cos(), 1.0 + r * t.sin(), 0.0]
}

fn plan(curve: fn(f64) -> [f64; 3], seed: u64) -> Plan {
    let robot = Robot::planar(&[1.0; 3]).unwrap();
    let points = (0..=INTERVALS).map(|i| curve(i as f64 / INTERVALS as f64)).collect();
    let path = Reference::new(1.0, points, None).unwrap();
    let constant = |value: f64| vec![Profile::Constant(value)];
    let limits = Limits::of(&robot)
        .replace(Field::Lower, constant(f64::NEG_INFINITY))
        .and_then(|limits| limits.replace(Field::Upper, constant(f64::INFINITY)))
        .and_then(|limits| limits.replace(Field::Velocity, constant(PI)))
        .and_then(|limits| limits.replace(Field::Acceleration, constant(4.0 * PI)))
        .unwrap();
    let options = AlongPathOptions { limits: Some(limits), seed, ..AlongPathOptions::default() };
    plan_along_path(&robot, &path, &options, &mut Unattended).unwrap()
}

#[test]
fn faster_than_the_optimum_in_uniform_time_by_what_was_measured() {
    // Durations of the optimum in uniform time, found by long searches, and the factor that must be beaten.
    for (curve, uniform, factor) in [(pentagram as fn(f64) -> [f64; 3], 5.501, 1.9), (trefoil, 3.234, 1.35)] {
        for seed in 0..3 {
            let plan = plan(curve, seed);
            assert_eq!(plan.status, Status::Solved, "{}", plan.message());
            assert!(plan.violations.is_empty());
            assert!(uniform / plan.cost >= factor, "seed {seed}: {} s", plan.cost);
            assert!(plan.trajectory.max_velocity().iter().all(|v| *v <= PI * (1.0 + 1e-9)));
            assert!(plan.trajectory.max_acceleration().iter().all(|a| *a <= 4.0 * PI * (1.0 + 1e-9)));
        }
    }
}
