//! Solutions clear of obstacles and of the robot itself.

use ikcore::batch::{BatchOptions, Targets, solve_batch};
use ikcore::ik::{AllOptions, Prefer, Solution, SolveOptions, solve, solve_all};
use ikcore::math::{Frame, Pose};
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Algorithm, AnySolver, Bas, DifferentialEvolution, Pso, PsoForm, Status, Stop, Unattended};
use ikcore::task::{Goal, Target, Tolerance};

const MARGIN: f64 = 0.01;

fn arm(name: &str) -> Robot {
    Robot::named(name).unwrap().with_capsules_along_links(0.06).unwrap()
}

/// Boxes in front of an arm, and the pose of a random configuration.
fn cluttered(robot: &Robot, rng: &mut LazyRng) -> (Vec<Shape>, Target) {
    let boxes = (0..9).map(|_| {
        let (angle, radius) = (rng.uniform_in(-3.0, 3.0), rng.uniform_in(0.3, 0.7));
        let center = [radius * angle.cos(), radius * angle.sin(), rng.uniform_in(0.1, 0.9)];
        Shape::cuboid(center, std::array::from_fn(|_| rng.uniform_in(0.05, 0.2)), None).unwrap()
    });
    let boxes = boxes.collect();
    let q = robot.random_configurations(1, rng).unwrap();
    (boxes, Target::Pose(Frame::from(&robot.fk(&q).unwrap())))
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Pose as a matrix, row by row.
fn rows(pose: &Pose) -> [f64; 16] {
    let matrix = pose.to_homogeneous();
    std::array::from_fn(|i| matrix[(i / 4, i % 4)])
}

fn among(obstacles: &[Shape]) -> SolveOptions {
    let surroundings = Surroundings { obstacles: Some(obstacles.into()), margin: Some(MARGIN), self_collision: None };
    SolveOptions { surroundings, ..SolveOptions::default() }
}

fn solved(robot: &Robot, target: &Target, options: &SolveOptions) -> Solution {
    solve(robot, target, options, &mut Unattended).unwrap()
}

#[test]
fn solutions_are_clear_and_blocked_poses_have_none() {
    for name in ["ur5e", "panda", "ur10"] {
        let robot = arm(name);
        let mut rng = rng::stream(7, 0);
        let (mut clear, mut blocked) = (0, 0);
        for _ in 0..60 {
            let (obstacles, target) = cluttered(&robot, &mut rng);
            let scene = Scene::new(&robot, &obstacles).unwrap();
            let options = among(&obstacles);
            let found = solved(&robot, &target, &options);
            let distance = scene.clearance(&found.q).unwrap();
            assert_eq!(found.clearance(), distance);
            assert!(found.error.position < 1e-6 && found.error.rotation < 1e-6);
            match found.status {
                Status::Solved => {
                    assert!(distance >= MARGIN, "{name}: {distance}");
                    clear += 1;
                }
                Status::InCollision => {
                    assert!(distance < MARGIN, "{name}: {distance}");
                    let all = AllOptions { redundancy: 50, ..AllOptions::default() };
                    let others = solve_all(&robot, &target, &all, &mut Unattended).unwrap();
                    for other in others.solutions.iter() {
                        assert!(!scene.is_clear(other.q, MARGIN), "{name}: {:?} is clear", other.q);
                        let deeper = scene.clearance(other.q).unwrap();
                        assert!(robot.dof() > 6 || deeper <= distance + 1e-9, "{name}: {deeper} is better");
                    }
                    blocked += 1;
                }
                status => panic!("{name}: {status:?}: {}", found.message()),
            }
        }
        assert!(clear >= 10 && blocked >= 4, "{name}: {clear} clear, {blocked} blocked");
    }
}

#[test]
fn no_obstacle_is_too_large_to_be_kept_clear_of() {
    let mut rng = rng::stream(8, 0);
    let panda = arm("panda");
    let hand = panda.with_capsules(panda.capsules()[panda.capsules().len() - 1..].to_vec()).unwrap();
    for robot in [arm("ur5e"), panda, hand] {
        let mut draw = || robot.random_configurations(1, &mut rng).unwrap();
        let q = std::iter::repeat_with(&mut draw).find(|q| robot.tip_position(q)[0] > 0.5).unwrap();
        let target = Target::Pose(Frame::from(&robot.fk(&q).unwrap()));
        for size in [1e3, 1e9, 1e18, 5e19, 1e30, 1e100] {
            // The tip is inside; the base is not, but for rounding.
            let center = [0.5 * size + robot.tip_position(&q)[0] - 0.1, 0.0, 0.0];
            let shapes = [
                Shape::sphere(center, 0.5 * size),
                Shape::cuboid(center, [size; 3], None),
                Shape::cylinder(center, [0.0, 0.0, 1.0], 0.5 * size, size),
            ];
            for shape in shapes {
                let obstacles = [shape.unwrap()];
                let scene = Scene::new(&robot, &obstacles).unwrap();
                assert!(!scene.is_clear(&q, 0.0) && scene.clearance(&q).unwrap() < 0.0, "{obstacles:?}");
                assert_eq!(scene.which_are_clear(&[&q[..], &q].concat(), 0.0).unwrap(), [false; 2], "{obstacles:?}");
                let found = solved(&robot, &target, &among(&obstacles));
                assert_eq!(found.status, Status::InCollision, "{obstacles:?}: {}", found.message());
            }
        }
    }
}

#[test]
fn positions_and_weak_starts_are_solved_clear() {
    let robot = arm("panda");
    let mut rng = rng::stream(8, 0);
    let mut clear = 0;
    for _ in 0..40 {
        let (obstacles, target) = cluttered(&robot, &mut rng);
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let Target::Pose(pose) = target else { unreachable!() };
        let position = Target::Position(pose.origin);
        let start = robot.random_configurations(1, &mut rng).unwrap();
        let options = SolveOptions { start: Some(start.to_vec()), ..among(&obstacles) };
        for target in [target, position] {
            let found = solved(&robot, &target, &options);
            if found.status == Status::Solved {
                assert!(scene.clearance(&found.q).unwrap() >= MARGIN);
                clear += 1;
            } else {
                assert_eq!(found.status, Status::InCollision, "{}", found.message());
            }
        }
    }
    assert!(clear > 40, "{clear} of 80");
}

#[test]
fn all_solutions_are_clear_and_none_is_left_out() {
    let robot = arm("ur5e");
    let mut rng = rng::stream(9, 0);
    let mut left_out = 0;
    for _ in 0..40 {
        let (obstacles, target) = cluttered(&robot, &mut rng);
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let every = solve_all(&robot, &target, &AllOptions::default(), &mut Unattended).unwrap();
        let options = AllOptions { each: among(&obstacles), ..AllOptions::default() };
        let found = solve_all(&robot, &target, &options, &mut Unattended).unwrap();
        let clear: Vec<&[f64]> =
            every.solutions.iter().map(|one| one.q).filter(|q| scene.is_clear(q, MARGIN)).collect();
        assert_eq!(found.solutions.iter().map(|one| one.q).collect::<Vec<_>>(), clear);
        assert_eq!(found.complete, every.complete);
        assert_eq!(found.status(), if clear.is_empty() { Status::InCollision } else { Status::Solved });
        for i in 0..clear.len() {
            assert!(found.solution(i).unwrap().clearance() >= MARGIN);
        }
        left_out += every.solutions.len() - clear.len();
    }
    assert!(left_out > 50, "{left_out}");
}

#[test]
fn the_nearest_clear_solution_of_six_joints_is_exact() {
    let robot = arm("ur5e");
    let mut rng = rng::stream(10, 0);
    let mut passed_over = 0;
    for _ in 0..60 {
        let (obstacles, target) = cluttered(&robot, &mut rng);
        let start = robot.random_configurations(1, &mut rng).unwrap();
        let each = SolveOptions { start: Some(start.clone()), ..among(&obstacles) };
        let all = AllOptions { each: each.clone(), turns: true, ..AllOptions::default() };
        let all = solve_all(&robot, &target, &all, &mut Unattended).unwrap();
        let found = solved(&robot, &target, &SolveOptions { prefer: Prefer::Nearest, ..each.clone() });
        let Some(nearest) = all.solutions.iter().next() else {
            assert_eq!(found.status, Status::InCollision);
            continue;
        };
        assert!((distance(&found.q, &start) - distance(nearest.q, &start)).abs() < 1e-6);
        let free = SolveOptions { surroundings: Surroundings::default(), prefer: Prefer::Nearest, ..each };
        passed_over += usize::from(distance(&solved(&robot, &target, &free).q, &found.q) > 0.1);
    }
    assert!(passed_over > 10, "{passed_over}");
}

#[test]
fn the_same_seed_gives_the_same_bits_on_any_number_of_threads() {
    let robot = arm("panda");
    let mut rng = rng::stream(11, 0);
    let (obstacles, _) = cluttered(&robot, &mut rng);
    let poses: Vec<f64> =
        (0..40).flat_map(|_| rows(&robot.fk(&robot.random_configurations(1, &mut rng).unwrap()).unwrap())).collect();
    let batch = |threads| {
        let options = BatchOptions { each: among(&obstacles), threads: Some(threads), ..BatchOptions::default() };
        let mut batch = solve_batch(&robot, Targets::Poses(poses.as_chunks().0), &options, &mut Unattended).unwrap();
        batch.elapsed = Default::default();
        batch.items.iter_mut().for_each(|item| item.elapsed = Default::default());
        batch
    };
    let one = batch(1);
    assert_eq!(one, batch(3));
    assert!(one.items.iter().any(|item| item.status == Status::Solved && item.clearance() >= MARGIN));
}

#[test]
fn a_goal_of_clearance_moves_away_inside_the_clear_space() {
    let robot = arm("panda");
    let mut rng = rng::stream(12, 0);
    let (mut gained, mut compared) = (0, 0);
    for _ in 0..40 {
        let (obstacles, target) = cluttered(&robot, &mut rng);
        let plain = solved(&robot, &target, &among(&obstacles));
        let goals = vec![Goal::Clearance { up_to: 0.3, weight: 1.0 }];
        let away = solved(&robot, &target, &SolveOptions { goals, ..among(&obstacles) });
        assert_eq!(plain.status == Status::Solved, away.status == Status::Solved);
        if plain.status == Status::Solved {
            assert!(away.clearance() >= MARGIN);
            let surroundings = among(&obstacles).surroundings;
            let space = surroundings.clear_space(&robot).unwrap().unwrap();
            let [before, after] = [&plain, &away].map(|one| space.nearness(&one.q, 0.3, 1.0, &mut [0.0; 7]));
            assert!(after <= before + 1e-9, "{before} {after}");
            gained += usize::from(after < 0.9 * before);
            compared += 1;
        }
    }
    assert!(compared > 15 && 2 * gained > compared, "{gained} of {compared}");
}

#[test]
fn the_derivative_of_nearness_is_its_difference() {
    let robot = arm("panda");
    let mut rng = rng::stream(13, 0);
    let (obstacles, _) = cluttered(&robot, &mut rng);
    let surroundings = among(&obstacles).surroundings;
    let space = surroundings.clear_space(&robot).unwrap().unwrap();
    let mut compared = 0;
    for _ in 0..300 {
        let q = robot.random_configurations(1, &mut rng).unwrap();
        let (short, near) = (space.squared_shortfall(&q), space.nearness(&q, MARGIN, 1.0, &mut [0.0; 7]));
        assert!(
            (short - MARGIN * MARGIN * near).abs() < 1e-9 * short && (short == 0.0) == space.holds(&q) || short < 1e-12
        );
        if space.clearance(&q).distance < 0.01 {
            continue;
        }
        compared += 1;
        let mut slope = vec![0.0; 7];
        space.nearness(&q, 0.2, 2.0, &mut slope);
        for j in 0..7 {
            let at = |step: f64| {
                let mut there = q.clone();
                there[j] += step;
                2.0 * space.nearness(&there, 0.2, 1.0, &mut [0.0; 7])
            };
            let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
            assert!((slope[j] - difference).abs() < 1e-2 * (1.0 + difference.abs()), "{} {difference}", slope[j]);
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn a_hand_in_the_way_is_said_before_any_search() {
    let robot = arm("ur5e");
    let q = [0.3, -1.2, 1.4, -0.9, -1.5, 0.2];
    let target = Target::Pose(Frame::from(&robot.fk(&q).unwrap()));
    let Target::Pose(pose) = target else { unreachable!() };
    let wall = [Shape::sphere(pose.origin, 0.05).unwrap()];
    let found = solved(&robot, &target, &among(&wall));
    assert_eq!(found.status, Status::InCollision);
    let link = &found.message()[found.message().find("link '").unwrap()..];
    let expected =
        "link 'link_6' is 0.1100 m inside obstacle 0 (Sphere) whatever the arm does: the hand itself is in the way: ";
    assert!(link.starts_with(expected), "{link}");
    // An obstacle that engulfs the arm.
    let all = [Shape::sphere([0.0; 3], 5.0).unwrap()];
    assert_eq!(solved(&robot, &target, &among(&all)).status, Status::InCollision);
}

#[test]
fn nothing_is_checked_unless_asked_for() {
    let robot = arm("panda");
    let mut rng = rng::stream(14, 0);
    let (_, target) = cluttered(&robot, &mut rng);
    let plain = solved(&robot, &target, &SolveOptions::default());
    assert!(plain.clearance().is_nan() && plain.nearest.is_none());
    let off = Surroundings { self_collision: Some(false), ..Surroundings::default() };
    let unchecked = solved(&robot, &target, &SolveOptions { surroundings: off, ..SolveOptions::default() });
    assert_eq!(plain.q, unchecked.q);
    let itself = Surroundings { self_collision: Some(true), ..Surroundings::default() };
    let checked = solved(&robot, &target, &SolveOptions { surroundings: itself, ..SolveOptions::default() });
    assert!(checked.clearance() >= 1e-3, "{}", checked.message());
}

#[test]
fn nearest_bodies_left_for_later_are_those_found_at_once() {
    let robot = arm("panda");
    let mut rng = rng::stream(16, 0);
    for _ in 0..20 {
        let (scene, target) = cluttered(&robot, &mut rng);
        let options = among(&scene);
        let at_once = solved(&robot, &target, &options);
        let mut later = solved(&robot, &target, &SolveOptions { nearest_later: true, ..options.clone() });
        assert!(later.status != Status::Solved || later.nearest.is_none());
        later.find_nearest(&robot, &options.surroundings).unwrap();
        assert_eq!((&later.q, &later.nearest), (&at_once.q, &at_once.nearest));
    }
}

#[test]
fn a_margin_larger_than_the_free_space_ends_within_its_budget() {
    for name in ["panda", "ur5e", "gen3"] {
        let robot = arm(name);
        let (_, target) = cluttered(&robot, &mut rng::stream(15, 0));
        let obstacles = vec![Shape::sphere([1.5, 0.0, 0.5], 0.05).unwrap()];
        let surroundings = Surroundings { obstacles: Some(obstacles.into()), margin: Some(3.0), self_collision: None };
        let stop = Stop { max_evaluations: 5_000, ..Stop::default() };
        let found = solved(&robot, &target, &SolveOptions { surroundings, stop, ..SolveOptions::default() });
        assert_eq!(found.status, Status::InCollision, "{}", found.message());
        assert!(found.message().contains("(of a margin of 3.000 m) from"), "{}", found.message());
        assert!(found.evaluations < 6_000, "{}", found.evaluations);
    }
}

#[test]
fn wrong_surroundings_are_refused() {
    let robot = arm("panda");
    let target = Target::Position([0.4, 0.0, 0.4]);
    let error = |robot: &Robot, surroundings: Surroundings| {
        let options = SolveOptions { surroundings, ..SolveOptions::default() };
        solve(robot, &target, &options, &mut Unattended).unwrap_err().to_string()
    };
    let given = |margin| Surroundings { obstacles: Some(vec![].into()), margin, self_collision: None };
    assert_eq!(error(&robot, given(Some(-0.1))), "margin must be zero or more and finite, got -0.1");
    assert_eq!(
        error(&robot, Surroundings { margin: Some(0.1), ..Surroundings::default() }),
        "a margin needs obstacles (perhaps none) or self-collision"
    );
    let bare = Robot::named("panda").unwrap();
    assert!(error(&bare, given(None)).contains("or give it capsules"));
    let goals = vec![Goal::Clearance { up_to: 0.1, weight: 1.0 }];
    let options = SolveOptions { goals, ..SolveOptions::default() };
    assert_eq!(
        solve(&robot, &target, &options, &mut Unattended).unwrap_err().to_string(),
        "the goal Clearance is for calls with obstacles (perhaps none) or self-collision"
    );
}

#[test]
fn an_open_mesh_is_said_to_have_no_inside() {
    let robot = arm("panda");
    let target = Target::Position([0.4, 0.1, 0.5]);
    let triangle = Shape::mesh(vec![[2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 1.0]], vec![[0, 1, 2]]).unwrap();
    let found = solved(&robot, &target, &among(&[Shape::sphere([2.0; 3], 0.1).unwrap(), triangle]));
    let end = " m clear of all surfaces; the mesh of obstacle 1 is open, so that its inside is unknown";
    assert!(found.message().ends_with(end), "{}", found.message());
}

#[test]
fn solvers_that_need_values_alone_take_obstacles_as_a_penalty() {
    let robot = arm("iiwa14");
    let solvers =
        [Pso::of(PsoForm::Constriction).into(), DifferentialEvolution::default().into(), Bas::default().into()];
    for (seed, solver) in (16..).zip(solvers.map(AnySolver::<Algorithm>::Single)) {
        let mut rng = rng::stream(seed, 0);
        let (mut avoided, mut solved_clear) = (0, 0);
        for _ in 0..30 {
            let (obstacles, target) = cluttered(&robot, &mut rng);
            let Target::Pose(pose) = target else { unreachable!() };
            let (target, scene) = (Target::Position(pose.origin), Scene::new(&robot, &obstacles).unwrap());
            let tolerance = Tolerance { position: 1e-2, rotation: 1.0 };
            let stop = Stop { max_evaluations: 20_000, ..Stop::default() };
            let free = SolveOptions { solver: Some(solver.clone()), tolerance, stop, ..SolveOptions::default() };
            let among = SolveOptions { surroundings: among(&obstacles).surroundings, ..free.clone() };
            let found = solved(&robot, &target, &among);
            let is_clear = scene.is_clear(&found.q, MARGIN);
            assert!(found.evaluations <= 20_100, "{}", found.evaluations);
            assert_eq!(found.status == Status::Solved, is_clear && found.error.position <= 1e-2, "{}", found.message());
            solved_clear += usize::from(found.status == Status::Solved);
            avoided += usize::from(is_clear && !scene.is_clear(&solved(&robot, &target, &free).q, MARGIN));
        }
        assert!(solved_clear > 10 && avoided > 0, "{solver:?}: {solved_clear} {avoided}");
    }
}
