//! Fastest timing of joint paths: known optima, limits at every instant, error messages.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::planning::{ConstantLimits, JointPath, SplineEnds, TimingOptions, time_optimal};
use ikcore::trajectory::Trajectory;
use ikcore::{Error, Result};
use proptest::prelude::*;

fn names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("q{i}")).collect()
}

fn limits(fields: &[(Field, Vec<f64>)], joints: usize) -> Result<ConstantLimits> {
    let constants = |values: &[f64]| values.iter().map(|value| Profile::Constant(*value)).collect();
    let start = Limits::none(names(joints));
    let all = fields.iter().try_fold(start, |limits, (field, values)| limits.replace(*field, constants(values)))?;
    ConstantLimits::new(&all, "time_optimal")
}

fn velocity_and_acceleration(velocity: &[f64], acceleration: &[f64]) -> ConstantLimits {
    let fields = [(Field::Velocity, velocity.to_vec()), (Field::Acceleration, acceleration.to_vec())];
    limits(&fields, acceleration.len()).unwrap()
}

fn spline(joints: usize, waypoints: &[f64], ends: SplineEnds) -> JointPath {
    JointPath::spline(names(joints), waypoints, None, ends).unwrap()
}

fn on_grid(gridpoints: usize) -> TimingOptions {
    TimingOptions { gridpoints: Some(gridpoints), ..TimingOptions::default() }
}

fn state(trajectory: &Trajectory, t: f64) -> [Vec<f64>; 3] {
    let n = trajectory.joints().len();
    let [mut q, mut qd, mut qdd] = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
    [q, qd, qdd]
}

#[test]
fn a_straight_line_takes_the_known_time() {
    // 2 rad at 8 rad/s^2: bang-bang, 2 sqrt(2/8) = 1 s. At most 1 rad/s: 2/1 + 1/8 s.
    for (velocity, expected) in [(f64::INFINITY, 1.0), (100.0, 1.0), (1.0, 2.125)] {
        for ends in [SplineEnds::Natural, SplineEnds::NotAKnot] {
            let path = spline(2, &[0.0, 1.0, 2.0, 0.5], ends);
            let fast = velocity_and_acceleration(&[velocity; 2], &[8.0; 2]);
            let trajectory = time_optimal(&path, &fast, &TimingOptions::default()).unwrap();
            let excess = trajectory.duration() / expected - 1.0;
            assert!((-1e-12..1e-3).contains(&excess), "{velocity} {ends:?}: {}", trajectory.duration());
        }
    }
}

#[test]
fn a_clamped_spline_is_as_fast_as_its_line() {
    // Without slope at its ends it is the same straight line: only how the parameter runs along it differs.
    let fast = velocity_and_acceleration(&[f64::INFINITY], &[8.0]);
    let path = spline(1, &[0.0, 2.0], SplineEnds::Clamped);
    let trajectory = time_optimal(&path, &fast, &TimingOptions::default()).unwrap();
    assert!((trajectory.duration() - 1.0).abs() < 1e-3, "{}", trajectory.duration());
    assert!(state(&trajectory, 0.0)[1][0].abs() < 1e-9 && state(&trajectory, 9.0)[1][0].abs() < 1e-9);
}

#[test]
fn speeds_at_the_ends_are_met_and_save_time() {
    let path = spline(2, &[0.0, 0.0, 3.0, 4.0], SplineEnds::Natural);
    let fast = velocity_and_acceleration(&[2.0; 2], &[1.0; 2]);
    let options = TimingOptions { start_speed: 1.0, end_speed: 0.5, ..TimingOptions::default() };
    let trajectory = time_optimal(&path, &fast, &options).unwrap();
    for (t, speed) in [(0.0, 1.0), (trajectory.duration(), 0.5)] {
        let [_, qd, _] = state(&trajectory, t);
        assert!((qd[0] - 0.6 * speed).abs() < 1e-9 && (qd[1] - 0.8 * speed).abs() < 1e-9, "{qd:?}");
    }
    assert!(trajectory.duration() < time_optimal(&path, &fast, &TimingOptions::default()).unwrap().duration());
}

