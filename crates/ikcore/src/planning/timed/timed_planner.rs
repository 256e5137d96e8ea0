//! The planner: corners, the search for postures, the timing of the best.

use super::interpolation::{Interpolation, JointWaypoints};
use super::nominal_motions::NominalMotions;
use super::path_problem::{PathMotion, PathProblem};
use super::redundant_motion::RedundantMotion;
use super::timed_cost::TimedCost;
use crate::error::{Error, Result};
use crate::objective::{Objective, Point};
use crate::planning::deviation::TipDeviation;
use crate::planning::search::{Search, SearchResult};
use crate::planning::{AlongPathOptions, Plan};
use crate::solver::{AnySolver, DifferentialEvolution, Monitor, Schedule, Status, Stop};

/// Evaluations of the search; more shorten the motion by less than 1 %.
const EVALUATIONS: usize = 2000;

/// Population size of the search.
const POPULATION: usize = 30;

/// Plans along a path, around the best of a few motions that follow it; `None` where each of these ends on the way.
///
/// # Errors
/// As [`plan_along_path`](crate::planning::plan_along_path).
pub(in crate::planning) fn along_path(problem: &PathProblem<'_>, monitor: &mut dyn Monitor) -> Result<Option<Plan>> {
    let PathProblem { robot, tip_path, options, .. } = problem;
    let mut nominal: Option<(Plan, Interpolation<'_>, JointWaypoints)> = None;
    for waypoints in NominalMotions::new(problem).all()? {
        let (interpolation, waypoints) = problem.corners_of(&waypoints, problem.accuracy)?;
        let plan = problem.plan(problem.motion(&interpolation, waypoints.clone(), problem.accuracy)?, None);
        if nominal.as_ref().is_none_or(|(best, ..)| is_better(&plan, best)) {
            nominal = Some((plan, interpolation, waypoints));
        }
    }
    let Some((nominal, interpolation, waypoints)) = nominal else { return Ok(None) };
    let motion = RedundantMotion::around(robot, tip_path, waypoints, options.start.is_some());
    let mut cost = TimedCost::new(problem, motion, interpolation);
    let Some(found) = search(&mut cost, options, EVALUATIONS, monitor)? else { return Ok(Some(nominal)) };
    let (waypoints, _) = cost.waypoints(&found.x);
    let motion = problem.motion(&cost.interpolation, waypoints, problem.accuracy)?;
    let nominal = problem.after(found.clone(), nominal);
    let plan = problem.plan(motion, Some(found));
    Ok(Some(if is_better(&nominal, &plan) { nominal } else { plan }))
}

/// Whether a plan keeps everything, and the other one does not or costs more.
fn is_better(plan: &Plan, other: &Plan) -> bool {
    plan.violations.is_empty() && (!other.violations.is_empty() || plan.cost < other.cost)
}

impl PathProblem<'_> {
    /// Whether the tip of a motion is farther off the path than its accuracy.
    pub(in crate::planning) fn leaves_path(&self, motion: &PathMotion) -> bool {
        let PathMotion { waypoints, path, .. } = motion;
        let configurations = |share: f64, q: &mut [f64]| path.position(share, q);
        let tip = TipDeviation { robot: &self.robot, tip_path: self.tip_path, configurations };
        tip.largest(&waypoints.knots).violations(self.tip_path, self.accuracy).next().is_some()
    }

    /// The plan of a motion that a search has `found`; `None` if there was nothing to search.
    pub(in crate::planning) fn plan(
        &self,
        motion: PathMotion,
        found: Option<SearchResult>,
    ) -> Plan {
        let Self { robot, tip_path, options, .. } = self;
        let PathMotion { waypoints, stretches, path, trajectory } = motion;
        let configurations = |share: f64, q: &mut [f64]| path.position(share, q);
        let deviation = TipDeviation { robot, tip_path, configurations }.largest(&waypoints.knots);
        let mut violations = self.limits.violations(&trajectory);
        violations.extend(deviation.violations(tip_path, self.accuracy));
        let keeps_everything = violations.is_empty();
        let plan = Plan {
            objective: options.objective,
            cost: options.objective.of(robot, &trajectory),
            clearance: None,
            nearest: None,
            obstruction: None,
            surroundings: None,
            chosen_end: None,
            freed: None,
            accuracy: Some(deviation.distance.value),
            reference: Some(tip_path.positions().to_vec()),
            redundancy: vec![],
            path: stretches,
            peak: None,
            violations,
            status: if keeps_everything { Status::Solved } else { Status::Stalled },
            evaluations: 1,
            history: vec![],
            elapsed: self.stopwatch.elapsed(),
            trajectory,
        };
        match found {
            Some(found) => self.after(found, plan),
            None => plan,
        }
    }

    /// A plan after a search that may have found it.
    fn after(&self, found: SearchResult, plan: Plan) -> Plan {
        Plan {
            status: found.status(plan.violations.is_empty()),
            evaluations: found.evaluations,
            history: found.history,
            elapsed: self.stopwatch.elapsed(),
            ..plan
        }
    }
}

/// Runs the search, with a default budget of `evaluations`; `None` if the arm is not redundant.
///
/// # Errors
/// [`Error::Contradiction`] for a solver without anything to search; those of the solver's options.
pub(in crate::planning) fn search(
    cost: &mut TimedCost<'_>,
    options: &AlongPathOptions,
    evaluations: usize,
    monitor: &mut dyn Monitor,
) -> Result<Option<SearchResult>> {
    let Some(bounds) = cost.bounds() else {
        return match &options.solver {
            None => Ok(None),
            Some(_) => Err(Error::Contradiction {
                problem: "solver searches the redundancy of the arm, but on this path it has none: leave solver out"
                    .into(),
            }),
        };
    };
    let schedule = Schedule::of(POPULATION);
    let evolution = || AnySolver::Single(DifferentialEvolution { schedule, ..DifferentialEvolution::default() }.into());
    let search = Search {
        solver: options.solver.clone().unwrap_or_else(evolution),
        stop: options.stop.unwrap_or(Stop { max_evaluations: evaluations, ..Stop::default() }),
        seed: options.seed,
        // The nominal motion: nothing worse is returned.
        start: Some(Point::from_elem(0.0, cost.dimension())),
    };
    search.run(cost, &bounds, monitor).map(Some)
}
