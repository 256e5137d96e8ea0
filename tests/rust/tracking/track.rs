//! Tracking: limits that are never violated, targets that cannot be followed, the model-based rule, and the record.

use std::f64::consts::FRAC_PI_2;

use crate::common::circles::{
    DT, OFF5, OFF7, Task, beetle, circle, count, descent, five_links, iiwa, sinusoid, velocity_limits,
};
use crate::common::{bits, jumping, robot};
use ikcore::limits::{Field, LimitAt, Limits, Profile, Sinusoid};
use ikcore::nalgebra::{Rotation3, Vector3};
use ikcore::path::{Path, Polyline};
use ikcore::solver::{BasVariant, Monitor, Status, Unattended};
use ikcore::task::Tolerance;
use ikcore::tracking::{TickRule, TrackOptions, track};

#[test]
fn a_circle_that_leaves_the_reach_is_followed_where_it_can_be() {
    let task = Task { circle: circle([4.0, 1.0, 0.0], 2.2), ..five_links() };
    for (rule, band) in [
        (beetle(BasVariant::Star, 1.0, 50), 4e-5),
        (beetle(BasVariant::Chain, 0.3, 30), 5e-5),
        (descent(), 1e-6),
        (TickRule::MidStep, 1e-6),
    ] {
        let record = task.track(rule.clone(), band, 1);
        assert_eq!(record.status, Status::Lost, "{rule:?}: {}", record.message());
        let capped = count(&record, Status::Capped);
        assert!((5..40).contains(&capped), "{rule:?}: {capped} capped steps");
        let worst = record.position_error[76..].iter().copied().fold(0.0, f64::max);
        // At its farthest the circle is 0.22 m out of reach, and the arm must slow down to turn there.
        assert!(worst < 0.35, "{rule:?}: {worst}");
        // The circle begins and ends out of reach; half-way round it is well inside.
        assert_eq!(record.step_status[60..90], [Status::Solved; 30], "{rule:?}");
    }
}

#[test]
fn limits_too_small_to_follow_end_in_statuses() {
    let task = Task { limit: 0.02, ..five_links() };
    for (rule, band) in [
        (beetle(BasVariant::Star, 1.0, 50), 4e-5),
        (beetle(BasVariant::Chain, 0.3, 30), 5e-5),
        (descent(), 1e-6),
        (TickRule::MidStep, 1e-6),
    ] {
        let record = task.track(rule.clone(), band, 1);
        assert!(record.status != Status::Solved, "{rule:?}: {}", record.message());
        let capped = count(&record, Status::Capped);
        assert!((50..150).contains(&capped), "{rule:?}: {capped} capped steps");
        assert!(record.position_error.iter().all(|error| *error < 2.0), "{rule:?}: the best is kept");
        // A capped step is worse than the one before only because the path moved on: standing still is no better.
        for i in (1..151).filter(|i| record.step_status[*i] == Status::Capped) {
            let before = task.robot.tip_position(&record.q[(i - 1) * 5..i * 5]);
            let wanted = record.reference[i];
            let standing = (0..3).map(|k| (before[k] - wanted[k]).powi(2)).sum::<f64>().sqrt();
            assert!(record.position_error[i] <= standing, "{rule:?}: row {i}");
        }
    }
}

#[test]
fn a_descent_tracks_to_a_nanometre() {
    for task in [five_links(), iiwa()] {
        let record = task.track(descent(), 1e-9, 0);
        assert_eq!(record.status, Status::Solved, "{}", record.message());
        assert!(record.evaluations() < 1500, "{} evaluations", record.evaluations());
    }
}

/// Starts on the path, stretched out (singular) or half a metre off it.
fn model_based_starts() -> [(Task, Vec<f64>); 5] {
    let on5 = [0.6697427192, -0.3400667941, -0.2474717864, -0.2588906663, 0.3263813181];
    let on7 = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];
    let (off5, off7) = (OFF5.to_vec(), OFF7.to_vec());
    [(five_links(), on5.to_vec()), (five_links(), off5), (iiwa(), on7.to_vec()), (iiwa(), off7), (iiwa(), vec![0.0; 7])]
}

