//! Search for pairs of end configurations that are near each other in time.

use super::end_pair::EndPair;
use super::least_displacement::Freedom;
use crate::constraint::{Keep, Onto};
use crate::error::{Error, Result};
use crate::free_path::least_displacement;
use crate::ik::{Solution, SolveOptions, solve};
use crate::limits::Limits;
use crate::message::{Setting, message};
use crate::objective::Point;
use crate::plan::{Cost, Deadline, EndName, EndTurns, Endpoint, Improvement, Plan, PointToPointOptions, no_usable_end};
use crate::rng::{self, LazyRng};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::task::{NamedTask, Target, Task, Tolerance};
use crate::timing::ConstantLimits;
use crate::trajectory::Trajectory;

/// Robot, limits, ends and random stream shared by the searches for end configurations.
pub(super) struct PairSearch<'a> {
    pub robot: &'a Robot,
    pub limits: &'a ConstantLimits,
    pub start: &'a Endpoint,
    /// Alternative ends.
    pub ends: &'a [Endpoint],
    pub task: Option<Task>,
    pub rng: LazyRng,
    pub evaluations: usize,
    pub deadline: Deadline,
    pub seed: u64,
    pub position_limits: Limits,
    end_turns: EndTurns,
    freedom: Freedom<'a>,
    /// Constraints at every instant of the motion, and so at its ends.
    keeps: &'a [Keep],
}

/// Evaluations that random starts may cost in all, so that ends without a free configuration take a fraction of a second.
const RANDOM_EVALUATIONS: usize = 500_000;

impl<'a> PairSearch<'a> {
    /// # Errors
    /// None in practice: the limits were checked.
    pub(super) fn new(
        robot: &'a Robot,
        limits: &'a ConstantLimits,
        start: &'a Endpoint,
        ends: &'a [Endpoint],
        options: &'a PointToPointOptions,
        deadline: Deadline,
    ) -> Result<Self> {
        let position_limits = limits.position_limits(robot)?;
        let (task, seed) = (options.task, options.seed);
        let freedom = Freedom::new(robot, limits, task)?;
        Ok(Self {
            robot,
            limits,
            start,
            ends,
            task,
            rng: rng::stream(seed, 0),
            evaluations: 0,
            deadline,
            seed,
            position_limits,
            end_turns: options.end_turns,
            freedom,
            keeps: &options.keeps,
        })
    }

    /// The name of an end in messages.
    pub(super) fn name(&self, chosen: usize) -> EndName {
        EndName::of(chosen, self.ends.len())
    }

    /// Returns up to twice `count` pairs, shared between all ends, the quickest first: half from random starts, half from
    /// the quickest pairs of branches, all improved along the self-motion. One pair for each end if all configurations
    /// are given. Ends without a configuration are passed over.
    ///
    /// # Errors
    /// [`Error::Unreachable`] if no configuration was found for the start, [`Error::OutsideLimits`] or
    /// [`Error::Unreachable`] for a single end, [`Error::NoUsableEnd`] for several.
    pub(super) fn pairs(&mut self, count: usize, monitor: &mut dyn Monitor) -> Result<Vec<EndPair>> {
        let count = count.div_ceil(self.ends.len());
        let (mut pairs, mut problems) = (vec![], vec![]);
        for chosen in 0..self.ends.len() {
            if !pairs.is_empty() && (self.deadline.is_over() || !monitor.keep_going()) {
                break;
            }
            match self.pairs_to(chosen, count, monitor) {
                Ok(found) => pairs.extend(found),
                Err(Missing::Start(problem)) => return Err(problem),
                Err(Missing::End(problem)) => problems.push(problem),
            }
        }
        if pairs.is_empty() {
            return Err(no_usable_end(self.ends.len(), problems));
        }
        pairs.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        Ok(pairs)
    }

