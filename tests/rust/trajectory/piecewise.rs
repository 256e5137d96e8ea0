//! Piecewise polynomial joint motion: values, exact extrema, samples, error messages.

use ikcore::trajectory::{Coefficients, Trajectory, polynomial};
use proptest::prelude::*;

fn names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("j{i}")).collect()
}

/// State of all joints at time `t`.
fn state(trajectory: &Trajectory, t: f64) -> [Vec<f64>; 3] {
    let n = trajectory.joints().len();
    let [mut q, mut qd, mut qdd] = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
    trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
    [q, qd, qdd]
}

/// Rest-to-rest motion over unit distance in `span` (s): 10 s^3 - 15 s^4 + 6 s^5 of the relative time.
fn rest_to_rest(span: f64) -> Coefficients {
    polynomial([0.0, 0.0, 0.0, 10.0 / span.powi(3), -15.0 / span.powi(4), 6.0 / span.powi(5)])
}

#[test]
fn rest_to_rest_quintic_has_its_known_extrema() {
    let span = 2.0;
    let trajectory = Trajectory::new(names(1), vec![0.0, span], vec![rest_to_rest(span)]).unwrap();
    // In closed form: 15/8 of the mean speed, and 10/sqrt(3) over span^2.
    assert!((trajectory.max_velocity()[0] - 15.0 / 8.0 / span).abs() < 1e-15);
    assert!((trajectory.max_acceleration()[0] - 10.0 / 3.0_f64.sqrt() / span.powi(2)).abs() < 1e-14);
    assert_eq!(state(&trajectory, 1.0), [vec![0.5], vec![15.0 / 16.0], vec![0.0]]);
    assert_eq!(state(&trajectory, -1.0), state(&trajectory, 0.0));
    assert_eq!(state(&trajectory, 9.0), state(&trajectory, span));
}

#[test]
fn samples_are_joined_by_straight_lines() {
    let times = [0.0, 0.5, 2.0];
    let q = [0.0, 1.0, 0.25, 1.0, -0.5, 4.0];
    let trajectory = Trajectory::from_samples(names(2), &times, &q, None, None).unwrap();
    assert_eq!((trajectory.knots(), trajectory.duration()), (&times[..], 2.0));
    for (row, t) in times.into_iter().enumerate() {
        assert_eq!(state(&trajectory, t)[0], q[2 * row..2 * row + 2]);
    }
    assert_eq!(state(&trajectory, 1.25), [vec![-0.125, 2.5], vec![-0.5, 2.0], vec![0.0, 0.0]]);
    // At a knot the velocity is that of the segment that begins.
    assert_eq!(state(&trajectory, 0.5)[1], [-0.5, 2.0]);
    assert_eq!(trajectory.max_velocity(), [0.5, 2.0]);
    assert_eq!(trajectory.max_acceleration(), [0.0, 0.0]);
}

#[test]
fn parts_rebuild_the_trajectory() {
    let trajectory =
        Trajectory::from_samples(names(2), &[0.0, 0.5, 2.0], &[0.0, 1.0, 0.25, 1.0, -0.5, 4.0], None, None).unwrap();
    let (joints, knots) = (trajectory.joints().to_vec(), trajectory.knots().to_vec());
    assert_eq!(Trajectory::new(joints, knots, trajectory.coefficients().to_vec()).unwrap(), trajectory);
}

#[test]
fn sample_times_end_at_the_end() {
    let trajectory = Trajectory::from_samples(names(1), &[0.0, 1.0], &[0.0, 1.0], None, None).unwrap();
    assert_eq!(trajectory.sample_times(0.4).unwrap(), [0.0, 0.4, 0.8, 1.0]);
    assert_eq!(trajectory.sample_times(0.1).unwrap().len(), 11);
    assert_eq!(trajectory.sample_times(5.0).unwrap(), [0.0, 1.0]);
    let error = trajectory.sample_times(-0.1).unwrap_err();
    assert_eq!(error.to_string(), "dt must be positive and finite, got -0.1");
}

