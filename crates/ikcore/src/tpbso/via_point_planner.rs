//! The point-to-point planner.

use super::collision_constraint::{Clearance, CollisionTest};
use super::end_configurations::EndConfigurations;
use super::published_settings::{METHOD, no_configuration, search};
use super::via_point_cost::ViaPointCost;
use crate::error::Result;
use crate::plan::{Elbow, Endpoint, Plan, PointToPointOptions, Tpbso, as_lines, can_collide};
use crate::robot::Robot;
use crate::solver::{Monitor, Stopwatch};
use crate::timing::ConstantLimits;

/// Plans a motion from point to point.
pub(crate) fn point_to_point(
    robot: &Robot,
    [start, end]: [&Endpoint; 2],
    tpbso: &Tpbso,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.refuse_jerk(METHOD)?;
    limits.require_velocities(METHOD)?;
    let can_collide = can_collide(robot, options);
    let lines = if can_collide { as_lines(robot, options)? } else { None };
    let collisions = can_collide.then(|| CollisionTest::new(robot, lines.as_ref(), options)).transpose()?;
    let mut configurations = |what: &str, end: &Endpoint, elbow: Elbow| {
        if let (Endpoint::Configuration(q), Some(collisions)) = (end, &collisions) {
            collisions.refuse_collision(what, q)?;
        }
        EndConfigurations::new(what, end, robot, &limits, elbow, options.seed, monitor)
    };
    let [start_elbow, end_elbow] = tpbso.elbows;
    let (start, end) = (configurations("start", start, start_elbow)?, configurations("end", end, end_elbow)?);
    let mut cost = ViaPointCost::new(robot, &limits, [start, end], options.objective, collisions.as_ref());
    let search = search(tpbso.solver.as_ref(), options.stop, options.seed);
    let bounds = cost.bounds();
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("start or end")))?;
    let mut violations = limits.violations(&trajectory);
    let (clearance, nearest) = match collisions.and_then(|collisions| collisions.clearance(&trajectory)) {
        None => (None, None),
        Some(Clearance { distance, nearest, violation }) => {
            violations.extend(violation);
            (Some(distance), nearest)
        }
    };
    let status = found.status(violations.is_empty());
    let cost = options.objective.of(robot, &trajectory);
    Ok(Plan {
        nearest,
        chosen_end: Some(0),
        history: found.history,
        clearance,
        status,
        violations,
        evaluations: found.evaluations,
        elapsed: stopwatch.elapsed(),
        ..Plan::of(trajectory, options.objective, cost)
    })
}