    /// Returns the pairs to one end.
    fn pairs_to(&mut self, chosen: usize, count: usize, monitor: &mut dyn Monitor) -> Result<Vec<EndPair>, Missing> {
        let (start, end) = (self.start, &self.ends[chosen]);
        self.require_inside(self.name(chosen), end).map_err(Missing::End)?;
        let given = [start, end].iter().all(|end| matches!(end, Endpoint::Configuration(_)));
        let mut pairs: Vec<EndPair> = vec![];
        for attempt in 0..if given { 1 } else { count } {
            if attempt > 0 && (self.deadline.is_over() || !monitor.keep_going()) {
                break;
            }
            let first = self.configuration(EndName::Start, start, None, attempt, monitor);
            let Some(first) = first.map_err(Missing::Start)? else { continue };
            // The second end is solved from the first, so that the solution is usually near. If the first is given,
            // only once: every attempt would find the same.
            let another = attempt == 0 || matches!(start, Endpoint::Targets { .. });
            let near = another.then_some(&first[..]);
            let second = self.configuration(self.name(chosen), end, near, attempt, monitor);
            let Some(second) = second.map_err(Missing::End)? else { continue };
            let pair = self.improved(self.pair(first, second, chosen), monitor);
            if pairs.iter().all(|known| !known.is_same(&pair)) {
                pairs.push(pair);
            }
        }
        if !given && !self.deadline.is_over() {
            for pair in self.branches(chosen, count, monitor).map_err(Missing::End)? {
                if self.deadline.is_over() {
                    break;
                }
                let pair = self.improved(pair, monitor);
                if pairs.iter().all(|known| !known.is_same(&pair)) {
                    pairs.push(pair);
                }
            }
        }
        Ok(pairs)
    }

