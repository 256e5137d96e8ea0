//! Tip kept in a box, eq. (5) of Cheng et al. (2020): with every solver, and reported where it binds.

use crate::common::{assert_derivative, configurations, message, pose_at, position_at, robot};
use ikcore::ik::{AllOptions, SolveOptions, solve, solve_all};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::robot::Robot;
use ikcore::solver::{Algorithm, AnySolver, Bas, BasVariant, Status, Stop, Unattended};
use ikcore::task::{Components, Criterion, Region, Target, Task, TaskKind, Tolerance};
use ikcore::tracking::{Session, TickRule, TrackOptions, WeightedPseudoInverse, track};

const OPEN: f64 = f64::INFINITY;
const KINDS: [TaskKind; 4] =
    [TaskKind::Pose, TaskKind::Position, TaskKind::Orientation, TaskKind::Pointing { axis: [0.6, 0.0, 0.8] }];
const Q: [f64; 7] = [0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1];

/// Region below a ceiling (m).
fn below(height: f64) -> Region {
    Region::new([-OPEN; 3], [OPEN, OPEN, height]).unwrap()
}

fn kept(kind: TaskKind, region: Region) -> Task {
    Task::from(kind).within(region).unwrap()
}

fn solvers() -> Vec<AnySolver> {
    let singles = Algorithm::all().into_iter().map(AnySolver::Single);
    singles.chain([AnySolver::default()]).collect()
}

#[test]
fn residual_and_jacobian_agree_on_both_sides_of_a_face() {
    let iiwa = robot("iiwa14");
    let free = Components { weights: [1.0, 0.5, 0.0, 1.0, 1.0, 1.0], tolerance: None };
    for q in configurations(&iiwa, 4) {
        let tip = iiwa.tip_position(&q);
        for kind in KINDS {
            let target = Task::from(kind).target(&pose_at(&iiwa, &Q)).unwrap();
            // The tip is outside in x, inside in y, and in z one and then the other.
            for height in [tip[2] - 0.2, tip[2] + 0.2] {
                let region = Region::new([tip[0] + 0.1, -OPEN, -OPEN], [OPEN, OPEN, height]).unwrap();
                let components = (kind == TaskKind::Position).then_some(free);
                let criterion = Criterion { region: Some(region), components, ..Criterion::default() };
                assert_derivative(&iiwa, &target, criterion, &q);
            }
        }
    }
}

#[test]
fn every_solver_ends_inside_and_says_what_held_it_back() {
    let iiwa = robot("iiwa14");
    let region = Region::new([-OPEN, -OPEN, 0.5], [OPEN, OPEN, 0.9]).unwrap();
    let stop = Stop { max_evaluations: 20_000, ..Stop::default() };
    let tolerance = Tolerance { position: 1e-3, rotation: 1e-3 };
    for solver in solvers() {
        let task = Some(kept(TaskKind::Position, region));
        let options = SolveOptions { task, solver: Some(solver.clone()), tolerance, stop, ..SolveOptions::default() };
        let (mut reached, mut held) = (0, 0);
        for height in [0.7, 0.9, 0.89999, 1.0, 0.4] {
            let solution = solve(&iiwa, &Target::Position([0.4, 0.3, height]), &options, &mut Unattended).unwrap();
            let inside = region.contains(&iiwa.tip_position(&solution.q));
            match solution.status {
                Status::Solved => reached += 1,
                Status::HeldInRegion => held += 1,
                _ => continue,
            }
            assert!(inside, "{solver:?} at {height}: {}", solution.message());
            assert_eq!(solution.status == Status::Solved, (0.5..=0.9).contains(&height), "{solver:?} at {height}");
        }
        assert!(reached + held > 0, "{solver:?} never arrived");
        if !matches!(solver.algorithm(), Algorithm::DerivativeFree(_)) {
            assert_eq!((reached, held), (3, 2), "{solver:?}");
        }
    }
}