#[test]
fn polylines_stop_at_corners_and_pass_rounded_ones() {
    let waypoints = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0];
    let fast = velocity_and_acceleration(&[10.0; 2], &[4.0; 2]);
    let timed = |blend: f64| {
        let path = JointPath::polyline(names(2), &waypoints, blend).unwrap();
        time_optimal(&path, &fast, &TimingOptions::default()).unwrap()
    };
    // Each leg alone is bang-bang: 2 sqrt(1/4) = 1 s.
    let stopping = timed(0.0);
    assert!((stopping.duration() - 2.0).abs() < 1e-3, "{}", stopping.duration());
    let corner = state(&stopping, 0.5 * stopping.duration());
    assert!((corner[0][0] - 1.0).abs() < 1e-3 && corner[1][0].abs() < 0.1);
    let rounded = timed(0.2);
    assert!(rounded.duration() < 1.8, "{}", rounded.duration());
    // The corner is passed at blend / 2 at the most: here at blend |d_out - d_in| / 4.
    let nearest = (0..=1000)
        .map(|i| state(&rounded, rounded.duration() * f64::from(i) / 1000.0)[0].clone())
        .map(|q| (q[0] - 1.0).hypot(q[1]))
        .fold(f64::INFINITY, f64::min);
    assert!((nearest - 0.2 * 2.0_f64.sqrt() / 4.0).abs() < 1e-3, "{nearest}");
    assert!(rounded.max_acceleration().iter().all(|a| *a <= 4.0 * (1.0 + 1e-9)));
}

#[test]
fn jerk_limits_are_kept_and_the_path_too() {
    let waypoints = [0.0, 0.3, 1.0, -0.5, -0.5, 0.8, 0.7, 1.5];
    let path = spline(2, &waypoints, SplineEnds::Natural);
    let fields = [(Field::Velocity, vec![2.0]), (Field::Acceleration, vec![10.0]), (Field::Jerk, vec![80.0, 120.0])];
    let smooth = time_optimal(&path, &limits(&fields, 2).unwrap(), &TimingOptions::default()).unwrap();
    let fastest = time_optimal(&path, &limits(&fields[..2], 2).unwrap(), &TimingOptions::default()).unwrap();
    let within = |values: Vec<f64>, limits: [f64; 2]| values.iter().zip(limits).all(|(v, l)| *v <= l * (1.0 + 1e-9));
    assert!(within(smooth.max_velocity(), [2.0; 2]));
    assert!(within(smooth.max_acceleration(), [10.0; 2]));
    assert!(within(smooth.max_jerk(), [80.0, 120.0]));
    let cost = smooth.duration() / fastest.duration();
    assert!((1.0..1.25).contains(&cost), "{cost}");
    // No jump of the acceleration either, not even at the ends.
    assert!(state(&smooth, 0.0)[2].iter().chain(&state(&smooth, 99.0)[2]).all(|a| a.abs() < 1e-6));
    for pair in smooth.knots().windows(2) {
        let step = pair[1] - pair[0];
        let [before, after] = [pair[1] - 1e-3 * step, pair[1]].map(|t| state(&smooth, t)[2].clone());
        assert!(before.iter().zip(&after).all(|(b, a)| (b - a).abs() <= 120.0 * 2e-3 * step + 1e-6));
    }
    assert!(farthest_from(&path, &smooth) < 1e-6);
}

