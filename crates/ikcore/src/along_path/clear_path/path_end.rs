//! Reason why the arm cannot follow a path beyond a place.

use super::passage::{Passage, Waypoint};
use super::sequence::{Swept, swept_on_to};
use crate::along_path::missed_points::missed_at;
use crate::along_path::timed::PathProblem;
use crate::error::Error;
use crate::math::vector::largest_difference;
use crate::obstacle::ClearSpace;
use crate::robot::limit_rounding;
use crate::wording::number;

/// Parts of the step beyond the place that are tried, the shorter the less the arm moves.
const PARTS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

/// A joint that would have to move farther (rad, m) in one step: the arm is singular between.
const JUMP: f64 = 1.0;

/// The cause, in words, why the arm does not get from a posture `from` to the path parameter `to` along the path.
///
/// Follows the path without regard to limits and obstacles, to the first thing that is in the way. With what the joints have `swept` until
/// there, whole turns may still be chosen.
pub(super) fn why_it_ends(
    passage: &mut Passage<'_>,
    space: Option<&ClearSpace<'_>>,
    from: Waypoint<'_>,
    to: f64,
    mut swept: Option<Swept>,
) -> String {
    let mut here = from.1.to_vec();
    for part in PARTS {
        let fraction = from.0 + part * (to - from.0);
        let Some(next) = passage.beyond_limits(fraction, &here) else {
            return unmet(passage, fraction);
        };
        let jump = largest_difference(&next, &here);
        if jump > JUMP {
            let joint = (0..here.len()).max_by(|a, b| {
                let moved = |j: usize| (next[j] - here[j]).abs();
                moved(*a).total_cmp(&moved(*b))
            });
            let name = passage.problem.limits.joint_name(joint.unwrap_or(0));
            return format!("a singularity: joint '{name}' would have to jump by {}", number(jump));
        }
        swept = swept.map(|swept| swept_on_to(&swept, &next));
        if let Some(limit) = beyond_limit(passage, &next, swept.as_ref()) {
            return limit;
        }
        if let Some(broken) = passage.problem.keeps.broken_at(&next) {
            return format!("what is to be kept would not hold: {broken}");
        }
        if let Some(heavy) = passage.problem.limits.too_heavy(&next) {
            return heavy;
        }
        let blocked = space.filter(|_| !passage.is_clear(fraction, &next));
        if let Some(near) = blocked.and_then(|space| Some((space.clearance(&next).nearest?, space.margin()))) {
            return format!("{} there", near.0.contact.in_words(near.1));
        }
        here = next.to_vec();
    }
    "no motion that was found leads on from there".into()
}

/// Words for the joint that is farthest beyond its limits, of those that whole turns do not bring inside.
fn beyond_limit(passage: &Passage<'_>, q: &[f64], swept: Option<&Swept>) -> Option<String> {
    let PathProblem { robot, limits, .. } = passage.problem;
    let excess = |j: usize| (limits.lower[j] - q[j]).max(q[j] - limits.upper[j]);
    let is_fixed = |j: &usize| swept.is_none_or(|[low, high]| passage.shift(*j, low[*j], high[*j]).is_none());
    let joint = (0..q.len()).filter(is_fixed).max_by(|a, b| excess(*a).total_cmp(&excess(*b)))?;
    let (lower, upper) = (limits.lower[joint], limits.upper[joint]);
    if excess(joint) <= limit_rounding(lower, upper) {
        return None;
    }
    let name = limits.joint_name(joint);
    let beyond = format!("beyond its limits [{}, {}]", number(lower), number(upper));
    let turns = robot.turn_period(joint).is_some_and(|period| upper - lower >= period);
    let (verb, end) = if turns { ("turn", ", and has no whole turns left") } else { ("go", "") };
    Some(format!("joint '{name}' would have to {verb} to {}, {beyond}{end}", number(q[joint])))
}

/// Words for a point that the arm does not reach from where it is, even without limits.
fn unmet(passage: &Passage<'_>, fraction: f64) -> String {
    let PathProblem { robot, tip_path, options, .. } = passage.problem;
    match missed_at(robot, tip_path, fraction, options.seed) {
        Ok(Some(Error::Unreachable { problem, .. })) => format!("it cannot be reached: {problem}"),
        Ok(Some(Error::NotFound { problem, .. })) => format!("no configuration was found: {problem}"),
        _ => "a singularity: no configuration on this branch of the arm leads on".into(),
    }
}