#[test]
fn wrong_trajectories_are_named() {
    let line = |from: f64, slope: f64| polynomial([from, slope]);
    let ramp = vec![line(0.0, 1.0), line(1.0, 1.0)];
    for (result, expected) in [
        (Trajectory::new(vec![], vec![0.0, 1.0], vec![]), "trajectory: it needs at least 1 joint"),
        (Trajectory::new(names(1), vec![0.0], vec![]), "trajectory times: expected at least 2, got 1"),
        (
            Trajectory::new(names(1), vec![1.0, 2.0], vec![ramp[0]]),
            "trajectory times: row 0 must be 0, where the clock starts (take the first time from all), got 1",
        ),
        (
            Trajectory::new(names(1), vec![0.0, 1.0, 1.0], ramp.clone()),
            "trajectory times must increase, but row 2 has 1 after 1",
        ),
        (
            Trajectory::new(names(2), vec![0.0, 1.0, 2.0], ramp.clone()),
            "trajectory coefficients: expected 4 polynomials (2 segments of 2 joints), got 2",
        ),
        (
            Trajectory::new(names(2), vec![0.0, 1.0], vec![ramp[0], line(0.0, f64::NAN)]),
            "trajectory coefficients must be finite, but power 1 of joint 'j2' in segment 0 is NaN",
        ),
        (
            Trajectory::new(names(1), vec![0.0, 1.0, 2.0], vec![ramp[0], line(1.5, 1.0)]),
            "trajectory: joint 'j1' jumps from 1 to 1.5 at t = 1 s",
        ),
        (
            Trajectory::from_samples(names(2), &[0.0, 1.0], &[0.0; 3], None, None),
            "trajectory samples: expected 4 numbers (2 times of 2 joints), got 3",
        ),
        (
            Trajectory::from_samples(names(2), &[0.0, 1.0], &[0.0, 0.0, 0.0, f64::INFINITY], None, None),
            "trajectory samples must be finite, but joint 'j2' of row 1 is inf",
        ),
    ] {
        assert_eq!(result.unwrap_err().to_string(), expected);
    }
    let trajectory = Trajectory::new(names(1), vec![0.0, 1.0, 2.0], ramp).unwrap();
    let error = trajectory.at(0.5, &mut [0.0], &mut [0.0; 2], &mut [0.0]).unwrap_err();
    assert_eq!(error.to_string(), "state of the trajectory: expected 1 joints, got 2");
}

/// Random segments of degree 6 of two joints, each continued from where the one before it ends.
fn any_trajectory() -> impl Strategy<Value = Trajectory> {
    let segment = (0.05..2.0_f64, prop::array::uniform12(-3.0..3.0_f64));
    prop::collection::vec(segment, 1..5).prop_map(|segments| {
        let (mut knots, mut coefficients, mut reached) = (vec![0.0], Vec::new(), [0.3, -0.7]);
        for (span, c) in segments {
            let start = knots[knots.len() - 1];
            for joint in 0..2 {
                let [a, b, d, e, f, g] = [0, 1, 2, 3, 4, 5].map(|i| c[6 * joint + i]);
                coefficients.push([reached[joint], a, b, d, e, f, g]);
                let s = (start + span) - start;
                reached[joint] += s * (a + s * (b + s * (d + s * (e + s * (f + s * g)))));
            }
            knots.push(start + span);
        }
        Trajectory::new(names(2), knots, coefficients).unwrap()
    })
}

