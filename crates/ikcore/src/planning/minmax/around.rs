//! Plans among obstacles: clear configurations for both ends, a clear way between them, and a timing whose whole motion
//! is certified again.

use super::clear::InTime;
use super::connect::{Room, Way};
use super::ends::{NAMES, Pair, Search};
use super::pace::Polyline;
use super::{NO_TIME, PAIRS, no_pair, straight};
use crate::error::{Error, Result};
use crate::obstacle::{Contact, Scene};
use crate::planning::planar_arm::PlanarArm;
use crate::planning::{End, Improvement, MotionLimits, Plan, PointToPointOptions, Violation};
use crate::rng;
use crate::solver::{Monitor, Status};
use crate::trajectory::Trajectory;
use crate::wording::number;

/// So much more is kept on straight lines, that they can be certified again once they are timed (m).
const EXTRA: f64 = 5e-5;
/// Configurations that all trees together may look at: about half a second.
const BUDGET: usize = 200_000;
/// Fewer open pairs make more be sought, so many from so many random starts.
const FEW_PAIRS: usize = 3;
const TRIES: usize = 400;
/// Places of a straight line that are looked at to find how deep it goes.
const PLACES: usize = 16;
/// Ways that are searched, of which the quickest is taken.
const WAYS: u64 = 4;
/// Times that blends are narrowed before the motion stops at every corner instead.
const NARROWINGS: usize = 12;

/// Plans for ends and options that are in order.
pub(super) fn plan(search: &mut Search, options: &PointToPointOptions, monitor: &mut dyn Monitor) -> Result<Plan> {
    let margin = options.kept_margin()?;
    let robot = search.robot;
    // Without capsules the links of an arm in the plane are lines that may cross each other, as in Wang et al. (2019).
    let bare = robot.capsules().is_empty() && robot.unread_collision_shapes().is_empty();
    let lines = if bare && PlanarArm::of(robot).is_some() { Some(robot.with_capsules_along_links(0.0)?) } else { None };
    let scene = Scene::new(lines.as_ref().unwrap_or(robot), &options.obstacles)?;
    let scene = if lines.is_some() { scene.without_self_collision() } else { scene };
    let pairs = search.pairs(PAIRS, monitor)?;
    let first = pairs.first().ok_or_else(no_pair)?;
    let is_clear = |q: &[f64]| scene.is_clear(q, margin + EXTRA);
    for (what, end) in NAMES.into_iter().zip(search.ends) {
        if let End::Configuration(q) = end {
            refuse_collision(what, &scene, q, margin)?;
        }
    }
    let is_open = |pair: &Pair| is_clear(&pair.start) && is_clear(&pair.end);
    let mut open: Vec<Pair> = pairs.iter().filter(|pair| is_open(pair)).cloned().collect();
    let given = search.ends.iter().all(|end| matches!(end, End::Configuration(_)));
    if open.len() < FEW_PAIRS && !given {
        open.extend(search.random_pairs(PAIRS, TRIES, is_open, monitor)?);
    }
    let limits = search.limits;
    let mut room = Room::new(&scene, limits, margin + EXTRA, options.stop.map_or(BUDGET, |stop| stop.max_evaluations));
    let found = match open.is_empty() {
        true => Found::Nothing(Status::Stalled),
        false => best_way(&mut room, limits, &open, options.seed, margin, monitor)?,
    };
    search.evaluations += room.sweep.looks();
    let (trajectory, ended) = match found {
        Found::Clear(trajectory) => (trajectory, Status::Solved),
        Found::Nothing(status) => {
            let tried = if open.is_empty() { &pairs } else { &open };
            (straight(least_deep(&scene, tried).unwrap_or(first), limits)?, status)
        }
    };
    finish(search, &scene, trajectory, ended, options, margin)
}

/// The pair whose straight line, looked at in some places, goes least deep into anything.
fn least_deep<'p>(scene: &Scene, pairs: &'p [Pair]) -> Option<&'p Pair> {
    let distance = |pair: &Pair| {
        let at = |i: usize| -> Vec<f64> {
            let share = i as f64 / PLACES as f64;
            pair.start.iter().zip(&pair.end).map(|(start, end)| start + share * (end - start)).collect()
        };
        let nearest = (0..=PLACES).filter_map(|i| scene.nearest(&at(i)).ok().flatten());
        nearest.map(|contact| contact.distance).fold(f64::INFINITY, f64::min)
    };
    pairs.iter().max_by(|one, other| distance(one).total_cmp(&distance(other)))
}

/// What the search for a way came to.
enum Found {
    Clear(Trajectory),
    Nothing(Status),
}