#[test]
fn the_model_tracks_to_a_nanometre_in_two_evaluations_a_step() {
    for (task, start) in model_based_starts() {
        let task = Task { start, ..task };
        let record = task.track(TickRule::MidStep, 1e-9, 0);
        assert_eq!(record.status, Status::Solved, "{}", record.message());
        let from = record.joined().unwrap() + 3;
        let steady: usize = record.step_evaluations[from..].iter().sum();
        assert!(steady <= 2 * (151 - from), "{steady} evaluations from row {from} on");
        let worst = record.position_error[from..].iter().copied().fold(0.0, f64::max);
        assert!(worst < 3e-10, "{} from {:?}: {worst}", task.robot.name(), task.start);
    }
}

#[test]
fn the_model_tracks_to_a_micrometre_in_one_evaluation_a_step() {
    let record = iiwa().track(TickRule::MidStep, 1e-6, 0);
    assert!(record.step_evaluations[20..].iter().all(|count| *count == 1));
}

#[test]
fn the_model_based_rule_damps_unneeded_self_motion() {
    // Extrapolated joint velocities would: after a start beside the path the arm would go on turning about its elbow.
    let rms = |rule: TickRule| {
        let record = iiwa().track(rule, 1e-9, 0);
        let steady = &record.qd()[75 * record.dof..];
        (steady.iter().map(|v| v * v).sum::<f64>() / steady.len() as f64).sqrt()
    };
    let (model, descent) = (rms(TickRule::MidStep), rms(descent()));
    assert!(model < 1.02 * descent, "{model} rad/s, Levenberg-Marquardt {descent} rad/s");
}

#[test]
fn a_record_holds_a_row_for_the_start_and_one_a_tick() {
    let task = iiwa();
    let record = task.track(beetle(BasVariant::Chain, 1.0, 30), 2.2e-5, 3);
    let (rows, n, qd) = (151, 7, record.qd());
    assert_eq!((record.dof, record.rows(), record.q.len(), qd.len()), (n, rows, rows * n, rows * n));
    assert_eq!((record.position.len(), record.reference.len(), record.velocity_limit().len()), (rows, rows, rows * n));
    assert_eq!(
        (record.step_status.len(), record.step_evaluations.len(), record.step_iterations.len()),
        (rows, rows, rows)
    );
    assert_eq!(record.evaluations(), record.step_evaluations.iter().sum::<usize>());
    assert_eq!((&record.q[..n], &qd[..n], record.time()[0]), (&OFF7[..], &[0.0; 7][..], 0.0));
    assert!(record.velocity_limit()[..n].iter().all(|limit| limit.is_nan()));
    assert!((record.position_error[0] - 0.1).abs() < 0.02, "{}", record.position_error[0]);
    assert!(record.rotation_error.iter().all(|error| error.is_nan()));
    for i in 0..rows {
        assert_eq!(record.time()[i], i as f64 * DT);
        assert_eq!(record.reference[i], task.reference().position(i));
        assert_eq!(record.position[i], task.robot.tip_position(&record.q[i * n..(i + 1) * n]));
        let distance = (0..3).map(|k| (record.position[i][k] - record.reference[i][k]).powi(2)).sum::<f64>().sqrt();
        assert!((record.position_error[i] - distance).abs() < 1e-15);
    }
    for i in n..rows * n {
        assert_eq!(qd[i], (record.q[i] - record.q[i - n]) / DT);
    }
    assert_eq!(record.limits, velocity_limits(&task.robot, Profile::Sinusoid(sinusoid(2.0))), "the limits in force");
}

#[test]
fn limits_left_out_are_those_of_the_robot() {
    let task = iiwa();
    let record = task.track_with(&TrackOptions { limits: None, ..task.options(descent(), 1e-6, 0) });
    assert_eq!((record.limits.clone(), record.max_violation), (Limits::of(&task.robot), 0.0));
    let own: Vec<f64> = task.robot.joints().iter().map(|joint| joint.velocity).collect();
    assert_eq!(record.velocity_limit()[7..14], own);
}

