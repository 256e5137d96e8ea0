//! Experiments of Yuan et al. 2016 to the last iteration: seven motions of the KUKA KR 210, its Tables 3, 4 and 5.
//!
//! Printed values that contradict the rest of the paper are corrected here, with the evidence.

use std::f64::consts::TAU;

use crate::common::robot;
use ikcore::Error;
use ikcore::ik::{Solution, SolveOptions, solve};
use ikcore::math::Frame;
use ikcore::objective::{Bounds, Gradient, Objective};
use ikcore::problem::Problem;
use ikcore::rng;
use ikcore::robot::{Joint, Robot};
use ikcore::solver::{Algorithm, AnySolver, Apps, JacobianTranspose, LearningRate, LevenbergMarquardt, NewtonRaphson};
use ikcore::solver::{Status, Stop, Unattended};
use ikcore::task::{Aims, Components, Criterion, Target, Tolerance};

/// Joint angles before the first motion (degrees), Table 3.
const START: [f64; 6] = [0.01, -78.33, 183.51, 0.16, -44.87, -179.93];

/// Motion: its target's position (m), and the results of the paper: iterations and R_1 (degrees).
type Motion = ([f64; 3], usize, [f64; 6]);

/// Motions of the paper, with two corrections. Table 2 has 1.9845 for the first x where Table 4 has 1.9485: with the former the
/// counts are 451 and 235. For R_1 of the first motion it prints theta_1 = -20.0995 and theta_6 = -147.3760, which its own R_2
/// (-20.10, -147.38), its positions and the symmetric motion 5-6 contradict.
const MOTIONS: [Motion; 7] = [
    ([1.9485, 0.6342, 1.1262], 438, [-20.0955, -66.5326, 184.7585, 142.2740, 34.1622, -147.3756]),
    ([1.7850, 0.6342, 1.2252], 256, [-21.9957, -75.7315, 191.8096, 137.4221, 33.6108, -142.5760]),
    ([1.6215, 0.6342, 1.3242], 316, [-24.2704, -85.0300, 197.4984, 130.2858, 32.6040, -135.1768]),
    ([1.6215, -0.6342, 1.3242], 618, [24.2704, -85.0300, 197.4985, 229.7142, 32.6040, -224.8230]),
    ([1.7850, -0.6342, 1.2252], 278, [21.9967, -75.7318, 191.8080, 222.5843, 33.6099, -217.4305]),
    ([1.9485, -0.6342, 1.1262], 233, [20.0955, -66.5326, 184.7585, 217.7259, 34.1623, -212.6243]),
    ([1.9168, 0.0, 1.5539], 281, [0.0122, -78.3288, 183.5099, 0.1615, -44.8711, -179.9318]),
];

/// Positions R_1 in Table 4 (m); the last y is printed as 0.
const POSITIONS: [[f64; 3]; 7] = [
    [1.94850, 0.63421, 1.12621],
    [1.78500, 0.63419, 1.22518],
    [1.62150, 0.63419, 1.32418],
    [1.62150, -0.63419, 1.32418],
    [1.78500, -0.63421, 1.22522],
    [1.94850, -0.63421, 1.12621],
    [1.91680, 0.00002, 1.55390],
];

/// Columns of the rotation in eq. (22).
const TOOL_DOWN: [[f64; 3]; 3] = [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];

/// Tolerance of the experiment.
const TOLERANCE: Tolerance = Tolerance { position: 1e-4, rotation: 1e-4 };

fn kuka() -> Robot {
    robot("kr210_yuan2016")
}

fn radians(degrees: &[f64]) -> Vec<f64> {
    degrees.iter().map(|angle| angle.to_radians()).collect()
}

fn paper_options(solver: impl Into<Algorithm>, start: Vec<f64>) -> SolveOptions {
    SolveOptions {
        solver: Some(AnySolver::Single(solver.into())),
        start: Some(start),
        tolerance: TOLERANCE,
        stop: Stop { max_iterations: 1000, ..Stop::default() },
        ..SolveOptions::default()
    }
}

