//! Distances, capsules and sweeps against brute force.

use ikcore::nalgebra::{Point3, Rotation3, Vector3};
use ikcore::obstacle::{ClearanceSweep, Edge, Neighbor, Scene};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{LinkCapsule, Robot};
use ikcore::shape::{Geometry, Shape};

/// Robot whose only capsule is a segment at rest relative to its last link.
fn rod(a: [f64; 3], b: [f64; 3], radius: f64) -> Robot {
    let arm = Robot::named("iiwa14").unwrap();
    let link = arm.link_names().last().unwrap().to_owned();
    let pose = arm.fk(&[0.0; 7]).unwrap();
    let local = |p: [f64; 3]| pose.inverse_transform_point(&p.into()).coords.into();
    arm.with_capsules(vec![LinkCapsule { link, a: local(a), b: local(b), radius }]).unwrap()
}

fn distance(a: [f64; 3], b: [f64; 3], radius: f64, obstacle: &Shape) -> f64 {
    let robot = rod(a, b, radius);
    let obstacles = [obstacle.clone()];
    let scene = Scene::new(&robot, &obstacles).unwrap();
    scene.nearest(&[0.0; 7]).unwrap().unwrap().distance
}

fn point(rng: &mut LazyRng, reach: f64) -> [f64; 3] {
    std::array::from_fn(|_| rng.uniform_in(-reach, reach))
}

fn rotation(rng: &mut LazyRng) -> Rotation3<f64> {
    Rotation3::new(Vector3::from(point(rng, 2.0)))
}

/// Random shape of this kind that may touch everything.
fn random_obstacle(rng: &mut LazyRng, kind: usize) -> Shape {
    let (center, turn) = (point(rng, 0.5), *rotation(rng).matrix());
    let sizes: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.05, 0.6));
    match kind {
        0 => Shape::sphere(center, sizes[0]),
        1 => Shape::cuboid(center, sizes, Some(turn)),
        2 => Shape::capsule(center, point(rng, 0.5), 0.3 * sizes[0]),
        3 => Shape::ellipsoid(center, sizes, Some(turn)),
        _ => Shape::convex_mesh(&std::array::from_fn::<_, 9, _>(|_| point(rng, 0.4))),
    }
    .unwrap()
}

/// Dense points on the surface and inside.
fn points_of(obstacle: &Shape, rng: &mut LazyRng, count: usize) -> Vec<Vector3<f64>> {
    let mut unit = [0.0; 3];
    (0..count)
        .map(|_| {
            rng.direction(&mut unit);
            let u = Vector3::from(unit);
            match obstacle.geometry() {
                Geometry::Sphere { center, radius } => Vector3::from(*center) + *radius * u,
                Geometry::Box { pose, size } => {
                    (pose * nalgebra_point(u.component_mul(&(0.5 * Vector3::from(*size))) / u.amax())).coords
                }
                Geometry::Capsule { a, b, radius } => {
                    let fraction = rng.uniform();
                    Vector3::from(*a) * (1.0 - fraction) + Vector3::from(*b) * fraction + *radius * u
                }
                Geometry::Ellipsoid { pose, semi_axes } => {
                    (pose * nalgebra_point(u.component_mul(&Vector3::from(*semi_axes)))).coords
                }
                Geometry::ConvexMesh(hull) => {
                    let triangles = hull.triangles();
                    let triangle = triangles[(rng.uniform() * triangles.len() as f64) as usize];
                    let (mut s, mut t) = (rng.uniform(), rng.uniform());
                    if s + t > 1.0 {
                        (s, t) = (1.0 - s, 1.0 - t);
                    }
                    let [p, q, r] = triangle.map(Vector3::from);
                    p + s * (q - p) + t * (r - p)
                }
                shape => unreachable!("{shape:?}"),
            }
        })
        .collect()
}

fn nalgebra_point(v: Vector3<f64>) -> Point3<f64> {
    v.into()
}

fn to_segment(a: &Vector3<f64>, b: &Vector3<f64>, p: &Vector3<f64>) -> f64 {
    let along = b - a;
    let fraction = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (a + fraction * along - p).norm()
}