/// Largest distance of the motion from the path (rad), by dense samples of both.
fn farthest_from(path: &JointPath, trajectory: &Trajectory) -> f64 {
    let n = path.joints().len();
    let rows: Vec<Vec<f64>> = (0..=4000)
        .map(|i| {
            let mut q = vec![0.0; n];
            path.position(f64::from(i) / 4000.0, &mut q);
            q
        })
        .collect();
    let gap = |q: &[f64]| {
        // To the chords between samples of the path.
        let chord = |pair: &[Vec<f64>]| {
            let along: Vec<f64> = pair[1].iter().zip(&pair[0]).map(|(b, a)| b - a).collect();
            let from: Vec<f64> = q.iter().zip(&pair[0]).map(|(q, a)| q - a).collect();
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let fraction = (dot(&from, &along) / dot(&along, &along)).clamp(0.0, 1.0);
            from.iter().zip(&along).map(|(f, a)| (f - fraction * a).powi(2)).sum::<f64>().sqrt()
        };
        rows.windows(2).map(chord).fold(f64::INFINITY, f64::min)
    };
    (0..=100).map(|i| gap(&state(trajectory, trajectory.duration() * f64::from(i) / 100.0)[0])).fold(0.0, f64::max)
}

/// Checks that the timed polyline keeps velocity and acceleration limits and ends at its last waypoint.
fn assert_polyline_is_timed(waypoints: &[f64], joints: usize, blend: f64, [velocity, acceleration]: [f64; 2]) -> f64 {
    let path = JointPath::polyline(names(joints), waypoints, blend).unwrap();
    let limits = velocity_and_acceleration(&vec![velocity; joints], &vec![acceleration; joints]);
    let trajectory = time_optimal(&path, &limits, &TimingOptions::default()).unwrap();
    let size = waypoints.iter().fold(0.0_f64, |size, q| size.max(q.abs()));
    let [q, ..] = state(&trajectory, trajectory.duration());
    let last = &waypoints[waypoints.len() - joints..];
    assert!(q.iter().zip(last).all(|(q, last)| (q - last).abs() < 1e-9 * size), "{q:?} {last:?}");
    let within = |largest: Vec<f64>, limit: f64| largest.iter().all(|x| *x <= limit * (1.0 + 1e-6));
    assert!(within(trajectory.max_velocity(), velocity), "{:?}", trajectory.max_velocity());
    assert!(within(trajectory.max_acceleration(), acceleration), "{:?}", trajectory.max_acceleration());
    trajectory.duration()
}

fn line(from: &[f64], to: &[f64], rows: usize) -> Vec<f64> {
    let fraction = |row: usize| row as f64 / (rows - 1) as f64;
    (0..rows).flat_map(|row| from.iter().zip(to).map(move |(a, b)| a + fraction(row) * (b - a))).collect()
}

#[test]
fn collinear_waypoints_are_as_fast_as_their_line() {
    let mut rng = ikcore::rng::stream(5, 0);
    for rows in [3, 20, 100] {
        for _ in 0..20 {
            let [from, to] = [(); 2].map(|()| (0..3).map(|_| rng.uniform_in(-2.0, 2.0)).collect::<Vec<f64>>());
            let direct = assert_polyline_is_timed(&line(&from, &to, 2), 3, 0.0, [1.0, 5.0]);
            for blend in [0.0, 0.1] {
                let timed = assert_polyline_is_timed(&line(&from, &to, rows), 3, blend, [1.0, 5.0]);
                assert!((timed / direct - 1.0).abs() < 1e-2, "{rows} rows, blend {blend}: {timed} and {direct}");
            }
        }
    }
}

#[test]
fn repeated_waypoints_of_polylines_count_once() {
    let once = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let expected = assert_polyline_is_timed(&once, 2, 0.1, [1.0, 5.0]);
    for gap in [0.0, 3e-17, 1e-14] {
        let twice: Vec<f64> = once.chunks(2).flat_map(|row| [row[0], row[1], row[0] + gap, row[1]]).collect();
        let timed = assert_polyline_is_timed(&twice, 2, 0.1, [1.0, 5.0]);
        assert!((timed / expected - 1.0).abs() < 1e-9, "{gap}: {timed} and {expected}");
    }
    assert_polyline_is_timed(&[0.0, 0.0, 1.0, 0.0, 1.0, 1e-9, 1.0, 1.0], 2, 0.1, [1.0, 5.0]);
    let same = JointPath::polyline(names(1), &[1.0; 3], 0.1).unwrap_err();
    assert_eq!(same.to_string(), "path: all waypoints are the same: give at least two that differ");
}

