//! Solutions of a redundant arm in narrow ranges of its parameter, which fall between the values that are tried.
//!
//! A branch that is inside the limits somewhere is only a little outside them nearby. Descents from the branches that are least outside
//! lead along the self-motion into the limits.

use smallvec::SmallVec;

use super::attempt::Attempt;
use super::preference::{Miss, Preference};
use super::solution::Solution;
use crate::closed_form::{ArmConfigurations, FamilyLimits, ParameterArcs, PoseFamily};
use crate::objective::Point;
use crate::solver::{LevenbergMarquardt, Status};

/// Values of the parameter at which near misses are looked for.
pub(super) const LOOKED: usize = 32;

/// A branch farther outside its limits (rad, m) is no near miss.
const NEAR: f64 = 1.2;

/// A branch less far outside is at a limit just where a solution is: it is descended from at once.
const AT_A_SOLUTION: f64 = 1e-3;

/// A branch less far outside may only touch its limits from outside, where descents are slow: its parameter is refined first.
const TOUCHING: f64 = 0.03;

/// A branch that is farther outside wherever the parameter is refined to does not touch its limits.
const APART_FROM_LIMITS: f64 = 0.002;

/// Halvings of the distance between values, two values each, that refine the parameter of such a branch.
const HALVINGS: usize = 7;

/// Most near misses that are refined or descended from.
const DESCENTS: usize = 6;

/// Most evaluations of a descent.
const STEPS: usize = 15;

/// Near misses in which all joints differ by less (rad, m) lead to the same place.
const APART: f64 = 0.3;

/// A branch near its limits.
#[derive(Debug, Clone)]
struct NearMiss {
    /// How far outside it is (rad, m).
    outside: f64,
    /// Value of the parameter (rad, m).
    value: f64,
    /// The branch, moved inside.
    q: Point,
}

impl NearMiss {
    fn leads_to_the_same_as(&self, other: &Point) -> bool {
        other.iter().zip(&self.q).all(|(a, b)| (a - b).abs() < APART)
    }
}

/// A solution that a descent from a near miss leads to, looked for at the values `open` of the parameter and then at others; a near miss
/// if a branch is inside the limits that does not reach the pose: the tolerances are tighter than rounding allows the closed form.
#[cold]
pub(super) fn from_near_misses(
    attempt: &mut Attempt<'_, '_>,
    (family, preference): (&PoseFamily<'_>, &Preference),
    arcs: &ParameterArcs,
    open: &[f64],
) -> Result<Solution, Miss> {
    let mut look = Look::new(family, preference);
    let mut misses: Vec<NearMiss> = Vec::new();
    // Where another joint reaches its limit just as joint 4 does, only the end of an arc is inside all limits.
    let others = arcs.iter().flatten().copied().chain(arcs.spread(LOOKED));
    for (number, value) in open.iter().copied().chain(others).enumerate() {
        let near = if number < open.len() { TOUCHING } else { AT_A_SOLUTION };
        for miss in look.at(value) {
            if miss.outside < near
                && let Some(solution) = descended(attempt, &miss)
            {
                return Ok(solution);
            }
            if miss.outside == 0.0 {
                return Err(Miss::Near);
            }
            misses.push(miss);
        }
    }
    misses.sort_by(|a, b| a.outside.total_cmp(&b.outside));
    let mut tried: SmallVec<[Point; DESCENTS]> = SmallVec::new();
    for miss in misses {
        if tried.len() == DESCENTS {
            break;
        }
        if tried.iter().any(|other| miss.leads_to_the_same_as(other)) {
            continue;
        }
        tried.push(miss.q.clone());
        let miss = if miss.outside < TOUCHING {
            let refined = look.refined(miss, arcs.length() / LOOKED as f64);
            if refined.outside > APART_FROM_LIMITS {
                continue;
            }
            refined
        } else {
            miss
        };
        if let Some(solution) = descended(attempt, &miss) {
            return Ok(solution);
        }
    }
    Err(Miss::Far)
}

/// The solution that a descent from a near miss leads to.
fn descended(attempt: &mut Attempt<'_, '_>, miss: &NearMiss) -> Option<Solution> {
    let (is_solved, q) = attempt.descend_some(&LevenbergMarquardt::default(), miss.q.clone(), STEPS);
    is_solved.then(|| attempt.solution(Status::Solved, q))
}

/// Where near misses are looked for.
struct Look<'a> {
    family: &'a PoseFamily<'a>,
    preference: &'a Preference,
    /// Wider than those of the arm.
    limits: FamilyLimits,
    likely: ArmConfigurations,
}

impl<'a> Look<'a> {
    fn new(family: &'a PoseFamily<'a>, preference: &'a Preference) -> Self {
        let [lower, upper] = preference.ranges();
        let wider = |ends: &[f64], by: f64| ends.iter().map(|end| end + by).collect::<Point>();
        let limits = family.limits(&wider(lower, -NEAR), &wider(upper, NEAR));
        Self { family, preference, limits, likely: ArmConfigurations::none() }
    }

    /// The near misses with the parameter at `value`.
    fn at(&mut self, value: f64) -> SmallVec<[NearMiss; 4]> {
        self.family.likely_at(value, &self.limits, &mut self.likely);
        let misses = self.preference.misses(&mut self.likely, NEAR);
        misses.map(|(outside, q)| NearMiss { outside, value, q }).collect()
    }

    /// The least of the misses around `miss`, which is one of those at values `spacing` apart.
    fn refined(&mut self, mut miss: NearMiss, spacing: f64) -> NearMiss {
        let mut step = spacing;
        for _ in 0..HALVINGS {
            step *= 0.5;
            let around = [miss.value - step, miss.value + step].map(|value| self.at(value));
            let least = around.into_iter().flatten().min_by(|a, b| a.outside.total_cmp(&b.outside));
            if let Some(nearer) = least.filter(|other| other.outside < miss.outside) {
                miss = nearer;
            }
        }
        miss
    }
}
