//! Plans among obstacles: collision-free configurations for both ends, a collision-free path between them, and a
//! certified timing of that path.

use super::end_pair::EndPair;
use super::line_check::PathConstraints;
use super::pair_search::PairSearch;
use super::path_search::{Certified, PathSearch};
use super::rrt_connect::TreeSearch;
use super::straight_line_plan::{PAIRS, no_pair, straight};
use crate::constraint::refuse_broken;
use crate::error::{Error, Result};
use crate::free_path::{no_way, path_search};
use crate::math::vector::{point_between, squared_distance};
use crate::objective::Point;
use crate::obstacle::{ClearSpace, Clearance, ClearanceSweep, Scene};
use crate::plan::{
    Cost, END_RESERVE, EndName, Endpoint, Plan, PointToPointOptions, configuration_at, least_clearance, no_usable_end,
    refuse_collision, too_near,
};
use crate::solver::{Monitor, Status};

/// Number of configurations that all trees may examine in all, for each joint: a second or two of an arm in a narrow place.
const BUDGET_PER_JOINT: usize = 150_000;
/// Fewest collision-free pairs; below it more are sought ...
const FEW_PAIRS: usize = 3;
/// ... from this number of random starts.
const TRIES: usize = 400;
/// Intervals of a straight line at whose ends its penetration is measured.
const INTERVALS: usize = 16;
/// Distances that paths may keep beyond the margin (m).
const CERTIFIED_RESERVES: [f64; 5] = [8e-3, 4e-3, 2e-3, 1e-3, 1e-4];
/// Rounding of distances in the check of a line, in single precision (m).
const SINGLE: f64 = 3e-5;

/// Plans for checked ends and options.
pub(super) fn plan(
    search: &mut PairSearch,
    space: &ClearSpace<'_>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let (scene, margin) = (space.scene(), space.margin());
    // A planar arm without bodies, seen as lines.
    let is_lines = search.robot.capsules().is_empty();
    let pairs = search.pairs(PAIRS, monitor)?;
    let first = pairs.first().ok_or_else(no_pair)?;
    let (robot, limits) = (search.robot, search.limits);
    let is_kept = |q: &[f64]| options.keeps.iter().all(|keep| keep.holds(robot, q));
    let is_held = |q: &[f64]| limits.too_heavy(q).is_none();
    let is_clear = |q: &[f64]| is_kept(q) && space.keeps(q, END_RESERVE) && is_held(q);
    let refusal = |name: EndName, end: &Endpoint| match end {
        Endpoint::Configuration(q) => {
            let what = name.of_configuration();
            refuse_broken(&what, &options.keeps, robot, q)?;
            limits.refuse_too_heavy(&what, q)?;
            refuse_collision(&what, space, q)
        }
        Endpoint::Targets { .. } => Ok(()),
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
    open.extend(search.other_ways(&open));
    let budget = options.stop.map_or(BUDGET_PER_JOINT * search.robot.dof(), |stop| stop.max_evaluations);
    let most = most_kept(space, &open);
    let ranges = TreeSearch::ranges(search.robot, limits, open.iter().flat_map(|pair| [&pair.start, &pair.end]));
    let mut trees =
        TreeSearch::new(scene, ranges, margin + most.min(path_search::SEARCH_RESERVE), budget, search.deadline);
    trees.check.held = limits.hold_check();
    trees.check.kept = PathConstraints::of(robot, &options.keeps, &trees.ranges);
    let mut sweep = ClearanceSweep::new(scene);
    let certified = match open.is_empty() {
        true if search.deadline.is_over() => Certified::Nothing(Status::BudgetSpent),
        true => Certified::Nothing(Status::Stalled),
        false => {
            let starts = sort_by_cost(&mut open, search, options.objective)?;
            let (improves, objective) = (options.stop.is_some(), options.objective);
            let search = PathSearch {
                trees: &mut trees,
                sweep: &mut sweep,
                search,
                objective,
                margin,
                most,
                improves,
                ends_are_free: open.len() > 1,
            };
            search.best(&open, &starts, monitor)?
        }
    };
    search.evaluations += trees.check.examined() + sweep.examined();
    let mut plan = match certified {
        Certified::Motion(trajectory, history) => {
            let clearance = Some(Clearance::at_least(margin));
            let keeps = options.keeps.clone();
            let plan = Plan { history, clearance, keeps, ..search.plan(trajectory, options.objective) };
            if is_lines { with_least_clearance(plan, &mut sweep, margin)? } else { plan }
        }
        Certified::Nothing(status) => {
            let tried = if open.is_empty() { &pairs } else { &open };
            let trajectory = straight(least_penetrating(scene, tried).unwrap_or(first), limits)?;
            let plan = Plan { status, ..search.plan(trajectory, options.objective) };
            let mut plan = with_least_clearance(plan, &mut sweep, margin)?;
            let broken = plan.note_kept(robot, &options.keeps)?;
            if plan.status == Status::Stalled && broken.is_some() {
                plan.status = status;
            }
            let (obstruction, own_points) =
                if let (true, Some(broken)) = (open.is_empty(), no_way::broken_ends(&pairs, &options.keeps, robot)) {
                    (broken, None)
                } else if let (true, Some(heavy)) = (open.is_empty(), no_way::heavy_ends(&pairs, limits)) {
                    (heavy, None)
                } else if open.is_empty() {
                    no_way::blocked_ends(scene, &pairs, margin + END_RESERVE)
                } else {
                    let nearest = plan.clearance.as_ref().and_then(|clearance| clearance.nearest.as_ref());
                    let contact = nearest.map(|nearest| nearest.contact.in_words(margin));
                    (no_way::gap(trees.gap, trees.check.examined(), contact.or(broken)), None)
                };
            Plan { obstruction: (plan.status != Status::Solved).then_some(obstruction), own_points, ..plan }
        }
    };
    plan.surroundings = (!is_lines).then(|| space.surroundings());
    let last = configuration_at(&plan.trajectory, plan.trajectory.duration())?;
    let distance = |pair: &&EndPair| squared_distance(&pair.end, &last);
    let taken = pairs.iter().chain(&open).min_by(|one, other| distance(one).total_cmp(&distance(other)));
    plan.chosen_end = taken.map(|pair| pair.chosen);
    Ok(plan)
}

/// Returns the pair whose straight line penetrates least, at samples.
fn least_penetrating<'p>(scene: &Scene, pairs: &'p [EndPair]) -> Option<&'p EndPair> {
    let distance = |pair: &EndPair| {
        let at = |i: usize| point_between(&pair.start, &pair.end, i as f64 / INTERVALS as f64).collect::<Vec<_>>();
        let nearest = (0..=INTERVALS).filter_map(|i| scene.nearest(&at(i)).ok().flatten());
        nearest.map(|contact| contact.distance).fold(f64::INFINITY, f64::min)
    };
    pairs.iter().max_by(|one, other| distance(one).total_cmp(&distance(other)))
}

