//! Collision test of a configuration, for a Panda of capsules or spheres among boxes, a mesh and a point cloud.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ikcore::obstacle::Scene;
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{LinkCapsule, Robot};
use ikcore::shape::Shape;

const CONFIGURATIONS: usize = 1000;

/// Panda with spheres along the links, about as many as a spherized model has.
fn of_spheres(robot: &Robot) -> Robot {
    let rods = robot.with_capsules_along_links(0.06).expect("rods");
    let spheres = rods.capsules().iter().flat_map(|rod| {
        let count = 8;
        (0..count).map(move |i| {
            let fraction = f64::from(i) / f64::from(count - 1);
            let center = std::array::from_fn(|k| rod.a[k] + fraction * (rod.b[k] - rod.a[k]));
            LinkCapsule { a: center, b: center, ..rod.clone() }
        })
    });
    robot.with_capsules(spheres.collect()).expect("spheres")
}

/// Panda with capsules side by side along the links, about as many as a model of fitted capsules has.
fn of_capsules(robot: &Robot) -> Robot {
    let rods = robot.with_capsules_along_links(0.05).expect("rods");
    let capsules = rods.capsules().iter().flat_map(|rod| {
        (0..4).map(move |i| {
            let aside = |end: [f64; 3]| std::array::from_fn(|k| end[k] + if k == i % 3 { 0.02 } else { 0.0 });
            LinkCapsule { a: aside(rod.a), b: aside(rod.b), ..rod.clone() }
        })
    });
    robot.with_capsules(capsules.collect()).expect("capsules")
}

fn around(rng: &mut LazyRng) -> [f64; 3] {
    let mut away = [0.0; 3];
    rng.direction(&mut away);
    let far = rng.uniform_in(0.7, 1.1);
    [far * away[0], far * away[1], 0.3 + far * away[2].abs()]
}

fn boxes(rng: &mut LazyRng, count: usize) -> Vec<Shape> {
    let mut one = || {
        let size = std::array::from_fn(|_| rng.uniform_in(0.05, 0.3));
        Shape::cuboid(around(rng), size, None).expect("a box")
    };
    (0..count).map(|_| one()).collect()
}

/// Mesh of 1,000 triangles: a bumpy ball in front of the arm.
fn mesh() -> Shape {
    let triangles = Shape::ellipsoid([0.7, 0.0, 0.3], [0.2, 0.3, 0.2], None).expect("a ball").triangles();
    let corners: Vec<[f64; 3]> = triangles
        .iter()
        .flat_map(|[a, b, c]| {
            let middle: [f64; 3] = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
            [*a, *b, middle, *b, *c, middle]
        })
        .collect();
    let faces = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Shape::mesh(corners, faces).expect("a mesh")
}

fn cloud(rng: &mut LazyRng) -> Shape {
    let points = (0..100_000).map(|_| around(rng)).collect();
    Shape::point_cloud(points, 0.01).expect("a cloud")
}

fn clear(criterion: &mut Criterion) {
    let mut rng = rng::stream(1, 0);
    let panda = Robot::named("panda").expect("a robot");
    let scenes = [
        ("10_boxes", boxes(&mut rng, 10)),
        ("1000_boxes", boxes(&mut rng, 1000)),
        ("1000_triangles", vec![mesh()]),
        ("100000_points", vec![cloud(&mut rng)]),
    ];
    for (bodies, robot) in [("spheres", of_spheres(&panda)), ("capsules", of_capsules(&panda))] {
        let qs = robot.random_configurations(CONFIGURATIONS, &mut rng).expect("configurations");
        for (name, obstacles) in &scenes {
            let scene = Scene::new(&robot, obstacles).expect("a scene").without_self_collision();
            let clear: Vec<f64> = qs.chunks(7).filter(|q| scene.is_clear(q, 0.001)).flatten().copied().collect();
            let name = format!("{}_{bodies}/{name}", robot.capsules().len());
            println!("{name}: {} of {CONFIGURATIONS} clear", clear.len() / 7);
            if clear.is_empty() {
                continue;
            }
            let mut group = criterion.benchmark_group(name);
            let each = clear.chunks(7).collect::<Vec<_>>();
            let mut next = (0..each.len()).cycle();
            group.bench_function("one_clear", |b| {
                b.iter(|| scene.is_clear(black_box(each[next.next().unwrap_or(0)]), 0.001));
            });
            let count = each.len().min(100);
            group.bench_function(format!("{count}_clear"), |b| {
                b.iter(|| scene.which_are_clear(black_box(&clear[..7 * count]), 0.001));
            });
            group.finish();
        }
    }
}

criterion_group!(benches, clear);
criterion_main!(benches);