#[test]
fn rests_between_waypoints_have_no_length() {
    let rested = [0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 1.0, 0.5, 1.0, 0.5, 0.0, 1.0, 0.0, 1.0];
    let moving = [0.0, 0.0, 1.0, 0.5, 0.0, 1.0];
    for ends in [SplineEnds::Natural, SplineEnds::NotAKnot, SplineEnds::Clamped] {
        assert_eq!(spline(2, &rested, ends), spline(2, &moving, ends));
        let given =
            |waypoints: &[f64], knots: &[f64]| JointPath::spline(names(2), waypoints, Some(knots), ends).unwrap();
        // The intervals that move last 1 and 2; the others are rests.
        let timed = given(&rested, &[5.0, 6.0, 7.0, 8.0, 9.0, 11.0, 12.0]);
        assert_eq!(timed, given(&moving, &[5.0, 6.0, 8.0]));
    }
}

#[test]
fn narrow_blends_of_long_polylines_keep_the_limits() {
    // Speeding up takes as little of the duration as its rounding leaves.
    let mut rng = ikcore::rng::stream(7, 0);
    for _ in 0..150 {
        let exponent = |rng: &mut ikcore::rng::LazyRng, from: f64, to: f64| 10.0_f64.powf(rng.uniform_in(from, to));
        let limits = [exponent(&mut rng, -1.0, 2.0), exponent(&mut rng, 3.0, 7.0)];
        let mut waypoints = vec![0.0; 3];
        for _ in 0..20 {
            let size = exponent(&mut rng, -3.0, 6.9);
            for _ in 0..3 {
                waypoints.push(waypoints[waypoints.len() - 3] + rng.uniform_in(-size, size));
            }
        }
        assert_polyline_is_timed(&waypoints, 3, 5e-4, limits);
    }
}

