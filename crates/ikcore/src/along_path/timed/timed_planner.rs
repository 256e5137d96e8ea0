//! The planner: corners, the search for postures, the timing of the best.

use super::interpolation::{Interpolation, JointWaypoints};
use super::nominal_motions::{NominalMotion, NominalMotions};
use super::null_space_offsets::NullSpaceOffsets;
use super::path_problem::{FollowedPath, PathProblem, SlowCorners};
use super::timed_cost::TimedCost;
use crate::along_path::deviation::deviation_on;
use crate::error::{Error, Result};
use crate::objective::{Objective, Point};
use crate::plan::{AlongPathOptions, Cost, Plan, Search, SearchResult};
use crate::solver::{Monitor, Status, Stop};

/// Most evaluations of the search: pattern search mostly ends by itself after 100 to 250, another solver uses them all.
const EVALUATIONS: usize = 2000;

/// A motion is not timed if its rough duration exceeds that of the best one by this factor: both are too long, or too short where torques
/// limit the motion, by about as much.
const HOPELESS: f64 = 1.05;

/// The same factor for a motion that is shortened within the whole tolerance band, before parts of the band are tried.
const PROMISING: f64 = 1.25;

/// Saving of all finer grids of the timing, as a multiple of that of the last halving: measured 1.0 to 1.2.
const STILL_SAVED: f64 = 1.5;

/// Least number of waypoints for that.
const MANY: usize = 300;

/// The part of the duration that halving saves on a grid that is fine enough to tell.
const TELLING: f64 = 0.01;

/// Plans along a path, around motions that follow it; `None` where each of these ends on the way.
///
/// # Errors
/// As [`plan_along_path`](crate::planning::plan_along_path).
pub(crate) fn along_path(problem: &PathProblem<'_>, monitor: &mut dyn Monitor) -> Result<Option<Plan>> {
    let mut motions = NominalMotions::new(problem);
    let mut timed = TimedCandidates::new(problem);
    timed.add(motions.all()?)?;
    for base in timed.promising_bases() {
        timed.add(motions.within_parts(base)?)?;
    }
    let TimedCandidates { candidates, refused, .. } = timed;
    let mut candidates = candidates.into_iter();
    let Some(widest) = candidates.next() else { return refused.map_or(Ok(None), Err) };
    // The shortest motion is not always the quickest, nor the quickest one after the search.
    match candidates.reduce(|first, other| if is_better(&other.plan, &first.plan) { other } else { first }) {
        Some(other) if is_better(&other.plan, &widest.plan) => {
            let (plan, found) = widest.improved(problem, 2, monitor)?;
            let (another, later) = other.improved(problem, 2, monitor)?;
            let found = found.zip(later).map(|(found, later)| found.then(later));
            Ok(Some(problem.after(found, if is_better(&another, &plan) { another } else { plan })))
        }
        _ => {
            let (plan, found) = widest.improved(problem, 1, monitor)?;
            Ok(Some(problem.after(found, plan)))
        }
    }
}

/// The motions along the path that are timed.
struct TimedCandidates<'p> {
    problem: &'p PathProblem<'p>,
    candidates: Vec<Candidate<'p>>,
    /// Unshortened motions of which only the widest shortening is timed, and how long that roughly takes (s).
    bases: Vec<(f64, JointWaypoints)>,
    /// Alternatives at corners that are not worth trying on further motions.
    slow: SlowCorners,
    /// The least cost of those that keep everything, and its rough duration (s): rough ones compare with each other.
    least: f64,
    rough_least: f64,
    /// The reason why joints cannot hold the arm on the first motion that is refused for it.
    refused: Option<Error>,
}

impl<'p> TimedCandidates<'p> {
    fn new(problem: &'p PathProblem<'p>) -> Self {
        let (slow, least) = (SlowCorners::default(), f64::INFINITY);
        Self { problem, candidates: vec![], bases: vec![], slow, least, rough_least: least, refused: None }
    }

