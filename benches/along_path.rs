//! Plans along the paths of Wang et al. (2019): redundancy and timing together, and their swarm in uniform time.

use std::f64::consts::{PI, TAU};

use criterion::{Criterion, criterion_group, criterion_main};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::path::{Path, Plane, Polyline, Waypoints};
use ikcore::planning::{AlongPathMethod, AlongPathOptions, TipPath, Tpbso, plan_along_path};
use ikcore::robot::Robot;
use ikcore::solver::Unattended;

fn pentagram() -> TipPath {
    let star = Polyline::pentagram(&Plane::xy([1.0, 1.0, 0.0]).expect("a plane"), 0.5, 1.0).expect("a star");
    TipPath::along(&Path::new(star)).expect("a tip_path")
}

/// Trefoil r = 1 + 0.35 cos 3u about (1, 1), scaled to a largest radius of 0.6.
fn trefoil() -> TipPath {
    let point = |i: u32| {
        let u = TAU * f64::from(i) / 50.0;
        let r = 0.6 / 1.35 * (1.0 + 0.35 * (3.0 * u).cos());
        [1.0 + r * u.cos(), 1.0 + r * u.sin(), 0.0]
    };
    TipPath::through(&Waypoints::new((0..=50).map(point).collect(), None).expect("points")).expect("a tip_path")
}

fn plans(criterion: &mut Criterion) {
    let arm = Robot::planar(&[1.0; 3]).expect("an arm");
    let all = |value: f64| vec![Profile::Constant(value)];
    let limits = Limits::of(&arm)
        .replace(Field::Lower, all(f64::NEG_INFINITY))
        .and_then(|limits| limits.replace(Field::Upper, all(f64::INFINITY)))
        .and_then(|limits| limits.replace(Field::Velocity, all(PI)))
        .and_then(|limits| limits.replace(Field::Acceleration, all(4.0 * PI)))
        .expect("limits");
    let mut group = criterion.benchmark_group("along_path");
    for (name, tip_path, accuracy) in [("pentagram", pentagram(), 0.04), ("trefoil", trefoil(), 0.02)] {
        for (method, published) in [(AlongPathMethod::Timed, "timed"), (Tpbso::default().into(), "tpbso")] {
            let limits = Some(limits.clone());
            let options = AlongPathOptions { method, limits, accuracy: Some(accuracy), ..Default::default() };
            group.bench_function(format!("{name}/{published}"), |bencher| {
                bencher.iter(|| plan_along_path(&arm, &tip_path, &options, &mut Unattended));
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = plans
}
criterion_main!(benches);