#[test]
fn distances_are_those_of_dense_points() {
    let mut rng = rng::stream(3, 0);
    let mut apart = 0;
    for case in 0..60 {
        let obstacle = random_obstacle(&mut rng, case % 5);
        let (a, b) = (point(&mut rng, 1.5), point(&mut rng, 1.5));
        let found = distance(a, b, 0.0, &obstacle);
        let dense = points_of(&obstacle, &mut rng, 4000);
        let nearest = dense.iter().map(|p| to_segment(&a.into(), &b.into(), p)).fold(f64::INFINITY, f64::min);
        // Sampled points are never nearer than the truth.
        assert!(found <= nearest + 1e-8, "case {case}: {found} {nearest}");
        if found > 0.02 {
            apart += 1;
            assert!(nearest - found < 0.05, "case {case}: {found} {nearest} {obstacle:?} {a:?} {b:?}");
        }
    }
    assert!(apart > 20);
}

#[test]
fn distances_of_known_places() {
    let box_ = Shape::cuboid([0.0; 3], [2.0, 2.0, 2.0], None).unwrap();
    let ball = Shape::sphere([0.0; 3], 1.0).unwrap();
    let egg = Shape::ellipsoid([0.0; 3], [3.0, 1.0, 1.0], None).unwrap();
    let cube: Vec<[f64; 3]> = (0..8).map(|i| [0, 1, 2].map(|k| f64::from(((i >> k) & 1) * 2 - 1))).collect();
    let mesh = Shape::convex_mesh(&cube).unwrap();
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    for cube in [&box_, &mesh] {
        close(distance([3.0, -5.0, 0.0], [3.0, 5.0, 0.0], 0.5, cube), 1.5); // beside a face
        close(distance([2.0, 2.0, -3.0], [2.0, 2.0, 3.0], 0.0, cube), 2.0_f64.sqrt()); // beside an edge
        close(distance([2.0, 2.0, 2.0], [3.0, 3.0, 3.0], 0.0, cube), 3.0_f64.sqrt()); // off a corner
        close(distance([0.25, 0.0, -5.0], [0.25, 0.0, 5.0], 0.0, cube), -0.75); // through the middle
    }
    close(distance([-4.0, 1.5, 0.0], [4.0, 1.5, 0.0], 0.1, &ball), 0.4);
    close(distance([-4.0, 0.5, 0.0], [4.0, 0.5, 0.0], 0.0, &ball), -0.5);
    close(distance([4.0, 0.0, 0.0], [9.0, 0.0, 0.0], 0.0, &egg), 1.0);
    close(distance([-4.0, 2.0, 0.5], [4.0, 2.0, 0.5], 0.0, &egg), 4.25_f64.sqrt() - 1.0);
    close(distance([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0, &egg), -1.0);
    let capsule = Shape::capsule([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], 0.5).unwrap();
    close(distance([-4.0, 2.0, 0.0], [4.0, 2.0, 0.0], 0.25, &capsule), 1.25);
}

#[test]
fn an_ellipse_is_as_far_as_its_own_boundary_in_the_plane() {
    let robot = Robot::planar(&[1.0, 1.0]).unwrap().with_capsules_along_links(0.0).unwrap();
    let mut rng = rng::stream(5, 0);
    for _ in 0..50 {
        let center = [rng.uniform_in(-2.0, 2.0), rng.uniform_in(-2.0, 2.0)];
        let (semi_axes, angle) = ([rng.uniform_in(0.05, 0.5), rng.uniform_in(0.05, 0.5)], rng.uniform_in(-3.0, 3.0));
        let obstacles = [Shape::ellipse(center, semi_axes, angle).unwrap()];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let q = [rng.uniform_in(-3.0, 3.0), rng.uniform_in(-3.0, 3.0)];
        let found = scene.nearest(&q).unwrap().unwrap().distance;
        let joint = Vector3::new(q[0].cos(), q[0].sin(), 0.0);
        let tip = joint + Vector3::new((q[0] + q[1]).cos(), (q[0] + q[1]).sin(), 0.0);
        let boundary = (0..20_000).map(|i| {
            let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 20_000.0).sin_cos();
            let (x, y) = (semi_axes[0] * cosine, semi_axes[1] * sine);
            let (s, c) = angle.sin_cos();
            Vector3::new(center[0] + c * x - s * y, center[1] + s * x + c * y, 0.0)
        });
        let nearest = boundary
            .map(|p| to_segment(&Vector3::zeros(), &joint, &p).min(to_segment(&joint, &tip, &p)))
            .fold(f64::INFINITY, f64::min);
        if found > 0.0 {
            assert!((nearest - found).abs() < 1e-6, "{found} {nearest}");
        } else {
            assert!(nearest < 0.51);
        }
    }
}