    /// Times motions, but none that is hopeless beside another one.
    ///
    /// # Errors
    /// Those of [`PathProblem::corners_of`] and [`PathProblem::motion`].
    fn add(&mut self, motions: Vec<NominalMotion>) -> Result<()> {
        let problem = self.problem;
        for Nominal { roughly, interpolation, waypoints, base } in nominals(problem, motions, &mut self.slow)? {
            let base = base.filter(|_| problem.options.objective == Cost::Time);
            self.bases.extend(base.map(|base| (roughly, base)));
            if roughly > HOPELESS * self.rough_least
                || stays_slower(problem, (roughly, self.least), &interpolation, &waypoints)?
            {
                continue;
            }
            match problem.motion_if_held(&interpolation, waypoints.clone())? {
                Ok(motion) => {
                    let plan = problem.plan(motion);
                    if plan.violations.is_empty() && plan.cost < self.least {
                        (self.least, self.rough_least) = (plan.cost, roughly);
                    }
                    self.candidates.push(Candidate { plan, interpolation, waypoints });
                }
                Err(heavy) => _ = self.refused.get_or_insert(heavy),
            }
        }
        Ok(())
    }

    /// Takes the unshortened motions that may be the quickest in part of the tolerance band: a wide one is not always
    /// used well.
    fn promising_bases(&mut self) -> Vec<JointWaypoints> {
        let most = PROMISING * self.rough_least;
        let bases = std::mem::take(&mut self.bases).into_iter();
        bases.filter_map(|(roughly, base)| (roughly <= most).then_some(base)).collect()
    }
}

/// A motion along the path that is timed only roughly.
struct Nominal<'p> {
    /// Duration (s), or zero where the duration is not what a plan costs.
    roughly: f64,
    interpolation: Interpolation<'p>,
    waypoints: JointWaypoints,
    base: Option<JointWaypoints>,
}

/// Times motions roughly: the first comes first, the others by their duration.
fn nominals<'p>(
    problem: &'p PathProblem<'p>,
    motions: Vec<NominalMotion>,
    slow: &mut SlowCorners,
) -> Result<Vec<Nominal<'p>>> {
    let of = |NominalMotion { waypoints, base }| {
        let (interpolation, waypoints, duration) =
            problem.quick_corners_of(&waypoints, problem.accuracy, true, slow)?;
        let roughly = if problem.options.objective == Cost::Time { duration } else { 0.0 };
        Ok(Nominal { roughly, interpolation, waypoints, base })
    };
    let mut all: Vec<Nominal<'p>> = motions.into_iter().map(of).collect::<Result<_>>()?;
    let others = all.get_mut(1..).unwrap_or_default();
    others.sort_by(|one, other| one.roughly.total_cmp(&other.roughly));
    Ok(all)
}

/// Whether a motion would take longer than the `least` duration of a plan on finer grids too, by what halving its grid saved. That is not
/// known under jerk limits, nor of few waypoints, which are timed at once anyway.
fn stays_slower(
    problem: &PathProblem<'_>,
    (roughly, least): (f64, f64),
    interpolation: &Interpolation<'_>,
    waypoints: &JointWaypoints,
) -> Result<bool> {
    let is_known = waypoints.knots.len() >= MANY && !problem.limits.limit_jerk();
    if roughly <= least || !is_known {
        return Ok(false);
    }
    let saved = problem.coarser_duration(interpolation, waypoints)? - roughly;
    Ok((0.0..TELLING * roughly).contains(&saved) && roughly - STILL_SAVED * saved > least)
}

/// A motion along the path to search around, and its plan.
struct Candidate<'p> {
    plan: Plan,
    interpolation: Interpolation<'p>,
    waypoints: JointWaypoints,
}