/// The quickest of the straight motions between open pairs that keep clear, or of some ways around.
fn best_way(
    room: &mut Room,
    limits: &MotionLimits,
    open: &[Pair],
    seed: u64,
    margin: f64,
    monitor: &mut dyn Monitor,
) -> Result<Found> {
    for pair in open {
        if room.is_clear(&pair.start, &pair.end) {
            let trajectory = straight(pair, limits)?;
            if keeps_clear(room, &trajectory, margin) {
                return Ok(Found::Clear(trajectory));
            }
        }
    }
    // The ends of all pairs that share the start of the quickest: any of them will do.
    let start = &open[0].start;
    let ends: Vec<Vec<f64>> = open.iter().filter(|pair| pair.start == *start).map(|pair| pair.end.to_vec()).collect();
    let mut best: Option<Trajectory> = None;
    for attempt in 1..=WAYS {
        let mut rng = rng::stream(seed, attempt);
        let way = match room.connect(start, &ends, &mut rng, monitor) {
            Way::Found(way) => room.shorten(way, &mut rng, monitor),
            Way::NotFound => break,
            Way::Interrupted => return Ok(best.map_or(Found::Nothing(Status::Interrupted), Found::Clear)),
        };
        let trajectory = timed(room, &way, limits, margin)?;
        if best.as_ref().is_none_or(|best| trajectory.duration() < best.duration()) {
            best = Some(trajectory);
        }
    }
    Ok(best.map_or(Found::Nothing(Status::BudgetSpent), Found::Clear))
}

/// A smooth timing of a clear way: through its corners as quickly as certified, or with a stop in each.
fn timed(room: &mut Room, way: &Polyline, limits: &MotionLimits, margin: f64) -> Result<Trajectory> {
    let stopping = way.with_stops(limits)?;
    let mut shares = vec![1.0; way.0.len()];
    for _ in 0..NARROWINGS {
        let Some(blended) = way.with_blends(limits, &shares).transpose()? else { break };
        if blended.duration() >= stopping.duration() {
            break;
        }
        match room.sweep.check(&InTime(&blended), [0.0, blended.duration()], margin) {
            Ok(()) => return Ok(blended),
            Err(near) => {
                let corner = nearest_corner(way, &blended, near.at)?;
                shares[corner] *= 0.5;
            }
        }
    }
    Ok(stopping)
}

/// The inner point of the way that the motion is nearest to at time `t` (s).
fn nearest_corner(way: &Polyline, motion: &Trajectory, t: f64) -> Result<usize> {
    let n = motion.joints().len();
    let (mut q, mut qd, mut qdd) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    motion.at(t, &mut q, &mut qd, &mut qdd)?;
    let squared = |point: &[f64]| -> f64 { point.iter().zip(&q).map(|(a, b)| (a - b).powi(2)).sum() };
    let inner = 1..way.0.len() - 1;
    let nearest = inner.min_by(|i, k| squared(&way.0[*i]).total_cmp(&squared(&way.0[*k])));
    Ok(nearest.unwrap_or(0))
}

fn keeps_clear(room: &mut Room, trajectory: &Trajectory, margin: f64) -> bool {
    room.sweep.check(&InTime(trajectory), [0.0, trajectory.duration()], margin).is_ok()
}

/// The plan with what its trajectory breaks, by the exact limits and the smallest certified distance.
fn finish(
    search: &Search,
    scene: &Scene,
    trajectory: Trajectory,
    ended: Status,
    options: &PointToPointOptions,
    margin: f64,
) -> Result<Plan> {
    let smallest = crate::obstacle::Sweep::new(scene).smallest(&InTime(&trajectory), [0.0, trajectory.duration()]);
    let mut violations = search.limits.violations(&trajectory);
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
    let objective = options.objective;
    Ok(Plan {
        trajectory,
        objective,
        cost,
        history,
        clearance,
        accuracy: None,
        redundancy: vec![],
        violations,
        status,
        evaluations,
        elapsed: NO_TIME,
    })
}

/// A distance below the margin, by name.
pub(in crate::planning) fn too_near(contact: &Contact, margin: f64) -> Violation {
    let what = format!("distance of link '{}' from {}", contact.link, contact.other);
    Violation { what, value: contact.distance, bound: margin, unit: "m".into() }
}

/// Err for a configuration nearer to something than the margin.
pub(in crate::planning) fn refuse_collision(what: &str, scene: &Scene, q: &[f64], margin: f64) -> Result<()> {
    match scene.nearest(q)? {
        Some(Contact { link, other, distance }) if distance < margin + EXTRA => {
            let (what, other) = (what.into(), other.to_string());
            let depth = if distance < 0.0 {
                format!("{} m inside", number(-distance))
            } else {
                format!("only {} m (of a margin of {} m) from", number(distance), number(margin + EXTRA))
            };
            Err(Error::InCollision { what, link, other, depth })
        }
        _ => Ok(()),
    }
}
