//! Solutions of a redundant arm in ranges of its parameter too narrow for the sampled values.
//!
//! Near such a range, branches are only slightly outside the limits. Descents from the branches least outside lead along the
//! self-motion into the limits.

use smallvec::SmallVec;

use super::attempt::Attempt;
use super::preference::{Miss, Preference};
use super::solution::Solution;
use crate::closed_form::{ArmConfigurations, FamilyLimits, ParameterArcs, PoseFamily};
use crate::math::vector::largest_difference;
use crate::objective::Point;
use crate::solver::{LevenbergMarquardt, Status};

/// Number of parameter values searched for near misses.
pub(super) const LOOKED: usize = 32;

/// Largest excess over the limits (rad, m) of a near miss.
const NEAR: f64 = 1.2;

/// Excess below which a solution is at the limit itself: the descent starts at once.
const AT_A_SOLUTION: f64 = 1e-3;

/// Excess below which a branch may only touch its limits from outside, where descents are slow: its parameter is refined first.
const TOUCHING: f64 = 0.03;

/// Excess after refinement above which a branch does not touch its limits.
const APART_FROM_LIMITS: f64 = 0.002;

/// Halvings of the distance between values, with two values each, that refine the parameter of such a branch.
const HALVINGS: usize = 7;

/// Largest number of near misses to refine or descend from.
const DESCENTS: usize = 6;

/// Evaluation budget of a descent.
const STEPS: usize = 15;

/// Joint difference (rad, m) below which two near misses lead to the same solution.
const APART: f64 = 0.3;

/// Branch slightly outside its limits.
#[derive(Debug, Clone)]
struct NearMiss {
    /// Excess over the limits (rad, m).
    outside: f64,
    /// Value of the parameter (rad, m).
    value: f64,
    /// Branch clamped to the limits.
    q: Point,
}

impl NearMiss {
    fn leads_to_the_same_as(&self, other: &Point) -> bool {
        largest_difference(other, &self.q) < APART
    }
}

/// Finds a solution by descent from near misses at the parameter values `open`, then at others. `Miss::Near` if a branch is
/// inside the limits but misses the pose: the tolerances are tighter than rounding allows the closed form.
#[cold]
pub(super) fn from_near_misses(
    attempt: &mut Attempt<'_, '_>,
    (family, preference): (&PoseFamily<'_>, &Preference),
    arcs: &ParameterArcs,
    open: &[f64],
) -> Result<Solution, Miss> {
    let mut search = NearMissSearch::new(family, preference);
    let mut misses: Vec<NearMiss> = Vec::new();
    // Only the end of an arc is inside all limits if another joint reaches its limit just as joint 4 does.
    let others = arcs.iter().flatten().copied().chain(arcs.spread(LOOKED));
    for (number, value) in open.iter().copied().chain(others).enumerate() {
        let near = if number < open.len() { TOUCHING } else { AT_A_SOLUTION };
        for miss in search.at(value) {
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
            let refined = search.refined(miss, arcs.length() / LOOKED as f64);
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

/// Descends from a near miss to a solution.
fn descended(attempt: &mut Attempt<'_, '_>, miss: &NearMiss) -> Option<Solution> {
    let (is_solved, q) = attempt.descend_some(&LevenbergMarquardt::default(), miss.q.clone(), STEPS);
    is_solved.then(|| attempt.solution(Status::Solved, q))
}

/// Search for near misses of one pose.
struct NearMissSearch<'a> {
    family: &'a PoseFamily<'a>,
    preference: &'a Preference,
    /// Limits widened by [`NEAR`].
    limits: FamilyLimits,
    likely: ArmConfigurations,
}

impl<'a> NearMissSearch<'a> {
    fn new(family: &'a PoseFamily<'a>, preference: &'a Preference) -> Self {
        let [lower, upper] = preference.ranges();
        let wider = |ends: &[f64], by: f64| ends.iter().map(|end| end + by).collect::<Point>();
        let limits = family.limits(&wider(lower, -NEAR), &wider(upper, NEAR));
        Self { family, preference, limits, likely: ArmConfigurations::none() }
    }

    /// Near misses with the parameter at `value`.
    fn at(&mut self, value: f64) -> SmallVec<[NearMiss; 4]> {
        self.family.likely_at(value, &self.limits, &mut self.likely);
        let misses = self.preference.misses(&mut self.likely, NEAR);
        misses.map(|(outside, q)| NearMiss { outside, value, q }).collect()
    }

    /// Refines the parameter of `miss`, found among values `spacing` apart, towards the least excess.
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
