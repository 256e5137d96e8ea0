//! The published search, and what both planners say of themselves.

use crate::error::Error;
use crate::planning::search::Search;
use crate::solver::{AnySolver, BeetleSwarm, DerivativeFree, Schedule, Stop};

/// The method, in messages.
pub(super) const METHOD: &str = "method=\"tpbso\"";

/// The search for a decision vector: as published, but for what is given.
pub(super) fn search(solver: Option<&AnySolver<DerivativeFree>>, stop: Option<Stop>, seed: u64) -> Search {
    Search {
        solver: solver.cloned().unwrap_or_else(published_swarm),
        stop: stop.unwrap_or_else(published_budget),
        seed,
    }
}

/// The beetle swarm, for as long as its budget lasts: the published one does not stop when it stalls.
fn published_swarm() -> AnySolver<DerivativeFree> {
    let swarm = BeetleSwarm::default();
    let schedule = Schedule { stall_generations: usize::MAX, ..swarm.schedule };
    AnySolver::Single(BeetleSwarm { schedule, ..swarm }.into())
}

/// 50 beetles that evaluate both antennae and their new place, 200 times, and where they start.
fn published_budget() -> Stop {
    Stop { max_evaluations: 50 * (3 * 200 + 1), ..Stop::default() }
}

/// The error of a search that met no vector with a configuration: its budget was of a few vectors, or the free links rarely
/// leave the other two a solution.
pub(super) fn no_configuration(what: &str) -> Error {
    let problem = "the search met no configuration that reaches it: raise the budget in stop=Stop(...)".into();
    Error::Unreachable { what: what.into(), problem }
}
