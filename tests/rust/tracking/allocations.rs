//! Real-time loops: a tracker allocates nothing, whatever its options and targets.

#![allow(unsafe_code, reason = "an allocator is an unsafe trait")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::math::Frame;
use ikcore::obstacle::Surroundings;
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::Unattended;
use ikcore::task::{Goal, Target};
use ikcore::tracking::{Arrival, OneEuro, Session, TargetFilter, TrackOptions};

/// System allocator with a counter for each thread.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: both calls are passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const START: [f64; 7] = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];

/// Number of ticks: a million in a release build, fewer in slow debug builds.
const TICKS: usize = if cfg!(debug_assertions) { 100_000 } else { 1_000_000 };

#[test]
fn a_step_allocates_nothing() {
    count_allocations(&Robot::named("panda").unwrap(), Surroundings::default(), f64::INFINITY, TICKS);
}

#[test]
fn a_step_within_torque_limits_allocates_nothing() {
    count_allocations(&Robot::named("panda").unwrap(), Surroundings::default(), 0.4, TICKS / 10);
}

#[test]
fn a_step_among_obstacles_allocates_nothing() {
    let arm = Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap();
    let tip = arm.tip(&START).origin;
    let boxes = [[0.0, 0.3, 0.0], [0.0, -0.2, 0.3], [0.3, 0.0, 0.0]].map(|away: [f64; 3]| {
        let center = std::array::from_fn(|k| tip[k] + away[k]);
        Shape::cuboid(center, [0.1, 0.2, 0.2], None).unwrap()
    });
    let surroundings = Surroundings { obstacles: Some((&boxes).into()), margin: Some(0.01), self_collision: None };
    count_allocations(&arm, surroundings, f64::INFINITY, TICKS / 20);
}

/// Drives an arm with every option on, within a part of the torque limits of its maker; the scratch grows in the first tenth of the ticks.
fn count_allocations(arm: &Robot, surroundings: Surroundings, part: f64, ticks: usize) {
    let wave = Sinusoid { mean: 1.2, amplitude: 0.5, angular_frequency: 2.0, phase: 0.0 };
    let torques = arm.joints().iter().map(|joint| part * joint.rated_torque).collect();
    let limits = Limits::of(arm)
        .with_torque_limit(torques)
        .unwrap()
        .replace(Field::Velocity, vec![Profile::Sinusoid(wave)])
        .and_then(|limits| limits.replace(Field::Acceleration, vec![Profile::Constant(5.0)]))
        .and_then(|limits| limits.replace(Field::Jerk, vec![Profile::Constant(80.0)]))
        .unwrap();
    let options = TrackOptions {
        limits: Some(limits),
        goals: vec![Goal::Centring { weight: 0.1 }],
        target_filter: Some(TargetFilter::OneEuro(OneEuro { min_cutoff: 5.0, beta: 5.0 })),
        timeout: Some(0.2),
        surroundings,
        ..TrackOptions::default()
    };
    let mut session = Session::new(arm, &START, 0.001, &options).unwrap();
    let tip = arm.tip(&START);
    let mut draws = rng::stream(2, 0);
    let mut step = |tick: usize, session: &mut Session| {
        let mut origin = tip.origin.map(|x| x + 1e-3 * draws.uniform_in(-1.0, 1.0));
        // Jumps, targets out of reach, and pauses that end in a stop.
        origin[1] += [0.0, 0.2, 3.0, -0.1][(tick / 500) % 4];
        let target = Target::Pose(Frame { origin, ..tip });
        let arrives = tick.is_multiple_of(5) && (tick / 2500) % 3 != 2;
        let stamp = Some((session.time() - 0.02).max(0.0));
        let arrival = arrives.then(|| Arrival { stamp, ..target.into() });
        session.advance(arrival, &mut Unattended).unwrap();
    };
    let first = if options.surroundings == Surroundings::default() { 1 } else { ticks / 10 };
    (0..first).for_each(|tick| step(tick, &mut session));
    let before = ALLOCATIONS.with(Cell::get);
    for tick in first..ticks {
        step(tick, &mut session);
    }
    assert_eq!(ALLOCATIONS.with(Cell::get) - before, 0);
}
