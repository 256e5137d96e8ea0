//! The planner: layers of postures, the cheapest clear sequence, its timing, and the certificate.

use super::dead_end::Layers;
use super::passage::Passage;
use super::path_end::why_it_ends;
use super::postures::{DENSITIES, LayerSampling, clear_layers, intervals, postures};
use super::price::Price;
use super::sequence::{FoundSequence, LayerPosture, Unreached, cheapest};
use super::smoothing::Smoothing;
use super::stretches::Stretch;
use crate::along_path::missed_points::{missed_at, missed_points};
use crate::along_path::timed::{
    FollowedPath, Interpolation, JointWaypoints, NullSpaceOffsets, PathProblem, TimedCost, search,
};
use crate::error::{Error, Result};
use crate::interrupt::checkpoint;
use crate::math::vector::squared_distance;
use crate::message::{Setting, message};
use crate::objective::Point;
use crate::obstacle::{ClearSpace, ClearanceSweep, TooNear};
use crate::plan::{Plan, SearchResult, certify, configuration_at, least_clearance, refuse_collision, too_near};
use crate::solver::{Monitor, Status, Stop};

/// Maximum number of motions tried, each with more clearance where the one before came too near.
const ROUNDS: usize = 10;

/// Rounds in which a motion that leaves the path is made to follow it more closely.
const CLOSER_ROUNDS: usize = 2;

/// Evaluations of the search for a better motion around a clear one.
const EVALUATIONS: usize = 600;

/// The first extra clearance (m) where a motion came too near.
const FIRST_EXTRA: f64 = 2.5e-4;

/// Reach of that clearance to both sides, in intervals between layers.
const AROUND: f64 = 1.5;

/// Certified distance beyond the margin (m), so that the margin remains when the motion is retimed.
const SPARE: f64 = 2e-5;

/// Advice where no motion is found.
const ADVICE: &str = "try another seed, wider limits, leave a part of the poses free by a task";

/// Penalty of a posture in collision per metre of its shortfall from the margin.
const DEEP: f64 = 1e6;

/// Plans along a path in `space`, or without regard to obstacles.
///
/// # Errors
/// As [`plan_along_path`](crate::planning::plan_along_path).
pub(crate) fn along_path(
    problem: &PathProblem<'_>,
    space: Option<&ClearSpace<'_>>,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    if let (Some(q), Some(space)) = (&problem.options.start, space) {
        refuse_collision("start_q", space, q)?;
    }
    let mut planner = ClearPlanner::new(problem, space, problem.tip_path.knots(intervals(problem.tip_path)));
    match (planner.first_sequence()?, space) {
        (Ok(sequence), _) => planner.certified(sequence, monitor),
        (Err(dead_end), Some(space)) => planner.least_deep(space, *dead_end),
        (Err(dead_end), None) => Err(planner.not_found(*dead_end)?),
    }
}

/// Plans along a path that the arm can follow through a `stretch` of postures.
///
/// # Errors
/// As [`plan_along_path`](crate::planning::plan_along_path).
pub(crate) fn along_stretch(
    problem: &PathProblem<'_>,
    space: Option<&ClearSpace<'_>>,
    stretch: Stretch,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let mut planner = ClearPlanner::new(problem, space, stretch.fractions);
    planner.postures = stretch.postures;
    planner.certified(stretch.sequence, monitor)
}

struct ClearPlanner<'p> {
    problem: &'p PathProblem<'p>,
    /// Space that the motion stays in, if anything can collide.
    space: Option<&'p ClearSpace<'p>>,
    price: Price,
    passage: Passage<'p>,
    /// Path parameters of the layers, and the postures there, clear or not.
    fractions: Vec<f64>,
    postures: Vec<Vec<Point>>,
    /// Allowed deviation of the tip from the path (m, rad); smaller where that keeps it clear.
    accuracy: f64,
}

/// Reason against a motion.
enum Fault {
    TooNear(Box<TooNear>),
    OutsideLimits,
    Broken,
    OffPath,
}

impl<'p> ClearPlanner<'p> {
    fn new(problem: &'p PathProblem<'p>, space: Option<&'p ClearSpace<'p>>, fractions: Vec<f64>) -> Self {
        Self {
            problem,
            space,
            price: Price::new(problem),
            passage: Passage::new(problem, space),
            fractions,
            postures: vec![],
            accuracy: problem.accuracy,
        }
    }

    /// Returns the cheapest clear sequence, from as few postures as suffice.
    fn first_sequence(&mut self) -> Result<FoundSequence> {
        let mut dead_end = Box::new(Unreached { layer: 0, last: None });
        for density in DENSITIES {
            let sampling = LayerSampling { fractions: &self.fractions, density };
            self.postures = postures(&mut self.passage, &self.price, &sampling)?;
            match self.clear_sequence()? {
                Ok(sequence) => return Ok(Ok(sequence)),
                Err(end) => dead_end = end,
            }
        }
        Ok(Err(dead_end))
    }

