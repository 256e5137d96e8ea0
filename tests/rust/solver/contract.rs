//! Contract of every algorithm, alone and from many starts: one table of solvers and problems, and one check of each promise
//! over all of it.

use std::sync::LazyLock;
use std::time::Duration;

use crate::common::{bits, pose_at, robot};
use ikcore::objective::{
    Bounds, Differentiable, Gradient, LeastSquares, Linearization, Objective, Residual, Score, SmoothScore, TaskBlock,
    TaskResiduals,
};
use ikcore::problem::Problem;
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::solver::{Algorithm, AnySolver, BestPoint, DerivativeFree, Evaluator, Monitor, Status, Stop, Unattended};
use ikcore::task::{Aims, CheckedTask, Target, Tolerance};

/// Evaluations between two polls of monitor and clock, plus the largest group handed in at once.
const POLL: usize = 256 + 16;

/// Bent valley r = s (x - 1/2, 2 (y - x^2), z - 0.3, floor), solved where r'r <= 1e-12 and therefore never above a floor. Its
/// slope s is about that of the tip of a small arm (m per rad), for which the default antennae are long enough.
#[derive(Clone, Copy)]
struct Valley {
    floor: f64,
    blocks: usize,
}

const SLOPE: f64 = 0.25;
const BOTTOM: [f64; 3] = [0.5, 0.25, 0.3];

impl Objective for Valley {
    fn dimension(&self) -> usize {
        3
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        self.linearize(x, &mut Linearization::default())
    }
}

impl Residual for Valley {
    fn residual(&mut self, x: &[f64], out: &mut TaskResiduals) -> Score {
        let mut completed = Linearization::default();
        let score = self.linearize(x, &mut completed);
        *out = completed.blocks().map(|block| block.residual).collect();
        score
    }
}

