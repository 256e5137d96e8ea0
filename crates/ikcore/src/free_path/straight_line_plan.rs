//! Plans without obstacles: the best of the straight lines between pairs of configurations.

use super::end_pair::EndPair;
use super::pair_search::PairSearch;
use crate::error::{Error, Result};
use crate::plan::{Cost, Improvement, Plan};
use crate::solver::{Monitor, Status};
use crate::timing::ConstantLimits;
use crate::trajectory::Trajectory;

/// Number of pairs from random starts; as many come from the quickest branches.
pub(super) const PAIRS: usize = 8;

/// Plans the best straight motion between pairs.
pub(super) fn without_obstacles(search: &mut PairSearch, objective: Cost, monitor: &mut dyn Monitor) -> Result<Plan> {
    let pairs = search.pairs(PAIRS, monitor)?;
    let mut best: Option<(f64, usize, Trajectory)> = None;
    let mut history = vec![];
    for pair in &pairs {
        let trajectory = straight(pair, search.limits)?;
        let cost = objective.of(search.robot, &trajectory);
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            history.push(Improvement { evaluations: search.evaluations, cost });
            best = Some((cost, pair.chosen, trajectory));
        }
    }
    let (_, chosen, trajectory) = best.ok_or_else(no_pair)?;
    let plan = Plan { history, chosen_end: Some(chosen), ..search.plan(trajectory, objective) };
    let status = if plan.violations.is_empty() { Status::Solved } else { Status::Stalled };
    Ok(Plan { status, ..plan })
}

/// Returns the quicker of a quintic and a motion at constant velocity between blends.
pub(super) fn straight(pair: &EndPair, limits: &ConstantLimits) -> Result<Trajectory> {
    pair.require_motion()?;
    Ok(pair.line().fastest(limits, &[1.0, 1.0])?.motion)
}

/// The error of a search that found no configuration for an end.
pub(super) fn no_pair() -> Error {
    Error::Unreachable { what: "end".into(), problem: "no configuration was found: try another seed".into() }
}
