//! Inverse dynamics, gravity, mass matrix and forward dynamics: nanoseconds a configuration.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ikcore::rng;
use ikcore::robot::{Motions, Robot};

/// Configurations of a batch.
const COUNT: usize = 100_000;

fn dynamics(c: &mut Criterion) {
    let robot = Robot::named("panda").expect("a built-in robot");
    let q = robot.random_configurations(COUNT, &mut rng::stream(0, 0)).expect("they fit into memory");
    let motions = Motions { q: &q, qd: Some(&q), qdd: Some(&q), wrenches: None };
    let mut group = c.benchmark_group("panda, batch of 100 000");
    group.throughput(Throughput::Elements(COUNT as u64)).sample_size(10);
    group.bench_function("inverse dynamics", |b| b.iter(|| robot.torques_all(black_box(&motions))));
    let rest = Motions { qd: None, qdd: None, ..motions };
    group.bench_function("gravity", |b| b.iter(|| robot.torques_all(black_box(&rest))));
    group.bench_function("mass matrix", |b| b.iter(|| robot.mass_matrix_all(black_box(&q))));
    group.bench_function("forward dynamics", |b| b.iter(|| robot.accelerations_all(black_box(&q), &q, &q)));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    targets = dynamics
}
criterion_main!(benches);