#[test]
fn without_a_start_the_first_point_is_solved_for() {
    let task = iiwa();
    let options = task.options(descent(), 1e-6, 0);
    let record = track(&task.robot, &task.reference(), None, &options, &mut Unattended).unwrap();
    assert_eq!((record.joined(), record.status), (Some(0), Status::Solved), "{}", record.message());
    assert!(record.position_error[0] <= 1e-7, "{}", record.position_error[0]);
}

#[test]
fn the_seed_decides_every_bit() {
    let q = |seed| bits(&five_links().track(beetle(BasVariant::Star, 1.0, 50), 4e-5, seed).q);
    assert_eq!(q(1), q(1));
    assert_ne!(q(1), q(2));
}

#[test]
fn a_limit_is_taken_over_the_tick_or_at_its_start() {
    let task = five_links();
    for (limit_at, expected) in [(LimitAt::Interval, 0.2 - 0.004), (LimitAt::Start, 0.2)] {
        // Falls from 0.2 to 0.196 within the first tick.
        let falling = Profile::Sampled { step: 0.2, values: vec![0.2, 0.196] };
        let limits = Some(velocity_limits(&task.robot, falling));
        let record = task.track_with(&TrackOptions { limits, limit_at, ..task.options(descent(), 1e-6, 0) });
        assert_eq!(record.velocity_limit()[5..10], [expected; 5]);
        let fastest = record.qd()[5..10].iter().fold(0.0_f64, |fastest, qd| fastest.max(qd.abs()));
        assert!((fastest - expected).abs() < 1e-12, "{limit_at:?}: the arm is in a hurry, {fastest}");
        assert_eq!(record.max_violation, 0.0);
    }
}

#[test]
fn position_limits_may_close_in_over_time() {
    let task = iiwa();
    // Joint 2 starts at 0.2 rad and must be below 0.08 rad after 10 s.
    let closing = Profile::Sampled { step: 10.0, values: vec![0.3, 0.08] };
    let upper: Vec<Profile> = task.robot.joints().iter().map(|joint| Profile::Constant(joint.upper)).collect();
    let upper = upper.into_iter().enumerate().map(|(j, own)| if j == 1 { closing.clone() } else { own }).collect();
    let limits = Limits::of(&task.robot).replace(Field::Upper, upper).unwrap();
    let record = task.track_with(&TrackOptions { limits: Some(limits), ..task.options(descent(), 1e-6, 0) });
    assert_eq!((record.status, record.max_violation), (Status::Solved, 0.0), "{}", record.message());
    for (row, q) in record.q.chunks_exact(7).enumerate() {
        assert!(q[1] <= closing.at(record.time()[row]), "row {row}: {}", q[1]);
    }
    assert!(record.q.chunks_exact(7).any(|q| q[1] == 0.08), "the limit is never felt");
}

#[test]
fn a_velocity_limit_of_zero_locks_its_joint() {
    let task = iiwa();
    let mut velocity = vec![Profile::Constant(2.0); 7];
    velocity[2] = Profile::Constant(0.0);
    let limits = Some(Limits::of(&task.robot).replace(Field::Velocity, velocity).unwrap());
    for (solver, band) in [(descent(), 1e-6), (beetle(BasVariant::Chain, 1.0, 30), 2.2e-5)] {
        let record = task.track_with(&TrackOptions { limits: limits.clone(), ..task.options(solver, band, 0) });
        assert_eq!(record.status, Status::Solved, "{}", record.message());
        assert!(record.q.chunks_exact(7).all(|q| q[2].to_bits() == OFF7[2].to_bits()));
    }
}

