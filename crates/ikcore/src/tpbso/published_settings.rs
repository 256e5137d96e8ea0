//! Settings and messages shared by both planners.

use crate::error::Error;
use crate::message::{Setting, message};
use crate::plan::Search;
use crate::solver::{AnySolver, BeetleSwarm, DerivativeFree, Schedule, Stop};

/// Name of the method in messages.
pub(super) const METHOD: Setting = Setting::Method("tpbso");

/// The search for a decision vector: as published, except for the given arguments.
pub(super) fn search(solver: Option<&AnySolver<DerivativeFree>>, stop: Option<Stop>, seed: u64) -> Search {
    Search {
        solver: Some(solver.cloned().unwrap_or_else(published_swarm)),
        stop: stop.unwrap_or_else(published_budget),
        seed,
        start: None,
    }
}

/// The beetle swarm, which runs until its budget is spent: the published one does not stop when it stalls.
fn published_swarm() -> AnySolver<DerivativeFree> {
    let swarm = BeetleSwarm::default();
    let schedule = Schedule { stall_generations: usize::MAX, ..swarm.schedule };
    AnySolver::Single(BeetleSwarm { schedule, ..swarm }.into())
}

/// 50 beetles that evaluate both antennae and their new position, 200 times, plus their initial positions.
fn published_budget() -> Stop {
    Stop { max_evaluations: 50 * (3 * 200 + 1), ..Stop::default() }
}

/// The error of a search that found no vector with a configuration: its budget was too small, or the free links rarely
/// leave a solution to the other two.
pub(super) fn no_configuration(what: &str) -> Error {
    let problem = message!["the search met no configuration that reaches it: raise the ", Setting::Budget];
    Error::Unreachable { what: what.into(), problem }
}