impl<'p> Candidate<'p> {
    /// Returns the best plan of a search around this one, with the budget divided by the number of `searches`.
    fn improved(
        self,
        problem: &'p PathProblem<'p>,
        searches: u32,
        monitor: &mut dyn Monitor,
    ) -> Result<(Plan, Option<SearchResult>)> {
        let PathProblem { robot, options, .. } = problem;
        let tip_path = self.interpolation.tip_path;
        let motion = NullSpaceOffsets::around(robot, tip_path, problem.keeps, self.waypoints, options.start.is_some());
        let mut cost = TimedCost::new(problem, motion, self.interpolation);
        let budget = options.stop.unwrap_or(Stop { max_evaluations: EVALUATIONS, ..Stop::default() });
        let stop = Stop {
            max_evaluations: budget.max_evaluations.div_ceil(searches as usize),
            max_time: budget.max_time.map(|time| time / searches),
            ..budget
        };
        let Some(found) = search(&mut cost, options, stop, monitor)? else { return Ok((self.plan, None)) };
        let (waypoints, _) = cost.waypoints(&found.x);
        // The search times a motion only roughly, and does not ask whether joints can hold the arm.
        let plan = match problem.motion_if_held(&cost.interpolation, waypoints)? {
            Ok(motion) => problem.plan(motion),
            Err(_) => return Ok((self.plan, Some(found))),
        };
        Ok((if is_better(&self.plan, &plan) { self.plan } else { plan }, Some(found)))
    }
}

/// Whether a plan keeps everything, and the other one does not or costs more.
fn is_better(plan: &Plan, other: &Plan) -> bool {
    plan.violations.is_empty() && (!other.violations.is_empty() || plan.cost < other.cost)
}

impl PathProblem<'_> {
    /// Whether the tip of a motion is farther off the path than its accuracy.
    pub(crate) fn leaves_path(&self, motion: &FollowedPath) -> bool {
        let FollowedPath { waypoints, path, .. } = motion;
        let tip = deviation_on(&self.robot, self.tip_path, path);
        tip.largest(&waypoints.knots).violations(self.tip_path, self.accuracy).next().is_some()
    }

    /// The plan of a motion.
    pub(crate) fn plan(&self, motion: FollowedPath) -> Plan {
        let Self { robot, tip_path, options, .. } = self;
        let FollowedPath { waypoints, stretches, path, trajectory } = motion;
        let deviation = deviation_on(robot, tip_path, &path).largest(&waypoints.knots);
        let mut violations = self.limits.violations(&trajectory);
        violations.extend(deviation.violations(tip_path, self.accuracy));
        let cost = options.objective.of(robot, &trajectory);
        Plan {
            accuracy: Some(deviation.distance.value),
            reference: Some(tip_path.positions().to_vec()),
            path: stretches,
            status: if violations.is_empty() { Status::Solved } else { Status::Stalled },
            violations,
            evaluations: 1,
            elapsed: self.stopwatch.elapsed(),
            ..Plan::of(trajectory, options.objective, cost)
        }
    }

    /// A plan after the search that found it, if there was one.
    pub(crate) fn after(&self, found: Option<SearchResult>, plan: Plan) -> Plan {
        let elapsed = self.stopwatch.elapsed();
        match found {
            None => Plan { elapsed, ..plan },
            Some(found) => Plan {
                status: found.status(plan.violations.is_empty()),
                evaluations: found.evaluations,
                history: found.history,
                elapsed,
                ..plan
            },
        }
    }
}

/// Runs the search; `None` if the arm is not redundant.
///
/// # Errors
/// [`Error::Contradiction`] for a solver without anything to search; those of the solver's options.
pub(crate) fn search(
    cost: &mut TimedCost<'_>,
    options: &AlongPathOptions,
    stop: Stop,
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
    let search = Search {
        solver: options.solver.clone(),
        stop,
        seed: options.seed,
        // The nominal motion: nothing worse is returned.
        start: Some(Point::from_elem(0.0, cost.dimension())),
    };
    search.run(cost, &bounds, monitor).map(Some)
}