#[test]
fn what_a_sweep_calls_free_is_free_at_every_sample() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let mut rng = rng::stream(7, 0);
    let (mut free, mut hits) = (0, 0);
    for case in 0..60 {
        let obstacles: Vec<Shape> = (0..2).map(|k| random_obstacle(&mut rng, (case + k) % 5)).collect();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let ends = robot.random_configurations(2, &mut rng).unwrap();
        let edge = Edge { from: &ends[..7], to: &ends[7..] };
        let mut sweep = ClearanceSweep::new(&scene);
        let verdict = sweep.check(&edge, [0.0, 1.0], 0.001);
        let smallest = sweep.smallest(&edge, [0.0, 1.0]).unwrap().contact.distance;
        let sampled = (0..=1000)
            .map(|i| {
                let fraction = f64::from(i) / 1000.0;
                let q: Vec<f64> = (0..7).map(|j| edge.from[j] + fraction * (edge.to[j] - edge.from[j])).collect();
                scene.nearest(&q).unwrap().unwrap().distance
            })
            .fold(f64::INFINITY, f64::min);
        assert!(smallest <= sampled + 1e-12, "case {case}: {smallest} {sampled}");
        assert!(sampled - smallest < 5e-3 + 0.02 * sampled.abs(), "case {case}: {smallest} {sampled}");
        match verdict {
            Ok(()) => {
                free += 1;
                assert!(sampled >= 0.001, "case {case}: {sampled}");
            }
            Err(near) => {
                hits += 1;
                assert!(near.contact.distance < 0.001 + 1e-5, "case {case}: {near:?}");
            }
        }
    }
    assert!(free > 5 && hits > 5, "{free} {hits}");
}

#[test]
fn pairs_that_belong_to_the_model_are_left_out() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let scene = Scene::new(&robot, &[]).unwrap();
    let rest: Vec<f64> = robot.joints().iter().map(|joint| 0.5 * (joint.lower + joint.upper)).collect();
    assert!(scene.nearest(&rest).unwrap().unwrap().distance > 0.0);
    // Folded back the hand meets the base.
    let folded = [0.0, -1.7, 0.0, -3.0, 0.0, 0.5, 0.0];
    let contact = scene.nearest(&folded).unwrap().unwrap();
    assert!(matches!(contact.other, Neighbor::Link(_)), "{contact:?}");
}

/// Volume of a convex body with this surface (m^3): pyramids from a point inside.
fn volume(obstacle: &Shape) -> f64 {
    let triangles: Vec<_> = obstacle.triangles().into_iter().map(|corners| corners.map(Vector3::from)).collect();
    let inside = triangles.iter().flatten().sum::<Vector3<f64>>() / (3 * triangles.len()) as f64;
    let pyramid = |[a, b, c]: &[Vector3<f64>; 3]| (a - inside).dot(&(b - inside).cross(&(c - inside))).abs() / 6.0;
    triangles.iter().map(pyramid).sum()
}

