//! Postures on circles: the published swarm and differential evolution, against the optima of a dense scan.

use std::f64::consts::PI;

use crate::common::{StopAt, message, robot};
use ikcore::posture::{CircleSwarm, Measure, Posture, PostureOptions, Rectangle, best_posture};
use ikcore::robot::Robot;
use ikcore::solver::{Status, Unattended};

const E: [f64; 3] = [0.5, 0.5, 0.0];
const FIRST_QUADRANT: Rectangle = Rectangle { lower: [0.0; 2], upper: [f64::INFINITY; 2] };

/// Length of the links, and the optima of SM_3 and SM anywhere and in the first quadrant, by a scan of 4e6 points (numpy).
const OPTIMA: [(f64, [f64; 2], [f64; 2]); 3] = [
    (0.3, [0.727905, 0.727905], [0.947446, 0.915893]),
    (0.5, [1.720667, 1.493501], [2.488703, 1.900676]),
    (1.0, [4.403020, 2.720699], [7.503629, 5.584065]),
];

fn search(arm: &Robot, options: PostureOptions) -> Posture {
    best_posture(arm, &E, &options, &mut Unattended).unwrap()
}

/// Index SM_3 or SM of a posture.
fn index(posture: &Posture, measure: Measure) -> f64 {
    if measure == Measure::Tip { PI * posture.index } else { posture.index }
}

fn cases() -> impl Iterator<Item = (f64, Measure, Option<Rectangle>, f64)> {
    OPTIMA.into_iter().flat_map(|(length, tip, overall)| {
        [(Measure::Tip, tip), (Measure::Overall, overall)].into_iter().flat_map(move |(measure, optima)| {
            [(None, optima[0]), (Some(FIRST_QUADRANT), optima[1])]
                .into_iter()
                .map(move |(region, optimum)| (length, measure, region, optimum))
        })
    })
}

#[test]
fn the_default_search_finds_the_optima_of_both_regions() {
    for (length, measure, region, optimum) in cases() {
        let arm = Robot::planar(&[length; 3]).unwrap();
        let found = search(&arm, PostureOptions { measure, region, ..PostureOptions::default() });
        assert_eq!(found.status, Status::Solved);
        assert!(found.error.position < 1e-12);
        let gap = 1.0 - index(&found, measure) / optimum;
        assert!(gap.abs() < 1e-5, "{length} {measure:?} {region:?}: {gap:.2e}");
    }
}

/// Gaps between the published swarm and the optimum, for many seeds.
fn gaps(swarm: CircleSwarm, seeds: u64, region: Option<Rectangle>, measure: Measure, optimum: f64) -> Vec<f64> {
    let arm = Robot::planar(&[0.5; 3]).unwrap();
    let gap = |seed| {
        let found = search(&arm, PostureOptions { measure, region, swarm: Some(swarm), seed });
        assert!(found.history.is_sorted(), "{:?}", found.history);
        assert_eq!((found.history.len(), found.history.last()), (swarm.generations, Some(&found.index)));
        1.0 - index(&found, measure) / optimum
    };
    (0..seeds).map(gap).collect()
}

#[test]
fn the_swarm_as_published_comes_near_and_a_larger_one_arrives() {
    let larger = CircleSwarm { population: 20, generations: 50, ..CircleSwarm::default() };
    let (_, tip, overall) = OPTIMA[1];
    for (measure, [anywhere, quadrant]) in [(Measure::Tip, tip), (Measure::Overall, overall)] {
        let best_of_50 = gaps(CircleSwarm::default(), 50, None, measure, anywhere).into_iter().fold(1.0, f64::min);
        assert!(best_of_50 < 1e-4, "{measure:?}: {best_of_50:.1e}");
        let worst = |gaps: Vec<f64>| gaps.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let anywhere = worst(gaps(larger, 10, None, measure, anywhere));
        assert!(anywhere < 1e-5, "{measure:?}: {anywhere:.1e}");
        let quadrant = worst(gaps(larger, 10, Some(FIRST_QUADRANT), measure, quadrant));
        assert!(quadrant < 5e-3, "{measure:?}: {quadrant:.1e}");
    }
    let signed = CircleSwarm { signed: true, ..CircleSwarm::default() };
    assert!(gaps(signed, 50, None, Measure::Tip, tip[0]).into_iter().fold(1.0, f64::min) < 1e-3);
}

