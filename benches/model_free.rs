//! Tracking without a model: 50 s of ZNNBAS at 1 kHz along the M of Khan et al. (2022), and secants on the circle of Cheng
//! et al. (2020), 150 steps to a nanometre.

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Polyline, Reference};
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::tracking::Znnbas;
use ikcore::tracking::{Controller, KinematicPlant, ModelFreeOptions, track_model_free};

fn letter() -> Reference {
    let plane = Plane::yz([0.1, 0.4, 0.3]).expect("a plane");
    Polyline::letter_m(&plane, 0.4, 0.4, 50.0).and_then(|letter| Path::new(letter).sample(1e-3)).expect("a letter")
}

fn circle() -> Reference {
    let plane = Plane::xy([0.3, 0.3, 1.0]).expect("a plane");
    Circle::new(plane, 0.2, 30.0).and_then(|circle| Path::new(circle).sample(0.2)).expect("a circle")
}

fn model_free(c: &mut Criterion) {
    let arm = Robot::named("iiwa14").expect("a built-in robot");
    let limit = Sinusoid { mean: 2.0, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 };
    let limits = Limits::of(&arm).replace(Field::Velocity, vec![Profile::Sinusoid(limit)]).expect("limits");
    let free = ModelFreeOptions::default();
    let on_circle = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];
    let znnbas = |znnbas| ModelFreeOptions { controller: Controller::Znnbas(znnbas), ..free.clone() };
    let mut group = c.benchmark_group("model_free");
    for (name, reference, start, options) in [
        ("M ZNNBAS 50 s at 1 kHz", letter(), &[0.0; 7], znnbas(Znnbas::default())),
        ("M ZNNBAS as published", letter(), &[0.0; 7], znnbas(Znnbas::published())),
        ("circle BroydenBAS 1 nm", circle(), &on_circle, ModelFreeOptions { limits: Some(limits), ..free.clone() }),
    ] {
        let mut plant = KinematicPlant::new(arm.clone(), 0.0, 0).expect("a plant");
        group.bench_function(name, |b| {
            b.iter(|| track_model_free(&mut plant, &reference, start, &options, &mut Unattended).expect("a track"));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    targets = model_free
}
criterion_main!(benches);
