//! Closed-form solutions: none missing, each verified, with messages for singular and unreachable poses.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::common::arms::{arm, calibrated_ur10, geared, jaco2, puma560};
use crate::common::{bits, configurations, message, pose_at, robot};
use ikcore::ik::{AllOptions, SolutionSet, SolveOptions, nearest_miss, solve, solve_all};
use ikcore::limits::Limits;
use ikcore::math::pose;
use ikcore::robot::{Joint, Robot};
use ikcore::solver::{Status, Unattended};
use ikcore::task::{Target, Task, TaskKind, Tolerance};

const Q: f64 = FRAC_PI_2;

/// Panda with its last joint fixed: its first three axes intersect.
fn panda_without_7() -> Robot {
    let shoulder = [[0.0, -Q, 0.333], [0.0, Q, 0.0], [0.0825, Q, 0.316]];
    let rest = [[-0.0825, -Q, 0.0], [0.0, Q, 0.384], [0.088, Q, 0.0]];
    arm("Panda without joint 7", [shoulder[0], shoulder[1], shoulder[2], rest[0], rest[1], rest[2]])
}

#[track_caller]
fn all(robot: &Robot, target: &Target, options: &AllOptions) -> SolutionSet {
    let found = solve_all(robot, target, options, &mut Unattended).unwrap();
    let Target::Pose(wanted) = target else { return found };
    for solution in found.solutions.iter() {
        let tip = robot.tip(solution.q);
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let residual = off(&tip.origin, &wanted.origin).max(off(tip.axes.as_flattened(), wanted.axes.as_flattened()));
        assert!(residual < 2e-10, "{}: off by {residual:e} at {:?}", robot.name(), solution.q);
        for (q, joint) in solution.q.iter().zip(robot.joints()) {
            assert!(joint.lower <= *q && *q <= joint.upper, "{}: {:?}", robot.name(), solution.q);
        }
    }
    found
}

fn from(start: &[f64]) -> AllOptions {
    AllOptions {
        each: SolveOptions { start: Some(start.to_vec()), ..SolveOptions::default() },
        ..AllOptions::default()
    }
}

/// Largest difference of angles, whole turns aside.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let turn = |(a, b): (&f64, &f64)| ((a - b + PI).rem_euclid(TAU) - PI).abs();
    a.iter().zip(b).map(turn).fold(0.0, f64::max)
}

/// Whether the tolerances admit configurations some milliradians from a solution.
fn is_nearly_singular(robot: &Robot, found: &SolutionSet) -> bool {
    let least = |q: &[f64]| robot.jacobian(q).unwrap().singular_values().min();
    found.solutions.iter().any(|solution| least(solution.q) < 5e-3)
}

#[track_caller]
fn assert_among(found: &SolutionSet, q: &[f64]) {
    let near = found.solutions.iter().any(|solution| apart(solution.q, q) < 1e-5);
    assert!(near, "{q:?} is missing: {}", found.message());
}

#[test]
fn the_structure_is_told() {
    let told = [
        ("ur5e", "axes 2 to 4 parallel; at most 8 solutions"),
        ("ur10", "axes 2 to 4 parallel; at most 8 solutions"),
        ("kr210", "spherical wrist; at most 8 solutions"),
        ("iiwa14", "spherical shoulder and wrist; at most 8 solutions for each arm angle"),
        ("panda", "spherical shoulder; at most 8 solutions for each value of joint 'panda_joint7'"),
    ];
    for (name, structure) in told {
        assert_eq!(robot(name).closed_form(), structure, "{name}");
    }
    assert_eq!(panda_without_7().closed_form(), "spherical shoulder; at most 8 solutions");
    assert_eq!(jaco2().closed_form(), "general; at most 16 solutions");
    let flat = arm("flat", [[0.2, 0.0, 0.0]; 6]);
    assert_eq!(flat.closed_form(), "none: the tip moves in 3 of 6 directions");
}

