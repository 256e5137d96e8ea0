//! Experiments of Cheng et al. (2020) over many seeds.
//!
//! The bounds on errors and counts are those of this library's own study of the paper, which prints no seeds, bands or
//! numbers of evaluations; they leave 25 to 50 per cent over the extremes of a hundred seeds.

use crate::common::circles::{Task, beetle, count, five_links, iiwa};
use ikcore::solver::{BasVariant, Status};
use ikcore::tracking::{Record, TickRule};

const SEEDS: u64 = 20;

/// Mean error from step 75 on (m).
fn steady_error(record: &Record) -> f64 {
    let errors = &record.position_error[76..];
    errors.iter().sum::<f64>() / errors.len() as f64
}

/// Root mean square of the change of joint velocity from tick to tick (rad/s), from step 75 on.
fn roughness(record: &Record) -> f64 {
    let n = record.dof;
    let qd = record.qd();
    let changes: Vec<f64> = (76 * n..qd.len()).map(|i| qd[i] - qd[i - n]).collect();
    (changes.iter().map(|change| change * change).sum::<f64>() / changes.len() as f64).sqrt()
}

/// Mean steady error over the seeds, after checking that each track was in its band by step 30 and stayed there within its
/// budget of evaluations.
fn mean_steady_error(task: &Task, rule: &TickRule, band: f64, most_evaluations: usize) -> f64 {
    let tracks = (1..=SEEDS).map(|seed| {
        let record = task.track(rule.clone(), band, seed);
        let name = format!("{} seed {seed}", task.robot.name());
        assert_eq!(record.status, Status::Solved, "{name}: {}", record.message());
        assert_eq!(count(&record, Status::Capped), 0, "{name}");
        assert!(record.joined().unwrap() <= 30, "{name} joined at step {:?}", record.joined());
        assert!(record.evaluations() <= most_evaluations, "{name}: {} evaluations", record.evaluations());
        steady_error(&record)
    });
    tracks.sum::<f64>() / SEEDS as f64
}

#[test]
fn five_links_track_to_twenty_micrometres() {
    let star = mean_steady_error(&five_links(), &beetle(BasVariant::Star, 1.0, 50), 4e-5, 140_000);
    assert!((1.5e-5..2.5e-5).contains(&star), "{star:.3e}");
    let chain = mean_steady_error(&five_links(), &beetle(BasVariant::Chain, 0.3, 30), 5e-5, 70_000);
    assert!((1.5e-5..2.5e-5).contains(&chain), "{chain:.3e}");
}

#[test]
fn iiwa_tracks_to_ten_micrometres() {
    let star = mean_steady_error(&iiwa(), &beetle(BasVariant::Star, 3.0, 50), 1.7e-5, 200_000);
    assert!((8e-6..1.3e-5).contains(&star), "{star:.3e}");
    let chain = mean_steady_error(&iiwa(), &beetle(BasVariant::Chain, 1.0, 30), 2.2e-5, 65_000);
    assert!((8e-6..1.3e-5).contains(&chain), "{chain:.3e}");
}

#[test]
fn iiwa_tracks_to_a_millimetre_in_few_evaluations() {
    let chain = mean_steady_error(&iiwa(), &beetle(BasVariant::Chain, 1.0, 30), 1e-3, 25_000);
    assert!((3e-4..7e-4).contains(&chain), "{chain:.3e}");
}

#[test]
fn greedy_beetle_tracks_to_a_nanometre() {
    let record = iiwa().track(beetle(BasVariant::Greedy, 3.0, 5), 1e-9, 1);
    assert_eq!(record.status, Status::Solved, "{}", record.message());
}

/// Mean over five seeds of (steps to the band, roughness, evaluations) for a star.
fn star_trend(task: &Task, c1: f64, explorations: usize, band: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for seed in 1..=5 {
        let record = task.track(beetle(BasVariant::Star, c1, explorations), band, seed);
        let figures = [record.joined().unwrap() as f64, roughness(&record), record.evaluations() as f64];
        sum = std::array::from_fn(|k| sum[k] + figures[k] / 5.0);
    }
    sum
}

#[test]
fn more_explorations_join_sooner_and_smoother_at_more_cost() {
    let (few, many) = (star_trend(&five_links(), 1.0, 5, 4e-5), star_trend(&five_links(), 1.0, 200, 4e-5));
    assert!(many[0] < 0.7 * few[0] && many[1] < 0.9 * few[1] && many[2] > 5.0 * few[2], "{few:?} {many:?}");
}

#[test]
fn longer_antennae_cost_less_and_shake_more() {
    let (short, long) = (star_trend(&five_links(), 0.3, 50, 4e-5), star_trend(&five_links(), 1.0, 50, 4e-5));
    assert!(2.0 * long[2] <= short[2] && long[1] >= 2.0 * short[1], "{short:?} {long:?}");
}
