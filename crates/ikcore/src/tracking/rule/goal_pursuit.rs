//! The model-based rule under acceleration and jerk limits: it keeps a goal, the moving configuration that meets the target,
//! and pursues it inside the reachable set of the tick.
//!
//! Each target gives a sample of the goal: Gauss-Newton steps from where the goal was expected, within the position limits
//! alone. [`MovingGoal`] filters the samples by their noise; [`Pursuit`] chooses the changes of the joints. Without noise the arm
//! meets a target that moves smoothly exactly, with one Jacobian and one tip a tick.

use super::tick::{Tick, TickResult};
use crate::math::vector::{distance, largest_difference};
use crate::motion::{GoalSample, MovingGoal, Pursuit};
use crate::objective::{Bounds, Linearization, Point};
use crate::solver::{LevenbergMarquardt, Stop};
use crate::tracking::step_context::StepContext;

/// Steps that Gauss-Newton may take in a tick; they converge quadratically.
const MOST_STEPS: usize = 6;

/// A step this short (rad, m) leaves an error of its square, which is below every tolerance.
const SHORT: f64 = 1e-5;

/// Evaluations of a tick in which Gauss-Newton fails: at singularities and out of reach. The next tick continues.
const MOST_EVALUATIONS: usize = 60;

/// A motion of the goal that lowers the squared error by less than this fraction is none towards the target.
const NO_GAIN: f64 = 1e-3;

/// A descent that lowers the error by less than this for each unit of its way (m/rad) goes along a flat valley, which need not end.
const FLAT: f64 = 1e-5;

/// Restarts the goal this many samples after obstacles changed one: its memory holds motions along obstacles, not noise.
const RELEASED: usize = 5;

/// A goal farther from the arm than this (rad, m) does not show the way along an obstacle.
const FAR: f64 = 0.1;

/// Ticks without progress of an arm that holds pairs, after which there is no way to a far goal.
const NO_WAY: usize = 10;

/// State of the rule between ticks.
#[derive(Debug, Default)]
pub(crate) struct GoalPursuit {
    goal: Option<MovingGoal>,
    /// Ticks since the start.
    now: f64,
    expected: Point,
    sample: Point,
    /// Samples since obstacles changed one.
    since_held: Option<usize>,
    /// The least distance (rad, m) of the goal from an arm that holds pairs, and samples since then.
    nearest: Option<(f64, usize)>,
    linearization: Box<Linearization>,
}

impl GoalPursuit {
    /// Drops the goal.
    pub(crate) fn forget(&mut self) {
        self.goal = None;
    }

    /// Finds a sample of the goal if new targets have arrived, which have the age `tick.sampled_ago` at the end of the tick, in ticks.
    pub(super) fn find_sample(&mut self, tick: &mut Tick<'_>) -> TickResult {
        let StepContext { q, aims, limited, .. } = tick.context;
        let mut found = TickResult::at(q);
        let Some(motion) = limited else { return found };
        let released = self.since_held == Some(RELEASED);
        if let Some(ago) = tick.sampled_ago.filter(|_| self.goal.is_none() || released) {
            self.since_held = None;
            self.goal = Some(MovingGoal::of_arm(q, motion.state(), self.now, self.now + 1.0 - ago));
        }
        self.now += 1.0;
        if let Some(goal) = &mut self.goal {
            goal.advance(motion.scales());
        }
        let Some(ago) = tick.sampled_ago else { return found };
        let time = self.now - ago;
        if let Some(goal) = &self.goal {
            goal.expected(time, &mut self.expected);
        }
        let anew = (aims.has_pairs() && self.has_no_way(self.away(q))).then_some(q);
        self.solve(anew, time, &tick.context.positions(), &mut found, tick);
        found
    }

    /// How far the expected goal is from an arm at `q` (rad, m).
    fn away(&self, q: &[f64]) -> f64 {
        largest_difference(&self.expected, q)
    }

