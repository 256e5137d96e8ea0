//! Tick rule that runs any solver from the accepted configuration in the box of the tick.

use super::tick::{Tick, TickResult};
use crate::objective::Differentiable;
use crate::problem::Problem;
use crate::solver::{AnySolver, Evaluator, Status, Stop};
use crate::task::{Aims, Criterion, Outside};
use crate::tracking::step_context::StepContext;

pub(super) fn advance(solver: &AnySolver, tick: Tick<'_>) -> TickResult {
    let Tick { context, target, criterion, rng, monitor, .. } = tick;
    let StepContext { robot, q, tick_box, last_value, .. } = context;
    // The arm starts inside its region, so points outside need not be considered.
    let kept = Criterion { outside: Outside::Infinite, ..*criterion }.into();
    let mut problem = Problem::new(robot, Aims::of_one(&kept, target));
    let objective: &mut dyn Differentiable = &mut problem;
    let mut evaluator = Evaluator::new(objective, &tick_box.bounds, stop(solver, last_value), rng, monitor);
    let status = solver.run(&mut evaluator, q);
    let best = evaluator.best().x.clone();
    TickResult {
        assessment: target.assess(robot, &best, criterion),
        position: robot.tip_position(&best),
        q: best,
        evaluations: evaluator.evaluations(),
        iterations: evaluator.iterations(),
        interrupted: status == Status::Interrupted,
    }
}

/// Stop criteria of the search in a tick. Solvers that end by themselves have no evaluation budget.
fn stop(solver: &AnySolver, last_value: Option<f64>) -> Stop {
    let standard = Stop::default();
    Stop {
        // Line 16 of Algorithm 1: a random search may end the tick once it beats the previous one.
        value_below: if solver.settles_for_improvement() { last_value } else { None },
        max_evaluations: if solver.ends_by_itself() { usize::MAX } else { standard.max_evaluations },
        // Lines 5 to 15 come before line 16: an arm that waits until it is out of its band would move in jerks.
        min_iterations: 1,
        ..standard
    }
}