#[test]
fn the_arms_own_configuration_is_always_among_them() {
    for (name, poses) in [("ur5e", 2000), ("ur10", 2000), ("kr210", 2000)] {
        let robot = robot(name);
        for q in configurations(&robot, poses) {
            let found = all(&robot, &pose_at(&robot, &q), &from(&q));
            assert_among(&found, &q);
            assert!(found.complete || is_nearly_singular(&robot, &found), "{name} {q:?}");
        }
    }
    for robot in [puma560(), panda_without_7(), jaco2()] {
        for q in configurations(&robot, if robot.name() == "JACO 2" { 50 } else { 500 }) {
            assert_among(&all(&robot, &pose_at(&robot, &q), &AllOptions::default()), &q);
        }
    }
}

#[test]
fn every_solution_that_a_search_finds_is_in_the_set() {
    // Weights of one change nothing but the method.
    let task = Task::new(TaskKind::Pose, Some(&[1.0; 6]), None, None).unwrap();
    for name in ["ur5e", "ur10", "kr210"] {
        let robot = robot(name);
        for q in configurations(&robot, 60) {
            let target = pose_at(&robot, &q);
            let mut options = from(&q);
            let found = all(&robot, &target, &options);
            options.each.task = Some(task);
            let searched = solve_all(&robot, &target, &options, &mut Unattended).unwrap();
            assert!(!searched.complete && (found.complete || is_nearly_singular(&robot, &found)));
            assert!(found.solutions.len() >= searched.solutions.len());
            for solution in searched.solutions.iter() {
                // A search stops within 1e-6 of the pose: beside a singularity that is more in the joints.
                let near = found.solutions.iter().any(|other| apart(other.q, solution.q) < 0.02);
                assert!(near, "{name}: {:?} is missing", solution.q);
            }
        }
    }
}

#[test]
fn limits_cut_branches_and_what_is_left_is_complete() {
    let robot = robot("ur10");
    let q = [0.4, -1.2, 1.1, -1.3, 0.9, 0.2];
    let target = pose_at(&robot, &q);
    let free = all(&robot, &target, &from(&q));
    assert_eq!(free.message(), "8 distinct solutions, no others inside the limits");
    let narrow = robot.with_limits(|j, joint| (joint.lower, joint.upper) = (q[j] - 0.3, q[j] + 0.3)).unwrap();
    let found = all(&narrow, &target, &from(&q));
    assert_eq!((found.solutions.len(), found.complete), (1, true));
    assert_eq!(found.message(), "1 solution, no others inside the limits");
    // At the very limits.
    let touching = robot.with_limits(|j, joint| (joint.lower, joint.upper) = (q[j], q[j] + 0.3)).unwrap();
    assert_eq!(all(&touching, &target, &from(&q)).solutions.len(), 1);
    // Around another place: no branch is left, and that is proven.
    let away = robot.with_limits(|_, joint| (joint.lower, joint.upper) = (2.0, 2.4)).unwrap();
    let none = all(&away, &target, &AllOptions::default());
    assert_eq!((none.status(), none.complete, none.solutions.len()), (Status::OutOfReach, true, 0));
    let says = none.message();
    assert!(says.starts_with("no solution (all 8 solutions are outside the limits): move or turn"), "{says}");
    let miss = nearest_miss(&away, &target, &AllOptions::default(), &mut Unattended).unwrap();
    assert_eq!(miss.status, Status::OutOfReach);
    assert!(miss.q.iter().all(|q| (2.0..=2.4).contains(q)), "{:?}", miss.q);
}

#[test]
fn the_limits_of_the_call_count() {
    let robot = robot("ur5e");
    let q = [0.4, -1.2, 1.1, -1.3, 0.9, 0.2];
    let mut options = from(&q);
    let narrow = robot.with_limits(|j, joint| (joint.lower, joint.upper) = (q[j] - 0.3, q[j] + 0.3)).unwrap();
    options.each.limits = Some(Limits::of(&narrow));
    assert_eq!(all(&robot, &pose_at(&robot, &q), &options).solutions.len(), 1);
}

