//! Plans from end to end: the planar arms of Wang et al. (2019), panda behind a box and around a wall; one clearance.

use criterion::{Criterion, criterion_group, criterion_main};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::planning::{Endpoint, PointToPointOptions, plan_point_to_point};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::Unattended;
use ikcore::task::Target;

/// Limits with this acceleration and, if given, velocity for all joints.
fn limits(robot: &Robot, velocity: Option<f64>, acceleration: f64) -> Option<Limits> {
    let all = |value: f64| vec![Profile::Constant(value)];
    let limits = Limits::of(robot).replace(Field::Acceleration, all(acceleration)).expect("limits");
    Some(velocity.map_or(limits.clone(), |velocity| limits.replace(Field::Velocity, all(velocity)).expect("limits")))
}

fn plane(c: &mut Criterion) {
    let position = |x, y| Endpoint::from(Target::Position([x, y, 0.0]));
    let mut group = c.benchmark_group("point_to_point");
    for links in 2..=5 {
        let arm = Robot::planar(&vec![2.0 / links as f64; links]).expect("an arm");
        let limits = limits(&arm, Some(std::f64::consts::PI), std::f64::consts::TAU);
        let options = PointToPointOptions { limits, ..Default::default() };
        group.bench_function(format!("{links} links in the plane"), |b| {
            b.iter(|| plan_point_to_point(&arm, &position(1.0, 0.0), &[position(0.5, 1.5)], &options, &mut Unattended));
        });
    }
}

fn panda(c: &mut Criterion) {
    let arm = Robot::named("panda").and_then(|arm| arm.with_capsules_along_links(0.06)).expect("an arm");
    let crate_ = Shape::cuboid([0.5, 0.0, 0.2], [0.2, 0.6, 0.4], None).expect("a box");
    let wall = Shape::cuboid([0.55, 0.0, 0.3], [0.5, 0.05, 0.6], None).expect("a wall");
    let behind = arm.fk(&[0.124, 0.768, -0.323, -0.972, 0.047, 1.456, 2.818]).expect("a pose");
    let centre = arm.joints().iter().map(|joint| 0.5 * (joint.lower + joint.upper)).collect();
    let side = |turn: f64| Endpoint::Configuration(vec![turn, 0.8, 0.0, -1.6, 0.0, 2.4, 0.8]);
    let mut group = c.benchmark_group("point_to_point");
    for (name, obstacle, start, end) in [
        ("panda behind a box", &crate_, Endpoint::Configuration(centre), Endpoint::from(Target::from(&behind))),
        ("panda around a wall", &wall, side(-0.7), side(0.7)),
    ] {
        let options = PointToPointOptions {
            limits: limits(&arm, None, 10.0),
            surroundings: Surroundings::among(vec![obstacle.clone()]),
            ..Default::default()
        };
        group.bench_function(name, |b| {
            b.iter(|| plan_point_to_point(&arm, &start, std::slice::from_ref(&end), &options, &mut Unattended))
        });
    }
    let obstacles = [crate_];
    let scene = Scene::new(&arm, &obstacles).expect("a scene");
    group.bench_function("clearance of one configuration", |b| b.iter(|| scene.nearest(&[0.1; 7])));
}

criterion_group!(benches, plane, panda);
criterion_main!(benches);
