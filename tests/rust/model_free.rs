//! The secant controller without a model, and what holds of every controller whatever the plant does.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

mod common;

use common::{bits, message, robot};
use ikcore::Error;
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Polyline, Reference};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{BroydenBas, Monitor, Status, Unattended};
use ikcore::tracking::controller::{Antenna, Session, Znnbas};
use ikcore::tracking::{
    Controller, Fault, FunctionPlant, KinematicPlant, ModelFreeOptions, ModelFreeRecord, Plant, track_model_free,
};

const SEEDS: u64 = 20;

/// On the circle of Cheng et al. (2020).
const ON_CIRCLE: [f64; 7] = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];

fn circle() -> Reference {
    let plane = Plane::xy([0.3, 0.3, 1.0]).unwrap();
    Path::new(Circle::new(plane, 0.2, 30.0).unwrap()).sample(0.2).unwrap()
}

/// The limits of that paper: 2 + 0.004 sin t (rad/s).
fn circle_limits(robot: &Robot) -> Limits {
    let limit = Sinusoid { mean: 2.0, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 };
    Limits::of(robot).replace(Field::Velocity, vec![Profile::Sinusoid(limit)]).unwrap()
}

fn on_circle(plant: &mut dyn Plant, options: &ModelFreeOptions) -> ModelFreeRecord {
    track_model_free(plant, &circle(), &ON_CIRCLE, options, &mut Unattended).unwrap()
}

fn options(seed: u64) -> ModelFreeOptions {
    ModelFreeOptions { limits: Some(circle_limits(&robot("iiwa14"))), seed, ..ModelFreeOptions::default() }
}

/// The arm with links wrong by up to 2 cm and joints by up to 2 degrees.
fn wrong_arm(seed: u64) -> Robot {
    robot("iiwa14").with_errors(0.02, 2_f64.to_radians(), &mut rng::stream(seed, 9)).unwrap()
}

/// The arm as designed, and a sensor without noise.
fn exact_plant() -> KinematicPlant {
    KinematicPlant::new(robot("iiwa14"), 0.0, 0).unwrap()
}