#[test]
fn limit_and_separation_leave_solutions_out_and_the_set_says_so() {
    let robot = robot("ur10");
    let q = [0.4, -1.2, 1.1, -1.3, 0.9, 0.2];
    let target = pose_at(&robot, &q);
    let three = all(&robot, &target, &AllOptions { limit: Some(3), ..from(&q) });
    assert_eq!((three.message().as_str(), three.complete), ("3 distinct solutions", false));
    assert_among(&three, &q);
    let coarse = all(&robot, &target, &AllOptions { separation: Some(3.0), ..from(&q) });
    assert!(coarse.solutions.len() < 8 && !coarse.complete);
}

#[test]
fn whole_turns_inside_the_limits_on_request() {
    let robot = robot("ur10");
    let q = [0.4, -1.2, 1.1, -1.3, 0.9, 0.2];
    let target = pose_at(&robot, &q);
    let once = all(&robot, &target, &from(&q));
    let turned = all(&robot, &target, &AllOptions { turns: true, ..from(&q) });
    let places = |solution: &[f64]| -> usize {
        let inside = |(q, joint): (&f64, &Joint)| {
            (-2..=2).filter(|turn| (joint.lower..=joint.upper).contains(&(q + TAU * f64::from(*turn)))).count()
        };
        solution.iter().zip(robot.joints()).map(inside).product()
    };
    let expected: usize = once.solutions.iter().map(|solution| places(solution.q)).sum();
    assert!(turned.complete && turned.solutions.len() == expected && expected > 100, "{expected}");
    for (i, a) in turned.solutions.iter().enumerate() {
        assert!(turned.solutions.iter().take(i).all(|b| bits(a.q) != bits(b.q)), "twice: {:?}", a.q);
    }
    let wide = robot.with_limits(|_, joint| (joint.lower, joint.upper) = (-60.0, 60.0)).unwrap();
    let says = message(solve_all(&wide, &target, &AllOptions { turns: true, ..from(&q) }, &mut Unattended));
    assert!(
        says.contains("taking all whole turns makes ")
            && says.ends_with("at most 10000 are allowed: narrow the limits"),
        "{says}"
    );
}

#[test]
fn a_family_of_solutions_is_reported_with_one_of_them() {
    let cases = [("kr210", [0.3, -0.5, 0.4, 0.2, 0.0, 0.5]), ("ur10", [0.3, -0.9, 1.0, 0.2, 0.0, 0.5])];
    for (name, q) in cases {
        let robot = robot(name);
        for beside in [0.0, 1e-12, 1e-9] {
            let mut q = q;
            q[4] = beside;
            let found = all(&robot, &pose_at(&robot, &q), &from(&q));
            assert!(!found.solutions.is_empty() && found.miss.is_none(), "{name} {beside}");
            assert!(found.singular || beside > 0.0, "{name}");
            if found.singular {
                let says = found.message();
                assert!(says.ends_with("; the pose is singular: a family counts as one solution"), "{says}");
            }
        }
    }
    // Limits that exclude the representative, but not the whole family.
    let kr210 = robot("kr210");
    let q = [0.3, -0.5, 0.4, 0.9, 0.0, 0.5];
    let narrow = kr210.with_limits(|j, joint| (joint.lower, joint.upper) = (q[j] - 0.1, q[j] + 0.1)).unwrap();
    let found = solve_all(&narrow, &pose_at(&narrow, &q), &from(&q), &mut Unattended).unwrap();
    assert!(found.solutions.iter().all(|solution| solution.error.position < 3e-10 && solution.error.rotation < 3e-10));
    assert!(!found.solutions.is_empty() && found.singular && !found.complete, "{}", found.message());
}

#[test]
fn poses_out_of_reach_are_proven_so() {
    for name in ["ur5e", "ur10", "kr210"] {
        let robot = robot(name);
        // Inside the ball that the arm can reach, but with orientations that would have the wrist farther out.
        let far = robot.reach(&[-9.0; 6], &[9.0; 6]);
        let mut unreachable = 0;
        for rpy in [[0.0, 0.0, 0.0], [PI, 0.0, 0.0], [0.0, Q, 0.0], [0.0, -Q, 0.0], [0.0, 0.0, PI], [Q, 0.0, 0.0]] {
            let [x, y, z] = far.center;
            let target = Target::from(&pose::from_rpy(rpy, [x + 0.97 * far.radius, y, z]));
            let found = all(&robot, &target, &AllOptions::default());
            assert!(found.complete, "{name}: {}", found.message());
            if found.solutions.is_empty() {
                unreachable += 1;
                let says = found.message();
                assert_eq!(found.status(), Status::OutOfReach, "{says}");
                let expected = "no solution (no configuration has this pose): move or turn the target into reach, or move the base";
                assert_eq!(says, expected);
                assert!(found.evaluations <= 16, "{} evaluations", found.evaluations);
            }
        }
        assert!(unreachable > 0, "{name}");
    }
}

