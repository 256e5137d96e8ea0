//! Fastest timing of joint paths under jerk limits: known optima, limits at every instant, looser limits.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::motion::{ArmState, state_to_state};
use ikcore::planning::{ConstantLimits, JointPath, SplineEnds, TimingOptions, time_optimal};
use ikcore::trajectory::Trajectory;
use proptest::prelude::*;

use crate::common::drawn;

const FIELDS: [Field; 3] = [Field::Velocity, Field::Acceleration, Field::Jerk];

fn names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("q{i}")).collect()
}

/// The same limits on velocity, acceleration and jerk for all joints.
fn limits(joints: usize, values: [f64; 3]) -> Limits {
    FIELDS.into_iter().zip(values).fold(Limits::none(names(joints)), |limits, (field, value)| {
        limits.replace(field, vec![Profile::Constant(value)]).unwrap()
    })
}

fn timed(path: &JointPath, values: [f64; 3]) -> Trajectory {
    let limits = ConstantLimits::new(&limits(path.joints().len(), values), "time_optimal").unwrap();
    time_optimal(path, &limits, &TimingOptions::default()).unwrap()
}

fn spline(joints: usize, waypoints: &[f64], ends: SplineEnds) -> JointPath {
    JointPath::spline(names(joints), waypoints, None, ends).unwrap()
}

/// The largest use of a limit on velocity, acceleration or jerk, as a fraction of it.
fn used(motion: &Trajectory, limits: [f64; 3]) -> f64 {
    let reached = [motion.max_velocity(), motion.max_acceleration(), motion.max_jerk()];
    let parts = reached.iter().zip(limits).flat_map(|(of, limit)| of.iter().map(move |value| value / limit));
    parts.fold(0.0, f64::max)
}

#[test]
fn a_line_takes_the_time_of_the_motion_between_its_ends() {
    let values = [0.1, 0.5, 1.0, 2.0, 10.0, 1000.0];
    for velocity in values {
        for acceleration in values {
            for jerk in values {
                let rates = [velocity, acceleration, jerk];
                let [from, to] = [[0.0], [1.0]].map(|q| ArmState::at_rest(&q));
                let shortest = state_to_state(&from, &to, &limits(1, rates)).unwrap().duration();
                let motion = timed(&spline(1, &[0.0, 1.0], SplineEnds::Natural), rates);
                let cost = motion.duration() / shortest;
                assert!((1.0 - 1e-9..1.006).contains(&cost), "{cost} at {rates:?}");
                assert!(used(&motion, rates) <= 1.0 + 1e-9, "{rates:?}");
            }
        }
    }
}

#[test]
fn a_clamped_spline_is_about_as_fast_as_its_line() {
    let of = |ends| timed(&spline(1, &[0.0, 2.0], ends), [1.0, 2.0, 10.0]).duration();
    let cost = of(SplineEnds::Clamped) / of(SplineEnds::Natural);
    assert!((0.99..1.02).contains(&cost), "{cost}");
}

#[test]
fn limits_that_are_hardly_felt_cost_hardly_any_time() {
    let path = spline(2, &[0.0, 0.3, 1.0, -0.5, -0.5, 0.8, 0.7, 1.5], SplineEnds::Natural);
    let fastest = timed(&path, [2.0, 10.0, f64::INFINITY]).duration();
    for jerk in [1e4, 1e6, 1e9, 1e15] {
        let cost = timed(&path, [2.0, 10.0, jerk]).duration() / fastest;
        assert!((1.0 - 1e-3..1.01).contains(&cost), "{cost} at {jerk}");
    }
}

#[test]
fn a_path_with_thousands_of_points_is_as_fast_as_with_few() {
    let through = |points: u32| {
        let at = |i: u32| f64::from(i) / f64::from(points - 1);
        let rows: Vec<f64> = (0..points).flat_map(|i| [(7.0 * at(i)).sin(), (5.0 * at(i)).cos()]).collect();
        timed(&spline(2, &rows, SplineEnds::NotAKnot), [2.0, 8.0, 80.0]).duration()
    };
    let cost = through(3000) / through(40);
    assert!((0.99..1.01).contains(&cost), "{cost}");
}

#[test]
fn units_do_not_matter() {
    let of = |scale: f64, per_second: f64| {
        let rows = [0.0, 0.3, 1.0, -0.5, -0.5, 0.8, 0.7, 1.5].map(|q| scale * q);
        let rates = [2.0 * per_second, 10.0 * per_second.powi(2), 80.0 * per_second.powi(3)];
        timed(&spline(2, &rows, SplineEnds::Natural), rates.map(|rate| scale * rate)).duration() * per_second
    };
    let expected = of(1.0, 1.0);
    for (scale, per_second) in [(1e-9, 1.0), (1e6, 1.0), (1.0, 1e-4), (1.0, 1e5), (1e-3, 1e3)] {
        let cost = of(scale, per_second) / expected;
        assert!((cost - 1.0).abs() < 1e-6, "{cost} at {scale}, {per_second}");
    }
}

/// A limit: often a round number.
fn rate() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), Just(10.0), Just(0.1), 0.1..20.0_f64]
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), -2.0..2.0_f64]
}

proptest! {
    #![proptest_config(drawn(80))]

    #[test]
    fn limits_and_path_are_kept_and_looser_limits_cost_no_time(
        rows in prop::collection::vec(coordinate(), 6..24),
        rates in [rate(), rate(), rate()],
        ends in prop_oneof![Just(SplineEnds::Natural), Just(SplineEnds::NotAKnot), Just(SplineEnds::Clamped)],
        looser in [prop_oneof![Just(1.0), 1.0..4.0_f64], prop_oneof![Just(1.0), 1.0..4.0_f64], prop_oneof![Just(1.0), 1.0..4.0_f64]],
    ) {
        let mut rows: Vec<f64> = rows[..rows.len() / 2 * 2].to_vec();
        // Consecutive points differ.
        rows.iter_mut().step_by(2).enumerate().for_each(|(i, q)| *q += 0.01 * i as f64);
        let Ok(path) = JointPath::spline(names(2), &rows, None, ends) else { return Ok(()) };
        let motion = timed(&path, rates);
        prop_assert!(used(&motion, rates) <= 1.0 + 1e-9);
        prop_assert!((used(&motion, rates) - 1.0).abs() < 1e-2, "some limit is reached: {}", used(&motion, rates));
        let wider: [f64; 3] = std::array::from_fn(|i| rates[i] * looser[i]);
        let faster = timed(&path, wider).duration();
        prop_assert!(faster <= 1.02 * motion.duration(), "{faster} after {}", motion.duration());
        // Among points of the path that are close together, one is near each point of the motion.
        let mut positions = vec![];
        let end = path.breaks()[path.pieces()];
        for i in 0..=20_000 {
            let mut q = [0.0; 2];
            path.position(end * f64::from(i) / 20_000.0, &mut q);
            positions.push(q);
        }
        let apart = positions.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).fold(0.0, f64::max);
        for i in 0..=300 {
            let [mut q, mut qd, mut qdd] = [[0.0; 2]; 3];
            motion.at(motion.duration() * f64::from(i) / 300.0, &mut q, &mut qd, &mut qdd).unwrap();
            let off = positions.iter().map(|p| (p[0] - q[0]).hypot(p[1] - q[1])).fold(f64::INFINITY, f64::min);
            prop_assert!(off <= 0.5 * apart + 1e-6, "{off}");
        }
    }
}