fn found(robot: &Robot, target: &Target, options: &SolveOptions) -> Solution {
    solve(robot, target, options, &mut Unattended).unwrap()
}

/// Targets and starts (rad) of the motions. Each starts from the last result rounded to 0.01 degrees, as the paper's robot did;
/// the way back goes to the orientation of the very first configuration, for which eq. (22) does not hold.
fn tasks(robot: &Robot) -> Vec<(Target, Vec<f64>)> {
    let mut start = radians(&START);
    let first = robot.tip(&start);
    let mut tasks = vec![];
    for (i, (origin, _, _)) in MOTIONS.into_iter().enumerate() {
        let axes = if i == 6 { first.axes } else { TOOL_DOWN };
        let target = Target::Pose(Frame { axes, origin });
        let solution = found(robot, &target, &paper_options(Apps::paper(), start.clone()));
        tasks.push((target, start));
        start = solution.q.iter().map(|angle| ((angle.to_degrees() * 100.0).round() / 100.0).to_radians()).collect();
    }
    tasks
}

#[test]
fn iterations_and_angles_are_the_papers() {
    let robot = kuka();
    for ((target, start), (_, iterations, angles)) in tasks(&robot).into_iter().zip(MOTIONS) {
        let solution = found(&robot, &target, &paper_options(Apps::paper(), start));
        assert_eq!((solution.status, solution.iterations), (Status::Solved, iterations));
        assert_eq!(solution.evaluations, iterations + 1);
        for (angle, printed) in solution.q.iter().zip(angles) {
            let angle = angle.to_degrees();
            assert!((angle - printed).abs() < 2e-4, "{angle} {printed}");
            assert_eq!((angle * 100.0).round(), (printed * 100.0).round());
        }
    }
}

#[test]
fn positions_and_their_errors_are_the_papers() {
    let robot = kuka();
    for ((target, start), printed) in tasks(&robot).into_iter().zip(POSITIONS) {
        let solution = found(&robot, &target, &paper_options(Apps::paper(), start));
        let tip = robot.tip(&solution.q).origin;
        let Target::Pose(Frame { origin: wanted, .. }) = target else { panic!("a pose") };
        for (coordinate, printed) in tip.iter().zip(printed) {
            assert_eq!((coordinate * 1e5).round(), (printed * 1e5).round());
        }
        let mean_error = tip.iter().zip(wanted).map(|(p, d)| (p - d).abs()).sum::<f64>() / 3.0;
        assert!(mean_error < 0.0115e-3, "{mean_error}");
    }
}

#[test]
fn no_other_rate_gives_these_counts() {
    let robot = kuka();
    let tasks = tasks(&robot);
    for rate in [0.1999, 0.2001] {
        let solver = Apps { learning_rate: LearningRate::Fixed(rate), ..Apps::paper() };
        let counts =
            tasks.iter().map(|(target, start)| found(&robot, target, &paper_options(solver, start.clone())).iterations);
        assert!(counts.zip(MOTIONS).any(|(count, (_, printed, _))| count != printed), "{rate}");
    }
}

#[test]
fn other_solvers_need_fewer_iterations_than_apps() {
    // Held inside the limits all the way, only APPS makes the last motion, on which the fourth joint passes one.
    let no_limits = |_: usize, joint: &mut Joint| (joint.lower, joint.upper) = (f64::NEG_INFINITY, f64::INFINITY);
    let free = kuka().with_limits(no_limits).unwrap();
    let exactly = Tolerance { position: 1e-9, rotation: 1e-9 };
    let solvers: [(Algorithm, usize); 3] = [
        (Apps::default().into(), 140),
        (LevenbergMarquardt::default().into(), 20),
        (NewtonRaphson::default().into(), 15),
    ];
    for (solver, most) in solvers {
        for (target, start) in tasks(&kuka()) {
            let options = SolveOptions { tolerance: exactly, ..paper_options(solver.clone(), start) };
            let solution = found(&free, &target, &options);
            assert_eq!(solution.status, Status::Solved, "{solver:?}: {}", solution.message());
            assert!(solution.iterations <= most, "{solver:?}: {}", solution.iterations);
        }
    }
}

