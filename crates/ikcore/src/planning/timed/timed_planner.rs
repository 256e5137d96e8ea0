//! The planner: corners, the search for postures, the timing of the best.

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

/// Plans along a path, around the shortest motion that follows it from a few starts; `None` where each of these ends on the way.
///
/// # Errors
/// As [`plan_along_path`](crate::planning::plan_along_path).
pub(in crate::planning) fn along_path(problem: &PathProblem<'_>, monitor: &mut dyn Monitor) -> Result<Option<Plan>> {
    let PathProblem { robot, tip_path, options, .. } = problem;
    let Some(mut motion) = RedundantMotion::new(robot, tip_path, options.start.as_deref(), options.seed)? else {
        return Ok(None);
    };
    let (interpolation, waypoints) = problem.corners_of(motion.nominal(), problem.accuracy)?;
    motion.take(waypoints);
    let mut cost = TimedCost::new(problem, motion, interpolation);
    let found = search(&mut cost, options, EVALUATIONS, monitor)?;
    let mut plan_of = |z: &[f64]| {
        let (waypoints, _) = cost.waypoints(z);
        let motion = problem.motion(&cost.interpolation, waypoints, problem.accuracy)?;
        Ok::<_, Error>(problem.plan(motion, found.clone()))
    };
    let nominal = plan_of(&vec![0.0; found.as_ref().map_or(0, |found| found.x.len())])?;
    match &found {
        None => Ok(Some(nominal)),
        Some(found) => Ok(Some(better(plan_of(&found.x)?, nominal))),
    }
}

/// The plan of the search, or the nominal one where that is quicker after all: the search times a motion only roughly.
fn better(found: Plan, nominal: Plan) -> Plan {
    let is_better = nominal.violations.is_empty() && (!found.violations.is_empty() || nominal.cost < found.cost);
    if is_better { nominal } else { found }
}

impl PathProblem<'_> {
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
        Plan {
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
            status: match &found {
                Some(found) => found.status(keeps_everything),
                None if keeps_everything => Status::Solved,
                None => Status::Stalled,
            },
            evaluations: found.as_ref().map_or(1, |found| found.evaluations),
            history: found.map_or_else(Vec::new, |found| found.history),
            elapsed: self.stopwatch.elapsed(),
            trajectory,
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