    fn clear_sequence(&mut self) -> Result<FoundSequence> {
        let layers = clear_layers(&self.passage, &self.fractions, &self.postures)?;
        cheapest(&layers, &self.fractions, &self.price, &mut self.passage)
    }

    /// Returns the plan of the first motion without a fault, or of the last one tried.
    fn certified(mut self, mut sequence: Vec<Point>, monitor: &mut dyn Monitor) -> Result<Plan> {
        let starts_as_given = self.problem.options.start.is_some();
        let mut found = None;
        let mut round = 0;
        loop {
            let Self { fractions, price, passage, .. } = &mut self;
            Smoothing { fractions, price, passage, starts_as_given }.smooth(&mut sequence)?;
            let nominal = JointWaypoints { knots: self.fractions.clone(), rows: sequence.concat() };
            let (interpolation, waypoints, _) = self.problem.corners_of(&nominal, self.accuracy, round == 0)?;
            let smooth = self.problem.motion(&interpolation, waypoints.clone())?;
            let fault = self.fault(&smooth);
            if round == 0 {
                let improved;
                (improved, found) = self.improved(interpolation, waypoints, monitor)?;
                let is_better = |improved: &FollowedPath| fault.is_some() || self.cost(improved) < self.cost(&smooth);
                if let Some(improved) = improved.filter(is_better)
                    && self.fault(&improved).is_none()
                {
                    return self.finished(improved, found, None);
                }
            }
            let blocked = match fault {
                None => return self.finished(smooth, found, None),
                Some(Fault::TooNear(near)) => {
                    self.keep_away(&smooth, &near)?;
                    Some(Status::Stalled)
                }
                Some(Fault::OutsideLimits) => {
                    self.passage.stay_inside();
                    None
                }
                Some(Fault::Broken) => {
                    // Denser waypoints keep closer to the constraints, which hold at each of them.
                    self.accuracy *= 0.25;
                    Some(Status::Stalled)
                }
                Some(Fault::OffPath) if round == CLOSER_ROUNDS => return self.finished(smooth, found, None),
                Some(Fault::OffPath) => {
                    self.accuracy *= 0.5;
                    None
                }
            };
            round += 1;
            let next = if round < ROUNDS { self.clear_sequence()?.ok() } else { None };
            let Some(next) = next else { return self.finished(smooth, found, blocked) };
            sequence = next;
        }
    }

    fn cost(&self, motion: &FollowedPath) -> f64 {
        self.problem.options.objective.of(&self.problem.robot, &motion.trajectory)
    }

    /// Searches around `waypoints` for a better motion; `None` if joints cannot hold the arm on the one that was found.
    fn improved(
        &self,
        interpolation: Interpolation<'_>,
        waypoints: JointWaypoints,
        monitor: &mut dyn Monitor,
    ) -> Result<(Option<FollowedPath>, Option<SearchResult>)> {
        let Self { problem, space, .. } = self;
        let starts_as_given = problem.options.start.is_some();
        let motion =
            NullSpaceOffsets::around(&problem.robot, interpolation.tip_path, problem.keeps, waypoints, starts_as_given);
        let mut cost = TimedCost::new(problem, motion, interpolation);
        cost.space = *space;
        let budget = Stop { max_evaluations: EVALUATIONS, ..Stop::default() };
        let found = search(&mut cost, problem.options, problem.options.stop.unwrap_or(budget), monitor)?;
        let z: &[f64] = found.as_ref().map_or(&[], |found| &found.x);
        let (waypoints, _) = cost.waypoints(z);
        Ok((problem.motion_if_held(&cost.interpolation, waypoints)?.ok(), found))
    }

    fn fault(&self, motion: &FollowedPath) -> Option<Fault> {
        let trajectory = &motion.trajectory;
        let too_near = self.space.and_then(|space| {
            certify(&mut ClearanceSweep::new(space.scene()), trajectory, space.margin() + SPARE).err()
        });
        if let Some(near) = too_near {
            return Some(Fault::TooNear(near));
        }
        if !self.problem.limits.violations(trajectory).is_empty() {
            return Some(Fault::OutsideLimits);
        }
        if !self.problem.is_kept(trajectory) {
            return Some(Fault::Broken);
        }
        self.problem.leaves_path(motion).then_some(Fault::OffPath)
    }

    /// Requires more clearance where a motion comes too near, and a smaller deviation from the path.
    fn keep_away(&mut self, motion: &FollowedPath, near: &TooNear) -> Result<()> {
        let Some(space) = self.space else { return Ok(()) };
        let q = configuration_at(&motion.trajectory, near.at)?;
        let waypoints = &motion.waypoints;
        let distance = |i: &usize| squared_distance(waypoints.row(*i), &q);
        let nearest = (0..waypoints.knots.len()).min_by(|i, k| distance(i).total_cmp(&distance(k)));
        let fraction = waypoints.knots[nearest.unwrap_or(0)];
        let kept = self.passage.kept_beyond_margin(fraction);
        let missing = (space.margin() - near.contact.distance).max(0.0);
        let extra = FIRST_EXTRA.max(2.0 * kept).max(kept + 2.0 * missing);
        let leaves_some = |i: &usize| self.postures[*i].iter().any(|q| space.keeps(q, extra));
        let reach = AROUND / self.fractions.len() as f64;
        let around: Vec<usize> =
            (0..self.fractions.len()).filter(|i| (self.fractions[*i] - fraction).abs() <= reach).collect();
        if around.iter().all(leaves_some) {
            self.passage.keep_more(fraction, reach, extra);
        }
        self.accuracy *= 0.5;
        Ok(())
    }

