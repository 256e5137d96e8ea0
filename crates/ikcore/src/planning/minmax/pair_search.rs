//! Search for pairs of end configurations that are near each other in time.

use super::end_pair::EndPair;
use super::least_displacement;
use crate::error::{Error, Result};
use crate::ik::{Solution, SolveOptions, solve};
use crate::limits::{Field, Limits, Profile};
use crate::objective::Point;
use crate::planning::deadline::Deadline;
use crate::planning::{Endpoint, MotionLimits};
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::Target;

/// Robot, limits, ends and random stream shared by the searches for end configurations.
pub(super) struct PairSearch<'a> {
    pub robot: &'a Robot,
    pub limits: &'a MotionLimits,
    pub ends: [&'a Endpoint; 2],
    pub rng: LazyRng,
    pub evaluations: usize,
    pub deadline: Deadline,
    pub seed: u64,
    pub position_limits: Limits,
}

/// Evaluations that random starts may cost in all, so that ends without a free configuration take a fraction of a second.
const RANDOM_EVALUATIONS: usize = 500_000;

/// Names of the two ends in messages.
pub(super) const NAMES: [&str; 2] = ["start", "end"];

impl<'a> PairSearch<'a> {
    /// # Errors
    /// [`Error::OutsideLimits`] for a configuration outside the limits.
    pub(super) fn new(
        robot: &'a Robot,
        limits: &'a MotionLimits,
        ends: [&'a Endpoint; 2],
        seed: u64,
        deadline: Deadline,
    ) -> Result<Self> {
        let constant = |values: &[f64]| values.iter().map(|value| Profile::Constant(*value)).collect();
        let position_limits = Limits::of(robot)
            .replace(Field::Lower, constant(&limits.lower))?
            .replace(Field::Upper, constant(&limits.upper))?;
        for (end, name) in ends.into_iter().zip(NAMES) {
            if let Endpoint::Configuration(q) = end {
                position_limits.require_inside(name, 0.0, q)?;
            }
        }
        Ok(Self { robot, limits, ends, rng: rng::stream(seed, 0), evaluations: 0, deadline, seed, position_limits })
    }

    /// Returns up to twice `count` pairs, the quickest first: half from random starts, half from the quickest pairs of
    /// branches, all improved along the self-motion. One pair if both configurations are given.
    ///
    /// # Errors
    /// [`Error::Unreachable`] if no configuration was found for an end.
    pub(super) fn pairs(&mut self, count: usize, monitor: &mut dyn Monitor) -> Result<Vec<EndPair>> {
        let given = self.ends.iter().all(|end| matches!(end, Endpoint::Configuration(_)));
        let mut pairs: Vec<EndPair> = vec![];
        for attempt in 0..if given { 1 } else { count } {
            if attempt > 0 && (self.deadline.is_over() || !monitor.keep_going()) {
                break;
            }
            let Some(first) = self.configuration(0, None, attempt, monitor)? else { continue };
            // The second end is solved from the first, so that the solution is usually near. If the first is given,
            // only once: every attempt would find the same.
            let another = attempt == 0 || matches!(self.ends[0], Endpoint::Target(_));
            let near = another.then_some(&first[..]);
            let Some(second) = self.configuration(1, near, attempt, monitor)? else { continue };
            let pair = self.improved(self.pair(first, second), monitor);
            if pairs.iter().all(|known| !known.is_same(&pair)) {
                pairs.push(pair);
            }
        }
        if !given && !self.deadline.is_over() {
            for pair in self.branches(count, monitor)? {
                if self.deadline.is_over() {
                    break;
                }
                let pair = self.improved(pair, monitor);
                if pairs.iter().all(|known| !known.is_same(&pair)) {
                    pairs.push(pair);
                }
            }
        }
        pairs.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        Ok(pairs)
    }

    /// Returns up to `count` pairs accepted by `accept`, not improved, from up to `tries` random starts or
    /// [`RANDOM_EVALUATIONS`]; the quickest first.
    ///
    /// # Errors
    /// None if [`pairs`](Self::pairs) has found some.
    pub(super) fn random_pairs(
        &mut self,
        count: usize,
        tries: usize,
        accept: impl Fn(&EndPair) -> bool,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<EndPair>> {
        let mut pairs: Vec<EndPair> = vec![];
        let last_evaluation = self.evaluations + RANDOM_EVALUATIONS;
        for attempt in 1..=tries {
            let is_spent = self.evaluations >= last_evaluation || self.deadline.is_over();
            if pairs.len() == count || is_spent || !monitor.keep_going() {
                break;
            }
            let Some(first) = self.configuration(0, None, attempt, monitor)? else { continue };
            let Some(second) = self.configuration(1, None, attempt, monitor)? else { continue };
            let pair = self.pair(first, second);
            if accept(&pair) && pairs.iter().all(|known| !known.is_same(&pair)) {
                pairs.push(pair);
            }
        }
        pairs.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        Ok(pairs)
    }

    pub(super) fn pair(&self, start: Point, end: Point) -> EndPair {
        let duration = self.limits.quintic_duration(start.iter().zip(&end).map(|(start, end)| end - start));
        EndPair { start, end, duration }
    }

    /// Solves for a configuration of an end, from `near` or a random start. The first attempt must succeed.
    fn configuration(
        &mut self,
        end: usize,
        near: Option<&[f64]>,
        attempt: usize,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<Point>> {
        let target = match self.ends[end] {
            Endpoint::Configuration(q) => return Ok(Some(q.as_slice().into())),
            Endpoint::Target(target) => target,
        };
        let start = match near {
            Some(q) => Some(q.to_vec()),
            None if attempt == 0 => None,
            None => Some(self.random()),
        };
        let solution = self.solve(target, start, monitor)?;
        match solution.status {
            Status::Solved => Ok(Some(solution.q)),
            _ if attempt == 0 => {
                let problem = format!("the nearest configuration found stays {} away", solution.error);
                Err(Error::Unreachable { what: NAMES[end].into(), problem })
            }
            _ => Ok(None),
        }
    }

    fn solve(&mut self, target: &Target, start: Option<Vec<f64>>, monitor: &mut dyn Monitor) -> Result<Solution> {
        let limits = Some(self.position_limits.clone());
        let options = SolveOptions { start, limits, seed: self.seed, ..SolveOptions::default() };
        let solution = solve(self.robot, target, &options, monitor)?;
        self.evaluations += solution.evaluations;
        Ok(solution)
    }

    fn random(&mut self) -> Vec<f64> {
        let joints = self.robot.joints().iter().enumerate();
        let ranges = joints.map(|(j, joint)| joint.sampling_range_within(self.limits.lower[j], self.limits.upper[j]));
        ranges.map(|(lower, upper)| self.rng.uniform_in(lower, upper)).collect()
    }

    /// Returns the pair moved along its self-motion, or unchanged if that does not help.
    fn improved(&mut self, pair: EndPair, monitor: &mut dyn Monitor) -> EndPair {
        let ends = self.ends;
        let free = ends.map(|end| match end {
            Endpoint::Target(target) => Some(target),
            Endpoint::Configuration(_) => None,
        });
        let mut moved = pair.clone();
        self.evaluations += least_displacement::shorten(self.robot, self.limits, free, &mut moved);
        for (target, q) in free.into_iter().zip([&mut moved.start, &mut moved.end]) {
            let Some(target) = target else { continue };
            match self.solve(target, Some(q.to_vec()), monitor) {
                Ok(solution) if solution.status == Status::Solved => *q = solution.q,
                _ => return pair,
            }
        }
        let moved = self.pair(moved.start, moved.end);
        if moved.duration < pair.duration { moved } else { pair }
    }
}