proptest! {
    #[test]
    fn extrema_bound_dense_samples_closely(trajectory in any_trajectory()) {
        let (velocity, acceleration) = (trajectory.max_velocity(), trajectory.max_acceleration());
        let (mut sampled_velocity, mut sampled_acceleration) = ([0.0_f64; 2], [0.0_f64; 2]);
        for ends in trajectory.knots().windows(2) {
            // The last sample lies just inside: at the knot itself the next segment begins.
            for i in 0..=2000 {
                let fraction = (f64::from(i) / 2000.0).min(1.0 - 1e-12);
                let [_, qd, qdd] = state(&trajectory, ends[0] + fraction * (ends[1] - ends[0]));
                for joint in 0..2 {
                    sampled_velocity[joint] = sampled_velocity[joint].max(qd[joint].abs());
                    sampled_acceleration[joint] = sampled_acceleration[joint].max(qdd[joint].abs());
                }
            }
        }
        for joint in 0..2 {
            for (exact, sampled) in
                [(velocity[joint], sampled_velocity[joint]), (acceleration[joint], sampled_acceleration[joint])]
            {
                prop_assert!(sampled <= exact * (1.0 + 1e-12), "{} above {}", sampled, exact);
                prop_assert!(exact - sampled < 1e-3 * (1.0 + exact), "{} far above {}", exact, sampled);
            }
        }
    }

    #[test]
    fn velocity_and_acceleration_are_derivatives(trajectory in any_trajectory(), fraction in 0.0..1.0_f64) {
        let h = 1e-6;
        let t = h + fraction * (trajectory.duration() - 2.0 * h);
        prop_assume!(trajectory.knots().iter().all(|knot| (knot - t).abs() > h));
        let [[q0, qd0, _], [_, qd, qdd], [q1, qd1, _]] = [t - h, t, t + h].map(|t| state(&trajectory, t));
        for joint in 0..2 {
            let scale = 1.0 + q0[joint].abs() + qd[joint].abs() + qdd[joint].abs();
            prop_assert!(((q1[joint] - q0[joint]) / (2.0 * h) - qd[joint]).abs() < 1e-7 * scale);
            prop_assert!(((qd1[joint] - qd0[joint]) / (2.0 * h) - qdd[joint]).abs() < 1e-7 * scale);
        }
    }
}

/// Samples of q = t^degree at both ends of a segment that does not begin at zero.
fn power(degree: i32, times: &[f64]) -> [Vec<f64>; 3] {
    let d = f64::from(degree);
    [
        times.iter().map(|t| t.powi(degree)).collect(),
        times.iter().map(|t| d * t.powi(degree - 1)).collect(),
        times.iter().map(|t| d * (d - 1.0) * t.powi(degree - 2)).collect(),
    ]
}

#[test]
fn samples_with_derivatives_reproduce_their_polynomial() {
    let times = [0.0, 0.5, 1.7];
    for (degree, with_accelerations) in [(3, false), (5, true)] {
        let [q, qd, qdd] = power(degree, &times);
        let qdd = with_accelerations.then_some(qdd.as_slice());
        let trajectory = Trajectory::from_samples(names(1), &times, &q, Some(&qd), qdd).unwrap();
        assert_eq!(trajectory.degree(), degree as usize);
        let (mut q, mut qd, mut qdd) = ([0.0], [0.0], [0.0]);
        for i in 0..=170 {
            let t = 0.01 * f64::from(i);
            trajectory.at(t, &mut q, &mut qd, &mut qdd).unwrap();
            let [expected_q, expected_qd, expected_qdd] = power(degree, &[t]);
            assert!((q[0] - expected_q[0]).abs() < 1e-12, "{t}");
            assert!((qd[0] - expected_qd[0]).abs() < 1e-11, "{t}");
            assert!((qdd[0] - expected_qdd[0]).abs() < 1e-10, "{t}");
        }
    }
}

#[test]
fn accelerations_without_velocities_are_refused() {
    let error = Trajectory::from_samples(names(1), &[0.0, 1.0], &[0.0, 1.0], None, Some(&[0.0, 0.0])).unwrap_err();
    assert_eq!(error.to_string(), "trajectory: accelerations need velocities too");
}