    /// Returns up to `count` pairs accepted by `accept`, not improved, from up to `tries` random starts or
    /// [`RANDOM_EVALUATIONS`], which all ends share; the quickest first.
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
            let chosen = (attempt - 1) % self.ends.len();
            let (start, end) = (self.start, &self.ends[chosen]);
            let Some(first) = self.configuration(EndName::Start, start, None, attempt, monitor)? else { continue };
            let name = self.name(chosen);
            let Some(second) = self.configuration(name, end, None, attempt, monitor)? else { continue };
            let pair = self.pair(first, second, chosen);
            if accept(&pair) && pairs.iter().all(|known| !known.is_same(&pair)) {
                pairs.push(pair);
            }
        }
        pairs.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        Ok(pairs)
    }

    /// The pair of `start` and `end`, which is brought to the whole turns that the options ask for.
    pub(super) fn pair(&self, start: Point, mut end: Point, chosen: usize) -> EndPair {
        if self.end_turns == EndTurns::Nearest && matches!(self.ends[chosen], Endpoint::Configuration(_)) {
            self.robot.turn_near([&self.limits.lower, &self.limits.upper], &start, &mut end);
        }
        self.pair_as_is(start, end, chosen)
    }

    fn pair_as_is(&self, start: Point, end: Point, chosen: usize) -> EndPair {
        let duration = self.limits.quintic_duration(start.iter().zip(&end).map(|(start, end)| end - start));
        EndPair { start, end, chosen, duration }
    }

    /// Returns the pairs whose end configuration is one whole turn farther for one joint: the other way round.
    pub(super) fn other_ways(&self, pairs: &[EndPair]) -> Vec<EndPair> {
        let [lower, upper] = [&self.limits.lower, &self.limits.upper];
        let mut others = vec![];
        let turned = |pair: &&EndPair| matches!(self.ends[pair.chosen], Endpoint::Configuration(_));
        for pair in pairs.iter().filter(turned).filter(|_| self.end_turns == EndTurns::Nearest) {
            for j in (0..pair.end.len()).filter(|j| self.robot.turns_freely(*j, [lower[*j], upper[*j]])) {
                let Some(period) = self.robot.turn_period(j) else { continue };
                let mut end = pair.end.clone();
                end[j] += if end[j] > pair.start[j] { -period } else { period };
                others.push(self.pair_as_is(pair.start.clone(), end, pair.chosen));
            }
        }
        others
    }

    /// Options of a solve for an end.
    pub(super) fn solve_options(&self) -> SolveOptions {
        let limits = Some(self.position_limits.clone());
        SolveOptions { task: self.task, limits, seed: self.seed, ..SolveOptions::default() }
    }

    /// Checks that a configuration is inside the limits.
    fn require_inside(&self, name: EndName, end: &Endpoint) -> Result<()> {
        match end {
            Endpoint::Configuration(q) => {
                self.position_limits.admit(Some(self.robot), &name.of_configuration(), q).map(|_| ())
            }
            Endpoint::Targets { .. } => Ok(()),
        }
    }

    /// Solves for a configuration of an end, from `near` or a random start. The first attempt must succeed.
    fn configuration(
        &mut self,
        name: EndName,
        end: &Endpoint,
        near: Option<&[f64]>,
        attempt: usize,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<Point>> {
        let target = match end {
            Endpoint::Configuration(q) => return Ok(Some(q.as_slice().into())),
            Endpoint::Targets { targets, .. } => &targets[0],
        };
        let start = match near {
            Some(q) => Some(q.to_vec()),
            None if attempt == 0 => None,
            None => Some(self.random()),
        };
        let solution = self.solve(target, start, monitor)?;
        match solution.status {
            _ if self.takes(solution.status) => Ok(Some(self.brought(target, solution.q)?)),
            Status::RotationGivenUp if attempt == 0 => {
                let problem = message![solution.message(), ", or give ", Setting::First("position"), " to end there"];
                Err(Error::Unreachable { what: name.of_target(), problem })
            }
            _ if attempt == 0 => {
                let problem = format!("the nearest configuration found stays {} away", solution.error);
                Err(Error::Unreachable { what: name.of_target(), problem: problem.into() })
            }
            _ => Ok(None),
        }
    }

    /// The configuration of `target` near `q` at which everything holds that is to be kept; `q` itself where none is found.
    fn brought(&self, target: &Target, q: Point) -> Result<Point> {
        if self.holds(&q) {
            return Ok(q);
        }
        let (task, mut target) = (NamedTask::of_only(self.task, Tolerance::default()).validated()?, *target);
        task.reduce(&mut target)?;
        let limits = [&self.limits.lower[..], &self.limits.upper[..]];
        let mut onto = Onto::new(self.robot, self.keeps, limits).reaching([(task, target)]);
        let mut moved = q.clone();
        Ok(if onto.bring(&mut moved) { moved } else { q })
    }

    fn holds(&self, q: &[f64]) -> bool {
        self.keeps.iter().all(|keep| keep.holds(self.robot, q))
    }

    /// Whether an end with this status is taken: one that gives up a part does so only by the caller's own order.
    fn takes(&self, status: Status) -> bool {
        let is_ordered = self.task.is_some_and(|task| task.first.is_some());
        status == Status::Solved || is_ordered && status.is_given_up()
    }

    fn solve(&mut self, target: &Target, start: Option<Vec<f64>>, monitor: &mut dyn Monitor) -> Result<Solution> {
        let options = SolveOptions { start, ..self.solve_options() };
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
        let free = [self.start, &self.ends[pair.chosen]].map(|end| match end {
            Endpoint::Targets { targets, .. } => targets.first(),
            Endpoint::Configuration(_) => None,
        });
        let mut moved = pair.clone();
        self.evaluations += least_displacement::shorten(&self.freedom, free, &mut moved);
        for (target, q) in free.into_iter().zip([&mut moved.start, &mut moved.end]) {
            let Some(target) = target else { continue };
            match self.solve(target, Some(q.to_vec()), monitor) {
                Ok(solution) if self.takes(solution.status) => *q = solution.q,
                _ => return pair,
            }
        }
        let moved = self.pair(moved.start, moved.end, pair.chosen);
        let holds = self.holds(&moved.start) && self.holds(&moved.end);
        if holds && moved.duration < pair.duration { moved } else { pair }
    }

    /// Solved plan of a motion, with the limits that it violates.
    pub(super) fn plan(&self, trajectory: Trajectory, objective: Cost) -> Plan {
        let cost = objective.of(self.robot, &trajectory);
        Plan {
            history: vec![Improvement { evaluations: self.evaluations, cost }],
            violations: self.limits.violations(&trajectory),
            evaluations: self.evaluations,
            elapsed: self.deadline.elapsed(),
            ..Plan::of(trajectory, objective, cost)
        }
    }
}

/// The error of a search for a configuration, and the end that it concerns.
enum Missing {
    Start(Error),
    End(Error),
}