    /// Where to look for a clear sample of an arm at `q`, and the sample to replace.
    pub(super) fn sample_to_clear<'s>(&'s mut self, q: &'s [f64]) -> (&'s [f64], &'s mut Point) {
        // A goal that obstacles have kept far away may be on the wrong side of one.
        let is_near = self.away(q) < FAR;
        (if is_near { &self.expected } else { q }, &mut self.sample)
    }

    /// Notes whether obstacles changed the sample.
    pub(super) fn note_held(&mut self, held: bool) {
        self.since_held = if held { Some(0) } else { self.since_held.map(|samples| samples + 1) };
    }

    /// Corrects the goal by the sample, if there is one, and moves the arm one tick towards it.
    pub(super) fn pursue(&mut self, mut found: TickResult, tick: &Tick<'_>) -> TickResult {
        let StepContext { robot, q, aims, limited, .. } = tick.context;
        let Some(motion) = limited else { return found };
        if let (Some(goal), Some(ago)) = (&mut self.goal, tick.sampled_ago) {
            goal.correct(GoalSample { q: &self.sample, time: self.now - ago }, &self.expected, motion.scales());
        }
        match &self.goal {
            Some(goal) if !found.interrupted => {
                let (braking, scales, reachable) = (motion.braking(), motion.scales(), tick.bounds());
                Pursuit { goal, braking, scales, reachable }.write(q, motion.state(), &mut found.q);
            }
            _ => {
                found.q = motion.stopping(q);
                tick.bounds().clip(&mut found.q);
            }
        }
        found.assess(robot, &aims);
        found.evaluations += 1;
        found
    }

    /// Whether an arm that holds pairs has got no nearer to its goal, which is `away` (rad, m), for long.
    fn has_no_way(&mut self, away: f64) -> bool {
        self.nearest = match self.nearest {
            _ if away <= FAR => None,
            Some((nearest, samples)) if away >= nearest => Some((nearest, samples + 1)),
            _ => Some((away, 0)),
        };
        let waited = self.nearest.is_some_and(|(_, samples)| samples >= NO_WAY);
        if waited {
            self.nearest = None;
        }
        waited
    }

    /// Sets `sample` to the configuration nearest to the expected one, or to that to begin `anew` at, that meets the target of `time`
    /// (in ticks).
    fn solve(
        &mut self,
        anew: Option<&[f64]>,
        time: f64,
        positions: &Bounds,
        found: &mut TickResult,
        tick: &mut Tick<'_>,
    ) {
        let n = self.expected.len();
        self.sample = Point::from_slice(anew.unwrap_or(&self.expected));
        positions.clip(&mut self.sample);
        let mut begin = self.sample.clone();
        let mut lowest = f64::INFINITY;
        for i in 0..MOST_STEPS {
            let value = self.linearize(found, tick);
            if value > lowest {
                break;
            }
            (lowest, begin) = (value, self.sample.clone());
            let preferred = (i == 0 && anew.is_none()).then(|| self.preferred(time, positions, tick));
            let least = self.linearization.least_damping(n);
            let lambda = least.max(LevenbergMarquardt::default().initial_damping * value);
            let ends = positions.ends();
            match preferred {
                Some(preferred) => {
                    self.linearization.write_step_near(&preferred, lambda, &begin, ends, &mut self.sample);
                }
                None => self.linearization.write_step(lambda, &begin, ends, &mut self.sample),
            }
            if largest_difference(&self.sample, &begin) <= SHORT {
                return;
            }
        }
        self.sample = begin;
        self.begin_at_rest((time, lowest), positions, found, tick);
        self.descend(positions, found, tick);
    }

    /// Moves `sample` to where the goal was, unless its motion has lowered the error below `lowest`: out of reach, the goal would go on
    /// along the self-motion for ever.
    fn begin_at_rest(
        &mut self,
        (time, lowest): (f64, f64),
        positions: &Bounds,
        found: &mut TickResult,
        tick: &Tick<'_>,
    ) {
        let Some(goal) = &self.goal else { return };
        let moved = self.sample.clone();
        goal.expected(time - goal.remembered(), &mut self.sample);
        positions.clip(&mut self.sample);
        if self.linearize(found, tick) > lowest * (1.0 + NO_GAIN) {
            self.sample = moved;
        }
    }

    /// Residual and Jacobian at `sample`; returns the squared error.
    fn linearize(&mut self, found: &mut TickResult, tick: &Tick<'_>) -> f64 {
        found.evaluations += 1;
        found.iterations += 1;
        let StepContext { robot, aims, .. } = tick.context;
        aims.linearize(robot, &self.sample, &mut self.linearization, |_| ()).score.value
    }

    /// Where the joints should be at `time` as far as the target leaves them free: where the goal was before the samples that it
    /// remembers, moved as the goals in the null space ask. The motion of the goal is not extrapolated there, since no target
    /// would ever stop it; nor would a filter that remembers many samples, were it told where the goal was one sample before.
    fn preferred(&self, time: f64, positions: &Bounds, tick: &mut Tick<'_>) -> Point {
        let mut preferred = self.sample.clone();
        if let Some(goal) = &self.goal {
            goal.expected(time - goal.remembered(), &mut preferred);
        }
        if !tick.goals.is_empty() {
            let mut slope = preferred.clone();
            let StepContext { robot, dt, .. } = tick.context;
            tick.goals.cost(robot, None, &self.sample, &mut slope);
            preferred.iter_mut().zip(&slope).for_each(|(preferred, slope)| *preferred -= dt * slope);
        }
        positions.clip(&mut preferred);
        preferred
    }

    /// Lowers the error as far as one tick allows, where Gauss-Newton fails.
    fn descend(&mut self, positions: &Bounds, found: &mut TickResult, tick: &mut Tick<'_>) {
        let StepContext { robot, aims, .. } = tick.context;
        let mut end = TickResult::at(&self.sample);
        tick.descend(&mut end, positions, Stop { max_evaluations: MOST_EVALUATIONS, ..Stop::default() });
        found.evaluations += end.evaluations;
        found.iterations += end.iterations;
        let [before, after] = [&self.sample, &end.q].map(|q| aims.assess(robot, q).score);
        if after.solved || before.value.sqrt() - after.value.sqrt() > FLAT * distance(&self.sample, &end.q) {
            self.sample = end.q;
        }
    }
}
