//! Tracking without a model: what the controllers reach, and what holds whatever the plant does.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

mod common;

use common::{message, robot};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{BroydenBas, Status, Unattended};
use ikcore::tracking::{Controller, KinematicPlant, ModelFreeOptions, ModelFreeRecord, Plant, track_model_free};

const EXACT7: [f64; 7] = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];

fn circle() -> Reference {
    let plane = Plane::xy([0.3, 0.3, 1.0]).unwrap();
    Path::new(Circle::new(plane, 0.2, 30.0).unwrap()).sample(0.2).unwrap()
}

fn circle_limits(robot: &Robot) -> Limits {
    let limit = Sinusoid { mean: 2.0, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 };
    Limits::of(robot).replace(Field::Velocity, vec![Profile::Sinusoid(limit)]).unwrap()
}

#[test]
fn explore() {
    let arm = robot("iiwa14");
    let options = ModelFreeOptions { limits: Some(circle_limits(&arm)), ..Default::default() };
    let mut plant = KinematicPlant::new(arm.clone(), 0.0, 0).unwrap();
    for length in [1e-6, 1e-4, 1e-3, 0.003, 0.01, 0.03, 0.1] {
        let broyden = BroydenBas { antenna_length: length, ..Default::default() };
        let options = ModelFreeOptions { controller: Controller::BroydenBas(broyden), ..options.clone() };
        let r = track_model_free(&mut plant, &circle(), &EXACT7, &options, &mut Unattended).unwrap();
        println!("{length} {} {} {:?}", r.track.evaluations(), r.message(), r.track.elapsed);
    }
    for seed in 0..20 {
        let wrong = arm.with_errors(0.02, 2f64.to_radians(), &mut rng::stream(seed, 0)).unwrap();
        let mut plant = KinematicPlant::new(wrong.clone(), 0.0, 0).unwrap();
        let r = track_model_free(&mut plant, &circle(), &EXACT7, &options, &mut Unattended).unwrap();
        let mut plant = KinematicPlant::new(wrong.clone(), 1e-4, seed).unwrap();
        let n = track_model_free(&mut plant, &circle(), &EXACT7, &options, &mut Unattended).unwrap();
        let errors: Vec<f64> = (20..150).map(|i| {
            let p = wrong.tip_position(&n.track.q[i * 7..][..7]);
            (0..3).map(|k| (p[k] - n.track.reference[i][k]).powi(2)).sum::<f64>() }).collect();
        println!("{seed} {} {:.2e} | noisy {} rms {:.2e} max {:.2e}", r.track.evaluations(), r.track.position_error[30..].iter().fold(0.0, |a: f64, b| a.max(*b)), n.track.evaluations(),
            (errors.iter().sum::<f64>() / 130.0).sqrt(), errors.iter().fold(0.0, |a: f64, b| a.max(*b)).sqrt());
    }
}
