//! The planner along a path.

use super::path_cost::PathCost;
use super::published_settings::{METHOD, no_configuration, search};
use super::redundancy::Redundancy;
use crate::along_path::{TipPath, refuse_repetition};
use crate::error::{Error, Result, require_positive};
use crate::message::{Setting, message};
use crate::plan::{AlongPathOptions, Plan, PlanarArm, Tpbso};
use crate::robot::Robot;
use crate::solver::{Monitor, Stopwatch};
use crate::timing::ConstantLimits;

/// Plans along a path, for planar arms.
pub(crate) fn along_path(
    robot: &Robot,
    tip_path: &TipPath,
    tpbso: &Tpbso,
    options: &AlongPathOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let arm = PlanarArm::of(robot).ok_or_else(|| not_planar(robot))?;
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.refuse_jerk(METHOD)?;
    limits.refuse_tips(METHOD)?;
    limits.refuse_torque(METHOD)?;
    limits.require_velocities(METHOD)?;
    let start = options.start.as_deref();
    let elbow = start.map_or_else(|| tpbso.elbow_along_path(), |q| Ok(arm.elbow(q)))?;
    let accuracy = options.accuracy.unwrap_or_else(|| ACCURACY * tip_path.extent());
    require_positive("accuracy", accuracy)?;
    refuse_repetition(tip_path.points())?;
    let redundancy = Redundancy::new(arm, tip_path.points(), elbow)?;
    let mut cost = PathCost::new(robot, &limits, redundancy, options.objective, accuracy, start);
    let search = search(tpbso.solver.as_ref(), options.stop, options.seed);
    let bounds = cost.bounds()?;
    let found = search.run(&mut cost, &bounds, monitor)?;
    let trajectory = cost.trajectory(&found.x).unwrap_or_else(|| Err(no_configuration("some point of the path")))?;
    let mut violations = limits.violations(&trajectory);
    let deviation = cost.deviation(tip_path);
    violations.extend(deviation.violations(tip_path, accuracy));
    let value = options.objective.of(robot, &trajectory);
    Ok(Plan {
        accuracy: Some(deviation.distance.value),
        reference: Some(tip_path.points().positions().to_vec()),
        redundancy: cost.orientations(&found.x),
        status: found.status(violations.is_empty()),
        violations,
        history: found.history,
        evaluations: found.evaluations,
        elapsed: stopwatch.elapsed(),
        ..Plan::of(trajectory, options.objective, value)
    })
}

/// Allowed distance from the path, relative to the extent of the path: the published planner needs this much for a
/// pentagram with every second of 50 points.
const ACCURACY: f64 = 0.04;

fn not_planar(robot: &Robot) -> Error {
    let problem = message![METHOD, " plans along paths for planar arms alone: use ", Setting::Method("timed")];
    Error::InvalidRobot { robot: robot.name().into(), problem }
}