/// Root mean square of what `errors` gives for rows 20 to 149.
fn rms(errors: impl Fn(usize) -> f64) -> f64 {
    ((20..150).map(|i| errors(i).powi(2)).sum::<f64>() / 130.0).sqrt()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn secants_follow_the_circle_to_a_nanometre_in_four_measurements_a_step() {
    let record = on_circle(&mut exact_plant(), &options(0));
    assert_eq!(record.track.status, Status::Solved, "{}", record.message());
    assert!(record.track.position_error.iter().all(|error| *error <= 1e-9));
    assert!(record.track.evaluations() <= 700, "{}", record.track.evaluations());
    assert_eq!(record.track.max_violation, 0.0);
    assert_eq!(record.command, record.track.q, "what was accepted was measured");
}

#[test]
fn a_wrong_model_makes_no_difference_to_who_has_none() {
    for seed in 0..SEEDS {
        let wrong = wrong_arm(seed);
        let designed = robot("iiwa14").tip_position(&ON_CIRCLE);
        assert!(distance(wrong.tip_position(&ON_CIRCLE), designed) > 1e-3, "seed {seed} is hardly wrong");
        let record = on_circle(&mut KinematicPlant::new(wrong, 0.0, 0).unwrap(), &options(0));
        assert!(
            record.track.position_error[1..].iter().all(|error| *error <= 1e-6),
            "seed {seed}: {}",
            record.message()
        );
        assert_eq!(record.track.max_violation, 0.0, "seed {seed}");
    }
}

#[test]
fn noise_of_the_sensor_is_not_much_more_than_passed_on() {
    for seed in 0..SEEDS {
        let wrong = wrong_arm(seed);
        let record = on_circle(&mut KinematicPlant::new(wrong.clone(), 1e-4, seed).unwrap(), &options(seed));
        let true_error =
            |i: usize| distance(wrong.tip_position(&record.track.q[7 * i..][..7]), record.track.reference[i]);
        let rms = rms(true_error);
        assert!(rms <= 3.0 * 1e-4 * 3_f64.sqrt(), "seed {seed}: {rms:.2e}");
        assert_eq!(record.track.max_violation, 0.0, "seed {seed}");
    }
}

#[test]
fn outliers_of_the_sensor_do_not_throw_it_off() {
    for seed in 0..SEEDS {
        let (wrong, mut rng) = (wrong_arm(seed), rng::stream(seed, 2));
        let mut plant = FunctionPlant(|q: &[f64]| {
            let outlier = if rng.uniform() < 0.01 { 0.1 } else { 0.0 };
            wrong.tip_position(q).map(|x| x + outlier * rng.normal_pair()[0])
        });
        let record = on_circle(&mut plant, &options(0));
        let wrong = wrong_arm(seed);
        let true_error =
            |i: usize| distance(wrong.tip_position(&record.track.q[7 * i..][..7]), record.track.reference[i]);
        let mut errors: Vec<f64> = (20..150).map(true_error).collect();
        errors.sort_by(f64::total_cmp);
        println!(
            "{seed} median {:.1e} p90 {:.1e} max {:.1e} ev {}",
            errors[65],
            errors[117],
            errors[129],
            record.track.evaluations()
        );
    }
}

#[test]
fn late() {
    for (name, delay) in [("0", 0), ("1", 1), ("2", 2), ("20", 20)] {
        let arm = robot("iiwa14");
        let mut past = vec![ON_CIRCLE.to_vec(); delay];
        let mut plant = FunctionPlant(|q: &[f64]| {
            past.push(q.to_vec());
            let q = past.remove(0);
            arm.tip_position(&q)
        });
        let o = ModelFreeOptions {
            controller: Controller::BroydenBas(BroydenBas { sensor_delay: delay, ..Default::default() }),
            ..options(0)
        };
        let record = on_circle(&mut plant, &o);
        println!("delay {name} {} ev {}", record.message(), record.track.evaluations());
        let mut past = vec![ON_CIRCLE.to_vec(); delay];
        let mut plant = FunctionPlant(|q: &[f64]| {
            past.push(q.to_vec());
            let q = past.remove(0);
            arm.tip_position(&q)
        });
        let z = ModelFreeOptions {
            controller: Controller::Znnbas(Znnbas { sensor_delay: delay, ..Znnbas::default() }),
            tolerance: 0.02,
            ..ModelFreeOptions::default()
        };
        let fine =
            Path::new(Circle::new(Plane::xy([0.3, 0.3, 1.0]).unwrap(), 0.2, 30.0).unwrap()).sample(0.001).unwrap();
        let record = track_model_free(&mut plant, &fine, &ON_CIRCLE, &z, &mut Unattended).unwrap();
        println!("   znn {} ev {}", record.message(), record.track.evaluations());
    }
    for per in [1, 2, 3, 5] {
        let o = ModelFreeOptions {
            controller: Controller::BroydenBas(BroydenBas { max_evaluations_per_step: per, ..Default::default() }),
            ..options(0)
        };
        let record = on_circle(&mut exact_plant(), &o);
        println!("{per} a step: {} ev {}", record.message(), record.track.evaluations());
    }
    let line = Polyline::new(&[[0.4, 0.3, 1.0], [2.4, 0.3, 1.0], [0.4, 0.3, 1.0]], 30.0);
    println!("{:?}", line.is_ok());
    if let Ok(line) = line {
        let r = Path::new(line).sample(0.2).unwrap();
        let record = track_model_free(&mut exact_plant(), &r, &ON_CIRCLE, &options(0), &mut Unattended).unwrap();
        println!(
            "out of reach {} ev {} last error {:e}",
            record.message(),
            record.track.evaluations(),
            record.track.position_error.last().unwrap()
        );
    }
    let record = track_model_free(&mut exact_plant(), &circle(), &[0.0; 7], &options(0), &mut Unattended).unwrap();
    println!("home {} ev {} {:?}", record.message(), record.track.evaluations(), &record.track.position_error[..10]);
    let record =
        track_model_free(&mut exact_plant(), &circle(), &[0.0; 7], &ModelFreeOptions::default(), &mut Unattended)
            .unwrap();
    println!(
        "home free {} ev {} {:?}",
        record.message(),
        record.track.evaluations(),
        &record.track.position_error[..10]
    );
}
