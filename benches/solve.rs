//! Default solver on random reachable targets, without a start, within the robot's limits; all solutions and the best posture
//! at such poses; and the cost of building the index of starts.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use ikcore::ik::{AllOptions, Prefer, SolveOptions, solve, solve_all};
use ikcore::manipulability::Motion;
use ikcore::math::Frame;
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::Unattended;
use ikcore::task::{Goal, Target, Tolerance};

const ROBOTS: [&str; 4] = ["iiwa14", "panda", "ur5e", "kr210"];
const TARGETS: u64 = 200;

type TargetAt = fn(Frame) -> Target;

/// Kind and tolerance of each target (m, rad).
const TASKS: [(&str, TargetAt, f64); 3] = [
    ("pose", Target::Pose, 1e-6),
    ("pose to 1e-9", Target::Pose, 1e-9),
    ("position", |tip| Target::Position(tip.origin), 1e-6),
];

fn named(name: &str) -> Robot {
    Robot::named(name).expect("a built-in robot")
}

fn targets(c: &mut Criterion) {
    for (task, target_at, tolerance) in TASKS {
        let mut group = c.benchmark_group(task);
        group.throughput(Throughput::Elements(TARGETS));
        for name in ROBOTS {
            let robot = named(name);
            let goals =
                robot.random_configurations(TARGETS as usize, &mut rng::stream(1, 0)).expect("they fit into memory");
            let targets: Vec<_> = goals.chunks_exact(robot.dof()).map(|q| target_at(robot.tip(q))).collect();
            let tolerance = Tolerance { position: tolerance, rotation: tolerance };
            group.bench_function(name, |b| {
                b.iter(|| {
                    for (target, seed) in targets.iter().zip(0..) {
                        let options = SolveOptions { seed, tolerance, ..SolveOptions::default() };
                        solve(&robot, target, &options, &mut Unattended).expect("a solution");
                    }
                });
            });
        }
    }
}

fn all_solutions(c: &mut Criterion) {
    let mut group = c.benchmark_group("all solutions");
    group.throughput(Throughput::Elements(TARGETS));
    for name in ["ur5e", "ur10", "kr210"] {
        let robot = named(name);
        let goals =
            robot.random_configurations(TARGETS as usize, &mut rng::stream(1, 0)).expect("they fit into memory");
        let targets: Vec<_> = goals.chunks_exact(robot.dof()).map(|q| Target::Pose(robot.tip(q))).collect();
        let options = AllOptions::default();
        group.bench_function(name, |b| {
            b.iter(|| {
                for target in &targets {
                    black_box(solve_all(&robot, target, &options, &mut Unattended).expect("solutions"));
                }
            });
        });
    }
}

fn best_postures(c: &mut Criterion) {
    const POSES: usize = 50;
    let mut group = c.benchmark_group("best posture");
    group.throughput(Throughput::Elements(POSES as u64));
    for name in ["iiwa14", "panda"] {
        let robot = named(name);
        let goals = robot.random_configurations(POSES, &mut rng::stream(1, 0)).expect("they fit into memory");
        let targets: Vec<_> = goals.chunks_exact(robot.dof()).map(|q| Target::Pose(robot.tip(q))).collect();
        let goals = vec![Goal::Manipulability { motion: Motion::Pose, tip: None, weight: 1.0 }];
        let options = SolveOptions { goals, prefer: Prefer::Best, ..SolveOptions::default() };
        group.bench_function(name, |b| {
            b.iter(|| {
                targets.iter().for_each(|target| {
                    solve(&robot, target, &options, &mut Unattended).expect("a solution");
                });
            });
        });
    }
}

fn index(c: &mut Criterion) {
    let mut group = c.benchmark_group("index of starts");
    for name in ROBOTS {
        let robot = named(name);
        // Limits replaced by others, even equal ones, require a new index.
        let fresh = || robot.with_limits(|_, _| ()).expect("the same limits");
        group.bench_function(name, |b| {
            b.iter_batched_ref(
                fresh,
                |robot| {
                    black_box(robot.starts_near_pose(&Frame::IDENTITY));
                },
                BatchSize::LargeInput,
            );
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = targets, all_solutions, best_postures, index
}
criterion_main!(benches);
