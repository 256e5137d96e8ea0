//! Reading of the arguments that `track` and `Tracker` share.

use ikcore::constraint::Keep;
use ikcore::limits::{LimitAt, Limits};
use ikcore::obstacle::Surroundings;
use ikcore::task::{Task, Tolerance};
use ikcore::tracking::{TickRule, TrackOptions};
use pyo3::prelude::*;

use super::weighted_pseudo_inverse::PyWeightedPseudoInverse;
use crate::convert::{count, summary};
use crate::error::{invalid, raise};
use crate::goal::read_goals;
use crate::solver::{known_solver, solver_names};
use crate::start_gate::read_slack;

/// Arguments of `track` and `Tracker` as given. The rule is read beforehand: it decides how a path is sampled.
pub struct TrackArguments<'a, 'py> {
    pub rule: TickRule,
    /// Task and tolerance of the only tip; the tasks of several tips are passed separately.
    pub only: (Option<Task>, Tolerance),
    pub goals: Option<&'a Bound<'py, PyAny>>,
    /// Weights of the joints, as read.
    pub joint_weights: Option<Vec<f64>>,
    pub surroundings: Surroundings,
    pub keeps: Vec<Keep>,
    pub recover: bool,
    pub seed: i128,
    pub limit_at: &'a str,
    pub start_slack: Option<&'a Bound<'py, PyAny>>,
}

impl TrackArguments<'_, '_> {
    /// Converts the arguments to options of the core, with the `limits` of the call.
    pub fn read(self, limits: Option<Limits>) -> PyResult<TrackOptions> {
        let (task, tolerance) = self.only;
        Ok(TrackOptions {
            rule: self.rule,
            task,
            goals: read_goals(self.goals)?,
            joint_weights: self.joint_weights,
            tolerance,
            limits,
            surroundings: self.surroundings,
            keeps: self.keeps,
            ease: false,
            start_slack: read_slack(self.start_slack)?,
            recover: self.recover,
            limit_at: self.limit_at.parse::<LimitAt>().map_err(raise)?,
            seed: count("seed", self.seed)?,
            ..TrackOptions::default()
        })
    }
}

/// Reads the `solver` argument: a tick rule, a solver, or None for the model-based rule.
pub fn tick_rule(solver: Option<&Bound<'_, PyAny>>) -> PyResult<TickRule> {
    let Some(solver) = solver else { return Ok(TickRule::default()) };
    if let Ok(rule) = solver.cast::<PyWeightedPseudoInverse>() {
        return Ok(rule.get().rule());
    }
    known_solver(solver).map(TickRule::Solver).ok_or_else(|| {
        let (names, got) = (solver_names(), summary(solver));
        invalid(format!("solver must be {names} or WeightedPseudoInverse, got {got}"))
    })
}
