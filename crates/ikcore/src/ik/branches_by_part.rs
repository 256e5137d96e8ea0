//! Branches of the closed form of an arm for a pose, a few in each call: for control loops, whose work in a tick is bounded.

use crate::closed_form::ArmConfigurations;
use crate::math::Frame;
use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// Number of values of the parameter of a redundant arm.
const VALUES: usize = 24;
/// Number of these values per call.
const VALUES_IN_A_CALL: usize = 2;

/// Hands likely branches of `pose`, to be confirmed by forward kinematics, to `take`: all of them or, for a redundant arm, those
/// at the next values of its parameter inside the finite `ranges`, of which `tried` counts those before. Returns whether these
/// were the last; `None` without a closed form that is as quick as a search.
pub(crate) fn next_branches(
    robot: &Robot,
    pose: &Frame,
    ranges: &Bounds,
    tried: &mut usize,
    mut take: impl FnMut(Point),
) -> Option<bool> {
    robot.solves_at_once().filter(|at_once| *at_once)?;
    let mut branches = ArmConfigurations::none();
    let mut hand_over = |branches: &ArmConfigurations| {
        for index in 0..branches.len() {
            take(branches.columns().iter().map(|values| values[index]).collect());
        }
    };
    let Some(family) = robot.family(pose) else {
        if !robot.approximate_branches(pose, &mut branches) {
            robot.likely_branches(pose, &mut branches);
        }
        hand_over(&branches);
        return Some(true);
    };
    let limits = family.limits(ranges.lower(), ranges.upper());
    let arcs = family.arcs(&limits);
    let mut values = arcs.spread(VALUES).skip(*tried);
    for value in values.by_ref().take(VALUES_IN_A_CALL) {
        family.likely_at(value, &limits, &mut branches);
        hand_over(&branches);
        *tried += 1;
    }
    Some(values.next().is_none())
}
