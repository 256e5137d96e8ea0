//! Batches: bits independent of threads and groups, invalid rows, interruption and progress.

use std::thread::{self, ThreadId};
use std::time::Duration;

use crate::common::chains::RandomChain;
use crate::common::{bits, message, robot};
use ikcore::batch::{Batch, BatchOptions, OnInvalid, Targets, solve_batch};
use ikcore::ik::{Solution, SolveOptions, SolveReport, solve};
use ikcore::math::pose;
use ikcore::nalgebra::Matrix4;
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{
    Algorithm, AnySolver, Bas, BasVariant, LevenbergMarquardt, Monitor, MultiStart, RestartRule, Status, Stop,
    Unattended,
};
use ikcore::task::Target;

const NAN: f64 = f64::NAN;

fn poses(robot: &Robot, count: usize) -> Vec<[f64; 16]> {
    let goals = robot.random_configurations(count, &mut rng::stream(5, 0)).unwrap();
    robot.fk_all(&goals).unwrap().as_chunks().0.to_vec()
}

fn on_threads(threads: usize) -> BatchOptions<'static> {
    BatchOptions { threads: Some(threads), ..BatchOptions::default() }
}

fn solved(robot: &Robot, targets: &[[f64; 16]], options: &BatchOptions<'_>) -> Batch {
    solve_batch(robot, Targets::Poses(targets), options, &mut Unattended).unwrap()
}

/// Results of an item without the time taken.
type Facts = (Vec<u64>, Status, [u64; 2], [usize; 3]);

fn facts(solution: &Solution) -> Facts {
    let SolveReport { status, error, iterations, restarts, evaluations, .. } = &solution.report;
    let errors = [error.position.to_bits(), error.rotation.to_bits()];
    (bits(&solution.q), *status, errors, [*iterations, *restarts, *evaluations])
}

fn all_facts(batch: &Batch) -> Vec<Facts> {
    (0..batch.items.len()).map(|i| facts(&batch.solution(i).unwrap())).collect()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for name in ["panda", "ur5e"] {
        let robot = robot(name);
        let targets = poses(&robot, 200);
        let expected = all_facts(&solved(&robot, &targets, &on_threads(1)));
        for threads in [2, 3, 2, 7] {
            assert_eq!(
                all_facts(&solved(&robot, &targets, &on_threads(threads))),
                expected,
                "{name}, {threads} threads"
            );
        }
        assert_eq!(all_facts(&solved(&robot, &targets, &BatchOptions::default())), expected, "{name}, all cores");
    }
}

#[test]
fn any_number_of_targets_gives_the_same_bits() {
    let robot = robot("iiwa14");
    let targets = poses(&robot, 64);
    let expected = all_facts(&solved(&robot, &targets, &on_threads(1)));
    for size in [1, 2, 17, 63] {
        for threads in [1, 2] {
            let found = all_facts(&solved(&robot, &targets[..size], &on_threads(threads)));
            assert_eq!(found, expected[..size], "{size} targets, {threads} threads");
        }
    }
}

#[test]
fn the_first_item_is_what_solve_finds() {
    let robot = robot("panda");
    for (target, seed) in poses(&robot, 20).iter().zip(0..) {
        let each = SolveOptions { seed, ..SolveOptions::default() };
        let options = BatchOptions { each: each.clone(), ..BatchOptions::default() };
        let matrix = Matrix4::from_row_slice(target);
        let alone =
            solve(&robot, &Target::from(&pose::from_matrix("target", &matrix).unwrap()), &each, &mut Unattended);
        assert_eq!(facts(&solved(&robot, &[*target], &options).solution(0).unwrap()), facts(&alone.unwrap()));
    }
}

/// Solves, misses, restarts and budgets that run out in mid-attempt, on arms with joints of all kinds.
#[test]
fn threads_do_not_change_results_of_any_kind() {
    let arms = ["panda", "ur5e", "kr210"].map(robot).into_iter();
    let chains = (0..12).map(|seed| RandomChain::new(seed, 1 + seed as usize % 9, 12).robot);
    let stops = [
        Stop::default(),
        Stop { max_evaluations: 23, ..Stop::default() },
        Stop { max_iterations: 9, min_iterations: 2, ..Stop::default() },
        Stop { value_below: Some(1e-3), ..Stop::default() },
    ];
    for robot in arms.chain(chains) {
        let mut targets = poses(&robot, 40);
        targets[3][3] += 0.2; // most likely where the arm does not reach
        targets[5][3] += 50.0;
        let starts = robot.random_configurations(40, &mut rng::stream(6, 0)).unwrap();
        let positions: Vec<[f64; 3]> = targets.iter().map(|pose| [pose[3], pose[7], pose[11]]).collect();
        for (stop, targets) in
            stops.iter().flat_map(|stop| [(stop, Targets::Poses(&targets)), (stop, Targets::Positions(&positions))])
        {
            let stop = Stop { max_evaluations: stop.max_evaluations.min(3000), ..*stop };
            for starts in [None, Some(&starts[..])] {
                let each = SolveOptions { stop, ..SolveOptions::default() };
                let facts = |threads| {
                    let options = BatchOptions { each: each.clone(), starts, ..on_threads(threads) };
                    all_facts(&solve_batch(&robot, targets, &options, &mut Unattended).unwrap())
                };
                assert_eq!(facts(1), facts(3), "{} {stop:?}", robot.name());
            }
        }
    }
}

