//! Clouds and grids without the robot's own points.

use ikcore::math::Pose;
use ikcore::obstacle::{Measured, Obstacle, Obstacles, Scene, Surroundings, WithoutRobot};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{BaseLimits, MobileBase, Robot};
use ikcore::shape::{Geometry, Shape};

/// Arms with capsules, with solids and what they carry, on a mobile base, and far from the origin.
fn robots() -> Vec<Robot> {
    let panda = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let carry =
        |robot: &Robot, shape: Shape, name: &str| robot.with_attached("flange", &shape, &[], Some(name)).unwrap();
    let part = Shape::cuboid([0.0, 0.0, 0.1], [0.05, 0.3, 0.05], None).unwrap();
    let can = Shape::cylinder([0.1, 0.0, 0.1], [1.0, 0.2, 0.0], 0.05, 0.2).unwrap();
    let egg = Shape::ellipsoid([0.0, 0.2, 0.1], [0.05, 0.1, 0.15], None).unwrap();
    let corners = [[0.0, -0.2, 0.1], [0.1, -0.2, 0.0], [0.0, -0.4, 0.1], [0.05, -0.3, 0.3], [-0.1, -0.2, 0.2]];
    let hull = Shape::convex_mesh(&corners).unwrap();
    let mut laden = panda.clone();
    for (shape, name) in [(part, "part"), (can, "can"), (egg, "egg"), (hull, "hull")] {
        laden = carry(&laden, shape, name);
    }
    let limits = BaseLimits {
        lower: vec![-2.0; 3],
        upper: vec![2.0; 3],
        velocity: vec![1.0; 3],
        acceleration: vec![f64::INFINITY; 3],
    };
    let rolling = panda.with_mobile_base(MobileBase::Planar, &limits).unwrap();
    let far = panda.with_base(Pose::translation(1e4, -1e4, 10.0)).unwrap();
    vec![panda, laden, rolling, far]
}

/// A number near the arm: round as often as not.
fn coordinate(rng: &mut LazyRng) -> f64 {
    let x = rng.uniform_in(-1.0, 1.0);
    if rng.uniform() < 0.5 { (10.0 * x).round() / 10.0 } else { x }
}

/// Points around the robot, in the frame of its base.
fn points(robot: &Robot, count: usize, rng: &mut LazyRng) -> Vec<[f64; 3]> {
    let origin = robot.base().translation.vector;
    (0..count).map(|_| std::array::from_fn(|k| origin[k] + coordinate(rng))).collect()
}

fn clearance(robot: &Robot, q: &[f64], shape: Shape) -> f64 {
    Scene::new(robot, vec![shape]).unwrap().without_self_collision().clearance(q).unwrap()
}

