//! A complete solver: random search, applied to the tip position of an arm. `cargo run --example random_search`.

use ikcore::objective::{Bounds, Objective, Point};
use ikcore::rng;
use ikcore::solver::{Evaluator, Solver, Status, Stop, Unattended, run};

/// Draws points uniformly from the box: a baseline for all other solvers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomSearch {
    /// Draws per iteration.
    pub draws: usize,
}

/// Storage for the point drawn.
#[derive(Debug, Clone, Default)]
pub struct State {
    x: Point,
}

impl<O: Objective + ?Sized> Solver<O> for RandomSearch {
    type State = State;

    fn start(
        &self,
        State { x }: &mut State,
        evaluator: &mut Evaluator<'_, O>,
        x0: &[f64],
    ) -> Result<(), Status> {
        *x = Point::from_slice(x0);
        evaluator.evaluate(x)?;
        Ok(())
    }

    fn step(
        &self,
        State { x }: &mut State,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<(), Status> {
        let bounds = evaluator.bounds();
        for _ in 0..self.draws {
            for (x, (lower, upper)) in
                x.iter_mut().zip(bounds.lower().iter().zip(bounds.upper()))
            {
                *x = lower + (upper - lower) * evaluator.rng().uniform();
            }
            evaluator.evaluate(x)?;
        }
        Ok(())
    }
}

/// The squared distance of a planar arm's tip from (0.9, 0.6) m; its links are 0.5 m long.
struct Reach;

impl Objective for Reach {
    fn dimension(&self) -> usize {
        3
    }

    fn evaluate(&mut self, x: &[f64]) -> ikcore::objective::Score {
        let (mut angle, mut tip) = (0.0, [0.0, 0.0]);
        for joint in x {
            angle += joint;
            tip = [tip[0] + 0.5 * f64::cos(angle), tip[1] + 0.5 * f64::sin(angle)];
        }
        let value = (tip[0] - 0.9).powi(2) + (tip[1] - 0.6).powi(2);
        ikcore::objective::Score { value, solved: value <= 1e-4 }
    }
}

fn main() -> ikcore::Result<()> {
    let bounds = Bounds::new(&[-3.0; 3], &[3.0; 3])?;
    let (mut objective, mut rng, mut monitor) =
        (Reach, rng::stream(0, 0), Unattended);
    let stop = Stop { max_evaluations: 100_000, ..Stop::default() };
    let mut evaluator =
        Evaluator::new(&mut objective, &bounds, stop, &mut rng, &mut monitor);
    let status = run(&RandomSearch { draws: 100 }, &mut evaluator, &[0.0; 3]);
    let best = evaluator.best();
    println!(
        "{status:?} after {} evaluations: value {:.2e} at {:.3?}",
        evaluator.evaluations(),
        best.value,
        best.x
    );
    Ok(())
}