/// Invalid targets on both sides of a boundary between groups, and one that takes its whole budget.
#[test]
fn groups_do_not_change_results() {
    let robot = robot("panda");
    let mut targets = poses(&robot, 600);
    for wrong in [255, 256, 512] {
        targets[wrong][0] = NAN;
    }
    targets[590][3] += 0.4;
    let found = |each: &SolveOptions, threads| {
        let options = BatchOptions { each: each.clone(), on_invalid: OnInvalid::Skip, ..on_threads(threads) };
        all_facts(&solved(&robot, &targets, &options))
    };
    let solver = Algorithm::from(LevenbergMarquardt::default()).into_multi_start();
    for max_starts in [3, usize::MAX] {
        let rule = RestartRule { max_starts, ..solver.rule };
        let solver = AnySolver::MultiStart(MultiStart { rule, ..solver.clone() });
        let stop = Stop { max_evaluations: 2500, ..Stop::default() };
        let each = SolveOptions { solver: Some(solver), stop, ..SolveOptions::default() };
        let expected = found(&each, 1);
        assert_eq!(expected.iter().filter(|facts| facts.1 == Status::Invalid).count(), 3);
        for threads in [2, 3] {
            assert_eq!(found(&each, threads), expected, "{max_starts} starts, {threads} threads");
        }
    }
}

/// Time shared by targets is counted once: together they take no longer than the batch.
#[test]
fn times_of_targets_add_up() {
    let robot = robot("panda");
    for count in [1, 7, 8, 300] {
        let batch = solved(&robot, &poses(&robot, count), &on_threads(1));
        let sum: Duration = batch.items.iter().map(|item| item.elapsed).sum();
        assert!(sum <= batch.elapsed && batch.items.iter().all(|item| item.elapsed > Duration::ZERO), "{count}");
    }
}

#[test]
fn items_draw_from_streams_of_their_own() {
    let robot = robot("iiwa14");
    let solver = AnySolver::Single(Algorithm::from(Bas::of(BasVariant::Greedy)));
    let each = SolveOptions { solver: Some(solver), start: Some(vec![0.3; 7]), ..SolveOptions::default() };
    let options = BatchOptions { each, ..on_threads(2) };
    let [first, second] = [[0.4, 0.3, 0.9], [0.5, 0.1, 0.8]];
    let found = |targets: &[[f64; 3]]| {
        all_facts(&solve_batch(&robot, Targets::Positions(targets), &options, &mut Unattended).unwrap())
    };
    let (twice, mixed) = (found(&[first; 3]), found(&[second, first, second]));
    assert_ne!(twice[0], twice[1]);
    assert_eq!(twice[1], mixed[1]);
    assert_ne!(mixed[0], mixed[2]);
}

#[test]
fn one_start_serves_all() {
    let robot = robot("iiwa14");
    let q = robot.random_configurations(1, &mut rng::stream(5, 0)).unwrap();
    let each = SolveOptions { start: Some(q.clone()), ..SolveOptions::default() };
    let batch = solved(&robot, &[poses(&robot, 1)[0]; 5], &BatchOptions { each, ..on_threads(2) });
    assert_eq!(bits(&batch.q), bits(&q.repeat(5)));
}

#[test]
fn answers_are_right_and_inside_the_limits() {
    let robot = robot("panda");
    let targets = poses(&robot, 300);
    let batch = solved(&robot, &targets, &on_threads(2));
    assert_eq!(batch.message(), "all 300 solved");
    for (q, wanted) in batch.q.chunks_exact(robot.dof()).zip(&targets) {
        assert!(q.iter().zip(robot.joints()).all(|(q, joint)| joint.lower <= *q && *q <= joint.upper));
        let reached = robot.fk(q).unwrap().to_homogeneous();
        assert!((reached - Matrix4::from_row_slice(wanted)).amax() < 3e-6);
    }
}

