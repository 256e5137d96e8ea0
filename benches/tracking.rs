//! The circles of Cheng et al. (2020), 150 steps of 0.2 s under time-varying velocity limits. The paper took 0.53 s for
//! the LBR iiwa 14 with an error of 1 mm.
//!
//! One measured body follows the circle once for each of 20 seeds; criterion's estimate over 20 is the mean of a run.

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::robot::Robot;
use ikcore::solver::{Algorithm, AnySolver, Bas, BasVariant, LevenbergMarquardt, Unattended};
use ikcore::task::Tolerance;
use ikcore::tracking::{Integrator, TickRule, TrackOptions, WeightedPseudoInverse, track};

const SEEDS: u64 = 20;

/// Circle, and a start beside it.
struct Scene {
    robot: Robot,
    reference: Reference,
    start: Vec<f64>,
    /// Mean of the velocity limit (rad/s).
    velocity: f64,
}

impl Scene {
    /// Scene with a start `offset` away from `on_path`, a configuration on the circle.
    fn new(name: &str, center: [f64; 3], diameter: f64, on_path: &[f64], offset: &[f64], velocity: f64) -> Self {
        let plane = Plane::xy(center).expect("a plane");
        let reference =
            Circle::new(plane, diameter, 30.0).and_then(|circle| Path::new(circle).sample(0.2)).expect("a circle");
        let start = on_path.iter().zip(offset).map(|(q, off)| q + off).collect();
        Self { robot: Robot::named(name).expect("a built-in robot"), reference, start, velocity }
    }

    fn iiwa14() -> Self {
        let on_path = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];
        Self::new("iiwa14", [0.3, 0.3, 1.0], 0.2, &on_path, &[0.1; 7], 2.0)
    }

    fn planar5() -> Self {
        let on_path = [0.6697427192, -0.3400667941, -0.2474717864, -0.2588906663, 0.3263813181];
        Self::new("planar5", [4.0, 1.0, 0.0], 1.4, &on_path, &[0.05, 0.05, 0.05, -0.05, 0.05], 0.2)
    }

    fn limits(&self) -> Limits {
        let Self { robot, velocity, .. } = self;
        let limit = Sinusoid { mean: *velocity, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 };
        Limits::of(robot).replace(Field::Velocity, vec![Profile::Sinusoid(limit)]).expect("limits")
    }

    fn follow(&self, options: &TrackOptions) {
        track(&self.robot, &self.reference, Some(&self.start), options, &mut Unattended).expect("a track");
    }
}

fn each_tick(algorithm: Algorithm) -> TickRule {
    TickRule::Solver(AnySolver::Single(algorithm))
}

fn weighted_pseudo_inverse(integrator: Integrator) -> TickRule {
    TickRule::WeightedPseudoInverse(WeightedPseudoInverse { integrator, ..WeightedPseudoInverse::default() })
}

fn beetle(variant: BasVariant, c1: f64, explorations: usize) -> TickRule {
    each_tick(Algorithm::from(Bas { variant, c1, explorations, ..Bas::default() }))
}

fn circles(c: &mut Criterion) {
    let (iiwa14, planar5) = (Scene::iiwa14(), Scene::planar5());
    let lm = each_tick(Algorithm::LevenbergMarquardt(LevenbergMarquardt::default()));
    let mut group = c.benchmark_group("circle");
    group.throughput(Throughput::Elements(SEEDS));
    for (name, scene, rule, band) in [
        ("iiwa14 chain 1 mm", &iiwa14, beetle(BasVariant::Chain, 1.0, 30), 1e-3),
        ("iiwa14 star 1 mm", &iiwa14, beetle(BasVariant::Star, 3.0, 20), 1e-3),
        ("iiwa14 chain 22 um", &iiwa14, beetle(BasVariant::Chain, 1.0, 30), 2.2e-5),
        ("iiwa14 star 17 um", &iiwa14, beetle(BasVariant::Star, 3.0, 50), 1.7e-5),
        ("iiwa14 Levenberg-Marquardt 1 nm", &iiwa14, lm.clone(), 1e-9),
        ("planar5 chain 50 um", &planar5, beetle(BasVariant::Chain, 0.3, 30), 5e-5),
        ("planar5 star 40 um", &planar5, beetle(BasVariant::Star, 1.0, 50), 4e-5),
        ("planar5 Levenberg-Marquardt 1 nm", &planar5, lm, 1e-9),
        ("iiwa14 model-based 1 nm", &iiwa14, TickRule::MidStep, 1e-9),
        ("planar5 model-based 1 nm", &planar5, TickRule::MidStep, 1e-9),
        // Rules that make one step a tick, whatever the band.
        ("iiwa14 weighted pseudo-inverse, Euler", &iiwa14, weighted_pseudo_inverse(Integrator::Euler), 1e-3),
        ("iiwa14 weighted pseudo-inverse, RK4", &iiwa14, weighted_pseudo_inverse(Integrator::RungeKutta4), 1e-3),
    ] {
        let options = TrackOptions {
            rule,
            tolerance: Tolerance { position: band, ..Tolerance::default() },
            limits: Some(scene.limits()),
            ..TrackOptions::default()
        };
        group.bench_function(name, |b| {
            b.iter(|| (0..SEEDS).for_each(|seed| scene.follow(&TrackOptions { seed, ..options.clone() })));
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
    targets = circles
}
criterion_main!(benches);
