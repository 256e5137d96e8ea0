//! Control loop with a jumping target: all joints move in proportion, brake in time, and reverse no more than the path
//! requires.

use crate::common::{pose_at, robot};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Twist;
use ikcore::tracking::{Session, Step, TrackOptions};

const DT: f64 = 0.01;
const START: [f64; 7] = [0.3, 0.6, 0.2, -1.2, 0.1, 0.9, 0.0];

fn limits(robot: &Robot, acceleration: Option<f64>) -> Limits {
    let limits = Limits::of(robot).replace(Field::Velocity, vec![Profile::Constant(1.0); 7]).unwrap();
    match acceleration {
        Some(most) => limits.replace(Field::Acceleration, vec![Profile::Constant(most); 7]).unwrap(),
        None => limits,
    }
}

/// Joint velocities and steps of `ticks` ticks towards targets that begin `offset` (m) away and move at `velocity` (m/s).
fn follow(acceleration: Option<f64>, offset: [f64; 3], velocity: [f64; 3], ticks: usize) -> Vec<(Vec<f64>, Step)> {
    let iiwa = robot("iiwa14");
    let options = TrackOptions { limits: Some(limits(&iiwa, acceleration)), ..TrackOptions::default() };
    let mut session = Session::new(&iiwa, &START, DT, &options).unwrap();
    let shifted = |by: [f64; 3]| pose_at(&iiwa, &START).moved(&Twist { linear: by, angular: [0.0; 3] }, 1.0);
    let at = |tick: usize| shifted(std::array::from_fn(|k| offset[k] + tick as f64 * DT * velocity[k]));
    session.begin(pose_at(&iiwa, &START).into()).unwrap();
    let mut step = |tick: usize| {
        let step = session.step(&at(tick), &mut Unattended).unwrap();
        assert!(step.inside_limits, "tick {tick}");
        (session.qd().to_vec(), step)
    };
    (0..ticks).map(&mut step).collect()
}

/// Largest change of a joint velocity from one tick to the next.
fn largest_change(record: &[(Vec<f64>, Step)]) -> f64 {
    let changes = record.windows(2).flat_map(|two| two[0].0.iter().zip(&two[1].0).map(|(a, b)| (a - b).abs()));
    changes.fold(0.0, f64::max)
}

#[test]
fn joints_do_not_chatter_on_the_way_to_a_target_that_jumped() {
    let record = follow(None, [0.0, 0.25, -0.15], [0.0; 3], 120);
    let arrived = record.iter().position(|(_, step)| step.status == Status::Solved).unwrap();
    assert!(arrived < 60, "{arrived}");
    assert!(record[1..arrived].iter().all(|(_, step)| step.status == Status::Improved));
    assert!(record[arrived..].iter().all(|(_, step)| step.status == Status::Solved));
    // One joint is at its limit all the way, and velocities change as the way turns, not from one limit to the other.
    let on_the_way = &record[..arrived];
    for (qd, step) in on_the_way {
        let fastest = qd.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!((0.99..=1.0 + 1e-12).contains(&fastest), "{fastest}");
        // Position and orientation are on a straight way, though it is walked by the model of each tick alone.
        assert!(step.error.rotation < 2e-3, "{}", step.error.rotation);
    }
    assert!(largest_change(on_the_way) < 0.05, "{}", largest_change(on_the_way));
}

#[test]
fn limited_accelerations_stop_at_a_target_that_jumped() {
    let record = follow(Some(5.0), [0.0, 0.25, -0.15], [0.0; 3], 200);
    let errors: Vec<_> = record.iter().map(|(_, step)| step.error.position).collect();
    assert!(errors.windows(2).all(|two| two[1] <= two[0] + 1e-9), "it never goes past the target");
    assert_eq!(record.last().unwrap().1.status, Status::Solved);
    assert!(record.last().unwrap().0.iter().all(|v| v.abs() < 1e-6), "and stands still there");
    assert!(largest_change(&record) <= 5.0 * DT * (1.0 + 1e-9), "{}", largest_change(&record));
}

#[test]
fn limited_accelerations_catch_up_with_a_moving_target() {
    let record = follow(Some(5.0), [0.1, 0.0, 0.0], [0.0, 0.05, 0.0], 150);
    let joined = record.iter().position(|(_, step)| step.status == Status::Solved).unwrap();
    assert!(joined < 100, "{joined}");
    assert!(record[joined..].iter().all(|(_, step)| step.status == Status::Solved), "and stays with it");
}
