//! Closed-form `solve`: the choice of a solution, its accuracy, and the result without one.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::common::arms::{arm, calibrated_ur10, geared, jaco2, puma560};
use crate::common::{bits, cases, configurations, pose_at, robot};
use ikcore::ik::{AllOptions, Solution, SolveOptions, solve, solve_all};
use ikcore::math::{Frame, pose};
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::{AnySolver, Status, Stop, Unattended};
use ikcore::task::{Target, Tolerance};

const SIX: [&str; 4] = ["ur5e", "ur10", "kr210", "ur3e"];
const SEVEN: [&str; 4] = ["panda", "iiwa14", "gen3", "iiwa7"];

fn solved(robot: &Robot, target: &Target, options: &SolveOptions) -> Solution {
    solve(robot, target, options, &mut Unattended).unwrap()
}

fn from(start: &[f64]) -> SolveOptions {
    SolveOptions { start: Some(start.to_vec()), ..SolveOptions::default() }
}

fn by_search() -> SolveOptions {
    SolveOptions { solver: Some(AnySolver::default()), ..SolveOptions::default() }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Checks that a solution is within the limits, and within `most` (m, and difference of matrix entries) of the pose.
#[track_caller]
fn assert_reaches(robot: &Robot, target: &Target, solution: &Solution, most: f64) {
    let Target::Pose(wanted) = target else { panic!("a pose") };
    assert_eq!(solution.status, Status::Solved, "{}: {}", robot.name(), solution.message());
    let tip = robot.tip(&solution.q);
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let missed = off(&tip.origin, &wanted.origin).max(off(tip.axes.as_flattened(), wanted.axes.as_flattened()));
    assert!(missed < most, "{}: off by {missed:e}", robot.name());
    for (q, joint) in solution.q.iter().zip(robot.joints()) {
        assert!(joint.lower <= *q && *q <= joint.upper, "{}: {:?}", robot.name(), solution.q);
    }
}

#[test]
fn the_nearest_branch_to_the_start_is_taken() {
    for robot in SIX.map(robot) {
        let qs = configurations(&robot, 60);
        for (q, start) in qs.iter().zip(qs.iter().rev()) {
            let target = pose_at(&robot, q);
            let solution = solved(&robot, &target, &from(start));
            assert_reaches(&robot, &target, &solution, 2e-10);
            let all = AllOptions { each: from(start), ..AllOptions::default() };
            let all = solve_all(&robot, &target, &all, &mut Unattended).unwrap();
            let nearest = all.solutions.iter().map(|one| distance(one.q, start)).fold(f64::INFINITY, f64::min);
            assert!((distance(&solution.q, start) - nearest).abs() < 1e-9, "{}", robot.name());
            assert_eq!(solution.iterations, 0);
        }
    }
}

#[test]
fn without_a_start_the_most_central_branch_is_taken() {
    for robot in SIX.map(robot) {
        let off_centre = |q: &[f64]| -> f64 {
            let fraction = |(q, joint): (&f64, &ikcore::robot::Joint)| {
                let (lower, upper) = joint.sampling_range();
                ((q - 0.5 * (lower + upper)) / (upper - lower)).powi(2)
            };
            q.iter().zip(robot.joints()).map(fraction).sum()
        };
        for q in configurations(&robot, 60) {
            let target = pose_at(&robot, &q);
            let solution = solved(&robot, &target, &SolveOptions::default());
            assert_reaches(&robot, &target, &solution, 2e-10);
            let all = solve_all(&robot, &target, &AllOptions::default(), &mut Unattended).unwrap();
            let least = all.solutions.iter().map(|one| off_centre(one.q)).fold(f64::INFINITY, f64::min);
            assert!(off_centre(&solution.q) < least + 1e-9, "{}", robot.name());
        }
    }
}

#[test]
fn a_named_solver_searches() {
    for robot in ["ur5e", "panda"].map(robot) {
        for q in configurations(&robot, 20) {
            let target = pose_at(&robot, &q);
            assert_eq!(solved(&robot, &target, &SolveOptions::default()).iterations, 0);
            let searched = solved(&robot, &target, &by_search());
            assert!(searched.iterations > 0 && searched.status == Status::Solved);
        }
    }
}

#[test]
fn redundant_arms_seldom_need_a_search() {
    for robot in SEVEN.map(robot) {
        let mut searched = 0;
        for q in configurations(&robot, 300) {
            let target = pose_at(&robot, &q);
            let solution = solved(&robot, &target, &SolveOptions::default());
            assert_reaches(&robot, &target, &solution, if solution.iterations == 0 { 2e-10 } else { 1e-5 });
            searched += usize::from(solution.iterations > 0);
        }
        assert!(searched < 6, "{}: {searched} of 300", robot.name());
    }
}

#[test]
fn arms_with_a_structure_that_holds_only_nearly_need_few_evaluations() {
    let (quarter, off) = (FRAC_PI_2, 1e-5);
    let gen3 = [
        [0.0, quarter, -0.2848],
        [0.0, quarter, -0.0118],
        [0.0, quarter, -0.4208],
        [off, quarter, -0.0128],
        [off, quarter, -0.3143],
        [0.0, quarter, off],
        [0.0, PI, -0.1674],
    ];
    for robot in [calibrated_ur10(1e-6), arm("Gen3, calibrated", gen3)] {
        assert!(robot.closed_form().contains("nearly"), "{}", robot.closed_form());
        let mut evaluations = 0;
        for q in configurations(&robot, 300) {
            let target = pose_at(&robot, &q);
            let solution = solved(&robot, &target, &SolveOptions::default());
            assert_reaches(&robot, &target, &solution, 3e-6);
            evaluations += solution.evaluations;
        }
        assert!(evaluations < 8 * 300, "{}: {evaluations} evaluations", robot.name());
    }
}

#[test]
fn redundant_arms_stay_near_their_start() {
    for robot in SEVEN.map(robot) {
        for q in configurations(&robot, 50) {
            let nearly: Vec<f64> = q.iter().map(|q| q + 1e-3).collect();
            let start: Vec<f64> =
                nearly.iter().zip(robot.joints()).map(|(q, joint)| q.clamp(joint.lower, joint.upper)).collect();
            let solution = solved(&robot, &pose_at(&robot, &q), &from(&start));
            assert_eq!(solution.status, Status::Solved);
            assert!(distance(&solution.q, &start) < 0.05, "{}: {:?} {start:?}", robot.name(), solution.q);
        }
    }
}

#[test]
fn joints_at_a_limit_do_not_hide_a_solution() {
    for robot in SIX.into_iter().chain(SEVEN).map(robot) {
        for (i, mut q) in configurations(&robot, 60).into_iter().enumerate() {
            let joint = &robot.joints()[i % robot.dof()];
            q[i % robot.dof()] = if i % 2 == 0 { joint.lower.max(-PI) } else { joint.upper.min(PI) };
            let target = pose_at(&robot, &q);
            assert_reaches(&robot, &target, &solved(&robot, &target, &SolveOptions::default()), 1e-5);
        }
    }
}

#[test]
fn tight_limits_leave_the_solution_inside_them() {
    for robot in SIX.into_iter().chain(SEVEN).map(robot) {
        for q in configurations(&robot, 30) {
            let narrow = robot.with_limits(|j, joint| (joint.lower, joint.upper) = (q[j] - 0.02, q[j] + 0.03)).unwrap();
            let target = pose_at(&robot, &q);
            assert_reaches(&narrow, &target, &solved(&narrow, &target, &SolveOptions::default()), 1e-5);
        }
    }
}

#[test]
fn singular_poses_are_solved() {
    for robot in ["ur5e", "kr210", "panda", "iiwa14"].map(robot) {
        let middle = |joint: &ikcore::robot::Joint| 0.5 * (joint.sampling_range().0 + joint.sampling_range().1);
        let mut q: Vec<f64> = robot.joints().iter().map(middle).collect();
        for bend in [0.0, 1e-12, 1e-8, 1e-4] {
            // The wrist is straight; the arm of a UR is stretched, too.
            q[robot.dof() - 2] = bend;
            let target = pose_at(&robot, &q);
            assert_reaches(&robot, &target, &solved(&robot, &target, &SolveOptions::default()), 1e-5);
        }
    }
}

#[test]
fn base_and_tool_far_away_and_geared_joints() {
    let shift = pose::from_parts([200.0, -50.0, 3.0], *pose::from_rpy([0.3, -0.8, 2.0], [0.0; 3]).rotation.matrix());
    for robot in ["ur10", "iiwa14"].map(robot) {
        let far = robot.with_base(shift).unwrap().with_tool(pose::translation(0.5, 3.0, -1.0)).unwrap();
        for q in configurations(&far, 40) {
            let target = pose_at(&far, &q);
            assert_reaches(&far, &target, &solved(&far, &target, &SolveOptions::default()), 1e-6);
        }
    }
    for (scale, offset) in [(-1.0, 0.4), (2.0, 0.3), (0.5, -1.0)] {
        let robot = geared(scale, offset, false);
        for q in configurations(&robot, 40) {
            let target = pose_at(&robot, &q);
            assert_reaches(&robot, &target, &solved(&robot, &target, &from(&q)), 1e-6);
        }
    }
}

#[test]
fn arms_without_limits_and_general_ones_are_solved() {
    for robot in [puma560(), jaco2()] {
        for q in configurations(&robot, 60) {
            let target = pose_at(&robot, &q);
            assert_reaches(&robot, &target, &solved(&robot, &target, &SolveOptions::default()), 1e-5);
        }
    }
}

#[test]
fn poses_out_of_reach_are_proven_so_at_once() {
    for robot in ["ur5e", "kr210"].map(robot) {
        let q = configurations(&robot, 1).remove(0);
        let mut far = robot.tip(&q);
        far.origin = far.origin.map(|x| 5.0 * x);
        let solution = solved(&robot, &Target::Pose(far), &SolveOptions::default());
        assert_eq!(solution.status, Status::OutOfReach, "{}", solution.message());
        assert!(solution.message().contains("out of reach by at least"), "{}", solution.message());
        assert!(solution.evaluations < 1000, "{}", solution.evaluations);
    }
    // Near enough, but turned where the wrist cannot bring it.
    let ur = robot("ur5e");
    let stretched = ur.tip(&[0.0, 0.0, 0.0, -FRAC_PI_2, 0.0, 0.0]);
    let turned = Frame { axes: [stretched.axes[1], stretched.axes[2], stretched.axes[0]], ..stretched };
    let solution = solved(&ur, &Target::Pose(turned), &SolveOptions::default());
    assert_eq!(solution.status, Status::OutOfReach, "{}", solution.message());
    assert!(solution.message().contains("(no configuration has this pose)"), "{}", solution.message());
    assert!(solution.evaluations < 1000 && ur.check("q", &solution.q).is_ok());
}

/// Robot with each joint restricted to a random part of its range, at least a tenth.
fn narrowed(full: &Robot, rng: &mut LazyRng) -> Robot {
    let parts: Vec<(f64, f64)> = full
        .joints()
        .iter()
        .map(|joint| {
            let (lower, upper) = joint.sampling_range();
            let width = (upper - lower) * rng.uniform_in(0.1, 1.0);
            let first = rng.uniform_in(lower, upper - width);
            (first, first + width)
        })
        .collect();
    let narrow = |j: usize, joint: &mut ikcore::robot::Joint| (joint.lower, joint.upper) = parts[j];
    full.with_limits(narrow).expect("they are ranges")
}

#[test]
fn every_pose_of_an_arm_with_spherical_shoulder_and_wrist_is_solved_or_proven_out_of_reach() {
    let (full, mut rng) = (robot("iiwa14"), rng::stream(3, 0));
    let mut counts = [0, 0];
    for trial in 0..cases(4) {
        let iiwa = if trial == 0 { full.clone() } else { narrowed(&full, &mut rng) };
        let qs = configurations(&iiwa, 60);
        for (q, other) in qs.iter().zip(qs.iter().rev()) {
            let pose = Frame { axes: iiwa.tip(other).axes, ..iiwa.tip(q) };
            let solution = solved(&iiwa, &Target::Pose(pose), &SolveOptions::default());
            match solution.status {
                Status::Solved => counts[0] += 1,
                Status::OutOfReach => {
                    counts[1] += 1;
                    let searched = solved(&iiwa, &Target::Pose(pose), &by_search());
                    assert_ne!(searched.status, Status::Solved, "{:?}", searched.q);
                }
                status => panic!("{status:?}: {}", solution.message()),
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 30), "{counts:?}");
}

#[test]
fn most_poses_that_limits_exclude_are_proven_out_of_reach() {
    for robot in ["panda", "gen3", "fr3"].map(robot) {
        let [mut missed, mut proven] = [0; 2];
        let qs = configurations(&robot, 400);
        for (q, other) in qs.iter().zip(qs.iter().rev()) {
            let pose = Target::Pose(Frame { axes: robot.tip(other).axes, ..robot.tip(q) });
            let solution = solved(&robot, &pose, &SolveOptions::default());
            missed += usize::from(solution.status != Status::Solved);
            if solution.status == Status::OutOfReach {
                proven += 1;
                let stop = Stop { max_evaluations: 1000, ..Stop::default() };
                let searched = solved(&robot, &pose, &SolveOptions { stop, ..by_search() });
                assert_ne!(searched.status, Status::Solved, "{}: {:?}", robot.name(), searched.q);
                // Two descents of eight end near the target.
                assert!(solution.evaluations < 20 + 16, "{}: {}", robot.name(), solution.evaluations);
            }
        }
        assert!(missed > 50 && 20 * proven > 19 * missed, "{}: {proven} of {missed}", robot.name());
    }
}

#[test]
fn budgets_hold_and_tolerances_beyond_rounding_end() {
    for robot in ["ur5e", "panda"].map(robot) {
        let q = configurations(&robot, 1).remove(0);
        let target = pose_at(&robot, &q);
        for max_evaluations in [1, 2, 10, 100] {
            let stop = Stop { max_evaluations, ..Stop::default() };
            let solution = solved(&robot, &target, &SolveOptions { stop, ..SolveOptions::default() });
            assert!(solution.evaluations <= max_evaluations, "{}", solution.evaluations);
        }
        let tolerance = Tolerance { position: 1e-17, rotation: 1e-17 };
        let stop = Stop { max_evaluations: 2000, ..Stop::default() };
        let solution = solved(&robot, &target, &SolveOptions { tolerance, stop, ..SolveOptions::default() });
        assert!(solution.error.position < 1e-12, "{}", solution.message());
    }
}

#[test]
fn the_same_call_gives_the_same_bits() {
    for robot in ["ur5e", "kr210", "panda", "iiwa14"].map(robot) {
        for q in configurations(&robot, 20) {
            let target = pose_at(&robot, &q);
            let solution = |seed| solved(&robot, &target, &SolveOptions { seed, ..SolveOptions::default() });
            assert_eq!(bits(&solution(1).q), bits(&solution(2).q));
        }
    }
}

/// Configurations with `fixed` joints at one of their limits.
fn at_limits(robot: &Robot, fixed: usize, count: usize) -> Vec<Vec<f64>> {
    let mut rng = rng::stream(7, fixed as u64);
    let ranges: Vec<(f64, f64)> = robot.joints().iter().map(|joint| joint.sampling_range()).collect();
    let mut draw = || {
        let mut q: Vec<f64> = ranges.iter().map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect();
        let mut free: Vec<usize> = (0..q.len()).collect();
        for _ in 0..fixed {
            let joint = free.swap_remove(rng.uniform_in(0.0, free.len() as f64) as usize);
            let (lower, upper) = ranges[joint];
            q[joint] = if rng.uniform_in(0.0, 1.0) < 0.5 { lower } else { upper };
        }
        q
    };
    (0..count).map(|_| draw()).collect()
}

#[test]
fn poses_that_only_narrow_ranges_of_the_self_motion_reach_are_solved() {
    for robot in SEVEN.map(robot) {
        for fixed in [0, 2, 3, 4, 6] {
            for q in at_limits(&robot, fixed, 300) {
                let solution = solved(&robot, &pose_at(&robot, &q), &SolveOptions::default());
                assert_eq!(solution.status, Status::Solved, "{}: {q:?}", robot.name());
            }
        }
    }
}

#[test]
fn poses_inside_narrowed_limits_are_solved() {
    let mut rng = rng::stream(11, 5);
    for full in SEVEN.map(robot) {
        for _ in 0..12 {
            let robot = narrowed(&full, &mut rng);
            for q in configurations(&robot, 100) {
                let solution = solved(&robot, &pose_at(&robot, &q), &SolveOptions::default());
                assert_eq!(solution.status, Status::Solved, "{}: {q:?}", robot.name());
            }
        }
    }
}
