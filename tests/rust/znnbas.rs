//! ZNNBAS and the experiments of Khan et al. (2022).

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should say so")]

mod common;

use common::robot;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::path::{Path, Plane, Polyline, Reference};
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::tracking::controller::{Accept, Antenna, Delay, Znnbas};
use ikcore::tracking::{Controller, KinematicPlant, ModelFreeOptions, ModelFreeRecord, track_model_free};

const SEEDS: u64 = 20;

fn letter() -> Reference {
    let plane = Plane::new([0.1, 0.4, 0.3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
    Path::new(Polyline::letter_m(&plane, 0.4, 0.4, 50.0).unwrap()).sample(1e-3).unwrap()
}

fn adaptive(gain: f64, c1: f64) -> Znnbas {
    Znnbas { gain, antenna: Antenna::Adaptive { c1 }, ..Znnbas::default() }
}

fn position_limits(robot: &Robot) -> Limits {
    Limits::of(robot).replace(Field::Velocity, vec![Profile::Constant(f64::INFINITY)]).unwrap()
}

struct Run {
    arm: Robot,
    record: ModelFreeRecord,
}

impl Run {
    fn new(znnbas: &Znnbas, limits: bool, seed: u64) -> Self {
        let arm = robot("iiwa14");
        let mut plant = KinematicPlant::new(arm.clone(), 0.0, 0).unwrap();
        let options = ModelFreeOptions {
            controller: Controller::Znnbas(znnbas.clone()),
            limits: limits.then(|| position_limits(&arm)),
            tolerance: 0.03,
            seed,
        };
        let record = track_model_free(&mut plant, &letter(), &[0.0; 7], &options, &mut Unattended).unwrap();
        Self { arm, record }
    }
    fn h(&self, i: usize) -> f64 {
        let p = self.arm.tip_position(&self.record.track.q[7 * i..][..7]);
        (0..3).map(|k| (p[k] - self.record.track.reference[i][k]).powi(2)).sum()
    }
    fn mean_h(&self) -> f64 {
        (40_000..=50_000).map(|i| self.h(i)).sum::<f64>() / 10_001.0
    }
    fn arrival(&self) -> f64 {
        (0..=50_000).find(|i| self.h(*i) < 1e-3).map_or(f64::INFINITY, |i| i as f64 * 1e-3)
    }
}

#[test]
fn explore() {
    let show = |name: &str, z: &Znnbas, limits: bool| {
        let runs: Vec<Run> = (0..5).map(|s| Run::new(z, limits, s)).collect();
        let hs: Vec<String> = runs.iter().map(|r| format!("{:.1e}/{:.2}", r.mean_h(), r.arrival())).collect();
        println!("{name}: {} {:?}", hs.join(" "), runs[0].record.track.elapsed);
    };
    show("published", &Znnbas::published(), false);
    show("published limits", &Znnbas::published(), true);
    show("k100", &adaptive(100.0, 0.3), false);
    show("k300", &adaptive(300.0, 0.3), false);
    show("negative", &Znnbas { gain: -10.0, ..Znnbas::published() }, false);
    show("held 10", &Znnbas { delay: Delay::Held, ..Znnbas::published() }, false);
    show("held 50", &Znnbas { delay: Delay::Held, delay_steps: 50, ..Znnbas::published() }, false);
    show("improving published", &Znnbas { accept: Accept::Improving, ..Znnbas::published() }, false);
    show("improving published 1", &Znnbas { accept: Accept::Improving, delay_steps: 1, ..Znnbas::published() }, false);
    show("improving k100", &Znnbas { accept: Accept::Improving, ..adaptive(100.0, 0.3) }, false);
    show("improving k300", &Znnbas { accept: Accept::Improving, ..adaptive(300.0, 0.3) }, false);
    for n in [1, 10, 100, 200, 300, 500, 1000, 10000] {
        show(&format!("delay {n}"), &Znnbas { delay_steps: n, ..Znnbas::published() }, false);
    }
}
