//! Approaches from rest onto a moving path, and the motion between ticks under acceleration limits.

use ikcore::limits::{Field, Limits, Profile};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Tolerance;
use ikcore::tracking::{Record, TrackOptions, track};

const DT: f64 = 0.01;
const ACCELERATION: f64 = 5.0;

fn reference() -> Reference {
    let plane = Plane::xy([0.4, 0.2, 0.4]).unwrap();
    Path::new(Circle::new(plane, 0.3, 5.0).unwrap()).sample(DT).unwrap()
}

fn tracked(ease: bool, limits: impl Fn(Limits) -> Limits) -> ikcore::Result<Record> {
    let robot = Robot::named("ur5e").unwrap();
    let options = TrackOptions {
        limits: Some(limits(Limits::of(&robot))),
        tolerance: Tolerance { position: 1e-5, rotation: 1e-5 },
        ease,
        ..TrackOptions::default()
    };
    track(&robot, &reference(), None, &options, &mut Unattended)
}

fn limited(limits: Limits) -> Limits {
    limits.replace(Field::Acceleration, vec![Profile::Constant(ACCELERATION)]).unwrap()
}

#[test]
fn an_eased_track_meets_its_path_and_stays_on_it() {
    let record = tracked(true, limited).unwrap();
    assert_eq!(record.status, Status::Solved, "{}", record.message());
    let joined = record.joined().unwrap();
    assert!((2..100).contains(&joined), "{joined}");
    assert_eq!((record.max_violation, record.rows()), (0.0, 501));
    // At rest in the beginning, and never beyond the acceleration limit from tick to tick.
    let n = record.dof;
    for i in 0..record.rows() - 1 {
        for j in 0..n {
            let at = |row: usize| record.q[row * n + j];
            let change = at(i + 1) - 2.0 * at(i) + at(i.saturating_sub(1));
            assert!(change.abs() <= ACCELERATION * DT * DT * (1.0 + 1e-9), "row {i}, joint {j}: {change}");
        }
    }
}

#[test]
fn without_ease_the_message_says_so() {
    let record = tracked(false, limited).unwrap();
    assert_eq!(record.status, Status::Lost);
    let advice = "the path moves at its start, where the arm is at rest: an eased start begins with an approach \
                  within the limits";
    assert!(record.message().ends_with(advice), "{}", record.message());
}

#[test]
fn a_path_that_no_motion_meets_is_a_status() {
    let slow = |limits: Limits| limits.replace(Field::Acceleration, vec![Profile::Constant(0.01)]).unwrap();
    let record = tracked(true, slow).unwrap();
    assert_eq!(record.status, Status::Lost);
    let advice = "no motion within the limits meets the path before it ends: slow it down or raise the limits";
    assert!(record.message().ends_with(advice), "{}", record.message());
}

#[test]
fn ease_without_acceleration_limits_is_an_error() {
    let error = tracked(true, |limits| limits).unwrap_err().to_string();
    let expected = "an eased start is an approach under acceleration or jerk limits, and there are none: give an acceleration limit";
    assert_eq!(error, expected);
}

#[test]
fn the_motion_between_ticks_keeps_the_acceleration_limit() {
    for ease in [true, false] {
        let record = tracked(ease, limited).unwrap();
        let names = (0..6).map(|j| j.to_string()).collect();
        let motion = record.trajectory(names).unwrap();
        for (reached, limit) in motion.max_acceleration().into_iter().zip([ACCELERATION; 6]) {
            assert!(reached <= limit * (1.0 + 1e-9) && reached > 0.0, "{reached}");
        }
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; 6]);
        for row in 0..record.rows() {
            motion.at(record.time()[row], &mut q, &mut qd, &mut qdd).unwrap();
            for (q, commanded) in q.iter().zip(&record.q[row * 6..]) {
                assert!((q - commanded).abs() <= ACCELERATION * DT * DT / 6.0 * (1.0 + 1e-9));
            }
        }
    }
    // Without acceleration limits the velocity jumps from tick to tick, as it was commanded.
    let linear = tracked(false, |limits| limits).unwrap().trajectory((0..6).map(|j| j.to_string()).collect()).unwrap();
    assert_eq!(linear.degree(), 1);
}