#[test]
fn drawn_surfaces_close_around_the_shape() {
    let (center, turn) = ([0.3, -0.2, 0.5], *Rotation3::new(Vector3::new(0.4, -0.7, 0.2)).matrix());
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    let cuboid = Shape::cuboid(center, [0.2, 0.3, 0.4], Some(turn)).unwrap();
    assert!((volume(&cuboid) - 0.024).abs() < 1e-12);
    let rod = std::f64::consts::PI * 0.01 * 0.5; // between the two halves of a capsule's ball
    let round = [
        (Shape::sphere(center, 0.1), ball * 0.001),
        (Shape::ellipsoid(center, [0.1, 0.2, 0.3], Some(turn)), ball * 0.006),
        (Shape::capsule([0.0, 0.0, 0.1], [0.3, 0.4, 0.1], 0.1), ball * 0.001 + rod),
    ];
    for (obstacle, exact) in round {
        let fraction = volume(&obstacle.unwrap()) / exact;
        assert!((0.9..1.0).contains(&fraction), "{fraction}"); // corners on the surface, so a little is left out
    }
    let ellipse = Shape::ellipse([0.3, 0.1], [0.2, 0.1], 0.4).unwrap();
    let area = |[a, b, c]: [[f64; 3]; 3]| {
        let (ab, ac) = (Vector3::from(b) - Vector3::from(a), Vector3::from(c) - Vector3::from(a));
        ab.cross(&ac).norm() / 2.0
    };
    let fraction = ellipse.triangles().into_iter().map(area).sum::<f64>() / (std::f64::consts::PI * 0.02);
    assert!((0.95..1.0).contains(&fraction), "{fraction}");
}

#[test]
fn a_configuration_is_clear_when_its_nearest_pair_is() {
    let mut rng = rng::stream(9, 0);
    for robot in [
        Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap(),
        with_random_bodies("iiwa14", &mut rng),
    ] {
        for count in [0, 20, 60] {
            let mut obstacles: Vec<Shape> = (0..count).map(|k| distant_obstacle(&mut rng, k)).collect();
            if count > 0 {
                obstacles.push(Shape::half_space([0.0, 0.0, 1.0], -0.3).unwrap());
            }
            let scene = Scene::new(&robot, &obstacles).unwrap();
            let (mut clear, mut near) = (0, 0);
            let qs = robot.random_configurations(203, &mut rng).unwrap();
            let margin = rng.uniform_in(0.0, 0.03);
            let at_once = scene.which_are_clear(&qs, margin).unwrap();
            for (q, one_of_many) in qs.chunks(robot.dof()).zip(at_once) {
                let distance = scene.clearance(q).unwrap();
                let found = scene.is_clear(q, margin);
                // Within rounding of the decision both answers are right.
                assert!((distance - margin).abs() < 3e-9 || found == (distance >= margin), "{distance} {margin}");
                assert_eq!(found, one_of_many);
                *(if found { &mut clear } else { &mut near }) += 1;
            }
            assert!(clear > 5 && (near > 5 || count == 0), "{count}: {clear} {near}");
        }
    }
}

/// Small shape at least 0.5 m from the origin.
fn distant_obstacle(rng: &mut LazyRng, kind: usize) -> Shape {
    let mut away = [0.0; 3];
    rng.direction(&mut away);
    let far = rng.uniform_in(0.5, 1.2);
    let center = away.map(|x| far * x);
    let (end, turn) = (std::array::from_fn(|k| center[k] + 0.1 * away[(k + 1) % 3]), *rotation(rng).matrix());
    let sizes: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.02, 0.15));
    match kind % 5 {
        0 => Shape::sphere(center, sizes[0]),
        1 => Shape::cuboid(center, sizes, Some(turn)),
        2 => Shape::capsule(center, end, sizes[0]),
        3 => Shape::cylinder(center, away, sizes[0], sizes[1]),
        _ => Shape::ellipsoid(center, sizes, Some(turn)),
    }
    .unwrap()
}

/// Robot with spheres and capsules on each link.
fn with_random_bodies(name: &str, rng: &mut LazyRng) -> Robot {
    let robot = Robot::named(name).unwrap();
    let names: Vec<String> = robot.link_names().map(str::to_owned).collect();
    let bodies = names.iter().flat_map(|link| {
        let mut body = |length: f64| {
            let a = point(rng, 0.05);
            let b = std::array::from_fn(|k| a[k] + rng.uniform_in(-length, length));
            LinkCapsule { link: link.clone(), a, b, radius: rng.uniform_in(0.0, 0.04) }
        };
        [body(0.0), body(0.1), body(0.0)]
    });
    robot.with_capsules(bodies.collect()).unwrap()
}

