//! The point-to-point planner.

use super::collision_constraint::CollisionTest;
use super::end_configurations::EndConfigurations;
use super::published_settings::{METHOD, no_configuration, search};
use super::via_point_cost::ViaPointCost;
use crate::error::Result;
use crate::obstacle::{ClearSpace, ClearanceSweep};
use crate::plan::{
    Elbow, EndName, Endpoint, Plan, PointToPointOptions, Tpbso, least_clearance, refuse_collision, too_near,
};
use crate::robot::Robot;
use crate::solver::{Monitor, Stopwatch};
use crate::timing::ConstantLimits;

/// Plans a motion from point to point.
pub(crate) fn point_to_point(
    robot: &Robot,
    [start, end]: [&Endpoint; 2],
    space: Option<&ClearSpace<'_>>,
    (tpbso, options): (&Tpbso, &PointToPointOptions),
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.refuse_jerk(METHOD)?;
    limits.refuse_tips(METHOD)?;
    limits.refuse_torque(METHOD)?;
    limits.require_velocities(METHOD)?;
    let collisions = space.map(|space| CollisionTest::new(space, robot));
    let mut configurations = |name: EndName, end: &Endpoint, elbow: Elbow| {
        let what = name.of_given(end);
        if let (Endpoint::Configuration(q), Some(space)) = (end, space) {
            refuse_collision(&what, space, q)?;
        }
        EndConfigurations::new(&what, end, robot, &limits, elbow, options.seed, monitor)
    };
    if let Endpoint::Configuration(q) = end {
        limits.position_limits(robot)?.admit(Some(robot), &EndName::End.of_configuration(), q)?;
    }
    let [start_elbow, end_elbow] = tpbso.elbows;
    let start = configurations(EndName::Start, start, start_elbow)?;
    let end = configurations(EndName::End, end, end_elbow)?;
    let mut cost = ViaPointCost::new(robot, &limits, [start, end], options.objective, collisions.as_ref());
    let search = search(tpbso.solver.as_ref(), options.stop, options.seed);
    let bounds = cost.bounds();
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("start or end")))?;
    let mut violations = limits.violations(&trajectory);
    let mut clearance = None;
    if let Some(space) = space
        && let Some((least, contact)) = least_clearance(&mut ClearanceSweep::new(space.scene()), &trajectory, None)?
    {
        violations.extend((least.distance < space.margin()).then(|| too_near(&contact, space.margin())));
        clearance = Some(least);
    }
    let status = found.status(violations.is_empty());
    let cost = options.objective.of(robot, &trajectory);
    Ok(Plan {
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