#[test]
fn the_edge_of_the_reach_is_reached() {
    // The elbow stretched, and beyond by less than the tolerance.
    let robot = robot("ur10");
    let q = [0.3, -0.9, 0.0, 0.2, 0.7, 0.5];
    let tip = robot.fk(&q).unwrap();
    for beyond in [-1e-6, -1e-9, 0.0, 1e-12] {
        let target = Target::from(&(pose::translation(0.0, 0.0, beyond) * tip));
        let found = solve_all(&robot, &target, &from(&q), &mut Unattended).unwrap();
        assert_eq!(found.status(), Status::Solved, "{beyond}: {}", found.message());
    }
}

#[test]
fn base_and_tool_far_away_change_nothing() {
    for name in ["ur10", "kr210"] {
        let plain = robot(name);
        let base = pose::translation(30.0, -50.0, 10.0) * pose::from_rpy([0.3, -0.7, 2.0], [0.0; 3]);
        let tool = pose::translation(0.5, 2.0, -1.0) * pose::from_rpy([1.0, 0.2, -0.4], [0.0; 3]);
        let moved = plain.with_base(base).unwrap().with_tool(tool).unwrap();
        assert_eq!(moved.closed_form(), plain.closed_form());
        for q in configurations(&moved, 200) {
            let found = all(&moved, &pose_at(&moved, &q), &from(&q));
            assert_among(&found, &q);
            assert_eq!(found.solutions.len(), all(&plain, &pose_at(&plain, &q), &from(&q)).solutions.len());
        }
        // The tool of a task.
        let task = Task::new(TaskKind::Pose, None, None, Some(tool)).unwrap();
        let q = [0.3, -0.9, 1.0, 0.2, 0.7, 0.5];
        let mut options = from(&q);
        options.each.task = Some(task);
        let target = Target::from(&(plain.fk(&q).unwrap() * tool));
        assert_among(&solve_all(&plain, &target, &options, &mut Unattended).unwrap(), &q);
    }
}

#[test]
fn joints_with_scale_and_offset() {
    for (scale, offset) in [(-1.0, 0.4), (2.0, 0.3), (0.5, -1.0), (-0.7, 2.0)] {
        let robot = geared(scale, offset, false);
        assert_eq!(robot.closed_form(), "axes 2 to 4 parallel; at most 8 solutions");
        for q in configurations(&robot, 100) {
            let found = all(&robot, &pose_at(&robot, &q), &from(&q));
            assert!(found.complete || is_nearly_singular(&robot, &found));
            let nearest = found.solutions.get(0).unwrap().q;
            assert!(q.iter().zip(nearest).all(|(a, b)| (a - b).abs() < 1e-5), "{scale}: {q:?} {nearest:?}");
        }
    }
    assert_eq!(geared(1.0, 0.0, true).closed_form(), "none: joint 'j1' drives 2 axes");
}

#[test]
fn calibrated_arms_are_only_nearly_decomposable() {
    for (off, nearly) in [(1e-6, true), (1e-12, false)] {
        let robot = calibrated_ur10(off);
        let says = if nearly {
            "axes 2 to 4 nearly parallel; at most 16 solutions"
        } else {
            "axes 2 to 4 parallel; at most 8 solutions"
        };
        assert_eq!(robot.closed_form(), says);
        let mut lost = 0;
        for q in configurations(&robot, 300) {
            let found = all(&robot, &pose_at(&robot, &q), &from(&q));
            assert!(found.complete || nearly || is_nearly_singular(&robot, &found));
            lost += usize::from(!found.solutions.iter().any(|solution| apart(solution.q, &q) < 1e-4));
        }
        assert_eq!(lost, 0);
    }
}