#[test]
fn a_target_outside_is_approached_as_far_as_the_box_allows() {
    let iiwa = robot("iiwa14");
    for kind in [TaskKind::Pose, TaskKind::Position, TaskKind::Pointing { axis: [0.0, 0.0, 1.0] }] {
        let options = SolveOptions { task: Some(kept(kind, below(0.9))), ..SolveOptions::default() };
        let wanted = pose_at(&iiwa, &Q);
        let solution = solve(&iiwa, &wanted, &options, &mut Unattended).unwrap();
        assert_eq!(solution.status, Status::HeldInRegion, "{kind:?}: {}", solution.message());
        let (tip, wished) = (iiwa.tip_position(&solution.q), wanted.position().unwrap());
        assert!((0..2).all(|k| (tip[k] - wished[k]).abs() < 2e-6) && (0.9 - 2e-6..0.9).contains(&tip[2]), "{tip:?}");
        assert!((solution.error.position - (wished[2] - 0.9)).abs() < 2e-6, "errors are those to the target itself");
        let away = format!("{:.4} m", solution.error.position);
        assert!(solution.message().starts_with(&format!("as near as its region allows, {away}")));
        assert!(
            solution
                .message()
                .ends_with("away (its region keeps z below 0.9): move the target into the region, or widen the region")
        );
        let found = solve_all(&iiwa, &wanted, &AllOptions { each: options, ..AllOptions::default() }, &mut Unattended);
        assert!(found.unwrap().solutions.is_empty(), "what is held back is no solution");
    }
}

#[test]
fn coordinates_that_are_free_are_kept_inside_too() {
    let iiwa = robot("iiwa14");
    let wanted = pose_at(&iiwa, &Q);
    let free_height = Components { weights: [1.0, 1.0, 0.0, 1.0, 1.0, 1.0], tolerance: None };
    for region in [below(0.6), below(0.9), Region::new([0.2, -OPEN, -OPEN], [0.3, OPEN, OPEN]).unwrap()] {
        let orientation = kept(TaskKind::Orientation, region);
        let solution = solve(
            &iiwa,
            &wanted,
            &SolveOptions { task: Some(orientation), ..SolveOptions::default() },
            &mut Unattended,
        )
        .unwrap();
        assert_eq!(solution.status, Status::Solved, "{}", solution.message());
        assert!(region.contains(&iiwa.tip_position(&solution.q)));
    }
    let task = Task { components: Some(free_height), ..kept(TaskKind::Position, below(0.7)) };
    let options = SolveOptions { task: Some(task), ..SolveOptions::default() };
    let solution = solve(&iiwa, &Target::Position([0.5, 0.2, 9.0]), &options, &mut Unattended).unwrap();
    assert_eq!(solution.status, Status::Solved, "{}", solution.message());
    let tip = iiwa.tip_position(&solution.q);
    assert!(tip[2] < 0.7 && (tip[0] - 0.5).hypot(tip[1] - 0.2) <= 1e-6, "{tip:?}");
}

#[test]
fn a_miss_says_that_the_tip_is_outside() {
    let iiwa = robot("iiwa14");
    let nowhere = Region::new([2.0, -OPEN, -OPEN], [3.0, OPEN, OPEN]).unwrap();
    let options = SolveOptions { task: Some(kept(TaskKind::Orientation, nowhere)), ..SolveOptions::default() };
    let solution = solve(&iiwa, &pose_at(&iiwa, &Q), &options, &mut Unattended).unwrap();
    assert!(!matches!(solution.status, Status::Solved | Status::HeldInRegion));
    assert!(solution.message().contains("(the tip is outside its region, which requires x above 2"));
}

/// Height of the ceiling, below the upper third of the circle.
const CEILING: f64 = 0.95;