fn points_of(shape: &Shape) -> &[[f64; 3]] {
    match shape.geometry() {
        Geometry::PointCloud(cloud) => cloud.points(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn points_go_if_their_clearance_is_at_most_the_padding() {
    let mut rng = rng::stream(1, 0);
    let mut counts = [0; 2];
    for robot in robots() {
        for case in 0..12 {
            let q = robot.random_configurations(1, &mut rng).unwrap();
            let (radius, padding) = ([0.0, 0.01, 0.05][case % 3], [0.0, 0.02, 0.1][case / 3 % 3]);
            let all = points(&robot, 300, &mut rng);
            let cloud = Obstacle::from(Shape::point_cloud(all.clone(), radius).unwrap());
            let WithoutRobot { obstacle, removed } = cloud.without_robot(&robot, &q, padding).unwrap();
            let left = points_of(&obstacle.shape);
            let mut next = left.iter().peekable();
            for point in &all {
                let distance = clearance(&robot, &q, Shape::point_cloud(vec![*point], radius).unwrap());
                let stays = next.next_if(|left| *left == point).is_some();
                assert!(
                    stays == (distance > padding) || (distance - padding).abs() < 2e-7,
                    "{}: {point:?} is {distance} away, with a padding of {padding}",
                    robot.name()
                );
                counts[usize::from(stays)] += 1;
            }
            assert!(next.peek().is_none() && left.len() + removed == all.len());
        }
    }
    assert!(counts[0] > 500 && counts[1] > 5000, "{counts:?}");
}

#[test]
fn distances_from_what_is_left_are_those_of_a_new_cloud() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let mut rng = rng::stream(2, 0);
    for count in [1, 3, 4, 5, 16, 17, 200, 5000] {
        for _ in 0..8 {
            let cloud = Obstacle::from(Shape::point_cloud(points(&robot, count, &mut rng), 0.01).unwrap());
            let q = robot.random_configurations(1, &mut rng).unwrap();
            let left = cloud.without_robot(&robot, &q, 0.1).unwrap().obstacle;
            let anew = Shape::point_cloud(points_of(&left.shape).to_vec(), 0.01).unwrap();
            assert_eq!(left.shape, anew);
            assert_eq!(left.shape.bounding_ball(), anew.bounding_ball());
            for q in robot.random_configurations(20, &mut rng).unwrap().chunks(7) {
                assert_eq!(clearance(&robot, q, left.shape.clone()), clearance(&robot, q, anew.clone()));
            }
        }
    }
}

#[test]
fn voxels_go_if_their_clearance_is_at_most_the_padding() {
    let mut rng = rng::stream(3, 0);
    let mut counts = [0; 2];
    for robot in robots() {
        let origin: [f64; 3] = (robot.base().translation.vector.add_scalar(-0.8)).into();
        for voxel in [0.1, 0.2, 0.37] {
            let counts_along = [(1.6 / voxel) as usize; 3];
            let total: usize = counts_along.iter().product();
            let occupied: Vec<bool> = (0..total).map(|_| rng.uniform() < 0.3).collect();
            let grid = Obstacle::from(Shape::grid(origin, voxel, counts_along, occupied.clone()).unwrap());
            let q = robot.random_configurations(1, &mut rng).unwrap();
            let left = grid.without_robot(&robot, &q, 0.02).unwrap();
            let Geometry::Grid(found) = left.obstacle.shape.geometry() else { panic!() };
            let n = counts_along[0];
            for i in (0..total).filter(|i| occupied[*i]) {
                let place = [i / n / n, i / n % n, i % n];
                let center = std::array::from_fn(|k| origin[k] + voxel * (place[k] as f64 + 0.5));
                let distance = clearance(&robot, &q, Shape::cuboid(center, [voxel; 3], None).unwrap());
                let stays = found.occupied()[i];
                assert!(stays == (distance > 0.02) || (distance - 0.02).abs() < 2e-7, "{center:?}: {distance}");
                counts[usize::from(stays)] += 1;
            }
            let kept = found.occupied().iter().filter(|kept| **kept).count();
            assert_eq!(kept + left.removed, occupied.iter().filter(|is| **is).count());
        }
    }
    assert!(counts[0] > 100 && counts[1] > 1000, "{counts:?}");
}

#[test]
fn nothing_touches_a_cloud_or_a_grid_without_points() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let q = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8];
    let nothing = Shape::point_cloud(vec![], 0.1).unwrap();
    let free = Shape::grid([-0.5; 3], 0.5, [2; 3], vec![false; 8]).unwrap();
    let inside = robot.fk(&q).unwrap().translation.vector.into();
    let own = Obstacle::new(Shape::point_cloud(vec![inside], 0.01).unwrap(), vec!["base".into()]);
    for shape in [nothing, free] {
        assert!(shape.is_empty() && shape.triangles().is_empty());
        let scene = Scene::new(&robot, vec![shape.clone()]).unwrap().without_self_collision();
        assert_eq!((scene.clearance(&q).unwrap(), scene.nearest(&q).unwrap()), (f64::INFINITY, None));
        assert!(scene.is_clear(&q, 0.1));
        assert_eq!(scene.which_are_clear(&[&q[..], &q].concat(), 0.1).unwrap(), [true; 2]);
        let around: Obstacles = (0..40).map(|_| shape.clone()).collect();
        let space = Surroundings { obstacles: Some(around), ..Surroundings::default() }.clear_space(&robot).unwrap();
        assert!(space.unwrap().holds(&q));
        let again = Obstacle::from(shape).without_robot(&robot, &q, 0.1).unwrap();
        assert!(again.obstacle.shape.is_empty() && again.removed == 0);
    }
    let left = own.without_robot(&robot, &q, 0.0).unwrap();
    assert!(left.obstacle.shape.is_empty() && left.removed == 1 && left.obstacle.touch() == ["base"]);
}

#[test]
fn sensor_obstacles_are_known_by_their_contacts() {
    let robot = Robot::named("panda").unwrap().with_capsules_along_links(0.06).unwrap();
    let cube = vec![true];
    let shapes = [
        (Shape::point_cloud(vec![[0.0; 3]], 0.1), Some(Measured::PointCloud)),
        (Shape::grid([0.0; 3], 0.1, [1; 3], cube), Some(Measured::Grid)),
        (Shape::sphere([0.0; 3], 0.1), None),
    ];
    for (shape, kind) in shapes {
        let contact = Scene::new(&robot, vec![shape.unwrap()]).unwrap().nearest(&[0.0; 7]).unwrap().unwrap();
        assert_eq!(contact.measured(), kind);
    }
}