#[test]
fn positions_leave_the_orientation_free() {
    let robot = robot("iiwa14");
    let targets = [[0.4, 0.3, 0.9], [9.0, 0.0, 0.0], [0.3, 0.3, 1.0]];
    let each = SolveOptions { stop: Stop { max_evaluations: 500, ..Stop::default() }, ..SolveOptions::default() };
    let options = BatchOptions { each, ..on_threads(2) };
    let batch = solve_batch(&robot, Targets::Positions(&targets), &options, &mut Unattended).unwrap();
    assert_eq!(
        batch.items.iter().map(|item| item.status).collect::<Vec<_>>(),
        [Status::Solved, Status::OutOfReach, Status::Solved]
    );
    assert!(batch.items.iter().all(|item| item.error.rotation.is_nan()));
    assert!(batch.items[1].evaluations <= 500);
    assert!(batch.solution(1).unwrap().message().contains("(out of reach by at least 8.061 m"));
    assert!(batch.items[1].error.position > 7.0);
    let says = "2 of 3 solved; 1 OUT_OF_REACH: move or turn the target into reach, or move the base";
    assert_eq!(batch.message(), says);
    assert_eq!(batch.solution(3), None);
    let some = batch.select(&[2, 1]);
    for (place, row) in [(0, 2), (1, 1)] {
        let (one, other) = (some.solution(place).unwrap(), batch.solution(row).unwrap());
        assert_eq!((&one.q, one.message()), (&other.q, other.message()));
    }
    assert_eq!(some.elapsed, batch.items[1].elapsed + batch.items[2].elapsed);
}

#[test]
fn every_item_begins_at_its_own_start() {
    let robot = robot("ur5e");
    let starts = robot.random_configurations(40, &mut rng::stream(2, 0)).unwrap();
    let targets: Vec<[f64; 16]> = robot.fk_all(&starts).unwrap().as_chunks().0.to_vec();
    let batch = solved(&robot, &targets, &BatchOptions { starts: Some(&starts), ..on_threads(2) });
    assert_eq!(bits(&batch.q), bits(&starts));
    assert!(batch.items.iter().all(|item| item.evaluations == 1));
}

#[test]
fn no_targets_give_no_solutions() {
    for threads in [1, 2] {
        let batch = solved(&robot("panda"), &[], &BatchOptions { starts: Some(&[]), ..on_threads(threads) });
        assert_eq!((batch.q.len(), batch.items.len(), batch.message().as_str()), (0, 0, "no targets"));
    }
}

/// Batch of six targets: 1 holds NaN, 3 is no rotation, and 4 has a start outside the limits.
fn with_wrong_rows(robot: &Robot) -> (Vec<[f64; 16]>, Vec<f64>) {
    let mut targets = poses(robot, 6);
    targets[1][3] = NAN;
    targets[3][0] += 0.5;
    let mut starts = robot.random_configurations(6, &mut rng::stream(1, 0)).unwrap();
    starts[4 * robot.dof() + 2] = NAN;
    (targets, starts)
}

#[test]
fn wrong_rows_are_skipped_on_demand_and_nothing_else_is_lost() {
    let robot = robot("panda");
    let (targets, starts) = with_wrong_rows(&robot);
    let (sound_targets, mut sound_starts) = (poses(&robot, 6), starts.clone());
    sound_starts[4 * robot.dof() + 2] = 0.0;
    let expected =
        all_facts(&solved(&robot, &sound_targets, &BatchOptions { starts: Some(&sound_starts), ..on_threads(1) }));
    for threads in [1, 2] {
        let options = BatchOptions { starts: Some(&starts), on_invalid: OnInvalid::Skip, ..on_threads(threads) };
        let batch = solved(&robot, &targets, &options);
        for (i, found) in all_facts(&batch).into_iter().enumerate() {
            if [1, 3, 4].contains(&i) {
                assert_eq!((found.1, found.3), (Status::Invalid, [0; 3]));
                assert!(batch.solution(i).unwrap().q.iter().all(|q| q.is_nan()));
            } else {
                assert_eq!(found, expected[i]);
            }
        }
        assert_eq!(batch.message(), "3 of 6 solved; 3 INVALID: make invalid items an error to see what is wrong");
        let says = "not solved: make invalid items an error to see what is wrong";
        assert_eq!(batch.solution(3).unwrap().message(), says);
    }
}

