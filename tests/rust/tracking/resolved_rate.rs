//! The weighted pseudo-inverse rule, and acceleration limits under every rule.
//!
//! The 2R1P arm of "Trajectory tracking of redundant manipulator based on PSO algorithm optimization" on its reference
//! q = (0.5 cos(pi t / 2), 0.5 cos(pi t / 2), 0.2 sin(pi t / 2)), t from 0 to 2 s.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::common::{jumping, message, robot};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::nalgebra::{Matrix3, Rotation3, Vector3};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::robot::Robot;
use ikcore::solver::{AnySolver, Status, Unattended};
use ikcore::task::{Goal, Target, Tolerance};
use ikcore::tracking::{Integrator, Record, Session, TickRule, TrackOptions, WeightedPseudoInverse, track};
use ikcore::trajectory::Trajectory;

/// Configuration and velocity of the reference.
fn wanted(t: f64) -> ([f64; 3], [f64; 3]) {
    let (sine, cosine) = (FRAC_PI_2 * t).sin_cos();
    let (q, qd) = ([0.5 * cosine, 0.5 * cosine, 0.2 * sine], [-0.5 * sine, -0.5 * sine, 0.2 * cosine]);
    (q, qd.map(|v| v * FRAC_PI_2))
}

fn reference(arm: &Robot, duration: f64, dt: f64) -> Reference {
    let times = || (0..=(duration / dt).round() as usize).map(|i| i as f64 * dt);
    let velocity = |t: f64| {
        let (q, qd) = wanted(t);
        let j = arm.jacobian(&q).unwrap();
        std::array::from_fn(|row| (0..3).map(|k| j[(row, k)] * qd[k]).sum())
    };
    let positions = times().map(|t| arm.tip_position(&wanted(t).0)).collect();
    Reference::new(dt, positions, None).unwrap().with_velocities(times().map(velocity).collect()).unwrap()
}

/// Limits too wide to matter: the note's errors are those of the plain formulas.
fn unlimited(arm: &Robot) -> Limits {
    let open = |limits: Limits, field, value| limits.replace(field, vec![Profile::Constant(value)]).unwrap();
    open(open(Limits::of(arm), Field::Lower, f64::NEG_INFINITY), Field::Upper, f64::INFINITY)
}

fn run(arm: &Robot, dt: f64, rule: WeightedPseudoInverse, options: TrackOptions) -> Record {
    let options = TrackOptions { rule: TickRule::WeightedPseudoInverse(rule), ..options };
    track(arm, &reference(arm, 2.0, dt), Some(&wanted(0.0).0), &options, &mut Unattended).unwrap()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn rule(gain: f64, integrator: Integrator) -> WeightedPseudoInverse {
    WeightedPseudoInverse { gain: Some(gain), integrator, ..WeightedPseudoInverse::default() }
}

#[test]
fn errors_are_those_of_the_formulas() {
    let arm = robot("hydraulic3");
    // Gain, time step, integrator; largest error of an independent computation by numpy (m).
    let cases = [
        (0.0, 0.01, Integrator::Euler, 3.0e-3),
        (0.0, 0.001, Integrator::Euler, 3.0e-4),
        (50.0, 0.01, Integrator::Euler, 8.3e-5),
        (50.0, 0.001, Integrator::Euler, 8.2e-6),
        (0.0, 0.01, Integrator::RungeKutta4, 2.5e-11),
        (50.0, 0.01, Integrator::RungeKutta4, 2.7e-7),
    ];
    for (gain, dt, integrator, expected) in cases {
        let options = TrackOptions { limits: Some(unlimited(&arm)), ..TrackOptions::default() };
        let error = largest(&run(&arm, dt, rule(gain, integrator), options).position_error);
        assert!(
            error < 1.02 * expected && error > 0.5 * expected,
            "{gain} {dt} {integrator:?}: {error:.3e}, expected {expected:.1e}"
        );
    }
}

fn posture(arm: &Robot) -> Arc<Trajectory> {
    let times: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.005).collect();
    let rows = |part: fn(f64) -> [f64; 3]| times.iter().flat_map(|t| part(*t)).collect::<Vec<f64>>();
    let (q, qd) = (rows(|t| wanted(t).0), rows(|t| wanted(t).1));
    let names = arm.joints().iter().map(|joint| joint.name.clone()).collect();
    Arc::new(Trajectory::from_samples(names, &times, &q, Some(&qd), None).unwrap())
}

