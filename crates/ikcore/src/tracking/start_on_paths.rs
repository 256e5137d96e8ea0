//! The configuration from which a track begins where none is given.

use super::tip_paths::TipPaths;
use super::track_options::{TRACK, TrackOptions};
use crate::constraint::{JointTorques, Onto};
use crate::error::Result;
use crate::ik::{Prefer, SolveOptions, checked_tasks, reduce, solve_tips};
use crate::limits::{Field, Limits, Profile};
use crate::manipulability::Motion;
use crate::rng;
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stop};
use crate::task::{Goal, NamedTask, Target, Tolerance};

/// Returns a configuration on, or nearest to, the first points of the paths: the best for the goals or, without goals, away from
/// limits and, for one tip, from singularities; where constraints hold and motors can hold the arm, if one is found.
pub(super) fn start_on_paths(
    robot: &Robot,
    asked: &TipPaths<'_>,
    limits: &Limits,
    options: &TrackOptions,
    monitor: &mut dyn Monitor,
) -> Result<Vec<f64>> {
    let goals = if options.goals.is_empty() { start_goals(robot, &asked.targets(0)[0]) } else { options.goals.clone() };
    let mut found = first_configuration(robot, asked, limits, options, goals, monitor)?;
    if let Some(torques) = JointTorques::new(robot, limits.torque(), TRACK)?
        && torques.too_heavy(&mut torques.point(), &found).is_some()
    {
        let goals = vec![Goal::LeastTorque { relative_to: Some(limits.torque().to_vec()), weight: 1.0 }];
        found = first_configuration(robot, asked, limits, options, goals, monitor)?;
    }
    where_all_holds(robot, asked, limits, options, found)
}

/// Evaluation budget of the first configuration: usually as good as the full budget, in a sixth of the time. If the target is
/// still unsolved, the full budget of a solve is used.
const CHOOSING: usize = 1000;

/// Solves for a configuration on, or nearest to, the first points of the paths: the best for the goals.
fn first_configuration(
    robot: &Robot,
    asked: &TipPaths<'_>,
    limits: &Limits,
    options: &TrackOptions,
    goals: Vec<Goal>,
    monitor: &mut dyn Monitor,
) -> Result<Vec<f64>> {
    // Tighter than the band, so that the track does not start at its edge.
    let tight =
        |Tolerance { position, rotation }: Tolerance| Tolerance { position: 0.1 * position, rotation: 0.1 * rotation };
    let targets = asked.targets(0);
    let choices = SolveOptions {
        task: options.task,
        tips: asked.tips.iter().map(|task| NamedTask { tolerance: tight(task.tolerance), ..*task }).collect(),
        goals,
        tolerance: tight(options.tolerance),
        limits: Some(limits_at_start(robot, limits)?),
        surroundings: options.surroundings.clone(),
        seed: options.seed,
        ..SolveOptions::default()
    };
    if robot.tip_count() > 1 {
        return Ok(solve_tips(robot, &targets, &choices, monitor)?.q.to_vec());
    }
    let stop = Stop { max_evaluations: CHOOSING, ..Stop::default() };
    let best = SolveOptions { prefer: Prefer::Best, stop, ..choices };
    let chosen = solve_tips(robot, &targets, &best, monitor)?;
    if chosen.status != Status::BudgetSpent {
        return Ok(chosen.q.to_vec());
    }
    Ok(solve_tips(robot, &targets, &SolveOptions { stop: Stop::default(), ..best }, monitor)?.q.to_vec())
}

/// Configurations, drawn at random, from which one is sought where all constraints hold.
const STARTS: usize = 30;

/// A configuration on the first points of the paths at which all constraints hold: `found` itself, one near it, or one near a drawn
/// configuration; `found` if there is none.
fn where_all_holds(
    robot: &Robot,
    asked: &TipPaths<'_>,
    limits: &Limits,
    options: &TrackOptions,
    found: Vec<f64>,
) -> Result<Vec<f64>> {
    if options.keeps.iter().all(|keep| keep.holds(robot, &found)) {
        return Ok(found);
    }
    let mut targets = asked.targets(0);
    let tasks = if asked.tips.is_empty() { vec![options.only_task()?] } else { checked_tasks(robot, asked.tips)? };
    reduce(robot, &tasks, &mut targets)?;
    let bounds = limits_at_start(robot, limits)?.position_box()?;
    let mut onto = Onto::new(robot, &options.keeps, bounds.ends()).reaching(tasks.into_iter().zip(targets));
    let drawn = robot.random_configurations(STARTS, &mut rng::stream(options.seed, 0))?;
    for from in std::iter::once(&found[..]).chain(drawn.chunks(robot.dof())) {
        let mut near = from.to_vec();
        if onto.bring(&mut near) {
            return Ok(near);
        }
    }
    Ok(found)
}

/// Position limits at t = 0.
fn limits_at_start(robot: &Robot, limits: &Limits) -> Result<Limits> {
    let at_start = |field: Field| -> Vec<Profile> {
        let profiles = limits.field(field).unwrap_or_default().iter();
        profiles.map(|profile| Profile::Constant(profile.at(0.0))).collect()
    };
    Limits::of(robot).replace(Field::Lower, at_start(Field::Lower))?.replace(Field::Upper, at_start(Field::Upper))
}

/// Default goals of the first configuration.
fn start_goals(robot: &Robot, target: &Target) -> Vec<Goal> {
    let centring = Goal::Centring { weight: 1.0 };
    if robot.tip_count() > 1 {
        return vec![centring];
    }
    let motion = if matches!(target, Target::Position(_)) { Motion::Position } else { Motion::Pose };
    vec![Goal::Manipulability { motion, tip: None, weight: 1.0 }, centring]
}