/// Derivatives of the smallest distance by joints, by differences of `step` (rad). The distance has a corner where another pair
/// or another face becomes the nearest: derivatives that differ by `corner` or more on the two sides are omitted.
fn slopes(scene: &Scene, q: &[f64], step: f64, corner: f64) -> Vec<(usize, f64)> {
    let here = scene.clearance(q).unwrap();
    let slope = |j: usize| {
        let at = |sign: f64| {
            let mut moved = q.to_vec();
            moved[j] += sign * step;
            scene.nearest(&moved).unwrap().unwrap()
        };
        let [low, high] = [at(-1.0), at(1.0)];
        let (slope, one_sided) = ((high.distance - low.distance) / (2.0 * step), (high.distance - here) / step);
        let is_smooth = low.other == high.other && low.link == high.link && (slope - one_sided).abs() < corner;
        is_smooth.then_some((j, slope))
    };
    (0..q.len()).filter_map(slope).collect()
}

#[test]
fn a_contact_lies_on_both_surfaces_and_its_gradient_is_the_slope() {
    let mut rng = rng::stream(11, 0);
    let robot = with_random_bodies("panda", &mut rng);
    let (mut with_links, mut inside) = (0, 0);
    for case in 0..120 {
        let obstacles = if case % 3 == 0 { vec![] } else { vec![random_obstacle(&mut rng, case % 5)] };
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let found = scene.nearest_contact(&q).unwrap().unwrap();
        assert_eq!(Some(&found.contact), scene.nearest(&q).unwrap().as_ref());
        let normal = Vector3::from(found.normal);
        assert!((normal.norm() - 1.0).abs() < 1e-9);
        match found.contact.other {
            Neighbor::Link(_) => with_links += 1,
            Neighbor::Obstacle(..) if found.contact.distance > 0.0 => {
                // A ball of no size at the point of the link is as far from the obstacle as the link.
                let point = found.point;
                let gap = distance(point, point, 0.0, &obstacles[0]);
                assert!((gap - found.contact.distance).abs() < 1e-6, "{gap} {found:?}");
            }
            Neighbor::Obstacle(..) => inside += 1,
        }
        for (j, slope) in slopes(&scene, &q, 1e-6, 1e-4) {
            // Halfway between opposite faces the depth does not change, and the gradient leads out past one of them.
            let is_halfway = found.contact.distance < 0.0 && slope.abs() < 1e-9;
            assert!(
                is_halfway || (slope - found.gradient[j]).abs() < 5e-3,
                "case {case}, joint {j}: {slope} {found:?}"
            );
        }
    }
    assert!(with_links > 20 && inside > 5, "{with_links} {inside}");
}

#[test]
fn the_deepest_of_several_bodies_in_an_obstacle_is_the_nearest() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap();
    // Each body by itself, with no other to compare it with.
    let panda = Robot::named("panda").unwrap();
    let by_themselves: Vec<Robot> =
        robot.capsules().iter().map(|capsule| panda.with_capsules(vec![capsule.clone()]).unwrap()).collect();
    let mut rng = rng::stream(29, 0);
    let mut several = 0;
    for case in 0..200 {
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let center = robot.tip_position(&q).map(|x| x + rng.uniform_in(-0.1, 0.1));
        let size = std::array::from_fn(|_| rng.uniform_in(0.05, 0.2));
        let shape = if case % 2 == 0 { Shape::cuboid(center, size, None) } else { Shape::sphere(center, size[0]) };
        let obstacles = [shape.unwrap()];
        let all = Scene::new(&robot, &obstacles).unwrap().clearance(&q).unwrap();
        let clearance = |robot| Scene::new(robot, &obstacles).unwrap().clearance(&q).unwrap();
        let alone: Vec<f64> = by_themselves.iter().map(clearance).collect();
        several += usize::from(alone.iter().filter(|distance| **distance < 0.0).count() > 1);
        let deepest = alone.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(deepest > 0.0 || (all - deepest).abs() < 1e-9, "case {case}: {all}, one by one {deepest}");
    }
    assert!(several > 40, "{several}");
}