#[test]
fn in_posture_mode_the_joints_follow_too() {
    let arm = robot("hydraulic3");
    let off = |record: &Record| {
        let rows = record.q.chunks(3).zip(record.time());
        rows.flat_map(|(q, t)| (0..3).map(|j| (q[j] - wanted(t).0[j]).abs()).collect::<Vec<_>>()).fold(0.0, f64::max)
    };
    for (dt, most) in [(0.01, 4e-4), (0.001, 4e-5)] {
        let rule = WeightedPseudoInverse { posture: Some(posture(&arm)), ..rule(50.0, Integrator::Euler) };
        let record = run(&arm, dt, rule, TrackOptions { limits: Some(unlimited(&arm)), ..TrackOptions::default() });
        assert!(off(&record) < most, "{dt}: {:.3e}", off(&record));
        assert!(largest(&record.position_error) < 1e-2 * dt);
    }
    // The task alone does not make the joints follow.
    let free = run(
        &arm,
        0.01,
        rule(50.0, Integrator::Euler),
        TrackOptions { limits: Some(unlimited(&arm)), ..TrackOptions::default() },
    );
    assert!(off(&free) > 1.0);
}

/// Lowest position of the slide by the literal eq. (8) to (14) (signs corrected), K = 50, h times `k`, ticks of 10 ms.
fn plain_projection(arm: &Robot, k: f64, reference: &Reference) -> f64 {
    let dt = reference.dt();
    let inverse_weights = Matrix3::from_diagonal(&Vector3::new(4.0, 4.0, 2.56)); // (vU - vL)^2
    let (mut q, mut least) = (Vector3::from(wanted(0.0).0), f64::INFINITY);
    for i in 0..reference.len() {
        let jacobian = arm.jacobian(q.as_slice()).unwrap();
        let j = jacobian.fixed_view::<2, 3>(0, 0);
        let inverse = inverse_weights * j.transpose() * (j * inverse_weights * j.transpose()).try_inverse().unwrap();
        let gap = Vector3::from(reference.position(i)) - Vector3::from(arm.tip_position(q.as_slice()));
        let velocity = (Vector3::from(reference.velocity(i).unwrap()) + 50.0 * gap).xy();
        // -k dh/dq of eq. (14).
        let slope = |j: usize| {
            let joint = &arm.joints()[j];
            let range = joint.upper - joint.lower;
            -k * 2.0 / 3.0 * (q[j] - 0.5 * (joint.lower + joint.upper)) / (range * range)
        };
        let downhill = Vector3::from_fn(|j, _| slope(j));
        q += dt * (inverse * velocity + (Matrix3::identity() - inverse * j) * downhill);
        least = least.min(q[2]);
    }
    least
}

#[test]
fn limits_are_kept_where_plain_projection_breaks_them() {
    let arm = robot("hydraulic3");
    let reference = reference(&arm, 2.0, 0.01);
    assert!(plain_projection(&arm, 2.0, &reference) < -0.004);
    // Takeover of the motion by the other joints when the slide meets its end: faster than 1 rad/s is needed, so with that
    // limit the tip is left behind, not the limits. With 2 rad/s it is not.
    for (speed, off) in [(1.0, 0.011), (2.0, 5e-4)] {
        let speeds = [speed, speed, 0.8].map(Profile::Constant).to_vec();
        let options = TrackOptions {
            rule: TickRule::WeightedPseudoInverse(rule(50.0, Integrator::Euler)),
            goals: vec![Goal::Centring { weight: 2.0 / 3.0 }],
            limits: Some(Limits::of(&arm).replace(Field::Velocity, speeds).unwrap()),
            ..TrackOptions::default()
        };
        let record = track(&arm, &reference, Some(&wanted(0.0).0), &options, &mut Unattended).unwrap();
        assert_eq!((record.max_violation, record.worst_violation), (0.0, None));
        let error = largest(&record.position_error);
        assert!(error < off, "{speed} rad/s: {error:.3e}");
    }
}

