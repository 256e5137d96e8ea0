//! APPS on the seven motions of Yuan et al. 2016, beside other methods, and one iteration of it.

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use ikcore::ik::{SolveOptions, solve};
use ikcore::math::Frame;
use ikcore::objective::{Gradient, Objective};
use ikcore::problem::Problem;
use ikcore::robot::Robot;
use ikcore::solver::{Algorithm, AnySolver, Apps, JacobianTranspose, LevenbergMarquardt, NewtonRaphson};
use ikcore::solver::{Stop, Unattended};
use ikcore::task::{Aims, Target, Tolerance};

/// Joint angles (degrees) at the start of each motion, and the position (m) at its end: Tables 3 and 4.
const MOTIONS: [(&str, [f64; 6], [f64; 3]); 6] = [
    ("I-1", [0.01, -78.33, 183.51, 0.16, -44.87, -179.93], [1.9485, 0.6342, 1.1262]),
    ("1-2", [-20.10, -66.53, 184.76, 142.27, 34.16, -147.38], [1.7850, 0.6342, 1.2252]),
    ("2-3", [-22.00, -75.73, 191.81, 137.42, 33.61, -142.58], [1.6215, 0.6342, 1.3242]),
    ("3-4", [-24.27, -85.03, 197.50, 130.29, 32.60, -135.18], [1.6215, -0.6342, 1.3242]),
    ("4-5", [24.27, -85.03, 197.50, 229.71, 32.60, -224.82], [1.7850, -0.6342, 1.2252]),
    ("5-6", [22.00, -75.73, 191.81, 222.58, 33.61, -217.43], [1.9485, -0.6342, 1.1262]),
];

/// Rotation of eq. (22), column by column.
const AXES: [[f64; 3]; 3] = [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];

fn kuka() -> Robot {
    Robot::named("kr210_yuan2016").expect("a built-in robot")
}

fn options(solver: impl Into<Algorithm>, start: &[f64], tolerance: f64) -> SolveOptions {
    SolveOptions {
        solver: Some(AnySolver::Single(solver.into())),
        start: Some(start.iter().map(|angle| angle.to_radians()).collect()),
        tolerance: Tolerance { position: tolerance, rotation: tolerance },
        stop: Stop { max_iterations: 1000, ..Stop::default() },
        ..SolveOptions::default()
    }
}

fn motions(c: &mut Criterion) {
    let robot = kuka();
    let solvers: [(&str, Algorithm, f64); 5] = [
        ("APPS as published", Apps::paper().into(), 1e-4),
        ("APPS", Apps::default().into(), 1e-6),
        ("Jacobian transpose", JacobianTranspose::default().into(), 1e-6),
        ("Newton-Raphson", NewtonRaphson::default().into(), 1e-6),
        ("Levenberg-Marquardt", LevenbergMarquardt::default().into(), 1e-6),
    ];
    for (method, solver, tolerance) in solvers {
        let mut group = c.benchmark_group(method);
        for (name, start, origin) in MOTIONS {
            let target = Target::Pose(Frame { axes: AXES, origin });
            let options = options(solver.clone(), &start, tolerance);
            group.bench_function(name, |b| {
                b.iter(|| solve(&robot, &target, &options, &mut Unattended).expect("a solution"));
            });
        }
    }
}

/// Cost of one iteration, overhead included: the time of a spent budget over the number of iterations.
fn iteration(c: &mut Criterion) {
    let robot = kuka();
    let (_, start, origin) = MOTIONS[3];
    let target = Target::Pose(Frame { axes: AXES, origin });
    let mut group = c.benchmark_group("iteration");
    group.throughput(Throughput::Elements(300));
    for (name, solver) in [("APPS as published", Apps::paper()), ("APPS", Apps::default())] {
        // E_0 = 0 is never met, so all 300 iterations are made.
        let solver = Apps { error_threshold: Some(f64::MIN_POSITIVE), ..solver };
        let mut options = options(solver, &start, 1e-4);
        options.stop.max_iterations = 300;
        group.bench_function(name, |b| {
            b.iter(|| solve(&robot, &target, &options, &mut Unattended).expect("a solution"));
        });
    }
    group.throughput(Throughput::Elements(1));
    let task = Tolerance::default().into();
    let mut problem = Problem::new(&robot, Aims::of_one(&task, &target));
    let q: Vec<f64> = start.iter().map(|angle| angle.to_radians()).collect();
    let mut gradient = [0.0; 6];
    group.bench_function("error and gradient", |b| b.iter(|| problem.differentiate(&q, &mut gradient)));
    group.bench_function("error alone", |b| b.iter(|| problem.evaluate(&q)));
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500));
    targets = motions, iteration
}
criterion_main!(benches);
