//! Plans among obstacles: collision-free configurations for both ends, a collision-free path between them, and a
//! certified timing of that path.

use super::end_pair::EndPair;
use super::line_timing::JointPolyline;
use super::pair_search::PairSearch;
use super::rrt_connect::{Connection, TreeSearch};
use super::straight_line_plan::{PAIRS, no_pair, straight};
use crate::error::{Error, Result};
use crate::math::vector::squared_distance;
use crate::objective::Point;
use crate::obstacle::{Scene, Sweep, kept_margin};
use crate::planning::collision_checks::{
    RESERVE, TimedMotion, as_lines, configuration_at, nearest_at, refuse_collision, scene, too_near,
};
use crate::planning::cost::tip_travel_along;
use crate::planning::deadline::Deadline;
use crate::planning::endpoint::{EndName, no_usable_end};
use crate::planning::{Cost, Endpoint, Improvement, MotionLimits, Plan, PointToPointOptions};
use crate::rng;
use crate::solver::{Monitor, Status};
use crate::trajectory::Trajectory;

/// Total number of configurations that all trees may examine: about half a second.
const BUDGET: usize = 200_000;
/// With fewer collision-free pairs than this, more are sought ...
const FEW_PAIRS: usize = 3;
/// ... from this many random starts.
const TRIES: usize = 400;
/// Intervals of a straight line at whose ends its penetration is measured.
const INTERVALS: usize = 16;
/// Number of paths searched at least, the same number from each start; the cheapest is taken.
const PATHS: usize = 4;
/// How often blends are narrowed before the motion stops at every corner instead.
const NARROWINGS: usize = 12;

/// Plans for checked ends and options.
pub(super) fn plan(search: &mut PairSearch, options: &PointToPointOptions, monitor: &mut dyn Monitor) -> Result<Plan> {
    let margin = kept_margin(options.margin)?;
    let lines = as_lines(search.robot, options)?;
    let scene = scene(search.robot, lines.as_ref(), options)?;
    let pairs = search.pairs(PAIRS, monitor)?;
    let first = pairs.first().ok_or_else(no_pair)?;
    let is_clear = |q: &[f64]| scene.is_clear(q, margin + RESERVE);
    let refusal = |name: EndName, end: &Endpoint| match end {
        Endpoint::Configuration(q) => refuse_collision(&name.of_target(), &scene, q, margin),
        Endpoint::Target(_) => Ok(()),
    };
    refusal(EndName::Start, search.start)?;
    let refused: Vec<Error> =
        (0..search.ends.len()).filter_map(|i| refusal(search.name(i), &search.ends[i]).err()).collect();
    if refused.len() == search.ends.len() {
        return Err(no_usable_end(search.ends.len(), refused));
    }
    let is_open = |pair: &EndPair| is_clear(&pair.start) && is_clear(&pair.end);
    let mut open: Vec<EndPair> = pairs.iter().filter(|pair| is_open(pair)).cloned().collect();
    let given = [search.start].into_iter().chain(search.ends).all(|end| matches!(end, Endpoint::Configuration(_)));
    if open.len() < FEW_PAIRS && !given {
        open.extend(search.random_pairs(PAIRS, TRIES, is_open, monitor)?);
    }
    let limits = search.limits;
    let budget = options.stop.map_or(BUDGET, |stop| stop.max_evaluations);
    let mut trees = TreeSearch::new(&scene, limits, margin + RESERVE, budget, search.deadline);
    let mut sweep = Sweep::new(&scene);
    let certified = match open.is_empty() {
        true if search.deadline.is_over() => Certified::Nothing(Status::BudgetSpent),
        true => Certified::Nothing(Status::Stalled),
        false => {
            let starts = sort_by_cost(&mut open, search, options.objective)?;
            PathSearch { trees: &mut trees, sweep: &mut sweep, search, options, margin }
                .best(&open, &starts, monitor)?
        }
    };
    search.evaluations += trees.check.examined();
    let (trajectory, ended) = match certified {
        Certified::Motion(trajectory) => (trajectory, Status::Solved),
        Certified::Nothing(status) => {
            let tried = if open.is_empty() { &pairs } else { &open };
            (straight(least_penetrating(&scene, tried).unwrap_or(first), limits)?, status)
        }
    };
    let mut plan = finish(search, &scene, trajectory, ended, options, margin)?;
    let last = configuration_at(&plan.trajectory, plan.trajectory.duration())?;
    let distance = |pair: &&EndPair| squared_distance(&pair.end, &last);
    let taken = pairs.iter().chain(&open).min_by(|one, other| distance(one).total_cmp(&distance(other)));
    plan.chosen_end = taken.map(|pair| pair.chosen);
    Ok(plan)
}