#[test]
fn goals_use_the_freedom_that_the_task_leaves() {
    let arm = robot("iiwa14");
    let start = [0.3, 0.6, 1.2, -1.3, 0.4, 0.9, 0.1];
    let center = arm.tip_position(&start);
    let path = Path::new(Circle::new(Plane::xy([center[0] - 0.05, center[1], center[2]]).unwrap(), 0.1, 4.0).unwrap());
    let reference = path.sample_with_velocities(0.01).unwrap();
    let end = |goals: Vec<Goal>| {
        let rule = TickRule::WeightedPseudoInverse(WeightedPseudoInverse {
            integrator: Integrator::RungeKutta4,
            ..WeightedPseudoInverse::default()
        });
        let options = TrackOptions {
            rule,
            goals,
            tolerance: Tolerance { position: 1e-4, rotation: 1e-4 },
            ..TrackOptions::default()
        };
        let record = track(&arm, &reference, Some(&start), &options, &mut Unattended).unwrap();
        assert_eq!(record.status, Status::Solved, "{}", record.message());
        record.q[record.q.len() - 7..].to_vec()
    };
    let middle = |q: &[f64]| q.iter().map(|q| q * q).sum::<f64>();
    assert!(middle(&end(vec![Goal::Centring { weight: 20.0 }])) < 0.7 * middle(&end(vec![])));
}

#[test]
fn turning_poses_are_followed() {
    let arm = robot("iiwa14");
    let start = [0.3, 0.6, 0.2, -1.3, 0.4, 0.9, 0.1];
    let begin = arm.fk(&start).unwrap();
    let count = 400;
    let at = |i: usize| {
        let t = i as f64 * 0.005;
        let turn = Rotation3::from_scaled_axis(Vector3::new(0.2, -0.3, 0.5) * (0.2 * t * t * (3.0 - t)));
        let p = begin.translation.vector;
        (std::array::from_fn(|k| p[k] + [0.02, -0.03, 0.02][k] * t * t), *(turn * begin.rotation).matrix())
    };
    let (positions, rotations) = (0..=count).map(at).unzip();
    let reference = Reference::new(0.005, positions, Some(rotations)).unwrap();
    let rule = TickRule::WeightedPseudoInverse(WeightedPseudoInverse::default());
    let options =
        TrackOptions { rule, tolerance: Tolerance { position: 1e-4, rotation: 1e-4 }, ..TrackOptions::default() };
    let record = track(&arm, &reference, Some(&start), &options, &mut Unattended).unwrap();
    assert_eq!(record.status, Status::Solved, "{}", record.message());
}