#[test]
fn tolerances_tighter_than_rounding_are_met_or_nothing_is_claimed() {
    let robot = robot("ur10");
    let q = [0.4, -1.2, 1.1, -1.3, 0.9, 0.2];
    let mut options = from(&q);
    options.each.tolerance = ikcore::task::Tolerance { position: 1e-18, rotation: 1e-18 };
    let found = solve_all(&robot, &pose_at(&robot, &q), &options, &mut Unattended).unwrap();
    assert!(!found.complete || found.solutions.iter().all(|solution| solution.error.position <= 1e-18));
}

/// Joints 2 to 4 parallel, then a wrist of two: a UR without its last joint. Its dimensions are off by multiples of `off`.
fn five_joints(off: f64) -> Robot {
    let rows = [[0.033, Q, 0.147], [0.155, 0.0, 0.0], [0.135, 0.0, 0.0], [0.0, Q, 0.0], [0.0, 0.0, 0.2175]];
    let odd = [[0.3, -0.7, 0.2], [-0.9, 0.4, 0.1], [0.5, -0.2, 0.8], [-0.4, 0.6, -0.3], [0.1, 0.2, -0.5]];
    arm("five", std::array::from_fn::<_, 5, _>(|k| std::array::from_fn(|i| rows[k][i] + off * odd[k][i])))
}

/// Requires each solution that descents from scattered starts find to be in a set that is called complete.
#[track_caller]
fn assert_nothing_is_missing(robot: &Robot, q: &[f64], tolerance: Tolerance) -> bool {
    let target = pose_at(robot, q);
    let mut options = AllOptions::default();
    options.each.tolerance = tolerance;
    let found = solve_all(robot, &target, &options, &mut Unattended).unwrap();
    for start in if found.complete { configurations(robot, 60) } else { vec![] } {
        // Weights of one change nothing but the method: each start is searched on its own.
        let task = Task::new(TaskKind::Pose, Some(&[1.0; 6]), None, None).unwrap();
        let each = SolveOptions { start: Some(start), task: Some(task), tolerance, ..SolveOptions::default() };
        let one = solve(robot, &target, &each, &mut Unattended).unwrap();
        let known = found.solutions.iter().any(|solution| apart(solution.q, &one.q) < 5e-3);
        assert!(known || one.status != Status::Solved, "{}: {:?} is missing: {}", robot.name(), one.q, found.message());
    }
    found.complete
}

#[test]
fn branches_that_miss_within_the_tolerances_are_not_lost() {
    let mut complete = 0;
    for off in [0.0, 1e-12, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 1e-5, 1e-3] {
        let robot = five_joints(off);
        for q in configurations(&robot, 12) {
            complete += usize::from(assert_nothing_is_missing(&robot, &q, Tolerance::default()));
        }
    }
    assert!(complete > 20, "{complete}");
    // The arm with its last joint turned by half a turn, and the others folded over.
    let robot = five_joints(1e-7);
    let found =
        solve_all(&robot, &pose_at(&robot, &[2.1, 2.0, 1.8, -1.5, 1.3]), &AllOptions::default(), &mut Unattended);
    assert_eq!(found.unwrap().solutions.len(), 4);
}

#[test]
fn nearly_singular_poses_and_wide_tolerances_claim_nothing() {
    let mut claims = 0;
    for name in ["ur5e", "ur10", "kr210"] {
        let robot = robot(name);
        for (k, mut q) in configurations(&robot, 60).into_iter().enumerate() {
            // Two angles that are each too large to be singular, but not their product.
            let small = [0.1, 0.03, 0.01, 3e-3, 1.5e-3][k % 5];
            (q[2], q[4]) = if name == "kr210" { (q[2], small) } else { (small, -small) };
            claims += usize::from(assert_nothing_is_missing(&robot, &q, Tolerance::default()));
        }
        let wide = Tolerance { position: 1e-3, rotation: 1e-3 };
        assert!(configurations(&robot, 20).iter().all(|q| !assert_nothing_is_missing(&robot, q, wide)));
    }
    assert!((20..150).contains(&claims), "{claims}");
}
