//! A plan, and motions that come before and after it.

use super::plan::{Improvement, Plan};
use crate::error::Result;
use crate::robot::Robot;
use crate::trajectory::Trajectory;

/// The plan with a motion before or after it. Each begins at rest where the one before ends. The clearance remains that of the
/// plan alone.
pub(crate) fn joined(
    robot: &Robot,
    before: Option<&Trajectory>,
    mut plan: Plan,
    after: Option<&Trajectory>,
) -> Result<Plan> {
    if let Some(before) = before {
        plan.trajectory = before.then(&plan.trajectory, 0.0)?;
    }
    if let Some(after) = after {
        plan.trajectory = plan.trajectory.then(after, 0.0)?;
    }
    if before.is_some() || after.is_some() {
        // Certified of the plan alone.
        plan.keeps.clear();
    }
    plan.cost = plan.objective.of(robot, &plan.trajectory);
    plan.history = vec![Improvement { evaluations: plan.evaluations, cost: plan.cost }];
    Ok(plan)
}