/// Panda with spheres, capsules and other shapes.
fn with_solid_bodies(rng: &mut LazyRng) -> Robot {
    let mut robot = with_random_bodies("panda", rng);
    for (kind, link) in ["link_2", "link_3", "link_4", "link_5", "link_7"].into_iter().enumerate() {
        let (center, turn) = (point(rng, 0.05), *rotation(rng).matrix());
        let sizes: [f64; 3] = std::array::from_fn(|_| rng.uniform_in(0.05, 0.2));
        let shape = match kind {
            0 => Shape::cylinder(center, point(rng, 1.0), sizes[0], sizes[1]),
            1 => Shape::ellipsoid(center, sizes.map(|x| 0.5 * x), Some(turn)),
            2 => Shape::convex_mesh(&std::array::from_fn::<_, 12, _>(|_| point(rng, 0.1))),
            _ => Shape::cuboid(center, sizes, Some(turn)),
        };
        robot = robot.with_attached(link, &shape.unwrap(), &[], None).unwrap();
    }
    robot
}

#[test]
fn bodies_of_any_shape_are_clear_when_the_nearest_pair_is() {
    let mut rng = rng::stream(21, 0);
    for count in [0, 12, 40] {
        let robot = with_solid_bodies(&mut rng);
        let obstacles: Vec<Shape> = (0..count).map(|k| distant_obstacle(&mut rng, k)).collect();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let (qs, margin) = (robot.random_configurations(101, &mut rng).unwrap(), rng.uniform_in(0.0, 0.03));
        let many = scene.which_are_clear(&qs, margin).unwrap();
        let capsules = robot.with_capsules(robot.capsules().to_vec()).unwrap();
        let capsules = capsules
            .with_collision_pairs(robot.collision_pairs().into_iter().map(|pair| pair.map(str::to_owned)).collect());
        let capsules = capsules.unwrap();
        let by_capsules = Scene::new(&capsules, &obstacles).unwrap();
        let (mut seen, mut closer) = ([0; 2], 0);
        for (q, clear) in qs.chunks(7).zip(many) {
            let distance = scene.clearance(q).unwrap();
            assert!((distance - margin).abs() < 1e-6 || clear == (distance >= margin), "{distance} {margin}");
            assert_eq!(scene.is_clear(q, margin), clear);
            seen[usize::from(clear)] += 1;
            let around = by_capsules.clearance(q).unwrap();
            assert!(around <= distance + 1e-6 || distance < 0.0, "{around} {distance}");
            closer += usize::from(around < distance - 1e-3);
        }
        assert!(seen[1] > 3 && (count == 0 || seen[0] > 3) && closer > 3, "{seen:?} {closer}");
    }
}

#[test]
fn motions_of_bodies_of_any_shape_are_certified() {
    let mut rng = rng::stream(22, 0);
    for _ in 0..12 {
        let robot = with_solid_bodies(&mut rng);
        let obstacles: Vec<Shape> = (0..6).map(|k| distant_obstacle(&mut rng, k)).collect();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let from = robot.random_configurations(1, &mut rng).unwrap();
        let to: Vec<f64> = from.iter().map(|x| x + rng.uniform_in(-0.4, 0.4)).collect();
        let edge = Edge { from: &from, to: &to };
        let found = ClearanceSweep::new(&scene).smallest(&edge, [0.0, 1.0]).unwrap();
        let at = |i: usize| {
            let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + i as f64 / 400.0 * (b - a)).collect();
            scene.clearance(&q).unwrap()
        };
        let sampled = (0..=400).map(at).fold(f64::INFINITY, f64::min);
        let slack = 1e-4_f64.max(0.011 * sampled.abs());
        let distance = found.contact.distance;
        assert!(distance <= sampled + 1e-9 && distance >= sampled - slack - 2e-3, "{distance}, sampled {sampled}");
    }
}

#[test]
fn the_gradient_of_bodies_of_any_shape_is_the_slope() {
    let mut rng = rng::stream(23, 0);
    let (mut with_links, mut with_obstacles) = (0, 0);
    for case in 0..80 {
        let robot = with_solid_bodies(&mut rng);
        let obstacles: Vec<Shape> = (0..case % 2 * 4).map(|k| distant_obstacle(&mut rng, k + case)).collect();
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let scene = if obstacles.is_empty() { scene } else { scene.without_self_collision() };
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let found = scene.nearest_contact(&q).unwrap().unwrap();
        if found.contact.distance < 1e-3 {
            continue; // of overlapping faces several may be equally deep
        }
        for (j, slope) in slopes(&scene, &q, 1e-5, 1e-3) {
            assert!((slope - found.gradient[j]).abs() < 1e-2, "case {case}, joint {j}: {slope} {found:?}");
            *(if matches!(found.contact.other, Neighbor::Link(_)) { &mut with_links } else { &mut with_obstacles }) +=
                1;
        }
    }
    assert!(with_links > 20 && with_obstacles > 50, "{with_links} {with_obstacles}");
}