#[test]
fn a_start_below_the_threshold_is_returned_untouched() {
    let robot = kuka();
    let start = radians(&START);
    let target = Target::Pose(robot.tip(&start));
    let solution = found(&robot, &target, &paper_options(Apps::paper(), start.clone()));
    assert_eq!((solution.status, solution.iterations, solution.evaluations), (Status::Solved, 0, 1));
    assert_eq!(solution.q.to_vec(), start);
}

#[test]
fn a_threshold_ends_the_search_and_tolerances_judge_it() {
    let robot = kuka();
    let (target, start) = tasks(&robot).swap_remove(0);
    let loose = Apps { error_threshold: Some(1e-3), ..Apps::paper() };
    let solution = found(&robot, &target, &paper_options(loose, start.clone()));
    assert_eq!(solution.status, Status::BelowThreshold);
    let message = solution.message();
    assert!(
        message.starts_with("error_threshold met, ")
            && message.ends_with(" rad away: lower error_threshold, or leave it out and let the tolerances decide"),
        "{message}"
    );
    // Without a threshold it ends where the tolerances are met.
    let solution = found(&robot, &target, &paper_options(Apps { error_threshold: None, ..loose }, start));
    assert!(solution.status == Status::Solved && solution.iterations < 438, "{}", solution.iterations);
}

#[test]
fn joints_are_brought_back_by_whole_turns() {
    // On its way home the fourth joint passes 350 degrees, and 360 as well.
    let robot = kuka();
    let (target, start) = tasks(&robot).pop().unwrap();
    let solution = found(&robot, &target, &paper_options(Apps::paper(), start));
    assert!((solution.q[3].to_degrees() - 0.1615).abs() < 1e-4);
}

#[test]
fn wrapping_takes_fewest_turns_and_clips_other_joints() {
    let bounds = Bounds::new(&[-1.0, -1.0, -9.0, 2.0, -1.0], &[1.0, 1.0, 9.0, 3.0, 1.0]).unwrap();
    let periods = [Some(TAU), Some(TAU), Some(TAU), Some(TAU), None];
    let mut x = [3.0 * TAU + 0.5, -2.0 * TAU - 0.5, 9.5, 4.0, 1.5];
    bounds.wrap(&mut x, &periods);
    // The third takes one turn though two would do; no turn brings the fourth inside; the last slides.
    let expected = [0.5, -0.5, 9.5 - TAU, 4.0, 1.0];
    assert!(x.iter().zip(expected).all(|(x, expected)| (x - expected).abs() < 1e-14), "{x:?}");
}

#[test]
fn a_solution_outside_the_limits_is_not_returned() {
    // Both joints of the arm turn the same way to the target, the second past its limit.
    let arm = Robot::planar(&[1.0, 1.0]).unwrap();
    let narrow = arm.with_limits(|_, joint| (joint.lower, joint.upper) = (-0.5, 0.5)).unwrap();
    let target = Target::Position(narrow.tip_position(&[0.1, 1.0]));
    let solver = Apps::default();
    let options = SolveOptions {
        solver: Some(AnySolver::Single(solver.into())),
        start: Some(vec![0.2, 0.4]),
        ..SolveOptions::default()
    };
    let solution = found(&narrow, &target, &options);
    assert_eq!(solution.status, Status::OutsideLimits);
    assert!(solution.q.iter().all(|angle| angle.abs() <= 0.5), "{:?}", solution.q);
    let message = solution.message();
    assert!(message.starts_with("reached only outside the limits; inside them "), "{message}");
    assert!(
        message.ends_with(
            " m away: try another start or seed, MultiStart, or a solver that searches inside the limits, such as \
         LevenbergMarquardt"
        ),
        "{message}"
    );
}

