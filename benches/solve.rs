//! Poses by the default solver: random reachable targets, each from its own random start, within the robot's limits.

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ikcore::ik::{SolveOptions, solve};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::task::Target;

const TARGETS: u64 = 200;

fn poses(c: &mut Criterion) {
    let mut group = c.benchmark_group("pose");
    group.throughput(Throughput::Elements(TARGETS));
    for name in ["iiwa14", "panda", "ur5e"] {
        let robot = Robot::named(name).expect("a built-in robot");
        let goals =
            robot.random_configurations(TARGETS as usize, &mut rng::stream(1, 0)).expect("they fit into memory");
        let targets: Vec<_> = goals.chunks_exact(robot.dof()).map(|q| Target::Pose(robot.tip(q))).collect();
        group.bench_function(name, |b| {
            b.iter(|| {
                for (target, seed) in targets.iter().zip(0..) {
                    let options = SolveOptions { seed, ..SolveOptions::default() };
                    solve(&robot, target, &options, &mut Unattended).expect("a solution");
                }
            });
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
    targets = poses
}
criterion_main!(benches);