/// Returns the pair whose straight line penetrates least, at samples.
fn least_penetrating<'p>(scene: &Scene, pairs: &'p [EndPair]) -> Option<&'p EndPair> {
    let distance = |pair: &EndPair| {
        let at = |i: usize| -> Vec<f64> {
            let share = i as f64 / INTERVALS as f64;
            pair.start.iter().zip(&pair.end).map(|(start, end)| start + share * (end - start)).collect()
        };
        let nearest = (0..=INTERVALS).filter_map(|i| scene.nearest(&at(i)).ok().flatten());
        nearest.map(|contact| contact.distance).fold(f64::INFINITY, f64::min)
    };
    pairs.iter().max_by(|one, other| distance(one).total_cmp(&distance(other)))
}

/// The certified motion, or why there is none.
enum Certified {
    Motion(Trajectory),
    Nothing(Status),
}

/// Sorts pairs by the cost of the straight motion between them. Returns the starts of the pairs that are cheapest for any
/// objective: paths are searched from these whatever the objective, so that none of them finds the best for another.
fn sort_by_cost(open: &mut Vec<EndPair>, search: &PairSearch, objective: Cost) -> Result<Vec<Point>> {
    let motions = open.iter().map(|pair| straight(pair, search.limits)).collect::<Result<Vec<_>>>()?;
    let costs_by = |objective: Cost| -> Vec<f64> { motions.iter().map(|m| objective.of(search.robot, m)).collect() };
    let mut starts: Vec<Point> = vec![];
    for objective in [Cost::Time, Cost::JointTravel, Cost::TipTravel] {
        let costs = costs_by(objective);
        let cheapest = open.iter().zip(&costs).min_by(|one, other| one.1.total_cmp(other.1));
        starts.extend(cheapest.map(|(pair, _)| pair.start.clone()).filter(|start| !starts.contains(start)));
    }
    let mut by_cost: Vec<(f64, EndPair)> = costs_by(objective).into_iter().zip(open.drain(..)).collect();
    by_cost.sort_by(|one, other| one.0.total_cmp(&other.0));
    open.extend(by_cost.into_iter().map(|(_, pair)| pair));
    Ok(starts)
}

/// The search for a certified motion.
struct PathSearch<'s, 'a> {
    trees: &'s mut TreeSearch<'a>,
    sweep: &'s mut Sweep<'a>,
    search: &'s PairSearch<'a>,
    options: &'s PointToPointOptions,
    margin: f64,
}

impl PathSearch<'_, '_> {
    /// Returns the cheapest motion found: straight between the first pair of `open`, if that is collision-free; else the
    /// cheapest of the first collision-free straight motion and of several paths around obstacles from `starts`. `open` is
    /// sorted by the cost of the straight motions.
    fn best(self, open: &[EndPair], starts: &[Point], monitor: &mut dyn Monitor) -> Result<Certified> {
        let Self { trees, sweep, search, options, margin } = self;
        let limits = search.limits;
        let mut best: Option<(f64, Trajectory)> = None;
        for (i, pair) in open.iter().enumerate() {
            if search.deadline.is_over() {
                return Ok(Certified::Nothing(Status::BudgetSpent));
            }
            if trees.check.is_clear(&pair.start, &pair.end) {
                let trajectory = straight(pair, limits)?;
                if keeps_clear(sweep, &trajectory, margin) {
                    if i == 0 {
                        return Ok(Certified::Motion(trajectory));
                    }
                    best = Some((options.objective.of(search.robot, &trajectory), trajectory));
                    break;
                }
            }
        }
        let mut keep = |path: &JointPolyline| -> Result<()> {
            let trajectory = timed(sweep, search.deadline, path, limits, margin)?;
            let cost = options.objective.of(search.robot, &trajectory);
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, trajectory));
            }
            Ok(())
        };
        let travel = |points: &[Vec<f64>]| tip_travel_along(search.robot, points);
        let from_each = PATHS.div_ceil(starts.len());
        let attempts = starts.iter().flat_map(|start| (0..from_each).map(move |_| start)).zip(1..);
        let mut ended = Status::BudgetSpent;
        for (start, attempt) in attempts {
            // The ends of all pairs that share this start: any of them will do. Their order is that of no objective.
            let mut sharing: Vec<&EndPair> = open.iter().filter(|pair| pair.start == *start).collect();
            sharing.sort_by(|one, other| one.duration.total_cmp(&other.duration));
            let ends: Vec<Vec<f64>> = sharing.into_iter().map(|pair| pair.end.to_vec()).collect();
            let mut rng = rng::stream(options.seed, attempt);
            let path = match trees.connect(start, &ends, &mut rng, monitor) {
                Connection::Found(path) => path,
                Connection::NotFound => break,
                Connection::Interrupted => {
                    ended = Status::Interrupted;
                    break;
                }
            };
            if options.objective == Cost::TipTravel {
                // A line is the shortest way of the joints, and the quickest, but not of the tip.
                let is_shorter = |old: &[Vec<f64>], new: &[Vec<f64>]| travel(new) <= travel(old);
                let shortened = trees.shorten(path.clone(), &is_shorter, &mut rng.clone(), monitor);
                keep(&shortened)?;
            }
            keep(&trees.shorten(path, &|_, _| true, &mut rng, monitor))?;
        }
        Ok(best.map_or(Certified::Nothing(ended), |(_, trajectory)| Certified::Motion(trajectory)))
    }
}