#[test]
fn wrong_rows_are_named() {
    let robot = robot("panda");
    let (mut targets, mut starts) = with_wrong_rows(&robot);
    let says = |targets: &[[f64; 16]], starts: &[f64]| {
        let options = BatchOptions { starts: Some(starts), ..BatchOptions::default() };
        message(solve_batch(&robot, Targets::Poses(targets), &options, &mut Unattended))
    };
    assert_eq!(says(&targets, &starts), "row 1: target must be finite, but entry (0, 3) is NaN");
    targets[1][3] = 0.4;
    let text = says(&targets, &starts);
    assert!(text.starts_with("row 3: target is not a rigid transform: R'R differs from the identity by "), "{text}");
    targets[3] = targets[1];
    starts[4 * robot.dof() + 2] = NAN;
    assert_eq!(says(&targets, &starts), "row 4: start_q must be finite, but joint 'panda_joint3' is NaN");
    let says = "starts: expected 42 numbers, 6 rows (one per target) of 7 joints, got 35";
    let options = BatchOptions { starts: Some(&starts[..35]), ..BatchOptions::default() };
    assert_eq!(message(solve_batch(&robot, Targets::Poses(&targets), &options, &mut Unattended)), says);
    let targets = Targets::Positions(&[[0.0; 3], [0.0, f64::INFINITY, 0.0]]);
    let says = "row 1: target must be finite, but coordinate y is inf";
    assert_eq!(message(solve_batch(&robot, targets, &BatchOptions::default(), &mut Unattended)), says);
}

#[test]
fn what_all_rows_fraction_is_refused_even_where_rows_are_skipped() {
    let robot = robot("panda");
    let says = |options: BatchOptions<'_>| {
        let options = BatchOptions { on_invalid: OnInvalid::Skip, ..options };
        message(solve_batch(&robot, Targets::Poses(&[]), &options, &mut Unattended))
    };
    assert_eq!(says(on_threads(0)), "threads must be from 1 to 1024, got 0");
    assert_eq!(says(on_threads(1025)), "threads must be from 1 to 1024, got 1025");
    let each = SolveOptions { start: Some(vec![0.0; 6]), ..SolveOptions::default() };
    assert_eq!(says(BatchOptions { each, ..on_threads(1) }), "start_q of robot 'panda': expected 7 joints, got 6");
    let each = SolveOptions { stop: Stop { max_evaluations: 0, ..Stop::default() }, ..SolveOptions::default() };
    assert_eq!(says(BatchOptions { each, ..on_threads(1) }), "max_evaluations must be at least 1, got 0");
    let says = "on_invalid must be one of 'raise', 'skip', got 'ignore'";
    assert_eq!(message("ignore".parse::<OnInvalid>()), says);
}

/// Monitor that stops after some polls, and records the threads and the progress reported.
struct Observer {
    looks_left: usize,
    threads: Vec<ThreadId>,
    told: Vec<(usize, usize)>,
}

impl Observer {
    fn with_patience(looks: usize) -> Self {
        Self { looks_left: looks, threads: vec![], told: vec![] }
    }
}

impl Monitor for Observer {
    fn keep_going(&mut self) -> bool {
        self.threads.push(thread::current().id());
        self.looks_left = self.looks_left.saturating_sub(1);
        self.looks_left > 0
    }

    fn progress(&mut self, done: usize, total: usize) {
        self.told.push((done, total));
    }
}

#[test]
fn progress_ends_with_all_and_never_goes_back() {
    let robot = robot("iiwa14");
    let targets = poses(&robot, 50);
    for threads in [1, 2] {
        let mut observer = Observer::with_patience(usize::MAX);
        solve_batch(&robot, Targets::Poses(&targets), &on_threads(threads), &mut observer).unwrap();
        assert_eq!(observer.told.last(), Some(&(50, 50)));
        assert!(observer.told.is_sorted());
        assert!(observer.threads.iter().all(|id| *id == thread::current().id()));
    }
}

#[test]
fn an_interrupted_batch_ends_in_the_middle_of_an_item() {
    let robot = robot("iiwa14");
    let mut targets = poses(&robot, 8);
    // Inside the shoulder, searched for with a budget of days.
    for target in &mut targets[1..3] {
        (target[3], target[7], target[11]) = (0.0, 0.0, 0.36);
    }
    let stop = Stop { max_evaluations: usize::MAX, ..Stop::default() };
    let each = SolveOptions { stop, solver: Some(AnySolver::default()), ..SolveOptions::default() };
    for threads in [1, 2] {
        let options = BatchOptions { each: each.clone(), ..on_threads(threads) };
        let batch = solve_batch(&robot, Targets::Poses(&targets), &options, &mut Observer::with_patience(5)).unwrap();
        assert_eq!(batch.items[1].status, Status::Interrupted);
        assert_eq!(batch.items[2].status, Status::Interrupted);
        assert!(batch.message().contains(" INTERRUPTED: run again to finish"));
    }
}

#[test]
fn items_that_were_not_begun_say_so() {
    let robot = robot("iiwa14");
    let targets = poses(&robot, 3);
    let batch = solve_batch(&robot, Targets::Poses(&targets), &on_threads(1), &mut Observer::with_patience(1)).unwrap();
    let last = batch.solution(2).unwrap();
    assert_eq!((last.status, last.message().as_str()), (Status::Interrupted, "not solved: run again to finish"));
    assert!(last.q.iter().all(|q| q.is_nan()));
}