    /// Returns the plan that penetrates least, where there is no clear one.
    fn least_deep(mut self, space: &ClearSpace<'_>, dead_end: Unreached) -> Result<Plan> {
        let layers = Layers { fractions: &self.fractions, postures: &self.postures };
        let (obstruction, own_points) = layers.obstruction(&self.passage, space, &dead_end);
        let missing = |q: &Point| (space.margin() - space.clearance(q).distance).max(0.0);
        let candidates = |postures: &Vec<Point>| -> Result<Vec<LayerPosture>> {
            checkpoint()?;
            Ok(postures.iter().map(|q| LayerPosture { q: q.clone(), penalty: DEEP * missing(q) }).collect())
        };
        let layers = self.postures.iter().map(candidates).collect::<Result<Vec<_>>>()?;
        let mut anywhere = Passage::new(self.problem, None);
        let sequence = match cheapest(&layers, &self.fractions, &self.price, &mut anywhere)? {
            Ok(sequence) => sequence,
            Err(dead_end) => {
                let PathProblem { robot, tip_path, options, .. } = self.problem;
                let missed = missed_points(robot, tip_path, options.seed)?;
                return Err(missed.map_or_else(|| self.not_found(*dead_end), Ok)?);
            }
        };
        let nominal = JointWaypoints { knots: std::mem::take(&mut self.fractions), rows: sequence.concat() };
        let (interpolation, waypoints, _) = self.problem.corners_of(&nominal, self.accuracy, false)?;
        let motion = self.problem.motion(&interpolation, waypoints)?;
        let plan = self.finished(motion, None, Some(Status::InCollision))?;
        Ok(Plan { obstruction: Some(obstruction), own_points, ..plan })
    }

    /// The error where no sequence follows the path, clear or not.
    fn not_found(&mut self, Unreached { layer, last }: Unreached) -> Result<Error> {
        let PathProblem { robot, tip_path, options, .. } = self.problem;
        if self.postures[layer].is_empty()
            && let Some(error) = missed_at(robot, tip_path, self.fractions[layer], options.seed)?
        {
            return Ok(error);
        }
        let place = tip_path.point_in_words(self.fractions[layer]);
        let problem = match (self.postures[layer].len(), self.broken_at(layer)) {
            (0, _) if !self.problem.keeps.keeps.is_empty() => {
                "none of the motions tried reached it with what is to be kept".into()
            }
            (0, _) => "none of the motions tried reached it".into(),
            (count, Some(broken)) => {
                format!("what is to be kept holds at none of {count} configurations tried there: {broken}")
            }
            (1, None) => "the one configuration tried there is on another branch than those before".into(),
            (count, None) => {
                format!("all {count} configurations tried there are on other branches than those before")
            }
        };
        let cause = last.map_or_else(String::new, |(q, swept)| {
            let from = (self.fractions[layer - 1], &q[..]);
            let turns = self.problem.options.start.is_none().then_some(swept);
            let why = why_it_ends(&mut self.passage, self.space, from, self.fractions[layer], turns);
            format!("; on the way there, {why}")
        });
        let problem = message![format!("{problem}{cause}; {ADVICE}, or "), Setting::Breaks];
        Ok(Error::NotFound { what: format!("a motion past {place}"), problem })
    }

    /// The error that breaks a constraint at the first posture of a layer, if some is broken at all of them.
    fn broken_at(&self, layer: usize) -> Option<String> {
        let broken = |q: &Point| self.problem.keeps.broken_at(q);
        self.postures[layer].iter().map(broken).collect::<Option<Vec<_>>>()?.into_iter().next()
    }

    /// Returns the plan of a motion; `blocked` is the status of a motion that is not certified.
    fn finished(&self, motion: FollowedPath, found: Option<SearchResult>, blocked: Option<Status>) -> Result<Plan> {
        let mut plan = self.problem.after(found, self.problem.plan(motion));
        let Some(space) = self.space else { return Ok(plan) };
        let margin = space.margin();
        plan.surroundings = Some(space.surroundings());
        let certified = blocked.is_none().then_some(margin);
        let least = least_clearance(&mut ClearanceSweep::new(space.scene()), &plan.trajectory, certified)?;
        let Some((least, contact)) = least else { return Ok(plan) };
        if let Some(status) = blocked
            && least.distance < margin
        {
            plan.violations.push(too_near(&contact, margin));
            plan.status = status;
        }
        plan.clearance = Some(least);
        Ok(plan)
    }
}
