//! Forward kinematics, Jacobians, and the gradient of manipulability: nanoseconds a configuration.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ikcore::manipulability::{Manipulability, Motion};
use ikcore::math::Columns;
use ikcore::rng;
use ikcore::robot::Robot;

const ROBOTS: [&str; 3] = ["iiwa14", "ur5e", "planar5"];

fn robot(name: &str) -> Robot {
    Robot::named(name).expect("a built-in robot")
}

fn single(c: &mut Criterion) {
    for name in ROBOTS {
        let robot = robot(name);
        let qs = robot.random_configurations(4, &mut rng::stream(0, 0)).expect("they fit into memory");
        let q = &qs[..robot.dof()];
        let mut columns = Columns::default();
        let mut group = c.benchmark_group(name);
        group.bench_function("fk", |b| b.iter(|| robot.tip(black_box(q))));
        group.bench_function("fk and jacobian", |b| b.iter(|| robot.tip_and_jacobian(black_box(q), &mut columns)));
        group.bench_function("tip position", |b| b.iter(|| robot.tip_position(black_box(q))));
        group.bench_function("four tip positions", |b| {
            b.iter(|| robot.tip_positions(black_box(&qs), |tip| _ = black_box(tip)));
        });
        // Planar arms turn about one axis only: the pose has no index.
        let motion = if name == "planar5" { Motion::Position } else { Motion::Pose };
        let measure = Manipulability::of(&robot, motion);
        let mut gradient = vec![0.0; robot.dof()];
        group.bench_function("manipulability", |b| b.iter(|| measure.index(&robot, black_box(q))));
        group.bench_function("manipulability and gradient", |b| {
            b.iter(|| measure.gradient(&robot, black_box(q), &mut gradient));
        });
        group.finish();
    }
}

fn batch(c: &mut Criterion) {
    const COUNT: usize = 100_000;
    let mut group = c.benchmark_group("batch of 100 000");
    group.throughput(Throughput::Elements(COUNT as u64)).sample_size(20);
    for name in ROBOTS {
        let robot = robot(name);
        let qs = robot.random_configurations(COUNT, &mut rng::stream(0, 0)).expect("they fit into memory");
        group.bench_function(format!("{name} fk"), |b| {
            b.iter(|| qs.chunks_exact(robot.dof()).for_each(|q| _ = black_box(robot.tip(q))));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    targets = single, batch
}
criterion_main!(benches);