#[test]
fn joints_that_slide_stay_inside() {
    let robot = robot("hydraulic3");
    let goals = robot.random_configurations(200, &mut rng::stream(5, 0)).unwrap();
    let solved = goals.chunks_exact(robot.dof()).filter(|goal| {
        let target = Target::Position(robot.tip_position(goal));
        let options = SolveOptions {
            solver: Some(AnySolver::Single(Apps::default().into())),
            start: Some(robot.joints().iter().map(|joint| 0.5 * (joint.lower + joint.upper)).collect()),
            ..SolveOptions::default()
        };
        let solution = found(&robot, &target, &options);
        let inside = solution.q.iter().zip(robot.joints()).all(|(q, joint)| joint.lower <= *q && *q <= joint.upper);
        assert!(inside, "{:?}", solution.q);
        solution.status == Status::Solved
    });
    let solved = solved.count();
    assert!(solved >= 150, "{solved} of 200");
}

#[test]
fn gradients_match_central_differences() {
    for name in ["kr210_yuan2016", "iiwa14", "hydraulic3", "planar5"] {
        let robot = robot(name);
        let n = robot.dof();
        let drawn = robot.random_configurations(40, &mut rng::stream(3, 0)).unwrap();
        for pair in drawn.chunks_exact(2 * n) {
            let (q, goal) = pair.split_at(n);
            for (target, criterion) in kinds_of_target(robot.tip(goal)) {
                let task = criterion.into();
                let mut problem = Problem::new(&robot, Aims::of_one(&task, &target));
                let mut gradient = vec![0.0; n];
                let slope = problem.differentiate(q, &mut gradient);
                let score = problem.evaluate(q);
                assert!(
                    (slope.score.value - score.value).abs() < 1e-13 && slope.score.solved == score.solved,
                    "{name}"
                );
                for (k, expected) in gradient.into_iter().enumerate() {
                    let mut error_at = |step: f64| {
                        let mut moved = q.to_vec();
                        moved[k] += step;
                        problem.differentiate(&moved, &mut vec![0.0; n]).error
                    };
                    let h = 1e-5;
                    let difference = (error_at(h) - error_at(-h)) / (2.0 * h);
                    assert!((difference - expected).abs() < 1e-8, "{name}: {difference} {expected}");
                }
            }
        }
    }
}

/// Targets of every kind at `frame`, one of them with weights.
fn kinds_of_target(frame: Frame) -> [(Target, Criterion); 5] {
    let components = Components { weights: [1.0, 0.0, 2.0, 0.5, 0.0, 1.0], tolerance: None };
    let weighted = Criterion { components: Some(components), ..Criterion::default() };
    let axis = [0.6, 0.0, 0.8];
    [
        (Target::Pose(frame), Criterion::default()),
        (Target::Position(frame.origin), Criterion::default()),
        (Target::Orientation(frame), Criterion::default()),
        (Target::Pointing { frame, axis }, Criterion::default()),
        (Target::Pose(frame), weighted),
    ]
}

#[test]
fn options_are_checked() {
    let bad = [0.0, -0.1, f64::NAN, f64::INFINITY];
    let out_of_range = |what: &str, requirement: &str, value: f64, result: Result<(), Error>| {
        let expected = format!("{what} must be {requirement}, got {value}");
        assert_eq!(result.unwrap_err().to_string(), expected);
    };
    for value in bad {
        let positive = "positive and finite";
        let rate = Apps { learning_rate: LearningRate::Fixed(value), ..Apps::default() };
        out_of_range("learning_rate", positive, value, rate.validate());
        let step = Apps { step_limit: value, ..Apps::default() };
        out_of_range("step_limit", positive, value, step.validate());
        let threshold = Apps { error_threshold: Some(value), ..Apps::default() };
        out_of_range("error_threshold", positive, value, threshold.validate());
        let transpose = JacobianTranspose { step_size: ikcore::solver::StepSize::Fixed(value) };
        out_of_range("step_size", positive, value, transpose.validate());
        let newton = NewtonRaphson { step_fraction: value };
        out_of_range("step_fraction", "above 0 and at most 1", value, newton.validate());
    }
}