fn leaving(iiwa: &Robot, rule: TickRule, tolerance: f64) -> (TrackOptions, Reference) {
    let upright = Plane::new([0.4, 0.3, 0.9], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
    let circle = Path::new(Circle::new(upright, 0.2, 2.0).unwrap());
    let fast = vec![Profile::Constant(2.0)];
    let options = TrackOptions {
        rule,
        task: Some(kept(TaskKind::Position, below(CEILING))),
        tolerance: Tolerance { position: tolerance, ..Tolerance::default() },
        limits: Some(Limits::of(iiwa).replace(Field::Velocity, fast).unwrap()),
        ..TrackOptions::default()
    };
    (options, circle.sample(0.02).unwrap())
}

#[test]
fn no_tick_of_any_rule_ends_outside() {
    let iiwa = robot("iiwa14");
    let rules = solvers().into_iter().map(TickRule::Solver);
    let own = [TickRule::MidStep, TickRule::WeightedPseudoInverse(WeightedPseudoInverse::default())];
    for rule in rules.chain(own) {
        let (options, reference) = leaving(&iiwa, rule.clone(), 1e-3);
        let record = track(&iiwa, &reference, None, &options, &mut Unattended).unwrap();
        assert!(record.position.iter().all(|tip| tip[2] < CEILING), "{rule:?}");
        assert_eq!(record.max_violation, 0.0, "{rule:?}");
        let held = record.step_status.iter().filter(|status| **status == Status::HeldInRegion).count();
        assert!(held > 0, "{rule:?}: {}", record.message());
    }
}

/// Beetles, which rest as soon as they are nearer than in the step before, must not leave the region for it.
#[test]
fn beetles_follow_the_faces() {
    let iiwa = robot("iiwa14");
    for variant in [BasVariant::Star, BasVariant::Chain] {
        let bas = Bas { variant, c1: 1.0, ..Bas::default() };
        let (options, reference) = leaving(&iiwa, TickRule::Solver(AnySolver::Single(bas.into())), 1e-4);
        let record = track(&iiwa, &reference, None, &options, &mut Unattended).unwrap();
        for (tip, wanted) in record.position.iter().zip(&record.reference) {
            let nearest = below(CEILING).nearest(wanted, 0.0);
            let away = (0..3).map(|k| (tip[k] - nearest[k]).powi(2)).sum::<f64>().sqrt();
            assert!(away < 3e-4, "{variant:?}: {tip:?} {wanted:?}");
        }
    }
}

#[test]
fn a_track_that_is_held_says_where() {
    let iiwa = robot("iiwa14");
    let (options, reference) = leaving(&iiwa, TickRule::MidStep, 1e-6);
    let record = track(&iiwa, &reference, None, &options, &mut Unattended).unwrap();
    assert_eq!(record.status, Status::HeldInRegion);
    for (status, wanted) in record.step_status.iter().zip(&record.reference) {
        let expected = if wanted[2] > CEILING + 1e-6 { Status::HeldInRegion } else { Status::Solved };
        assert_eq!(*status, expected, "{wanted:?}");
    }
    assert_eq!(
        record.message(),
        "in the band of 1.000e-6 m from t = 0 s on, except in 33 of 100 steps, in which its region held the tip up to \
         0.05000 m away: move the target into the region, or widen the region"
    );
}

#[test]
fn what_cannot_be_guaranteed_is_refused() {
    let iiwa = robot("iiwa14");
    let says = |limits: Limits, start: &[f64], ceiling: f64| {
        let task = Some(kept(TaskKind::Position, below(ceiling)));
        let options = TrackOptions { task, limits: Some(limits), ..TrackOptions::default() };
        message(Session::new(&iiwa, start, 0.01, &options))
    };
    let own = || Limits::of(&iiwa);
    let sudden = own().replace(Field::Acceleration, vec![Profile::Constant(5.0)]).unwrap();
    assert_eq!(
        says(sudden, &Q, 2.0),
        "a task with a region cannot honour acceleration limits: an arm that may not stop at once can be carried out \
         of it; leave one of the two out"
    );
    let wave = Profile::Sinusoid(Sinusoid { mean: 2.5, amplitude: 0.1, angular_frequency: 1.0, phase: 0.0 });
    let moving = own().replace(Field::Upper, vec![wave]).unwrap();
    assert_eq!(
        says(moving, &Q, 2.0),
        "a task with a region cannot honour time-varying upper limits: limits that move can push the arm out of it; \
         give numbers, or leave region out"
    );
    let Target::Position([.., z]) = position_at(&iiwa, &Q) else { panic!("a position") };
    assert_eq!(says(own(), &Q, 0.5), format!("start_q: z of the tip, {z} m, is outside its region (-inf, 0.5)"));
}

#[test]
fn what_is_wrong_with_a_region_is_named() {
    let region = |lower, upper| message(Region::new(lower, upper));
    assert_eq!(region([0.0; 3], [1.0, 0.0, 1.0]), "lower y of region must be below its upper one, 0, got 0");
    assert_eq!(region([0.0, 0.0, f64::NAN], [1.0; 3]), "lower z of region must be below its upper one, 1, got NaN");
    assert_eq!(region([0.0; 3], [f64::NAN, 1.0, 1.0]), "upper x of region must be a number, got NaN");
    assert_eq!(region([OPEN; 3], [OPEN; 3]), "lower x of region must be below its upper one, inf, got inf");
    let task = Task::new(TaskKind::Pose, Some(&[1.0, 1.0, 0.0, 1.0, 1.0, 1.0]), None, None).unwrap();
    assert_eq!(
        message(task.within(below(1.0))),
        "region keeps x, y and z of the base, but weights free some of x, y and z of the target: free all three or \
         none, or take task Position, whose axes are the base's"
    );
}