#[test]
fn accelerations_are_kept_under_every_rule() {
    let arm = robot("iiwa14");
    let start = [0.3, 0.6, 0.2, -1.3, 0.4, 0.9, 0.1];
    let center = arm.tip_position(&start);
    let path = Path::new(Circle::new(Plane::xy([center[0] - 0.1, center[1], center[2]]).unwrap(), 0.2, 3.0).unwrap());
    let dt = 0.01;
    let reference = path.sample_with_velocities(dt).unwrap();
    let limits = Limits::of(&arm).replace(Field::Acceleration, vec![Profile::Constant(6.0)]).unwrap();
    let rules = [
        TickRule::MidStep,
        TickRule::Solver(AnySolver::default()),
        TickRule::WeightedPseudoInverse(rule(10.0, Integrator::Euler)),
        TickRule::WeightedPseudoInverse(rule(10.0, Integrator::RungeKutta4)),
    ];
    for rule in rules {
        let options = TrackOptions { rule: rule.clone(), limits: Some(limits.clone()), ..TrackOptions::default() };
        let record = track(&arm, &reference, Some(&start), &options, &mut Unattended).unwrap();
        assert_eq!(record.max_violation, 0.0, "{rule:?}");
        let qd = record.qd();
        let jumps =
            qd.windows(14).step_by(7).flat_map(|two| (0..7).map(|j| (two[7 + j] - two[j]).abs()).collect::<Vec<_>>());
        let largest_jump = jumps.fold(0.0, f64::max);
        assert!(largest_jump <= 6.0 * dt * (1.0 + 1e-9), "{rule:?}: {largest_jump}");
        // From rest the arm catches up with a path that moves from the first tick on.
        assert!(largest(&record.position_error[150..]) < 3e-4, "{rule:?}");
    }
}

#[test]
fn a_joint_brakes_before_its_position_limit() {
    // The target lies beyond the limit: the joint must come to rest there, with its acceleration kept.
    let arm = Robot::planar(&[1.0]).unwrap();
    let limits = |acceleration: f64| {
        let limits = Limits::of(&arm).replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap();
        limits.replace(Field::Acceleration, vec![Profile::Constant(acceleration)]).unwrap()
    };
    for acceleration in [0.3, 2.0, 40.0] {
        let options = TrackOptions { limits: Some(limits(acceleration)), ..TrackOptions::default() };
        let dt = 0.01;
        let mut session = Session::new(&arm, &[-0.4], dt, &options).unwrap();
        let mut last = 0.0;
        for _ in 0..1000 {
            let step = session.step(&Target::Position([0.0, 1.0, 0.0]), &mut Unattended).unwrap();
            assert!(step.inside_limits, "{acceleration} {:?} {:?} {last}", session.q(), session.qd());
            assert!((session.qd()[0] - last).abs() <= acceleration * dt * (1.0 + 1e-9));
            assert!(session.q()[0] <= 0.5);
            last = session.qd()[0];
        }
        assert!((session.q()[0] - 0.5).abs() < 1e-12 && last.abs() < 1e-9, "{} {last}", session.q()[0]);
    }
}

#[test]
fn a_velocity_limit_that_falls_is_braked_for() {
    let arm = Robot::planar(&[1.0]).unwrap();
    let falling = Profile::Sampled { step: 0.5, values: vec![2.0, 2.0, 0.1, 0.1] };
    let limits = Limits::of(&arm).replace(Field::Velocity, vec![falling.clone()]).unwrap();
    let limits = limits.replace(Field::Acceleration, vec![Profile::Constant(1.0)]).unwrap();
    let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
    let mut session = Session::new(&arm, &[0.0], 0.01, &options).unwrap();
    for tick in 0..120 {
        let step = session.step(&Target::Position([-1.0, 0.1, 0.0]), &mut Unattended).unwrap();
        assert!(step.inside_limits, "tick {tick}");
        let limit = falling.smallest(0.01 * f64::from(tick), 0.01 * f64::from(tick + 1)).1;
        assert!(session.qd()[0].abs() <= limit * (1.0 + 1e-9), "tick {tick}: {} {limit}", session.qd()[0]);
    }
}

