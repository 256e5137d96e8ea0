//! ZNNBAS and the experiments of Khan et al. (2022): 50 s along the letter M at 1 kHz.
//!
//! The bounds are those of this library's own study of the paper, which prints no seeds.

use crate::common::robot;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::path::{Path, Plane, Polyline, Reference};
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::tracking::{
    Antenna, Controller, KinematicPlant, ModelFreeOptions, ModelFreeRecord, UpdateRule, Znnbas, track_model_free,
};

const SEEDS: u64 = 20;
const DT: f64 = 1e-3;

fn letter() -> Reference {
    let plane = Plane::yz([0.1, 0.4, 0.3]).unwrap();
    Path::new(Polyline::letter_m(&plane, 0.4, 0.4, 50.0).unwrap()).sample(DT).unwrap()
}

fn adaptive(gain: f64, c1: f64) -> Znnbas {
    Znnbas { gain, antenna: Antenna::Adaptive { c1 }, ..Znnbas::default() }
}

/// Limits of the paper's runs, on positions alone.
fn position_limits(robot: &Robot) -> Limits {
    Limits::of(robot).replace(Field::Velocity, vec![Profile::Constant(f64::INFINITY)]).unwrap()
}

struct Run {
    arm: Robot,
    record: ModelFreeRecord,
}

impl Run {
    fn new(znnbas: &Znnbas, reference: &Reference, limits: Option<Limits>, seed: u64) -> Self {
        let arm = robot("iiwa14");
        let mut plant = KinematicPlant::new(arm.clone(), 0.0, 0).unwrap();
        let options =
            ModelFreeOptions { controller: Controller::Znnbas(znnbas.clone()), limits, seed, ..Default::default() };
        let record = track_model_free(&mut plant, reference, &[0.0; 7], &options, &mut Unattended).unwrap();
        assert!(record.track.step_evaluations.iter().all(|count| *count == 1), "one measurement a step");
        assert_eq!(record.track.max_violation, 0.0);
        Self { arm, record }
    }

    fn on_letter(znnbas: &Znnbas, seed: u64) -> Self {
        Self::new(znnbas, &letter(), None, seed)
    }

    /// Error h of eq. (12) at theta, where the arm never is.
    fn h(&self, i: usize) -> f64 {
        let (tip, target) = (self.arm.tip_position(&self.record.track.q[7 * i..][..7]), self.record.track.reference[i]);
        (0..3).map(|k| (tip[k] - target[k]).powi(2)).sum()
    }

    /// Mean of h from 40 to 50 s.
    fn mean_h(&self) -> f64 {
        (40_000..=50_000).map(|i| self.h(i)).sum::<f64>() / 10_001.0
    }

    /// Time at which h first falls below 1e-3 (s).
    fn arrival(&self) -> f64 {
        (0..=50_000).find(|i| self.h(*i) < 1e-3).map_or(f64::INFINITY, |i| i as f64 * DT)
    }
}

#[test]
fn the_published_constants_converge_to_1e_4() {
    for seed in 0..SEEDS {
        let run = Run::on_letter(&Znnbas::published(), seed);
        assert!(run.mean_h() <= 2e-4 && run.arrival() <= 8.0, "seed {seed}: {:.1e}, {} s", run.mean_h(), run.arrival());
    }
}

#[test]
fn antennae_that_follow_the_error_converge_to_1e_5_and_below() {
    for seed in 0..SEEDS {
        let (slow, fast) = (Run::on_letter(&adaptive(100.0, 0.3), seed), Run::on_letter(&adaptive(300.0, 0.3), seed));
        assert!(
            slow.mean_h() <= 2e-5 && slow.arrival() <= 2.0,
            "seed {seed}: {:.1e}, {} s",
            slow.mean_h(),
            slow.arrival()
        );
        assert!(fast.mean_h() <= 5e-6, "seed {seed}: {:.1e}", fast.mean_h());
    }
}

#[test]
fn the_first_stroke_is_out_of_reach_within_the_limits() {
    for seed in 0..SEEDS {
        let run = Run::new(&Znnbas::published(), &letter(), Some(position_limits(&robot("iiwa14"))), seed);
        assert!((11.0..=13.0).contains(&run.arrival()), "seed {seed}: {} s", run.arrival());
    }
}

#[test]
fn the_printed_sign_diverges() {
    let run = Run::on_letter(&Znnbas { gain: -10.0, ..Znnbas::published() }, 0);
    assert!(run.h(50_000) > 1.0, "{}", run.h(50_000));
}

#[test]
fn the_delay_matters_little_up_to_the_inverse_of_the_gain() {
    let standard = Run::on_letter(&Znnbas::published(), 0).mean_h();
    for delay_steps in [1, 100] {
        let h = Run::on_letter(&Znnbas { delay_steps, ..Znnbas::published() }, 0).mean_h();
        assert!(h <= 1.5 * standard, "{delay_steps} steps: {h:.1e} against {standard:.1e}");
    }
    let seconds = Run::on_letter(&Znnbas { delay_steps: 10_000, ..Znnbas::published() }, 0).mean_h();
    assert!(seconds > 0.1, "a delay of ten seconds: {seconds:.1e}");
}

#[test]
fn theorem_1_holds_for_the_algorithm_of_its_proof_alone() {
    // Its target stands still.
    let point = Reference::new(DT, vec![[0.1, 0.4, 0.3]; 5001], None).unwrap();
    let rises = |accept| {
        let run = Run::new(&Znnbas { accept, ..Znnbas::published() }, &point, None, 1);
        (1..=5000).filter(|i| run.h(*i) > run.h(i - 1)).count()
    };
    assert_eq!(rises(UpdateRule::Improving), 0);
    assert!(rises(UpdateRule::Always) > 100, "{}", rises(UpdateRule::Always));
}
