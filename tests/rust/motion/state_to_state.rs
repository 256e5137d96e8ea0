//! Motions between states: durations by formula and by an oracle, limits at every instant, error messages.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::math::one_joint::{MotionState, Rates, Transfer};
use ikcore::motion::{ArmState, state_to_state};
use ikcore::trajectory::Trajectory;
use proptest::prelude::*;

use crate::common::drawn;

type Rows = [[f64; 3]; 3];

/// Limits (velocity, acceleration, jerk), start and end (position, velocity, acceleration) of three joints, and the
/// duration (s) that the library ruckig 0.19.4 computes. In the third and the sixth, no joint alone needs as long.
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)]
const BY_RUCKIG: [(Rows, Rows, Rows, f64); 12] = [
    ([[0.82, 1.75, 2.0], [1.2, 2.04, 7.5], [10.3, 14.7, 76.1]], [[0.488, -0.524, 0.046], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0.651, -0.899, -1.448], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 1.112221200175208),
    ([[2.47, 2.18, 1.78], [6.72, 4.84, 7.87], [20.3, 46.5, 41.3]], [[-0.587, 0.366, -1.059], [-0.13, -0.777, -1.187], [1.864, -2.306, 5.055]], [[1.209, 1.469, -1.485], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 1.3748694236542465),
    ([[2.45, 2.82, 0.87], [5.38, 2.01, 4.1], [64.0, 72.1, 61.9]], [[-1.858, -0.562, -1.348], [-0.56, -1.981, 0.516], [-3.627, 0.357, -1.76]], [[1.995, -1.424, -1.023], [0.535, -1.535, -0.002], [-3.971, -1.237, 0.363]], 2.959937430235559),
    ([[2.09, 1.31, 2.11], [3.46, 1.91, 3.21], [34.6, 73.4, 13.7]], [[-1.655, 0.246, 1.854], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[1.629, 0.801, -1.733], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 2.59162744161721),
    ([[2.52, 2.21, 0.86], [4.25, 1.35, 6.61], [58.9, 65.3, 62.0]], [[-0.931, 1.159, -1.003], [-0.864, 0.374, 0.141], [1.596, -0.453, 3.16]], [[-1.448, -0.438, -0.009], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 2.5034675043912795),
    ([[1.75, 2.37, 2.79], [5.28, 4.05, 2.85], [73.4, 62.4, 65.0]], [[-1.114, -0.253, 1.534], [-0.787, -0.472, -1.892], [-1.678, 1.742, -1.366]], [[-1.016, 1.256, 0.155], [0.485, 0.86, -2.103], [0.312, 1.982, 0.319]], 1.9718909348022111),
    ([[0.81, 2.77, 2.37], [4.95, 3.33, 5.08], [34.4, 13.9, 14.2]], [[-1.819, -1.319, -1.018], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0.541, 0.321, 0.362], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 3.2211119593871524),
    ([[2.56, 0.74, 1.47], [1.56, 3.93, 1.55], [10.0, 12.8, 34.2]], [[1.052, -0.872, 0.967], [-1.741, -0.061, 0.197], [0.174, 0.493, -1.113]], [[-1.067, -0.851, -0.114], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 1.8324135488798854),
    ([[1.85, 2.78, 2.0], [7.94, 2.63, 5.64], [48.3, 43.5, 52.1]], [[0.202, -0.653, 0.566], [-0.849, 0.303, 0.544], [1.234, -1.76, -2.442]], [[-1.666, -0.084, -0.189], [-1.11, -0.903, -1.402], [-0.662, -0.203, -4.214]], 1.4017796672097453),
    ([[2.87, 1.08, 2.02], [2.56, 5.17, 3.47], [28.9, 40.6, 49.0]], [[0.393, 0.754, -0.926], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[-1.634, -0.987, -0.693], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 1.9482744240080996),
    ([[2.02, 1.54, 1.28], [1.69, 5.18, 1.77], [43.8, 56.6, 51.7]], [[-1.361, -0.576, 1.764], [0.367, -0.262, -0.77], [0.808, -1.046, 0.106]], [[-1.637, 0.715, -0.254], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], 2.0203278160821823),
    ([[1.24, 1.52, 2.47], [6.11, 3.96, 1.08], [53.6, 35.5, 13.8]], [[0.524, -0.22, -0.774], [-0.212, 1.075, -0.088], [3.58, 1.123, 0.69]], [[-0.923, 0.083, -1.009], [-0.489, 0.052, 1.649], [2.509, 1.141, -0.124]], 4.011638457774532),
];

fn limits(fields: &[(Field, Vec<f64>)]) -> Limits {
    let constants = |values: &[f64]| values.iter().map(|value| Profile::Constant(*value)).collect();
    let start = Limits::none_for(fields[0].1.len());
    fields.iter().fold(start, |limits, (field, values)| limits.replace(*field, constants(values)).unwrap())
}

fn up_to_jerk([velocity, acceleration, jerk]: [&[f64]; 3]) -> Limits {
    limits(&[
        (Field::Velocity, velocity.to_vec()),
        (Field::Acceleration, acceleration.to_vec()),
        (Field::Jerk, jerk.to_vec()),
    ])
}

fn state([q, qd, qdd]: [&[f64]; 3]) -> ArmState {
    ArmState { q: q.to_vec(), qd: qd.to_vec(), qdd: qdd.to_vec() }
}

fn rest(q: &[f64]) -> ArmState {
    ArmState::at_rest(q)
}

fn at(trajectory: &Trajectory, t: f64) -> ArmState {
    let n = trajectory.joints().len();
    let mut state = rest(&vec![0.0; n]);
    trajectory.at(t, &mut state.q, &mut state.qd, &mut state.qdd).unwrap();
    state
}

fn largest_difference(one: &ArmState, other: &ArmState) -> f64 {
    let both = [(&one.q, &other.q), (&one.qd, &other.qd), (&one.qdd, &other.qdd)];
    both.iter().flat_map(|(a, b)| a.iter().zip(b.iter())).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn message(from: &ArmState, to: &ArmState, limits: &Limits) -> String {
    state_to_state(from, to, limits).unwrap_err().to_string()
}

#[test]
fn durations_are_those_of_ruckig() {
    for (rates, from, to, duration) in &BY_RUCKIG {
        let rows = |rows: &'static Rows| [&rows[0][..], &rows[1], &rows[2]];
        let found = state_to_state(&state(rows(from)), &state(rows(to)), &up_to_jerk(rows(rates))).unwrap();
        assert!((found.duration() - duration).abs() < 1e-9, "{} instead of {duration}", found.duration());
        for (t, wanted) in [(0.0, from), (found.duration(), to)] {
            let error = largest_difference(&at(&found, t), &state(rows(wanted)));
            assert!(error < 1e-11, "{error} at {t}");
        }
    }
}

/// Issue 14 of rsruckig, which ruckig 0.19.4 fails on too; beside it, at a velocity of 0.3477303818, it computes 2.313557098 s.
#[test]
fn a_motion_that_ruckig_does_not_find_is_found() {
    let from = state([&[1.1032599505208334], &[0.363378125], &[0.8525]]);
    let to = state([&[2.9033375720687795], &[0.3477303818980908], &[-0.833942902]]);
    let found = state_to_state(&from, &to, &up_to_jerk([&[1.0], &[1.0], &[1.0]])).unwrap();
    assert!((found.duration() - 2.313557098).abs() < 1e-8, "{}", found.duration());
    assert!(largest_difference(&at(&found, found.duration()), &to) < 1e-12);
}

#[test]
fn a_motion_from_rest_takes_the_time_of_its_formula() {
    // With jerk alone, four phases of (d / 2 J)^(1/3); with acceleration alone, 2 sqrt(d / A); with velocity alone, d / V.
    let d: f64 = 0.3;
    for (field, limit, expected) in [
        (Field::Jerk, 50.0, 4.0 * (d / 100.0).cbrt()),
        (Field::Acceleration, 5.0, 2.0 * (d / 5.0).sqrt()),
        (Field::Velocity, 1.5, d / 1.5),
    ] {
        let motion = state_to_state(&rest(&[0.1, 1.0]), &rest(&[0.1 + d, 0.9]), &limits(&[(field, vec![limit; 2])]));
        let duration = motion.unwrap().duration();
        assert!((duration - expected).abs() < 1e-12, "{field}: {duration} instead of {expected}");
    }
}

#[test]
fn tiny_motions_take_the_time_that_their_length_needs() {
    let limits = up_to_jerk([&[1.5], &[5.0], &[50.0]]);
    for exponent in 1..16 {
        let d = 10.0_f64.powi(-exponent);
        let motion = state_to_state(&rest(&[0.0]), &rest(&[d]), &limits).unwrap();
        let expected = if exponent == 1 { motion.duration() } else { 4.0 * (d / 100.0).cbrt() };
        assert!((motion.duration() / expected - 1.0).abs() < 1e-9, "{d}: {}", motion.duration());
    }
}

#[test]
fn the_rest_of_a_motion_is_found_again_from_every_state_on_it() {
    let limits = up_to_jerk([&[1.5, 2.0], &[5.0, 4.0], &[50.0, 30.0]]);
    let to = rest(&[0.6, -0.4]);
    let whole = state_to_state(&rest(&[0.0, 0.0]), &to, &limits).unwrap();
    for i in 0..1000 {
        let t = whole.duration() * f64::from(i) / 1000.0;
        let rest = state_to_state(&at(&whole, t), &to, &limits).unwrap();
        assert!((t + rest.duration() - whole.duration()).abs() < 1e-5, "from {t}: {}", rest.duration());
    }
}

#[test]
fn a_joint_outside_its_limits_returns_inside_first() {
    let limits = up_to_jerk([&[1.0], &[4.0], &[40.0]]);
    for (v, a) in [(1.8, 0.0), (-1.8, 0.0), (0.5, 9.0), (0.95, 3.9), (1.5, -4.0), (-0.2, -7.0)] {
        let motion = state_to_state(&state([&[0.0], &[v], &[a]]), &rest(&[2.0]), &limits).unwrap();
        assert!(motion.max_jerk()[0] <= 40.0 * (1.0 + 1e-9));
        let mut inside_since = 0.0;
        for i in 0..=2000 {
            let t = motion.duration() * f64::from(i) / 2000.0;
            let ArmState { qd, qdd, .. } = at(&motion, t);
            if qd[0].abs() > 1.0 + 1e-9 || qdd[0].abs() > 4.0 + 1e-9 {
                inside_since = t;
            }
        }
        assert!(inside_since < 0.6, "{v}, {a}: outside until {inside_since}");
    }
}

#[test]
fn errors_name_the_joint_and_the_bound() {
    let open = up_to_jerk([&[1.0; 2], &[4.0; 2], &[40.0; 2]]);
    let two = |q: &[f64; 2]| rest(q);
    assert_eq!(
        message(&two(&[0.0; 2]), &two(&[0.0; 2]), &open),
        "trajectory: start_q and end_q, with their velocities and accelerations, are the same state: nothing moves"
    );
    assert_eq!(message(&two(&[0.0; 2]), &rest(&[0.0]), &open), "end_q: expected 2 joints, got 1");
    let fast = state([&[1.0, 0.0], &[0.0, 1.2], &[0.0; 2]]);
    assert_eq!(
        message(&two(&[0.0; 2]), &fast, &open),
        "infeasible: the final velocity (end_qd) of joint '1' is 1.200, its limit 1.000"
    );
    let rising = state([&[1.0, 0.0], &[0.0, -0.9], &[0.0, 3.5]]);
    assert_eq!(
        message(&two(&[0.0; 2]), &rising, &open),
        "infeasible: to end with its velocity and acceleration (end_qd, end_qdd), joint '1' would need a velocity of -1.053 \
         shortly before; its limit is 1.000"
    );
    let narrow = open.clone().replace(Field::Upper, vec![Profile::Constant(1.0)]).unwrap();
    assert_eq!(
        message(&state([&[0.98, 0.0], &[1.0, 0.0], &[0.0; 2]]), &two(&[0.5, 0.0]), &narrow),
        "infeasible: joint '0' would get to 1.153, beyond its upper limit 1.000: begin or end it slower, or farther from its \
         limit"
    );
    assert_eq!(
        message(&two(&[0.0; 2]), &two(&[1.5, 0.0]), &narrow),
        "end_q: joint '0' at 1.5 is outside its limits [-inf, 1] by 0.5000 rad: moving it to the limit changes the pose"
    );
    let none = Limits::none_for(2).replace(Field::Jerk, vec![Profile::Constant(5.0), Profile::Constant(f64::INFINITY)]);
    assert_eq!(
        message(&two(&[0.0; 2]), &two(&[1.0, 0.0]), &none.unwrap()),
        "joint '1' has neither a velocity nor an acceleration limit, so that nothing sets its pace: give \
         a velocity limit"
    );
    let still = limits(&[(Field::Velocity, vec![1.0, 0.0])]);
    assert_eq!(
        message(&two(&[0.0; 2]), &two(&[1.0, 0.0]), &still),
        "velocity limit of joint '1' must be positive, got 0"
    );
}

/// Limits of a joint (velocity, acceleration, jerk), and two states (position, velocity, acceleration).
type OneJoint = ([f64; 3], [f64; 3], [f64; 3]);

/// Limits of a joint, and states inside them from which it can stop.
fn joint() -> impl Strategy<Value = OneJoint> {
    let part = -1.0..1.0_f64;
    let logarithms = (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64);
    let size = prop_oneof![Just(0.0), Just(1.0), (-15.0..0.0_f64).prop_map(|e| 10.0_f64.powf(e))];
    let fractions = [part.clone(), part.clone(), part.clone(), part.clone(), part.clone(), part];
    (logarithms, fractions, size.clone(), size).prop_map(|((v, a, j), [q0, v0, a0, q1, v1, a1], small, smaller)| {
        let [v, a, j] = [1.5 * 10.0_f64.powf(v), 5.0 * 10.0_f64.powf(a), 50.0 * 10.0_f64.powf(j)];
        // Velocities that leave room to end the acceleration, after the start and before the end.
        let room = |velocity: f64, acceleration: f64| {
            let change = 0.5 * acceleration * acceleration.abs() / j;
            (velocity - change).clamp(-v, v).min(v - change).max(-v - change)
        };
        let (a0, a1) = (small * a0 * a.min((2.0 * j * v).sqrt()), small * a1 * a.min((2.0 * j * v).sqrt()));
        let (v0, v1) = (room(small * v0 * v, a0), -room(-small * v1 * v, a1));
        ([v, a, j], [2.0 * q0, v0, a0], [if smaller > 0.0 { 2.0 * q0 + smaller * q1 } else { 2.0 * q1 }, v1, a1])
    })
}

/// Round numbers: one, two or five times a power of ten.
fn round() -> impl Strategy<Value = f64> {
    (prop::sample::select(vec![1.0, 2.0, 5.0]), -3..=3_i32).prop_map(|(digit, power)| digit * 10.0_f64.powi(power))
}

/// Limits of a joint (velocity, acceleration, jerk), half of them with two reached at once.
fn round_limits() -> impl Strategy<Value = [f64; 3]> {
    let tied = prop::option::of(prop::sample::select(vec![1.0, 1.0, 0.5, 2.0, 0.25, 4.0]));
    (round(), round(), round(), tied)
        .prop_map(|(v, a, j, tied)| [v, a, tied.map_or(j, |fraction| fraction * a * a / v)])
}

/// Fractions of a limit: none, all, round ones, any; and a number of rounding steps beside them.
fn part() -> impl Strategy<Value = (f64, i32)> {
    let fraction = prop_oneof![
        prop::sample::select(vec![0.0, 1.0, -1.0, 0.5, -0.5, 0.2]),
        -1.0..1.0_f64,
        (-16.0..0.0_f64).prop_map(|power| 10.0_f64.powf(power)),
    ];
    (fraction, -1..=1)
}

/// Fraction of a limit, shifted by rounding steps.
fn of(limit: f64, (fraction, steps): (f64, i32)) -> f64 {
    let value: f64 = fraction * limit;
    match steps {
        _ if value == 0.0 => value,
        -1 => value.next_down(),
        1 => value.next_up(),
        _ => value,
    }
}

/// Velocity and acceleration at a start (`sense` 1) or an end (-1), at the limits in many ways. With `tied` the joint reaches
/// that fraction of its velocity limit when the acceleration has ended.
fn rates([v, a, j]: [f64; 3], sense: f64, parts: [(f64, i32); 2], tied: Option<(f64, i32)>) -> (f64, f64) {
    let acceleration = of(a, parts[0]).clamp(-a, a);
    let change = sense * 0.5 * acceleration * acceleration.abs() / j;
    let velocity = tied.map_or(of(v, parts[1]), |part| of(v, part) - change);
    let kept = velocity.abs() <= v && (velocity + change).abs() <= v;
    if kept { (velocity, acceleration) } else { (0.0, 0.0) }
}

/// Joint with round limits, in states that are at the limits in many ways.
fn round_joint() -> impl Strategy<Value = OneJoint> {
    let state = || (part(), part(), prop::option::of(part()));
    let displacement = prop_oneof![
        Just((0.0, 0)),
        round().prop_map(|d| (d, 0)),
        (-1..=1).prop_map(|steps| (f64::INFINITY, steps)), // that of the limits
        part(),
    ];
    (round_limits(), state(), prop::option::of(state()), displacement, prop::sample::select(vec![0.0, 1.0, -0.7]))
        .prop_map(|(limits, start, end, (d, steps), q)| {
            let [v, a, j] = limits;
            let (v0, a0) = rates(limits, 1.0, [start.0, start.1], start.2);
            let (v1, a1) = end.map_or((0.0, 0.0), |end| rates(limits, -1.0, [end.0, end.1], end.2));
            let d = if d.is_infinite() { of(v * (v / a + a / j), (1.0, steps)) } else { d };
            (limits, [q, v0, a0], [q + d, v1, a1])
        })
}

const REFUSED: [&str; 2] = ["do not resolve its shortest phases", "are the same state: nothing moves"];

/// Admissible relative excess over a limit: rounding, and the effect of a rate within the resolution of the times.
fn excess(limit: f64, rate: f64, duration: f64) -> f64 {
    1e-9 + 4.0 * f64::EPSILON * duration * rate / limit
}

proptest! {
    #![proptest_config(drawn(2000))]

    #[test]
    fn limits_hold_throughout_and_the_ends_are_met(
        joints in prop::collection::vec(prop_oneof![joint(), round_joint()], 1..5)
    ) {
        let column = |pick: fn(&OneJoint) -> f64| joints.iter().map(pick).collect::<Vec<f64>>();
        let rates = [column(|j| j.0[0]), column(|j| j.0[1]), column(|j| j.0[2])];
        let from = ArmState { q: column(|j| j.1[0]), qd: column(|j| j.1[1]), qdd: column(|j| j.1[2]) };
        let to = ArmState { q: column(|j| j.2[0]), qd: column(|j| j.2[1]), qdd: column(|j| j.2[2]) };
        prop_assume!(from.qd != to.qd || from.qdd != to.qdd || largest_difference(&from, &to) > 1e-15);
        let motion = match state_to_state(&from, &to, &up_to_jerk([&rates[0], &rates[1], &rates[2]])) {
            // Named, not computed: motions of weeks with phases of microseconds, and ways shorter than rounding.
            Err(error) if REFUSED.iter().any(|refused| error.to_string().contains(refused)) => return Ok(()),
            motion => motion.unwrap(),
        };
        let duration = motion.duration();
        for (order, found) in [motion.max_velocity(), motion.max_acceleration(), motion.max_jerk()].iter().enumerate() {
            for (j, found) in found.iter().enumerate() {
                let (limit, rate) = (rates[order][j], if order < 2 { rates[order + 1][j] } else { 0.0 });
                prop_assert!(*found <= limit * (1.0 + excess(limit, rate, duration)), "{found} of {limit}");
            }
        }
        let scale = 1.0 + rates.iter().flatten().copied().fold(0.0, f64::max) * motion.duration();
        prop_assert!(largest_difference(&at(&motion, 0.0), &from) < 1e-11 * scale);
        prop_assert!(largest_difference(&at(&motion, motion.duration()), &to) < 1e-11 * scale);
        for knot in &motion.knots()[1..motion.knots().len() - 1] {
            let [before, after] = [knot * (1.0 - 1e-12), knot * (1.0 + 1e-12)].map(|t| at(&motion, t));
            prop_assert!(largest_difference(&before, &after) < 1e-9 * scale);
        }
    }

    /// Reversed motions: they connect the states in reverse order, with velocities reversed.
    #[test]
    fn backwards_takes_as_long(joint in joint()) {
        let ([velocity, acceleration, jerk], [q0, v0, a0], [q1, v1, a1]) = joint;
        let rates = Rates { velocity, acceleration, jerk };
        let there = Transfer::new(MotionState { q: q0, v: v0, a: a0 }, MotionState { q: q1, v: v1, a: a1 }, &rates);
        let back = Transfer::new(MotionState { q: q1, v: -v1, a: a1 }, MotionState { q: q0, v: -v0, a: a0 }, &rates);
        let (there, back) = (there.duration(0.0), back.duration(0.0));
        prop_assert!((there - back).abs() <= 1e-6 * there + 1e-9, "{there} and {back}");
    }

    /// Durations between the extremal motions of a joint: all are possible from the shortest on, except for at most two gaps.
    #[test]
    fn a_duration_that_is_possible_has_a_motion(joint in joint(), factor in 1.0..4.0_f64) {
        let ([velocity, acceleration, jerk], [q0, v0, a0], [q1, v1, a1]) = joint;
        let rates = Rates { velocity, acceleration, jerk };
        let to = MotionState { q: q1, v: v1, a: a1 };
        let transfer = Transfer::new(MotionState { q: q0, v: v0, a: a0 }, to, &rates);
        let shortest = transfer.duration(0.0);
        let longer = transfer.duration(factor * shortest);
        prop_assert!(shortest.is_finite() && longer >= factor * shortest && transfer.duration(longer) == longer);
        if shortest > 0.0 {
            let profile = transfer.motion(longer);
            let end = profile.at(longer);
            let scale = 1.0 + (velocity + acceleration + jerk) * longer;
            prop_assert!((end.q - to.q).abs() + (end.v - to.v).abs() + (end.a - to.a).abs() < 1e-11 * scale);
        }
    }

    /// Starts that differ by rounding: they take the same time, up to the square root of rounding.
    #[test]
    fn the_next_start_takes_as_long(joint in round_joint(), step in prop::sample::select(vec![f64::next_up, f64::next_down])) {
        let ([velocity, acceleration, jerk], [q0, v0, a0], [q1, ..]) = joint;
        let rates = Rates { velocity, acceleration, jerk };
        let duration = |v: f64| {
            Transfer::new(MotionState { q: q0, v, a: a0 }, MotionState::rest(q1), &rates).duration(0.0)
        };
        let (one, next) = (duration(v0), duration(step(v0)));
        prop_assert!((one - next).abs() <= 1e-6 * one + 1e-5 * (velocity / jerk).sqrt(), "{one} and {next}");
    }

    /// Starts inside the limits or not, unless the return takes centuries: a joint reaches any rest within its jerk limit, and
    /// its end is exact.
    #[test]
    fn every_start_has_a_motion(
        (limits, parts, beyond, d) in (round_limits(), [part(), part()], [round(), round()], round())
    ) {
        let [velocity, acceleration, jerk] = limits;
        let (v0, a0) = (of(velocity * beyond[0], parts[0]), of(acceleration * beyond[1], parts[1]));
        let a0 = a0.clamp(-(100.0 * velocity * jerk).sqrt(), (100.0 * velocity * jerk).sqrt());
        let v0 = v0.clamp(-50.0 * velocity, 50.0 * velocity);
        let from = state([&[0.0], &[v0], &[a0]]);
        let motion = state_to_state(&from, &rest(&[d]), &up_to_jerk([&[velocity], &[acceleration], &[jerk]])).unwrap();
        prop_assert!(motion.max_jerk()[0] <= jerk * (1.0 + 1e-9));
        let end = at(&motion, motion.duration());
        let (fastest, hardest) = (motion.max_velocity()[0], motion.max_acceleration()[0]);
        let resolution = 16.0 * f64::EPSILON * motion.duration();
        prop_assert!((end.q[0] - d).abs() <= 1e-9 * d + resolution * velocity, "{} of {d}", end.q[0]);
        prop_assert!(end.qd[0].abs() <= 1e-9 * fastest + resolution * hardest, "{}", end.qd[0]);
    }
}
