//! A plan, and motions that come before and after it.

use super::collision_checks::{TimedMotion, nearest_at};
use super::plan::{Improvement, Plan};
use crate::error::Result;
use crate::obstacle::{NearestContact, Scene, Sweep};
use crate::robot::Robot;
use crate::trajectory::Trajectory;

/// A motion and how near it comes to anything.
#[derive(Debug, Clone)]
pub(super) struct MeasuredMotion {
    pub trajectory: Trajectory,
    /// The smallest distance (m) and the two bodies there; `None` if nothing can touch.
    closest: Option<(f64, Option<NearestContact>)>,
}

impl MeasuredMotion {
    /// Measures the smallest distance in `scene`; `least` is the distance (m) that is certified.
    pub(super) fn new(trajectory: Trajectory, scene: Option<&Scene>, least: f64) -> Result<Self> {
        let whole = [0.0, trajectory.duration()];
        let near =
            scene.and_then(|scene| Some((scene, Sweep::new(scene).smallest(&TimedMotion::new(&trajectory), whole)?)));
        let closest = match near {
            None => None,
            Some((scene, near)) => Some((near.contact.distance.max(least), nearest_at(scene, &trajectory, near.at)?)),
        };
        Ok(Self { trajectory, closest })
    }
}

/// The plan with a motion before or after it. Each begins at rest where the one before ends.
pub(super) fn joined(
    robot: &Robot,
    before: Option<MeasuredMotion>,
    plan: Plan,
    after: Option<MeasuredMotion>,
) -> Result<Plan> {
    let mut plan = plan;
    for (motion, is_first) in [(before, true), (after, false)] {
        let Some(MeasuredMotion { trajectory, closest }) = motion else { continue };
        plan.trajectory =
            if is_first { trajectory.then(&plan.trajectory, 0.0)? } else { plan.trajectory.then(&trajectory, 0.0)? };
        if let Some((distance, nearest)) = closest
            && plan.clearance.is_none_or(|clearance| distance < clearance)
        {
            (plan.clearance, plan.nearest) = (Some(distance), nearest);
        }
    }
    plan.cost = plan.objective.of(robot, &plan.trajectory);
    plan.history = vec![Improvement { evaluations: plan.evaluations, cost: plan.cost }];
    Ok(plan)
}