#[test]
fn bodies_that_no_joint_moves_count_against_obstacles() {
    let arm = Robot::named("panda").unwrap();
    let base = arm.link_names().next().unwrap().to_owned();
    let foot = LinkCapsule { link: base.clone(), a: [0.0; 3], b: [0.0, 0.0, 0.1], radius: 0.05 };
    let hand = LinkCapsule { link: "flange".into(), a: [0.0; 3], b: [0.0; 3], radius: 0.02 };
    let robot = arm.with_capsules(vec![foot, hand]).unwrap();
    let box_on_foot = Shape::cuboid([0.0, 0.3, 0.05], [0.02, 0.02, 0.02], None).unwrap();
    let carrying = robot.with_attached(&base, &box_on_foot, &[], None).unwrap();
    let q = [0.0, 0.0, 0.0, -1.5, 0.0, 1.5, 0.0];
    let other: Vec<f64> = q.iter().map(|x| x + 0.2).collect();
    for (robot, link, expected) in [(&robot, base.as_str(), 0.25), (&carrying, "attached", 0.34)] {
        let obstacles =
            [Shape::sphere([-0.4, 0.0, 0.05], 0.1).unwrap(), Shape::sphere([0.0, 0.7, 0.05], 0.05).unwrap()];
        let obstacles = if link == "attached" { &obstacles[1..] } else { &obstacles[..1] };
        let scene = Scene::new(robot, obstacles).unwrap();
        let found = scene.nearest_contact(&q).unwrap().unwrap();
        assert!((found.contact.distance - expected).abs() < 1e-6, "{found:?}");
        assert_eq!((found.contact.link.as_str(), found.gradient), (link, vec![0.0; 7]));
        let distance = found.contact.distance;
        let edge = Edge { from: &q, to: &other };
        for (margin, clear) in [(distance - 1e-3, true), (distance + 1e-3, false)] {
            assert_eq!(scene.is_clear(&q, margin), clear);
            assert_eq!(scene.which_are_clear(&[q, q].concat(), margin).unwrap(), [clear; 2]);
            assert_eq!(ClearanceSweep::new(&scene).check(&edge, [0.0, 1.0], margin).is_ok(), clear);
        }
        let smallest = ClearanceSweep::new(&scene).smallest(&edge, [0.0, 1.0]).unwrap();
        assert_eq!(smallest.contact, found.contact);
    }
}

#[test]
fn of_many_obstacles_the_nearest_is_found_and_each_counts() {
    let mut rng = rng::stream(30, 0);
    let mut nearest_to_base = 0;
    for case in 0..40 {
        let robot = with_random_bodies("panda", &mut rng);
        let q = robot.random_configurations(1, &mut rng).unwrap();
        // Far fewer are near than there are; in some cases none is.
        let (count, spread) = (24 + 10 * case, if case % 4 == 0 { 6.0 } else { 2.0 });
        let balls: Vec<Shape> =
            (0..count).map(|_| Shape::sphere(point(&mut rng, spread), rng.uniform_in(0.01, 0.1)).unwrap()).collect();
        let scene = Scene::new(&robot, &balls).unwrap().without_self_collision();
        let alone = |ball: &Shape| Scene::new(&robot, std::slice::from_ref(ball)).unwrap().without_self_collision();
        let found = scene.nearest(&q).unwrap().unwrap();
        let one_by_one: Vec<f64> = balls.iter().map(|ball| alone(ball).clearance(&q).unwrap()).collect();
        let least = one_by_one.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((found.distance - least).abs() < 1e-9, "case {case}: {found:?}, one by one {least}");
        for margin in [0.0, 0.02, 0.5] {
            let tied = (least - margin).abs() < 1e-6;
            assert!(tied || scene.is_clear(&q, margin) == (least >= margin), "case {case}, margin {margin}: {least}");
        }
        nearest_to_base += usize::from(found.link == "base");
    }
    assert!(nearest_to_base > 0);
}
