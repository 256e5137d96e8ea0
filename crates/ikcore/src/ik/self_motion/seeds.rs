//! Configurations on the curves of a self-motion.

use crate::ik::attempt::Attempt;
use crate::objective::Point;
use crate::robot::{JointKind, Robot};
use crate::task::Target;

/// Configurations on curves, and whether every curve contains one of them.
pub(super) struct Seeds {
    pub seeds: Vec<Point>,
    pub complete: bool,
}

/// Configurations of every branch at `count` values of the parameter, limits aside; `None` without a closed form.
pub(super) fn by_closed_form(robot: &Robot, attempt: &mut Attempt<'_, '_>, count: usize) -> Option<Seeds> {
    let (Target::Pose(pose), _) = attempt.problem.only_target()? else { return None };
    let family = robot.family(pose)?;
    let bounds = attempt.context.bounds();
    // Tracing ignores the limits of revolute joints.
    let slides = |j: &usize| robot.joints()[*j].kind == JointKind::Prismatic;
    let limits = |values: &[f64], open: f64| -> Vec<f64> {
        (0..robot.dof()).map(|j| if slides(&j) { values[j] } else { open }).collect()
    };
    let (lower, upper) = (limits(bounds.lower(), f64::NEG_INFINITY), limits(bounds.upper(), f64::INFINITY));
    let (mut seeds, mut is_singular) = (Vec::new(), false);
    for value in family.arcs(&family.limits(&lower, &upper)).spread(count) {
        let branches = family.branches_at(value);
        attempt.budget.evaluations += branches.evaluations;
        is_singular |= branches.singular;
        seeds.extend(branches.iter().map(|(q, _)| Point::from_slice(q)));
    }
    Some(Seeds { seeds, complete: family.is_by_arm_angle() && !is_singular })
}
