//! Batches of poses by the default solver, on one core and on two.

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use ikcore::batch::{BatchOptions, Targets, solve_batch};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::Unattended;

const TARGETS: usize = 10_000;

fn poses(c: &mut Criterion) {
    let mut group = c.benchmark_group("batch");
    group.throughput(Throughput::Elements(TARGETS as u64));
    for name in ["panda", "iiwa14"] {
        let robot = Robot::named(name).expect("a built-in robot");
        let goals = robot.random_configurations(TARGETS, &mut rng::stream(1, 0)).expect("they fit into memory");
        let poses = robot.fk_all(&goals).expect("finite configurations");
        let targets = Targets::Poses(poses.as_chunks().0);
        for threads in [1, 2] {
            let options = BatchOptions { threads: Some(threads), ..BatchOptions::default() };
            group.bench_function(BenchmarkId::new(name, threads), |b| {
                b.iter(|| solve_batch(&robot, targets, &options, &mut Unattended).expect("solutions"));
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    targets = poses
}
criterion_main!(benches);