#[test]
fn mistakes_are_named() {
    let two = names(2);
    let path = || spline(2, &[0.0, 0.0, 1.0, 2.0], SplineEnds::Natural);
    let timed = |fields: &[(Field, Vec<f64>)], options: TimingOptions| -> Result<Trajectory> {
        time_optimal(&path(), &limits(fields, 2)?, &options)
    };
    let standard = (Field::Acceleration, vec![1.0]);
    for (result, expected) in [
        (
            JointPath::spline(two.clone(), &[0.0, 1.0], None, SplineEnds::Natural).map(drop),
            "waypoints: expected at least 2, got 1",
        ),
        (
            JointPath::spline(two.clone(), &[0.0, 1.0, f64::NAN, 2.0], None, SplineEnds::Natural).map(drop),
            "waypoints must be finite, but joint 'q1' of row 1 is NaN",
        ),
        (
            JointPath::spline(two.clone(), &[2.0, 3.0, 2.0, 3.0], None, SplineEnds::Natural).map(drop),
            "path: all waypoints are the same: give at least two that differ",
        ),
        (
            JointPath::spline(two.clone(), &[0.0, 1.0, 2.0, 3.0], Some(&[0.0, 0.5, 1.0]), SplineEnds::Natural)
                .map(drop),
            "knots: expected 2 (one per waypoint), got 3",
        ),
        (
            JointPath::spline(two.clone(), &[0.0, 1.0, 2.0, 3.0], Some(&[0.0, 0.0]), SplineEnds::Natural).map(drop),
            "knots must increase, but row 1 has 0 after 0",
        ),
        (
            JointPath::polyline(two.clone(), &[0.0, 1.0, 2.0, 3.0], -0.1).map(drop),
            "blend must be zero or more and finite, got -0.1",
        ),
        (
            timed(&[], TimingOptions::default()).map(drop),
            "time_optimal cannot honour infinite acceleration limits: joint 'q1' could start at any speed; give \
             acceleration limits",
        ),
        (
            timed(&[(Field::Acceleration, vec![1.0, f64::INFINITY])], TimingOptions::default()).map(drop),
            "time_optimal cannot honour infinite acceleration limits: joint 'q2' could start at any speed; give \
             acceleration limits",
        ),
        (
            timed(&[(Field::Acceleration, vec![1.0, 0.0])], TimingOptions::default()).map(drop),
            "infeasible: the path moves joint 'q2', where the acceleration limit is 0: give an acceleration limit",
        ),
        (
            timed(&[standard.clone(), (Field::Velocity, vec![0.0, 1.0])], TimingOptions::default()).map(drop),
            "infeasible: the path moves joint 'q1', where the velocity limit is 0: give a velocity limit",
        ),
        (
            timed(&[standard.clone(), (Field::Velocity, vec![-1.0])], TimingOptions::default()).map(drop),
            "velocity limit of joint 'q1' is -1 at t = 0 s: a limit cannot be negative",
        ),
        (
            timed(&[standard.clone(), (Field::Upper, vec![1.5])], TimingOptions::default()).map(drop),
            "infeasible: the path takes joint 'q2' to 2, beyond its upper limit 1.5",
        ),
        (
            timed(&[(Field::Acceleration, vec![1.0; 3])], TimingOptions::default()).map(drop),
            "acceleration limit: expected one number, or 2 (one per joint), got 3",
        ),
        (timed(std::slice::from_ref(&standard), on_grid(2)).map(drop), "gridpoints must be from 3 to 200000, got 2"),
        (
            timed(std::slice::from_ref(&standard), TimingOptions { end_speed: 9.0, ..TimingOptions::default() })
                .map(drop),
            "infeasible: the speed at the end of the path is beyond what the limits allow there",
        ),
        (
            timed(std::slice::from_ref(&standard), TimingOptions { start_speed: -1.0, ..TimingOptions::default() })
                .map(drop),
            "start_speed must be zero or more and finite, got -1",
        ),
        (
            time_optimal(&path(), &velocity_and_acceleration(&[1.0], &[1.0]), &TimingOptions::default()).map(drop),
            "limits: expected 2 joints, as the path has, got 1",
        ),
    ] {
        assert_eq!(result.unwrap_err().to_string(), expected);
    }
    let corner = JointPath::polyline(two, &[0.0, 0.0, 1.0, 0.0, 1.0, 1.0], 0.1).unwrap();
    let jerky = limits(&[standard, (Field::Jerk, vec![5.0])], 2).unwrap();
    let error = time_optimal(&corner, &jerky, &TimingOptions::default()).unwrap_err();
    assert!(matches!(error, Error::UnsupportedLimit { .. }), "{error}");
}

#[test]
fn a_joint_that_stays_needs_no_speed() {
    let path = spline(2, &[0.0, 0.5, 1.0, 0.5], SplineEnds::NotAKnot);
    let still = velocity_and_acceleration(&[1.0, 0.0], &[1.0, 0.0]);
    let trajectory = time_optimal(&path, &still, &TimingOptions::default()).unwrap();
    assert!((trajectory.duration() - 2.0).abs() < 2e-3);
}

