//! Cost of the solvers per evaluation: on a sphere in seven dimensions, where nearly all of it is the solver's own, and on
//! positions of a 7-joint arm. Populations of 40; no run ends before its budget.

use std::time::Duration;

use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime};
use ikcore::objective::{
    Bounds, Differentiable, Gradient, LeastSquares, Linearization, Objective, Residual, Score, SmoothScore,
    TaskResiduals,
};
use ikcore::problem::Problem;
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{
    Algorithm, AnySolver, Bas, BasVariant, BeeColony, BeetleSwarm, DifferentialEvolution, Evaluator, Firefly, Genetic,
    Pso, PsoForm, Qpso, Schedule, Stop, Unattended,
};
use ikcore::task::{Aims, Target, Tolerance};

const EVALUATIONS: usize = 20_000;
const POPULATION: usize = 40;

struct Sphere;

impl Objective for Sphere {
    fn dimension(&self) -> usize {
        7
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        // Value zero is never reached, so that no population comes to rest.
        Score { value: x.iter().map(|x| (x - 0.7) * (x - 0.7)).sum(), solved: false }
    }
}

/// Problem that never counts as solved.
struct Unsolved<'a>(Problem<'a>);

impl Objective for Unsolved<'_> {
    fn dimension(&self) -> usize {
        self.0.dimension()
    }

    fn evaluate(&mut self, x: &[f64]) -> Score {
        Score { solved: false, ..self.0.evaluate(x) }
    }

    fn evaluate_all(&mut self, xs: &[f64], out: &mut [Score]) {
        self.0.evaluate_all(xs, out);
        out.iter_mut().for_each(|score| score.solved = false);
    }
}

impl Residual for Sphere {
    fn residual(&mut self, x: &[f64], _: &mut TaskResiduals) -> Score {
        self.evaluate(x)
    }
}

impl Residual for Unsolved<'_> {
    fn residual(&mut self, x: &[f64], out: &mut TaskResiduals) -> Score {
        Score { solved: false, ..self.0.residual(x, out) }
    }
}

impl LeastSquares for Sphere {
    fn linearize(&mut self, x: &[f64], _: &mut Linearization) -> Score {
        self.evaluate(x)
    }
}

impl LeastSquares for Unsolved<'_> {
    fn linearize(&mut self, x: &[f64], out: &mut Linearization) -> Score {
        Score { solved: false, ..self.0.linearize(x, out) }
    }
}

impl Gradient for Sphere {
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore {
        gradient.iter_mut().zip(x).for_each(|(slope, x)| *slope = x - 0.7);
        let score = self.evaluate(x);
        SmoothScore { error: 0.5 * score.value, score }
    }
}

impl Gradient for Unsolved<'_> {
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore {
        let SmoothScore { error, score } = self.0.differentiate(x, gradient);
        SmoothScore { error, score: Score { solved: false, ..score } }
    }
}

fn swarms() -> Vec<(&'static str, Algorithm)> {
    let schedule = Schedule { stall_generations: usize::MAX, ..Schedule::of(POPULATION) };
    let bas = |variant| Bas { max_passes: usize::MAX, ..Bas::of(variant) };
    vec![
        ("PSO constriction", Pso { schedule, ..Pso::default() }.into()),
        ("PSO inertia", Pso { schedule, ..Pso::of(PsoForm::Inertia(0.729)) }.into()),
        ("QPSO", Qpso { schedule, ..Qpso::default() }.into()),
        ("beetle swarm", BeetleSwarm { schedule, ..BeetleSwarm::default() }.into()),
        ("bee colony", BeeColony { schedule, ..BeeColony::default() }.into()),
        ("firefly", Firefly { schedule, ..Firefly::default() }.into()),
        ("genetic", Genetic { schedule, ..Genetic::default() }.into()),
        ("differential evolution", DifferentialEvolution { schedule, ..DifferentialEvolution::default() }.into()),
        ("BAS star", bas(BasVariant::Star).into()),
        ("BAS chain", bas(BasVariant::Chain).into()),
        ("BAS greedy", bas(BasVariant::Greedy).into()),
    ]
}

/// Spends the whole budget.
fn spend(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, solver: Algorithm, problem: &mut dyn Differentiable) {
    let bounds = Bounds::new(&[-2.0; 7], &[2.5; 7]).expect("a box");
    let solver = AnySolver::Single(solver);
    let stop = Stop { max_evaluations: EVALUATIONS, ..Stop::default() };
    group.throughput(Throughput::Elements(EVALUATIONS as u64));
    group.bench_function(name, |b| {
        b.iter(|| {
            let (mut rng, mut monitor) = (rng::stream(1, 0), Unattended);
            let mut evaluator = Evaluator::new(&mut *problem, &bounds, stop, &mut rng, &mut monitor);
            solver.run(&mut evaluator, &[0.1; 7]);
            assert_eq!(evaluator.evaluations(), EVALUATIONS, "{name} ended early");
        });
    });
}

fn sphere(c: &mut Criterion) {
    let mut group = c.benchmark_group("sphere, per evaluation");
    for (name, solver) in swarms() {
        spend(&mut group, name, solver, &mut Sphere);
    }
}

fn iiwa14(c: &mut Criterion) {
    let robot = Robot::named("iiwa14").expect("a built-in robot");
    let target = Target::Position([0.4, 0.3, 0.8]);
    let task = Tolerance::default().into();
    let mut problem = Unsolved(Problem::new(&robot, Aims::of_one(&task, &target)));
    let mut group = c.benchmark_group("position of iiwa14, per evaluation");
    for (name, solver) in swarms() {
        spend(&mut group, name, solver, &mut problem);
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = sphere, iiwa14
}
criterion_main!(benches);