#[test]
fn longer_arms_are_searched_too() {
    let arm = Robot::planar(&[0.3, 0.3, 0.25, 0.2, 0.2]).unwrap();
    let own = search(&arm, PostureOptions::default());
    let swarm = CircleSwarm { population: 40, generations: 200, ..CircleSwarm::default() };
    let published = search(&arm, PostureOptions { swarm: Some(swarm), ..PostureOptions::default() });
    assert!(own.error.position < 1e-12 && published.error.position < 1e-12);
    assert!(published.index < own.index * (1.0 + 1e-6), "{} {}", published.index, own.index);
    assert!(published.index > 0.9 * own.index, "{} {}", published.index, own.index);
}

#[test]
fn impossible_targets_end_in_a_status() {
    let arm = Robot::planar(&[0.2; 3]).unwrap();
    for swarm in [None, Some(CircleSwarm::default())] {
        let found = search(&arm, PostureOptions { swarm, ..PostureOptions::default() });
        assert_eq!(found.status, Status::OutOfReach);
        let says = "no posture: the tip stays 0.1071 m away; move the target nearer";
        assert_eq!(found.message(), says);
        assert!(found.index.is_nan() && (found.error.position - (0.5_f64.sqrt() - 0.6)).abs() < 1e-3);
    }
    let narrow = Rectangle { lower: [0.0; 2], upper: [0.01; 2] };
    let arm = Robot::planar(&[0.5; 3]).unwrap();
    let found = search(&arm, PostureOptions { region: Some(narrow), ..PostureOptions::default() });
    assert_eq!(found.message(), "no posture found inside the region and the joint limits: widen them");
}

#[test]
fn an_interrupted_search_keeps_its_best() {
    let arm = Robot::planar(&[0.5; 3]).unwrap();
    let endless = CircleSwarm { population: 7, generations: 1_000_000, ..CircleSwarm::default() };
    let mut evaluations = 0;
    for (swarm, patience, generations) in [(Some(endless), 3, 0), (Some(endless), 20, 2), (None, 2, 0)] {
        let options = PostureOptions { swarm, ..PostureOptions::default() };
        let found = best_posture(&arm, &E, &options, &mut StopAt(patience)).unwrap();
        assert_eq!(found.status, Status::Interrupted);
        assert_eq!(found.message(), "interrupted: run again to finish");
        assert_eq!(found.history.len(), generations);
        assert!(found.index > 0.0 && found.error.position < 1e-12);
        evaluations += found.evaluations;
    }
    assert!(evaluations < 10_000, "{evaluations}");
}

#[test]
fn wrong_arms_and_options_are_named() {
    let says = |robot: &Robot, options: PostureOptions| message(best_posture(robot, &E, &options, &mut Unattended));
    let standard = PostureOptions::default();
    assert_eq!(
        says(&Robot::planar(&[0.5; 2]).unwrap(), standard),
        "robot 'planar2': a posture on circles needs at least 3 links, got 2"
    );
    let needs = "a posture on circles needs an arm of joints that turn about z in one plane";
    assert_eq!(says(&robot("iiwa14"), standard), format!("robot 'iiwa14': {needs}"));
    let swarm = Some(CircleSwarm { c1: 1.5, c2: 1.5, ..CircleSwarm::default() });
    let arm = Robot::planar(&[0.5; 3]).unwrap();
    assert_eq!(says(&arm, PostureOptions { swarm, ..standard }), "c1 + c2 must be above 4, got 3");
    let above = best_posture(&arm, &[0.5, 0.5, 0.1], &standard, &mut Unattended);
    assert_eq!(message(above), "z of the target must be that of the arm's plane, 0, got 0.1");
}