#[test]
fn orientations_are_held_along_the_path() {
    let task = iiwa();
    let rotation = task.robot.fk(&OFF7).unwrap().rotation.into_inner();
    let path = Path::new(task.circle.clone()).with_orientation(rotation).unwrap();
    let tolerance = Tolerance { position: 1e-6, rotation: 1e-6 };
    for rule in [descent(), TickRule::MidStep] {
        let options = TrackOptions { tolerance, ..task.options(rule, 1e-6, 0) };
        let record = track(&task.robot, &path.sample(DT).unwrap(), Some(&OFF7), &options, &mut Unattended).unwrap();
        assert_eq!(record.status, Status::Solved, "{}", record.message());
        assert!(record.rotation_error[record.joined().unwrap()..].iter().all(|error| *error <= 1e-6));
        assert!(
            record.message().starts_with("in the band of 1.000e-6 m and 1.000e-6 rad from t = "),
            "{}",
            record.message()
        );
    }
}

#[test]
fn an_orientation_that_cannot_be_held_is_told_in_radians() {
    // A planar arm cannot turn its tip out of the plane.
    let task = five_links();
    let upright = Rotation3::from_axis_angle(&Vector3::x_axis(), FRAC_PI_2).into_inner();
    let path = Path::new(task.circle.clone()).with_orientation(upright).unwrap();
    let options = task.options(descent(), 1e-6, 0);
    let record = track(&task.robot, &path.sample(DT).unwrap(), Some(&OFF5), &options, &mut Unattended).unwrap();
    assert!(record.status != Status::Solved && record.joined().is_none());
    let nearest = record.rotation_error.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(nearest > FRAC_PI_2 - 1e-9, "{nearest}");
    assert!(record.message().contains(" m and 1.571 rad): "), "{}", record.message());
}

/// Monitor that stops once this many rows are done.
struct StopAfterRows(usize);

impl Monitor for StopAfterRows {
    fn keep_going(&mut self) -> bool {
        self.0 > 0
    }

    fn progress(&mut self, _done: usize, total: usize) {
        assert_eq!(total, 150);
        self.0 -= 1;
    }
}

#[test]
fn an_interrupted_track_keeps_the_ticks_that_were_finished() {
    let task = iiwa();
    for (solver, band) in [(beetle(BasVariant::Star, 3.0, 50), 1.7e-5), (descent(), 1e-9)] {
        let options = task.options(solver, band, 1);
        let full = task.track_with(&options);
        let start = Some(task.start.as_slice());
        let record = track(&task.robot, &task.reference(), start, &options, &mut StopAfterRows(40)).unwrap();
        assert_eq!((record.status, record.rows()), (Status::Interrupted, 41));
        assert_eq!(bits(&record.q), bits(&full.q[..41 * 7]));
        assert_eq!(record.message(), "interrupted at t = 8 s: run again to finish");
    }
}

#[test]
fn an_interruption_before_the_band_is_told_as_one() {
    let task = Task { limit: 0.02, ..five_links() };
    let options = task.options(descent(), 1e-6, 0);
    let start = Some(task.start.as_slice());
    let record = track(&task.robot, &task.reference(), start, &options, &mut StopAfterRows(3)).unwrap();
    assert_eq!(record.message(), "interrupted at t = 0.6 s: run again to finish");
}