#[test]
fn a_position_limit_that_outruns_braking_is_reported() {
    let arm = Robot::planar(&[1.0]).unwrap();
    let closing = Profile::Sampled { step: 0.5, values: vec![1.0, -1.0] };
    let limits = Limits::of(&arm).replace(Field::Upper, vec![closing]).unwrap();
    let limits = limits.replace(Field::Velocity, vec![Profile::Constant(0.5)]).unwrap();
    let limits = limits.replace(Field::Acceleration, vec![Profile::Constant(1.0)]).unwrap();
    let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
    let mut session = Session::new(&arm, &[0.5], 0.01, &options).unwrap();
    let steps = (0..50).map(|_| session.step(&Target::Position([0.8, 0.6, 0.0]), &mut Unattended).unwrap());
    let outside = steps.into_iter().find(|step| !step.inside_limits).unwrap();
    assert!(outside.message().contains("; a joint is outside its limits and returns"), "{}", outside.message());
}

#[test]
fn a_singular_posture_gets_no_step_where_there_is_none() {
    let arm = Robot::planar(&[1.0, 1.0]).unwrap();
    let rule = TickRule::WeightedPseudoInverse(WeightedPseudoInverse::default());
    let options = TrackOptions { rule, limits: jumping(&arm), ..TrackOptions::default() };
    let mut session = Session::new(&arm, &[0.0, 0.0], 0.01, &options).unwrap();
    let step = session.step(&Target::Position([1.5, 0.0, 0.0]), &mut Unattended).unwrap();
    assert_eq!((step.status, session.q()), (Status::Improved, &[0.0, 0.0][..]));
    let step = session.step(&Target::Position([1.5, 0.0, 0.0]), &mut Unattended).unwrap();
    assert_eq!(step.status, Status::Capped);
}

#[test]
fn a_locked_joint_leaves_its_fraction_to_the_others() {
    let arm = robot("hydraulic3");
    let limits = Limits::of(&arm).replace(Field::Velocity, [1.0, 1.0, 0.0].map(Profile::Constant).to_vec()).unwrap();
    let record = run(
        &arm,
        0.01,
        rule(50.0, Integrator::Euler),
        TrackOptions { limits: Some(limits), ..TrackOptions::default() },
    );
    assert!(record.q.chunks(3).all(|q| q[2] == 0.0));
    assert!(record.max_violation == 0.0);
}

#[test]
fn options_that_make_no_sense_are_named() {
    let arm = robot("hydraulic3");
    let says = |rule: WeightedPseudoInverse| {
        let options = TrackOptions { rule: TickRule::WeightedPseudoInverse(rule), ..TrackOptions::default() };
        message(Session::new(&arm, &[0.0; 3], 0.01, &options))
    };
    let standard = WeightedPseudoInverse::default;
    assert_eq!(
        says(WeightedPseudoInverse { gain: Some(-1.0), ..standard() }),
        "gain must be zero or positive, and finite, got -1"
    );
    assert_eq!(
        says(WeightedPseudoInverse { gain: Some(250.0), ..standard() }),
        "gain must be below 2 / dt = 200, beyond which errors grow, got 250"
    );
    assert_eq!(
        says(WeightedPseudoInverse { weights: Some(vec![1.0; 2]), ..standard() }),
        "weights for robot 'hydraulic3': expected 3 joints, got 2"
    );
    assert_eq!(
        says(WeightedPseudoInverse { weights: Some(vec![1.0, 0.0, 1.0]), ..standard() }),
        "weights[1] must be positive and finite, got 0"
    );
    assert_eq!(
        says(WeightedPseudoInverse { damping: f64::NAN, ..standard() }),
        "damping must be zero or positive, and finite, got NaN"
    );
    assert_eq!(message("heun".parse::<Integrator>()), "integrator must be one of 'euler', 'rk4', got 'heun'");
    let short = posture(&Robot::planar(&[1.0, 1.0, 1.0]).unwrap());
    let two = Trajectory::from_samples(vec!["a".into(), "b".into()], &[0.0, 1.0], &[0.0; 4], None, None).unwrap();
    assert_eq!(short.joints().len(), 3);
    assert_eq!(
        says(WeightedPseudoInverse { posture: Some(Arc::new(two)), ..standard() }),
        "posture for robot 'hydraulic3': expected 3 joints, got 2"
    );
}