impl LeastSquares for Valley {
    fn linearize(&mut self, x: &[f64], out: &mut Linearization) -> Score {
        let sloped = |entries: [f64; 6]| entries.map(|entry| SLOPE * entry);
        // In two blocks the third row is that of another task.
        let split = usize::from(self.blocks > 1);
        out.more.resize_with(split, TaskBlock::default);
        out.first.residual = sloped([x[0] - 0.5, 2.0 * (x[1] - x[0] * x[0]), 0.0, self.floor, 0.0, 0.0]);
        out.first.columns[0] = sloped([1.0, -4.0 * x[0], 0.0, 0.0, 0.0, 0.0]);
        out.first.columns[1] = sloped([0.0, 2.0, 0.0, 0.0, 0.0, 0.0]);
        out.first.columns[2] = [0.0; 6];
        if let Some(last) = out.blocks_mut().last() {
            last.residual[2] = SLOPE * (x[2] - 0.3);
            last.columns[2] = sloped([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        }
        let value = out.blocks().flat_map(|block| block.residual).map(|r| r * r).sum();
        Score { value, solved: value <= 1e-12 }
    }
}

impl Gradient for Valley {
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore {
        let mut linearization = Linearization::default();
        let score = self.linearize(x, &mut linearization);
        linearization.gradient(gradient);
        SmoothScore { error: 0.5 * score.value, score }
    }
}

/// Rule that makes the value of a point, by its number, not finite.
type Poison = fn(&[f64], usize) -> Option<f64>;

/// Objective that forwards to `inner`, records every point, and replaces values by the poison.
struct Probe {
    inner: Box<dyn Differentiable>,
    poison: Poison,
    seen: Vec<f64>,
    values: Vec<f64>,
}

impl Probe {
    fn note(&mut self, x: &[f64], score: Score) -> Score {
        let number = self.values.len();
        // A poisoned point claims to be the solution: nobody may believe it.
        let poisoned = (self.poison)(x, number).map(|value| Score { value, solved: true });
        let score = poisoned.unwrap_or(score);
        self.seen.extend_from_slice(x);
        self.values.push(score.value);
        score
    }
}

impl Objective for Probe {
    fn dimension(&self) -> usize {
        self.inner.dimension()
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        let score = self.inner.evaluate(x);
        self.note(x, score)
    }

    fn evaluate_all(&mut self, xs: &[f64], out: &mut [Score]) {
        self.inner.evaluate_all(xs, out);
        for (x, score) in xs.chunks_exact(self.dimension()).zip(out) {
            *score = self.note(x, *score);
        }
    }

    fn propose_start(&mut self, attempt: usize, bounds: &Bounds, rng: &mut LazyRng, x: &mut [f64]) {
        self.inner.propose_start(attempt, bounds, rng, x);
    }

    fn period(&self, entry: usize) -> Option<f64> {
        self.inner.period(entry)
    }
}

impl Gradient for Probe {
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore {
        let slope = self.inner.differentiate(x, gradient);
        SmoothScore { score: self.note(x, slope.score), ..slope }
    }
}

impl Residual for Probe {
    fn residual(&mut self, x: &[f64], out: &mut TaskResiduals) -> Score {
        let score = self.inner.residual(x, out);
        self.note(x, score)
    }
}

impl LeastSquares for Probe {
    fn linearize(&mut self, x: &[f64], out: &mut Linearization) -> Score {
        let score = self.inner.linearize(x, out);
        self.note(x, score)
    }
}

static ARM: LazyLock<Robot> = LazyLock::new(|| robot("iiwa14"));
static TASK: LazyLock<CheckedTask> = LazyLock::new(|| Tolerance::default().into());
static POSE: LazyLock<Target> = LazyLock::new(|| pose_at(&ARM, &[0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1]));

/// Objective, start and rules of a run.
struct Case {
    name: &'static str,
    problem: fn() -> Box<dyn Differentiable>,
    start: Vec<f64>,
    bounds: Bounds,
    stop: Stop,
    seed: u64,
    poison: Poison,
}

fn healthy(_: &[f64], _: usize) -> Option<f64> {
    None
}

fn valley() -> Case {
    Case {
        name: "valley",
        problem: || Box::new(Valley { floor: 0.0, blocks: 1 }),
        start: vec![-0.5, -1.0, 0.9],
        bounds: Bounds::new(&[-1.0, -1.0, 0.1], &[1.0, 2.0, 1.0]).unwrap(),
        stop: Stop::default(),
        seed: 7,
        poison: healthy,
    }
}

/// Valley as two tasks of six rows.
fn two_blocks() -> Case {
    Case { name: "valley in two blocks", problem: || Box::new(Valley { floor: 0.0, blocks: 2 }), ..valley() }
}

/// Valley whose bottom does not count as solved.
fn bottomless() -> Case {
    Case { name: "valley above a floor", problem: || Box::new(Valley { floor: 1.0, blocks: 1 }), ..valley() }
}

fn arm() -> Case {
    let limits = |side: fn(&ikcore::robot::Joint) -> f64| ARM.joints().iter().map(side).collect::<Vec<_>>();
    Case {
        name: "pose of iiwa14",
        problem: || Box::new(Problem::new(&ARM, Aims::of_one(&TASK, &POSE))),
        start: vec![0.1; 7],
        bounds: Bounds::new(&limits(|joint| joint.lower), &limits(|joint| joint.upper)).unwrap(),
        ..valley()
    }
}

/// Arm with whole turns equivalent: solvers with a wrapped domain may search outside the limits.
fn turning_arm() -> Case {
    Case {
        name: "pose of iiwa14 up to whole turns",
        problem: || Box::new(Problem::new(&ARM, Aims::of_one(&TASK, &POSE)).disregarding_turns()),
        ..arm()
    }
}

/// All algorithms, alone and from many starts.
fn solvers() -> Vec<AnySolver> {
    let all = Algorithm::all().into_iter();
    all.flat_map(|algorithm| {
        [AnySolver::Single(algorithm.clone()), AnySolver::MultiStart(algorithm.into_multi_start())]
    })
    .collect()
}

/// Whether the solver solves the valley within the default budget. A bee moves along one coordinate at a time and crosses a
/// bent valley slowly; mutations shrink on a schedule, regardless of progress.
fn solves_the_valley(solver: &AnySolver) -> bool {
    !matches!(solver.algorithm(), Algorithm::DerivativeFree(DerivativeFree::BeeColony(_) | DerivativeFree::Genetic(_)))
}

/// Checks that the valley is solved or, by solvers without a guarantee, nearly.
fn check_valley(solver: &AnySolver, run: &Run) {
    if solves_the_valley(solver) {
        assert_eq!(run.status, Status::Solved, "{solver:?}: {:?}", run.best);
    } else {
        assert!(run.best.value < 1e-5, "{solver:?}: {:?}", run.best);
    }
}

/// Whether the solver's path depends on its seed even without a restart.
fn is_random(solver: &AnySolver) -> bool {
    matches!(solver, AnySolver::MultiStart(_) | AnySolver::Single(Algorithm::DerivativeFree(_)))
}

/// Whether the solver may look outside the box, where the objective repeats itself.
fn is_free(solver: &AnySolver) -> bool {
    matches!(solver.algorithm(), Algorithm::Apps(_))
}

struct Run {
    status: Status,
    iterations: usize,
    evaluations: usize,
    best: BestPoint,
    seen: Vec<f64>,
    values: Vec<f64>,
}

impl Case {
    fn with_stop(self, stop: Stop) -> Self {
        Self { stop, ..self }
    }

    fn run(&self, solver: &AnySolver) -> Run {
        self.run_watched(solver, &mut Unattended)
    }

    /// Runs the solver and checks the promises that hold in every case.
    fn run_watched(&self, solver: &AnySolver, monitor: &mut dyn Monitor) -> Run {
        let mut probe = Probe { inner: (self.problem)(), poison: self.poison, seen: vec![], values: vec![] };
        let mut rng = rng::stream(self.seed, 0);
        let objective: &mut dyn Differentiable = &mut probe;
        let mut evaluator = Evaluator::new(objective, &self.bounds, self.stop, &mut rng, monitor);
        let status = solver.run(&mut evaluator, &self.start);
        let (evaluations, iterations) = (evaluator.evaluations(), evaluator.iterations());
        let best = evaluator.best().clone();
        let run = Run { status, iterations, evaluations, best, seen: probe.seen, values: probe.values };
        let what = format!("{} by {solver:?}", self.name);
        run.check_points(self, is_free(solver), &what);
        run.check_best(self, &what);
        run.check_counts(self, &what);
        run
    }
}

impl Run {
    fn check_points(&self, case: &Case, is_free: bool, what: &str) {
        let repeats = is_free && (case.problem)().period(0).is_some();
        assert_eq!(self.seen[..case.start.len()], case.start, "{what}: the start comes first");
        for x in self.seen.chunks_exact(case.start.len()) {
            let admitted = repeats || case.bounds.contains(x);
            assert!(admitted && x.iter().all(|v| v.is_finite()), "{what}: {x:?} is outside the box");
        }
    }

    /// Checks that the best is the lowest finite value seen in the box, at the point where it was seen; without any, the start.
    fn check_best(&self, case: &Case, what: &str) {
        let BestPoint { x, value, solved } = &self.best;
        assert!(case.bounds.contains(x), "{what}: kept {x:?}, which is outside the box");
        let seen = self.seen.chunks_exact(x.len()).zip(&self.values);
        let inside = seen.filter(|(x, value)| case.bounds.contains(x) && value.is_finite());
        let lowest = inside.map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
        assert!(*value == lowest || *solved, "{what}: kept {value}, saw {lowest}");
        let at = self.values.iter().position(|v| v == value).unwrap_or(0);
        let seen = &self.seen[at * x.len()..(at + 1) * x.len()];
        assert_eq!(bits(x), bits(seen), "{what}: the best value belongs to another point");
        assert_eq!(*solved, self.status == Status::Solved, "{what}");
    }

    fn check_counts(&self, case: &Case, what: &str) {
        let Run { status, iterations, .. } = *self;
        let made = self.values.len();
        assert!(made <= case.stop.max_evaluations, "{what}: {made} evaluations");
        assert!(iterations <= case.stop.max_iterations, "{what}: {iterations} iterations");
        assert_eq!(made, self.evaluations, "{what}: evaluations made and reported");
        if status == Status::BudgetSpent {
            let spent = made == case.stop.max_evaluations || iterations == case.stop.max_iterations;
            assert!(spent, "{what}: gave up after {made} evaluations and {iterations} iterations");
        }
    }
}

#[test]
fn all_solve_the_valley_and_come_near_the_pose() {
    for solver in solvers() {
        check_valley(&solver, &valley().run(&solver));
        check_valley(&solver, &two_blocks().run(&solver));
        if matches!(solver, AnySolver::MultiStart(_)) {
            // Six rows at once are slow work for a beetle: the default budget brings it near, not there.
            for case in [arm, turning_arm] {
                let run = case().run(&solver);
                assert!(run.best.value < 1e-2, "{solver:?}: {:?}", run.best);
            }
        }
    }
}

#[test]
fn budgets_are_kept_to_the_last_evaluation() {
    for solver in solvers() {
        for case in [bottomless, two_blocks, arm, turning_arm] {
            for max_evaluations in [1, 2, 3, 4, 5, 7, 8, 9, 50, 151, 1000] {
                let run = case().with_stop(Stop { max_evaluations, ..Stop::default() }).run(&solver);
                let gave_up_before = run.evaluations < max_evaluations;
                let may = matches!(run.status, Status::Stalled | Status::Solved);
                assert!(!gave_up_before || may, "{solver:?}: {:?} after {}", run.status, run.evaluations);
            }
        }
    }
}

#[test]
fn iterations_are_limited() {
    for solver in solvers() {
        for max_iterations in [1, 2, 3] {
            let run = bottomless().with_stop(Stop { max_iterations, ..Stop::default() }).run(&solver);
            let Run { status, iterations, .. } = run;
            // The floor leaves a quadratic: Newton-Raphson is at its end after two.
            let ended_before = status == Status::Stalled && iterations < max_iterations;
            assert!(
                ended_before || (status, iterations) == (Status::BudgetSpent, max_iterations),
                "{solver:?}: {status:?}"
            );
        }
    }
}

#[test]
fn a_start_that_is_solved_is_returned_untouched() {
    for solver in solvers() {
        let run = Case { start: BOTTOM.to_vec(), ..valley() }.run(&solver);
        assert_eq!((run.status, run.iterations), (Status::Solved, 0), "{solver:?}");
        assert_eq!((run.evaluations, bits(&run.best.x)), (1, bits(&BOTTOM)), "{solver:?}");
    }
}

#[test]
fn nothing_finite_anywhere_leaves_the_start() {
    let poisons: [Poison; 3] = [|_, _| Some(f64::NAN), |_, _| Some(f64::INFINITY), |_, _| Some(f64::NEG_INFINITY)];
    for solver in solvers() {
        for poison in poisons {
            let stop = Stop { max_evaluations: 3000, ..Stop::default() };
            let run = Case { poison, ..arm().with_stop(stop) }.run(&solver);
            assert_eq!(bits(&run.best.x), bits(&[0.1; 7]), "{solver:?}");
            assert_eq!((run.best.value, run.best.solved), (f64::INFINITY, false), "{solver:?}");
        }
    }
}

#[test]
fn a_space_that_is_half_poisoned_is_still_searched() {
    for solver in solvers() {
        let run = Case { poison: |x, _| (x[0] < -0.6).then_some(f64::NAN), ..valley() }.run(&solver);
        check_valley(&solver, &run);
    }
}

#[test]
fn a_poisoned_start_is_left_by_those_that_draw() {
    for solver in solvers() {
        let poison: Poison = |_, number| (number == 0).then_some(f64::INFINITY);
        let run = Case { poison, ..valley() }.run(&solver);
        if is_random(&solver) {
            check_valley(&solver, &run);
        } else {
            assert_eq!(run.status, Status::Stalled, "{solver:?}");
        }
    }
}

#[test]
fn the_seed_decides_every_draw() {
    for solver in solvers() {
        let points = |seed| {
            let poison: Poison = |_, number| (number == 0).then_some(f64::NAN);
            let stop = Stop { max_evaluations: 500, ..Stop::default() };
            bits(&Case { seed, poison, ..valley().with_stop(stop) }.run(&solver).seen)
        };
        assert_eq!(points(1), points(1), "{solver:?}");
        assert_eq!(points(1) != points(2), is_random(&solver), "{solver:?}");
    }
}

#[test]
fn a_locked_entry_never_moves() {
    let bounds = Bounds::new(&[-1.0, -1.0, 0.3], &[1.0, 2.0, 0.3]).unwrap();
    for solver in solvers() {
        let case = Case { bounds: bounds.clone(), start: vec![-0.5, -1.0, 0.3], ..valley() };
        check_valley(&solver, &case.run(&solver));
    }
}

#[test]
fn a_box_of_one_point_holds_everybody() {
    let bounds = Bounds::new(&[0.0; 3], &[0.0; 3]).unwrap();
    for solver in solvers() {
        let stop = Stop { max_evaluations: 2000, ..Stop::default() };
        let run = Case { bounds: bounds.clone(), start: vec![0.0; 3], ..valley().with_stop(stop) }.run(&solver);
        assert!(matches!(run.status, Status::Stalled | Status::BudgetSpent), "{solver:?}: {:?}", run.status);
    }
}

#[test]
fn a_box_without_walls_is_searched_with_finite_points() {
    let (minus, plus) = (f64::NEG_INFINITY, f64::INFINITY);
    for (lower, upper) in [([minus; 3], [plus; 3]), ([minus, -3.0, minus], [3.0, plus, plus])] {
        for solver in solvers() {
            let case = Case { bounds: Bounds::new(&lower, &upper).unwrap(), ..valley() };
            check_valley(&solver, &case.run(&solver));
        }
    }
}

/// Monitor that lets the run continue `left` more times.
struct Countdown {
    left: usize,
    asked_in_vain: usize,
}

impl Monitor for Countdown {
    fn keep_going(&mut self) -> bool {
        if self.left == 0 {
            self.asked_in_vain += 1;
            return false;
        }
        self.left -= 1;
        true
    }
}

#[test]
fn a_monitor_that_says_stop_is_obeyed_at_once() {
    for solver in solvers() {
        for left in [0, 1, 3] {
            let mut monitor = Countdown { left, asked_in_vain: 0 };
            let run = bottomless().run_watched(&solver, &mut monitor);
            if run.status == Status::Stalled && run.values.len() < POLL {
                continue; // over before anybody could ask
            }
            assert_eq!(run.status, Status::Interrupted, "{solver:?}");
            assert!(run.values.len() <= (left + 1) * POLL, "{solver:?}: {} evaluations", run.values.len());
            assert_eq!(monitor.asked_in_vain, 1, "{solver:?}");
        }
    }
}

#[test]
fn no_time_ends_the_run_at_the_first_look_at_the_clock() {
    for solver in solvers() {
        let run = bottomless().with_stop(Stop { max_time: Some(Duration::ZERO), ..Stop::default() }).run(&solver);
        assert!(matches!(run.status, Status::TimeUp | Status::Stalled), "{solver:?}: {:?}", run.status);
        assert!(run.values.len() <= POLL, "{solver:?}: {} evaluations", run.values.len());
    }
}

#[test]
fn a_value_below_the_asked_one_is_enough() {
    for solver in solvers() {
        let run = valley().with_stop(Stop { value_below: Some(0.001), ..Stop::default() }).run(&solver);
        // One whose last step went all the way has solved it.
        let expected = if run.best.solved { Status::Solved } else { Status::Improved };
        assert_eq!(run.status, expected, "{solver:?}");
        assert!(run.best.value < 0.001, "{solver:?}: {:?}", run.best);
        // The start is below it: one step is made all the same.
        let run = bottomless().with_stop(Stop { value_below: Some(1e9), ..Stop::default() }).run(&solver);
        assert_eq!((run.status, run.iterations), (Status::Improved, 1), "{solver:?}");
    }
}
