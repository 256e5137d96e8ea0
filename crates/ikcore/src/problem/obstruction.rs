//! Why a target was not reached, in words.

use crate::kinematics::Beyond;
use crate::objective::Bounds;
use crate::robot::Robot;

/// Joints named at most; the others are counted.
const MOST_NAMED: usize = 3;

/// What is in the way at `q`: how far the target is out of reach, if it provably is, where the tip has `passed` its
/// region, and the joints at their limits.
pub(crate) fn obstruction(
    robot: &Robot,
    bounds: &Bounds,
    q: &[f64],
    beyond: Option<Beyond>,
    passed: Option<String>,
) -> String {
    let reach = beyond.map(|beyond| beyond.to_string());
    reach.into_iter().chain(passed).chain(joints_at_limits(robot, bounds, q)).collect::<Vec<_>>().join("; ")
}

fn joints_at_limits(robot: &Robot, bounds: &Bounds, q: &[f64]) -> Option<String> {
    let side = |j: usize| match (q[j] == bounds.lower()[j], q[j] == bounds.upper()[j]) {
        (true, true) => Some("held by limits that leave it no room"),
        (true, false) => Some("at its lower limit"),
        (false, true) => Some("at its upper limit"),
        (false, false) => None,
    };
    let stuck: Vec<_> = (0..q.len()).filter_map(|j| Some((&robot.joints()[j].name, side(j)?))).collect();
    let named: Vec<_> = stuck
        .iter()
        .take(MOST_NAMED)
        .map(|(name, side)| format!("joint '{name}' {side}"))
        .chain((stuck.len() > MOST_NAMED).then(|| format!("{} more joints at theirs", stuck.len() - MOST_NAMED)))
        .collect();
    (!named.is_empty()).then(|| named.join(", "))
}
