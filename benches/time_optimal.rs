//! Fastest timing of random splines for seven joints.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::planning::{ConstantLimits, JointPath, SplineEnds, TimingOptions, time_optimal};
use ikcore::rng;

const JOINTS: usize = 7;
const WAYPOINTS: usize = 8;

fn names() -> Vec<String> {
    (1..=JOINTS).map(|i| format!("q{i}")).collect()
}

fn path() -> JointPath {
    let mut rng = rng::stream(1, 0);
    let waypoints: Vec<f64> = (0..JOINTS * WAYPOINTS).map(|_| rng.uniform_in(-2.0, 2.0)).collect();
    JointPath::spline(names(), &waypoints, None, SplineEnds::Natural).expect("a spline")
}

fn limits(jerk: Option<f64>) -> ConstantLimits {
    let constant = |value: f64| vec![Profile::Constant(value)];
    let limits = Limits::none(names())
        .replace(Field::Velocity, constant(2.0))
        .and_then(|limits| limits.replace(Field::Acceleration, constant(5.0)))
        .and_then(|limits| match jerk {
            None => Ok(limits),
            Some(jerk) => limits.replace(Field::Jerk, constant(jerk)),
        })
        .expect("limits");
    ConstantLimits::new(&limits, "time_optimal").expect("constant limits")
}

/// Time from path to trajectory; proportional to the number of grid points.
fn grids(criterion: &mut Criterion) {
    let (path, limits) = (path(), limits(None));
    let mut group = criterion.benchmark_group("time_optimal/7_joints");
    for gridpoints in [150, 1_000, 10_000, 100_000] {
        group.throughput(Throughput::Elements(gridpoints as u64));
        let options = TimingOptions { gridpoints: Some(gridpoints), ..TimingOptions::default() };
        group.bench_function(BenchmarkId::from_parameter(gridpoints), |bencher| {
            bencher.iter(|| time_optimal(black_box(&path), &limits, &options));
        });
    }
    group.finish();
    criterion.bench_function("time_optimal/7_joints/refined", |bencher| {
        bencher.iter(|| time_optimal(black_box(&path), &limits, &TimingOptions::default()));
    });
}

fn with_jerk(criterion: &mut Criterion) {
    let (path, limits) = (path(), limits(Some(50.0)));
    criterion.bench_function("time_optimal/7_joints/jerk", |bencher| {
        bencher.iter(|| time_optimal(black_box(&path), &limits, &TimingOptions::default()));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(3));
    targets = grids, with_jerk
}
criterion_main!(benches);
