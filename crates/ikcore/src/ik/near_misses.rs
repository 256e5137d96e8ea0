//! Solutions of a redundant arm in narrow ranges of its parameter, which fall between the values that are tried.
//!
//! A branch that is inside the limits somewhere is only a little outside them nearby. Descents from the branches that are least outside
//! lead along the self-motion into the limits.

use super::attempt::Attempt;
use super::preference::Preference;
use super::solution::Solution;
use crate::closed_form::{ArmConfigurations, ParameterArcs, PoseFamily};
use crate::objective::Point;
use crate::solver::{LevenbergMarquardt, Status};

/// Values of the parameter at which near misses are looked for.
pub(super) const LOOKED: usize = 48;

/// A branch farther outside its limits (rad, m) is no near miss.
const NEAR: f64 = 0.4;

/// Most near misses that are descended from.
const DESCENTS: usize = 8;

/// Most evaluations of a descent.
const STEPS: usize = 40;

/// Near misses in which all joints differ by less (rad, m) lead to the same place.
const APART: f64 = 0.3;

/// A solution that a descent from a near miss leads to.
#[cold]
pub(super) fn from_near_misses(
    attempt: &mut Attempt<'_, '_>,
    family: &PoseFamily<'_>,
    arcs: &ParameterArcs,
    preference: &Preference,
) -> Option<Solution> {
    let mut misses = near_misses(family, arcs, preference);
    misses.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut tried: Vec<Point> = Vec::with_capacity(DESCENTS);
    for (_, q) in misses {
        if tried.len() == DESCENTS {
            break;
        }
        if tried.iter().any(|other| other.iter().zip(&q).all(|(a, b)| (a - b).abs() < APART)) {
            continue;
        }
        let (is_solved, found) = attempt.descend_some(&LevenbergMarquardt::default(), q.clone(), STEPS);
        if is_solved {
            return Some(attempt.solution(Status::Solved, found));
        }
        tried.push(q);
    }
    None
}

/// Branches near the limits, moved inside, and how far outside they were (rad, m).
fn near_misses(family: &PoseFamily<'_>, arcs: &ParameterArcs, preference: &Preference) -> Vec<(f64, Point)> {
    let [lower, upper] = preference.ranges();
    let wider = |ends: &[f64], by: f64| ends.iter().map(|end| end + by).collect::<Point>();
    let limits = family.limits(&wider(lower, -NEAR), &wider(upper, NEAR));
    let mut likely = ArmConfigurations::none();
    let mut misses = vec![];
    for value in arcs.spread(LOOKED) {
        family.likely_at(value, &limits, &mut likely);
        misses.extend(preference.misses(&likely).filter(|(outside, _)| *outside < NEAR));
    }
    misses
}