/// Waypoints of up to four joints with limits for each.
#[test]
fn waypoints_at_position_limits_are_inside_them() {
    let bounds = [2.8973, 1.7628, 3.0718, 0.0175, 0.1, 0.3];
    let fields = [
        (Field::Lower, bounds.map(|bound| -bound).to_vec()),
        (Field::Upper, bounds.to_vec()),
        (Field::Velocity, vec![1.0; 6]),
        (Field::Acceleration, vec![5.0; 6]),
    ];
    let limits = limits(&fields, 6).unwrap();
    for signs in 0..64_u32 {
        let corner = |bits: u32| bounds.iter().enumerate().map(move |(j, b)| if bits >> j & 1 == 1 { *b } else { -b });
        let waypoints: Vec<f64> =
            corner(signs).chain(bounds.map(|bound| bound / 3.0)).chain(corner(63 - signs)).collect();
        for blend in [0.0, 0.1] {
            let path = JointPath::polyline(names(6), &waypoints, blend).unwrap();
            let motion = time_optimal(&path, &limits, &TimingOptions::default()).unwrap();
            for ((low, high), bound) in motion.position_range().iter().zip(bounds) {
                assert!(low.abs().max(*high) <= bound * (1.0 + 1e-12), "{low} and {high}");
            }
        }
    }
}

fn any_problem() -> impl Strategy<Value = (JointPath, Vec<f64>, Vec<f64>)> {
    let ends = prop::sample::select(vec![SplineEnds::Natural, SplineEnds::NotAKnot, SplineEnds::Clamped]);
    (1..5_usize, 2..8_usize, ends).prop_flat_map(|(n, rows, ends)| {
        // Two rows that are the same are a mistake: each differs from the one before by its own number.
        let waypoints = prop::collection::vec(-2.0..2.0_f64, n * rows)
            .prop_map(move |q| q.iter().enumerate().map(|(i, q)| q + 1e-3 * (i / n) as f64).collect::<Vec<_>>());
        let positive = || prop::collection::vec(0.3..30.0_f64, n);
        (waypoints, positive(), positive()).prop_map(move |(q, v, a)| (spline(n, &q, ends), v, a))
    })
}

proptest! {
    #[test]
    fn limits_hold_at_every_instant_on_any_grid((path, velocity, acceleration) in any_problem(), gridpoints in 3..300_usize) {
        let allowed = velocity_and_acceleration(&velocity, &acceleration);
        let trajectory = time_optimal(&path, &allowed, &on_grid(gridpoints)).unwrap();
        // Exact extremes, not samples.
        for (largest, limit) in trajectory.max_velocity().iter().zip(&velocity) {
            prop_assert!(*largest <= limit * (1.0 + 1e-9), "velocity {largest} over {limit}");
        }
        for (largest, limit) in trajectory.max_acceleration().iter().zip(&acceleration) {
            prop_assert!(*largest <= limit * (1.0 + 1e-9), "acceleration {largest} over {limit}");
        }
        prop_assert!(state(&trajectory, 0.0)[1].iter().all(|qd| qd.abs() < 1e-9));
        prop_assert!(state(&trajectory, 1e9)[1].iter().all(|qd| qd.abs() < 1e-6));
    }

    #[test]
    fn a_finer_grid_is_faster_and_the_default_is_fine_enough((path, velocity, acceleration) in any_problem()) {
        let allowed = velocity_and_acceleration(&velocity, &acceleration);
        let duration = |options: TimingOptions| time_optimal(&path, &allowed, &options).unwrap().duration();
        let (chosen, fine) = (duration(TimingOptions::default()), duration(on_grid(5001)));
        prop_assert!(chosen <= fine * (1.0 + 2e-3), "{chosen} {fine}");
        prop_assert!(duration(on_grid(30)) >= fine * (1.0 - 1e-3));
    }
}

#[test]
fn where_all_joints_reverse_the_path_has_no_corner() {
    // Slopes vanish there but for rounding, which is all that the sides can differ by.
    let limits =
        limits(&[(Field::Velocity, vec![1.0]), (Field::Acceleration, vec![5.0]), (Field::Jerk, vec![50.0])], 1)
            .unwrap();
    for step in [0.1, 0.3, 1e-3, 7.0] {
        for rise in 1..40 {
            let rows: Vec<f64> = (0..=rise).chain((0..rise).rev()).map(|i| step * f64::from(i) + 0.2).collect();
            time_optimal(&spline(1, &rows, SplineEnds::Natural), &limits, &TimingOptions::default()).unwrap();
        }
    }
}