/// A smooth timing of a collision-free path: with blends as wide as can be certified, or else with a stop at each corner.
fn timed(
    sweep: &mut Sweep,
    deadline: Deadline,
    path: &JointPolyline,
    limits: &MotionLimits,
    margin: f64,
) -> Result<Trajectory> {
    let stopping = path.with_stops(limits)?;
    let mut shares = vec![1.0; path.0.len()];
    for _ in 0..NARROWINGS {
        if deadline.is_over() {
            break;
        }
        let Some(blended) = path.with_blends(limits, &shares).transpose()? else { break };
        if blended.duration() >= stopping.duration() {
            break;
        }
        match sweep.check(&TimedMotion::new(&blended), [0.0, blended.duration()], margin) {
            Ok(()) => return Ok(blended),
            Err(near) => {
                let corner = nearest_corner(path, &blended, near.at)?;
                shares[corner] *= 0.5;
            }
        }
    }
    Ok(stopping)
}

/// The inner point of the path that the motion is nearest to at time `t` (s).
fn nearest_corner(path: &JointPolyline, motion: &Trajectory, t: f64) -> Result<usize> {
    let q = configuration_at(motion, t)?;
    let distance = |i: usize| squared_distance(&path.0[i], &q);
    let inner = 1..path.0.len() - 1;
    let nearest = inner.min_by(|i, k| distance(*i).total_cmp(&distance(*k)));
    Ok(nearest.unwrap_or(0))
}

fn keeps_clear(sweep: &mut Sweep, trajectory: &Trajectory, margin: f64) -> bool {
    sweep.check(&TimedMotion::new(trajectory), [0.0, trajectory.duration()], margin).is_ok()
}

/// Completes the plan with the violations and clearance of its trajectory.
fn finish(
    search: &PairSearch,
    scene: &Scene,
    trajectory: Trajectory,
    ended: Status,
    options: &PointToPointOptions,
    margin: f64,
) -> Result<Plan> {
    let smallest = Sweep::new(scene).smallest(&TimedMotion::new(&trajectory), [0.0, trajectory.duration()]);
    let mut violations = search.limits.violations(&trajectory);
    let nearest = smallest.as_ref().map_or(Ok(None), |near| nearest_at(scene, &trajectory, near.at))?;
    let clearance = smallest.map(|near| {
        let distance = near.contact.distance;
        if ended == Status::Solved {
            // Certified above; the search for the smallest may stop just short of it.
            return distance.max(margin);
        }
        if distance < margin {
            violations.push(too_near(&near.contact, margin));
        }
        distance
    });
    let status = match ended {
        // A straight line that no search could certify with room to spare may still keep everything.
        _ if violations.is_empty() => Status::Solved,
        Status::Solved => Status::Stalled,
        status => status,
    };
    let cost = options.objective.of(search.robot, &trajectory);
    let evaluations = search.evaluations;
    let history = vec![Improvement { evaluations, cost }];
    Ok(Plan {
        trajectory,
        objective: options.objective,
        cost,
        history,
        clearance,
        nearest,
        obstruction: None,
        surroundings: None,
        chosen_end: None,
        freed: None,
        accuracy: None,
        reference: None,
        redundancy: vec![],
        path: vec![],
        peak: None,
        violations,
        status,
        evaluations,
        elapsed: search.deadline.elapsed(),
    })
}