#[test]
fn messages_say_how_it_went() {
    let record = iiwa().track(descent(), 1e-6, 0);
    let since = record.time()[record.joined().unwrap()];
    assert!(
        record.message().starts_with(&format!("in the band of 1.000e-6 m from t = {since} s on; worst error there "))
    );
    let far = Path::new(Polyline::new(&[[9.0, 0.0, 0.0], [9.0, 1.0, 0.0]], 1.0).unwrap()).sample(DT).unwrap();
    let options = TrackOptions { limits: jumping(&robot("planar5")), ..TrackOptions::default() };
    let record = track(&robot("planar5"), &far, Some(&[0.0; 5]), &options, &mut Unattended).unwrap();
    let advice = "move or turn the target into reach, or move the base";
    let why = "the path is out of reach by at least 4.055 m at t = 1 s";
    let message = format!("never came within 1.000e-6 m (nearest 4.000 m): {why}: {advice}");
    assert_eq!((record.message().to_string(), record.status), (message, Status::Capped));
    let rising = Path::new(Polyline::new(&[[3.0, 0.0, 0.0], [3.0, 1.0, 0.5]], 1.0).unwrap()).sample(DT).unwrap();
    let record = track(&robot("planar5"), &rising, None, &options, &mut Unattended).unwrap();
    let why = "the path is out of reach by at least 0.5000 m, 0.5000 m off the plane that the tip moves in at t = 1 s";
    assert!(record.message().ends_with(&format!("by up to 0.5000 m: {why}: {advice}")), "{}", record.message());
    let slow = Limits::of(&robot("planar5")).replace(Field::Velocity, vec![Profile::Constant(0.01)]).unwrap();
    let options = TrackOptions { limits: Some(slow), ..TrackOptions::default() };
    let flat = Path::new(Polyline::new(&[[3.0, 0.0, 0.0], [3.0, 1.0, 0.0]], 1.0).unwrap()).sample(DT).unwrap();
    let record = track(&robot("planar5"), &flat, None, &options, &mut Unattended).unwrap();
    let advice =
        "slow the path down, widen the limits, start elsewhere (another start or seed), or move the path into reach";
    assert!(record.message().ends_with(advice), "{}", record.message());
}

#[test]
fn an_arm_inside_its_band_moves_on_evenly() {
    // One that waits until it is out of its band stands still for most ticks, and then jumps at full speed.
    let task = iiwa();
    let reference = Path::new(task.circle.clone()).sample(0.01).unwrap();
    for rule in [descent(), beetle(BasVariant::Chain, 1.0, 30), TickRule::MidStep] {
        let options = TrackOptions { limits: None, ..task.options(rule.clone(), 1e-3, 0) };
        let record = track(&task.robot, &reference, None, &options, &mut Unattended).unwrap();
        assert_eq!(record.status, Status::Solved, "{rule:?}: {}", record.message());
        let fastest = record.qd().iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // A beetle's steps are uneven, by how much depends on the start; full speed is above 1.4 rad/s.
        assert!(fastest < 0.4, "{rule:?}: {fastest} rad/s; the path asks for 0.06");
    }
}

#[test]
fn a_position_limit_that_outruns_its_joint_is_no_success() {
    let task = iiwa();
    let closing = Profile::Sampled { step: 0.5, values: vec![3.0, -1.0] };
    let free = Profile::Constant(f64::INFINITY);
    let mut upper = vec![free; 7];
    upper[6] = closing;
    let limits = Limits::of(&task.robot).replace(Field::Upper, upper).unwrap();
    let limits = limits.replace(Field::Velocity, vec![Profile::Constant(0.5)]).unwrap();
    let record = task.track_with(&TrackOptions { limits: Some(limits), ..task.options(descent(), 1e-6, 0) });
    assert_eq!(record.status, Status::Lost);
    // At 0.5 s the limit is -1 rad, and since the start at 0.1 rad the joint has come down by 0.5 rad/s.
    let says = "joint 'joint_a7' is 0.9000 (rad or m) beyond its limits at t = 0.6 s: a limit closes in faster than the \
                joint may move; slow it down, raise the velocity or acceleration limit, or start farther inside";
    assert_eq!(record.message(), says);
}

#[test]
fn position_limits_that_move_together_are_no_contradiction() {
    let task = iiwa();
    let swinging = |mean: f64| Profile::Sinusoid(Sinusoid { mean, amplitude: 1.0, angular_frequency: 0.3, phase: 0.0 });
    let limits = Limits::of(&task.robot).replace(Field::Lower, vec![swinging(-2.0)]).unwrap();
    let limits = limits.replace(Field::Upper, vec![swinging(2.0)]).unwrap();
    assert_eq!(limits.validate(DT, 150), Ok(()));
    let crossing = limits.replace(Field::Upper, vec![Profile::Constant(-1.5)]).unwrap();
    let error = crossing.validate(DT, 150).unwrap_err().to_string();
    assert!(error.starts_with("joint 'joint_a1': lower limit -1.4"), "{error}");
    assert!(error.contains(" is above upper limit -1.5 at t = "), "{error}");
}