/// Sorts pairs by the cost of the straight motion between them. Returns the starts of the pairs that are cheapest for any
/// objective: paths are searched from these whatever the objective, so that none of them finds the best for another.
fn sort_by_cost(open: &mut Vec<EndPair>, search: &PairSearch, objective: Cost) -> Result<Vec<Point>> {
    if let [only] = &open[..] {
        return Ok(vec![only.start.clone()]);
    }
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

/// The most that all ends keep beyond the margin (m), of a few distances.
fn most_kept(space: &ClearSpace<'_>, open: &[EndPair]) -> f64 {
    let keep = |more: f64| {
        let mut ends = open.iter().flat_map(|pair| [&pair.start, &pair.end]);
        ends.all(|q| space.keeps(q, more))
    };
    // Lines to ends that keep none of these are examined with a little less than the margin, for what rounding takes off.
    CERTIFIED_RESERVES.into_iter().find(|more| keep(*more)).unwrap_or(-SINGLE)
}

/// The plan with its smallest distance, and the violation if that is less than the margin. A bound that it has is certified.
fn with_least_clearance(mut plan: Plan, sweep: &mut ClearanceSweep, margin: f64) -> Result<Plan> {
    let certified = plan.clearance.as_ref().map(|_| margin);
    let Some((least, contact)) = least_clearance(sweep, &plan.trajectory, certified)? else { return Ok(plan) };
    if least.distance < margin {
        plan.violations.push(too_near(&contact, margin));
    }
    plan.clearance = Some(least);
    // A straight line that no search could certify may still keep everything.
    plan.status = match plan.status {
        _ if plan.violations.is_empty() => Status::Solved,
        Status::Solved => Status::Stalled,
        status => status,
    };
    Ok(plan)
}
