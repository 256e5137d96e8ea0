//! Motions that may leave their path by a tolerance: inside it at every instant, and never slower for a wider one.

use ikcore::Result;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::planning::{ConstantLimits, JointPath, SplineEnds, TimingOptions, time_optimal, time_optimal_within};
use ikcore::trajectory::Trajectory;
use proptest::prelude::*;

use crate::common::drawn;

fn names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("q{i}")).collect()
}

fn limits(joints: usize, fields: &[(Field, f64)]) -> ConstantLimits {
    let start = Limits::none(names(joints));
    let constant = |value: f64| vec![Profile::Constant(value); joints];
    let all = fields.iter().try_fold(start, |limits, (field, value)| limits.replace(*field, constant(*value)));
    ConstantLimits::new(&all.unwrap(), "time_optimal").unwrap()
}

fn spline(joints: usize, waypoints: &[f64]) -> JointPath {
    JointPath::spline(names(joints), waypoints, None, SplineEnds::Natural).unwrap()
}

fn within(path: &JointPath, tolerance: f64, limits: &ConstantLimits) -> Result<Trajectory> {
    time_optimal_within(path, &vec![tolerance; path.joints().len()], limits, &TimingOptions::default())
}

/// Largest distance of the motion from the polyline of many points of the path, in the largest joint difference.
fn distance_from(path: &JointPath, motion: &Trajectory) -> f64 {
    let n = path.joints().len();
    let [begin, end] = [path.breaks()[0], path.breaks()[path.pieces()]];
    let on_path: Vec<Vec<f64>> = (0..=12_000)
        .map(|i| {
            let mut q = vec![0.0; n];
            path.position(begin + (end - begin) * f64::from(i) / 12_000.0, &mut q);
            q
        })
        .collect();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
    let mut largest = 0.0_f64;
    for i in 0..=300 {
        motion.at(motion.duration() * f64::from(i) / 300.0, &mut q, &mut qd, &mut qdd).unwrap();
        let to = |row: &Vec<f64>| row.iter().zip(&q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        largest = largest.max(on_path.iter().map(to).fold(f64::INFINITY, f64::min));
    }
    largest
}

/// Rows of an encoder with this step that follow sines, as they are recorded.
fn recording(joints: usize, rows: usize, step: f64) -> Vec<f64> {
    let angle = |row: usize, j: usize| 0.8 * (6.0 * row as f64 / rows as f64 / (1.0 + 0.3 * j as f64) + j as f64).sin();
    (0..rows).flat_map(|row| (0..joints).map(move |j| (angle(row, j) / step).round() * step)).collect()
}

#[test]
fn noise_inside_the_tolerance_costs_little_time() {
    let (step, n) = (std::f64::consts::TAU / 4096.0, 3);
    let (noisy, clean) = (spline(n, &recording(n, 800, step)), spline(n, &recording(n, 80, 1e-9)));
    for fields in [
        &[(Field::Velocity, 2.0), (Field::Acceleration, 10.0)][..],
        &[(Field::Velocity, 2.0), (Field::Acceleration, 10.0), (Field::Jerk, 100.0)],
    ] {
        let limits = limits(n, fields);
        let time = |path: &JointPath| time_optimal(path, &limits, &TimingOptions::default()).unwrap().duration();
        let smoothed = within(&noisy, 2.0 * step, &limits).unwrap().duration();
        assert!(smoothed < 1.2 * time(&clean), "{smoothed} s, {} s on the clean path", time(&clean));
        assert!(time(&noisy) > 3.0 * smoothed);
    }
}

#[test]
fn a_tolerance_makes_a_polyline_fit_for_jerk_limits() {
    let corner = JointPath::polyline(names(2), &[0.0, 0.0, 1.0, 0.0, 1.0, 1.0], 0.0).unwrap();
    let limits = limits(2, &[(Field::Velocity, 1.0), (Field::Acceleration, 5.0), (Field::Jerk, 50.0)]);
    assert!(within(&corner, 0.0, &limits).unwrap_err().to_string().contains("its curvature jumps"));
    let motion = within(&corner, 0.05, &limits).unwrap();
    assert!(distance_from(&corner, &motion) <= 0.05 + 1e-3);
}

#[test]
fn a_reading_beyond_a_limit_is_led_inside() {
    // The middle of the path is 1e-2 beyond the limit, where the spline overshoots its waypoints.
    let path = spline(1, &[0.0, 0.9, 1.0 + 1e-3, 0.9, 0.0]);
    let limits = limits(1, &[(Field::Upper, 1.0), (Field::Lower, -1.0), (Field::Acceleration, 5.0)]);
    assert!(within(&path, 0.0, &limits).is_err());
    let motion = within(&path, 0.02, &limits).unwrap();
    assert!(motion.position_range()[0].1 <= 1.0 + 1e-9);
}

#[test]
fn a_joint_at_rest_and_a_closed_path_stay_what_they_are() {
    let rows: Vec<f64> = (0..=40).flat_map(|i| [(f64::from(i) * std::f64::consts::TAU / 40.0).sin(), 0.7]).collect();
    let path = spline(2, &rows);
    let limits = limits(2, &[(Field::Acceleration, 5.0)]);
    // Tubes wider than the motion leave nothing of it: narrower ones are tried.
    for tolerance in [1e-3, 0.1, 1.0, 10.0, 1e6] {
        let motion = within(&path, tolerance, &limits).unwrap();
        assert_eq!(motion.position_range()[1], (0.7, 0.7));
        assert!(motion.duration() > 0.0);
    }
}

#[test]
fn a_tube_wider_than_a_return_trip_is_used() {
    // The widest tube leaves nothing of the motion, the next ones leave less than a narrow one.
    let there_and_back = spline(2, &[0.5, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, -1.0]);
    let limits = limits(2, &[(Field::Velocity, 1.0), (Field::Acceleration, 5.0)]);
    let duration = |tolerance| within(&there_and_back, tolerance, &limits).unwrap().duration();
    let narrow = duration(0.2);
    for tolerance in [0.9, 1.0, 1.5, 2.0, 100.0, 1e9] {
        assert!(duration(tolerance) <= narrow, "{tolerance}: {} after {narrow}", duration(tolerance));
    }
}

proptest! {
    #![proptest_config(drawn(20))]

    #[test]
    fn wider_tolerances_never_take_longer_and_all_are_kept(
        waypoints in prop::collection::vec(prop_oneof![-1.0..1.0_f64, Just(0.0), Just(0.5), Just(-1.0)], 8..24),
        narrow in prop_oneof![Just(0.01), Just(0.1), 1e-4..0.3_f64],
        factor in prop_oneof![Just(1.0), Just(2.0), 1.0..8.0_f64],
        jerk in prop_oneof![Just(f64::INFINITY), Just(10.0), Just(100.0)],
    ) {
        let rows = &waypoints[..waypoints.len() / 2 * 2];
        prop_assume!(rows.chunks(2).any(|row| row != &rows[..2]));
        let path = spline(2, rows);
        let limits = limits(2, &[(Field::Velocity, 1.0), (Field::Acceleration, 5.0), (Field::Jerk, jerk)]);
        let mut before = f64::INFINITY;
        for tolerance in [0.0, narrow, narrow * factor] {
            let motion = within(&path, tolerance, &limits).unwrap();
            prop_assert!(motion.duration() <= before, "{tolerance}: {} after {before}", motion.duration());
            before = motion.duration();
            prop_assert!(distance_from(&path, &motion) <= tolerance + 2e-3);
            for j in 0..2 {
                prop_assert!(motion.max_velocity()[j] <= 1.0 + 1e-9);
                prop_assert!(motion.max_acceleration()[j] <= 5.0 * (1.0 + 1e-9));
                prop_assert!(motion.max_jerk()[j] <= jerk * (1.0 + 1e-9));
            }
        }
    }
}
