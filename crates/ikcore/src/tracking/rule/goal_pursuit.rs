//! Model-based rule under acceleration and jerk limits: pursues a goal, the moving configuration that meets the target, inside
//! the reachable set of the tick.
//!
//! Each target gives a sample of the goal by Gauss-Newton steps from its predicted configuration, within the position limits
//! only. [`MovingGoal`] filters the samples by their noise; [`Pursuit`] chooses the joint accelerations. Without noise the arm
//! meets a smoothly moving target exactly, with one Jacobian and one tip per tick.

use super::tick::{BY_LEVELS, Tick, TickResult};
use crate::ik::{LevelDescent, RankedDescent};
use crate::limits::Field;
use crate::math::vector::{distance, largest_difference};
use crate::motion::{GoalSample, JointState, MovingGoal, Pursuit};
use crate::objective::{Bounds, Linearization, Point};
use crate::solver::{LevenbergMarquardt, Stop};
use crate::task::Levels;
use crate::tracking::step_context::StepContext;

/// Largest number of Gauss-Newton steps in a tick; they converge quadratically.
const MOST_STEPS: usize = 6;

/// Step length (rad, m) that ends the iteration: its error is its square, below every tolerance.
const SHORT: f64 = 1e-5;

/// Evaluation budget of a tick in which Gauss-Newton fails: at singularities and out of reach. The next tick continues.
const MOST_EVALUATIONS: usize = 60;

/// Relative decrease of the squared error below which a motion of the goal does not approach the target.
const NO_GAIN: f64 = 1e-3;

/// Least decrease of the error per unit of motion (m/rad); a slower descent follows a flat valley, which need not end.
const FLAT: f64 = 1e-5;

/// Number of samples after a change by obstacles at which the goal restarts: its memory holds motions along obstacles, not
/// noise.
const RELEASED: usize = 5;

/// Distance of a goal (rad, m) beyond which it does not show the way along an obstacle.
const FAR: f64 = 0.1;

/// Ticks without progress after which an arm that holds pairs gives up a far goal.
const NO_WAY: usize = 10;

/// State of the rule between ticks.
#[derive(Debug, Default)]
pub(crate) struct GoalPursuit {
    goal: Option<MovingGoal>,
    /// Ticks elapsed since the start.
    now: f64,
    expected: Point,
    sample: Point,
    /// Samples since obstacles last changed one.
    since_held: Option<usize>,
    /// Smallest distance (rad, m) of the goal from an arm that holds pairs, and samples since then.
    nearest: Option<(f64, usize)>,
    linearization: Box<Linearization>,
}

impl GoalPursuit {
    /// Drops the goal.
    pub(crate) fn forget(&mut self) {
        self.goal = None;
    }

    /// Makes `q` the goal, at rest.
    pub(crate) fn head_for(&mut self, q: &[f64]) {
        let at_rest = JointState::at_rest(q.len());
        self.goal = Some(MovingGoal::of_arm(q, &at_rest, self.now, self.now + 1.0));
        (self.since_held, self.nearest) = (None, None);
    }

    /// The goal, if there is one.
    pub(crate) fn goal(&self) -> Option<&[f64]> {
        self.goal.as_ref().map(MovingGoal::q)
    }

    /// Whether the goal has moved on without targets.
    pub(super) fn has_outlived_targets(&self) -> bool {
        self.goal.as_ref().is_some_and(MovingGoal::has_outlived_samples)
    }

    /// Finds a sample of the goal if new targets have arrived, of age `tick.sampled_ago` (ticks) at the end of the tick.
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
            goal.begin_tick();
        }
        let Some(ago) = tick.sampled_ago else { return found };
        let time = self.now - ago;
        if let Some(goal) = &self.goal {
            goal.expected(time, motion.scales(), &mut self.expected);
        }
        let anew = (aims.has_pairs() && self.has_no_way(self.away(q))).then_some(q);
        let positions = tick.context.positions();
        self.solve(anew, &positions, &mut found, tick);
        self.solve_in_order(&positions, &mut found, tick);
        found
    }

    /// Solves for a sample within the tolerances where the target itself was not met, of a pose of which one part comes first, or of
    /// several tips by levels.
    fn solve_in_order(&mut self, positions: &Bounds, found: &mut TickResult, tick: &mut Tick<'_>) {
        let StepContext { robot, aims, .. } = tick.context;
        let (ranked, has_levels) = (tick.ranked(), tick.has_levels());
        if ranked.is_none() && !has_levels && !aims.iter().any(|(task, _)| task.criterion.has_band()) {
            return;
        }
        found.evaluations += 1;
        if aims.assess(robot, &self.sample).score.solved {
            return;
        }
        let mut near = TickResult::at(&self.sample);
        let is_within = tick.descend_into_band(&mut near, positions);
        found.evaluations += near.evaluations;
        if is_within {
            self.sample = near.q;
            return;
        }
        if has_levels {
            let levels = Levels::of(&aims);
            let mut descent = LevelDescent::new(robot, &levels, positions, BY_LEVELS);
            self.sample = descent.descend(&self.expected, None).q;
            found.evaluations += descent.evaluations;
            return;
        }
        let Some((pose, first)) = ranked else { return };
        let mut descent = RankedDescent::new(robot, &pose, first, positions);
        self.sample = descent.descend(&self.expected).q;
        found.evaluations += descent.evaluations;
    }

    /// Largest joint distance of the predicted goal from `q` (rad, m).
    fn away(&self, q: &[f64]) -> f64 {
        largest_difference(&self.expected, q)
    }

    /// Start of the search for a clear sample by an arm at `q`, and the sample to replace.
    pub(super) fn sample_to_clear<'s>(&'s mut self, q: &'s [f64]) -> (&'s [f64], &'s mut Point) {
        // Obstacles may have kept a distant goal on the wrong side of one of them.
        let is_near = self.away(q) < FAR;
        (if is_near { &self.expected } else { q }, &mut self.sample)
    }

    /// Records whether obstacles changed the sample.
    pub(super) fn note_held(&mut self, held: bool) {
        self.since_held = if held { Some(0) } else { self.since_held.map(|samples| samples + 1) };
    }

    /// Corrects the goal by the sample, if there is one, and moves the arm one tick towards it.
    pub(super) fn pursue(&mut self, mut found: TickResult, tick: &Tick<'_>) -> TickResult {
        let StepContext { robot, q, aims, limited, .. } = tick.context;
        let Some(motion) = limited else { return found };
        if let Some(goal) = &mut self.goal {
            let sample = tick.sampled_ago.map(|ago| GoalSample { q: &self.sample, time: self.now - ago });
            goal.end_tick(sample, motion.scales());
        }
        match &self.goal {
            Some(goal) if !found.interrupted => {
                let (braking, scales, reachable) = (motion.braking(), motion.scales(), tick.bounds());
                Pursuit { goal, braking, scales, reachable }.write(q, motion.state(), &mut found.q);
                keep_lowest_level(&mut found, tick);
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

    /// Whether an arm that holds pairs has made no progress towards its goal for too long; `away` is their distance (rad, m).
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

    /// Solves for the `sample` of the target: the configuration that meets it nearest to the predicted one or, if given, nearest to the
    /// start `anew`.
    fn solve(&mut self, anew: Option<&[f64]>, positions: &Bounds, found: &mut TickResult, tick: &mut Tick<'_>) {
        let n = self.expected.len();
        self.sample = Point::from_slice(anew.unwrap_or(&self.expected));
        positions.clip(&mut self.sample);
        let mut begin = Point::from_slice(&self.sample);
        let mut lowest = f64::INFINITY;
        for i in 0..MOST_STEPS {
            let value = self.linearize(found, tick);
            if value > lowest {
                break;
            }
            lowest = value;
            begin.copy_from_slice(&self.sample);
            let preferred = (i == 0 && anew.is_none()).then(|| self.preferred(positions, tick));
            let least = self.linearization.least_damping(n);
            let lambda = least.max(LevenbergMarquardt::default().initial_damping * value);
            match preferred {
                Some(preferred) => {
                    self.linearization.write_step_near(&preferred, lambda, &begin, positions, &mut self.sample);
                }
                None => self.linearization.write_step(lambda, &begin, positions, &mut self.sample),
            }
            if largest_difference(&self.sample, &begin) <= SHORT {
                return;
            }
        }
        self.sample = begin;
        self.begin_at_rest(lowest, positions, found, tick);
        self.descend(positions, found, tick);
    }

    /// Moves `sample` back to the goal before its remembered motion, unless that motion has lowered the error below `lowest`:
    /// out of reach, the goal would otherwise drift along the self-motion for ever.
    fn begin_at_rest(&mut self, lowest: f64, positions: &Bounds, found: &mut TickResult, tick: &Tick<'_>) {
        let (Some(goal), Some(motion)) = (&self.goal, tick.context.limited) else { return };
        let moved = self.sample.clone();
        goal.remembered_from(motion.scales(), &mut self.sample);
        positions.clip(&mut self.sample);
        if self.linearize(found, tick) > lowest * (1.0 + NO_GAIN) {
            self.sample = moved;
        }
    }

    /// Computes residual and Jacobian at `sample`; returns the squared error.
    fn linearize(&mut self, found: &mut TickResult, tick: &Tick<'_>) -> f64 {
        found.evaluations += 1;
        found.iterations += 1;
        let StepContext { robot, aims, .. } = tick.context;
        aims.linearize(robot, &self.sample, &mut self.linearization, |_| ()).score.value
    }

    /// Preferred configuration where the target leaves the joints free: the goal before the samples that it
    /// remembers, moved along the negative gradient of the null-space goals. Motion in the null space is not extrapolated,
    /// since no target would ever stop it; a filter with a long memory would sustain it even from one sample ago.
    fn preferred(&self, positions: &Bounds, tick: &mut Tick<'_>) -> Point {
        let mut preferred = Point::from_slice(&self.sample);
        if let (Some(goal), Some(motion)) = (&self.goal, tick.context.limited) {
            goal.remembered_from(motion.scales(), &mut preferred);
        }
        if !tick.goals.is_empty() {
            let mut slope = preferred.clone();
            let StepContext { robot, dt, .. } = tick.context;
            tick.goals.cost(robot, None, &self.sample, &mut slope);
            positions.steepest(&mut slope);
            preferred.iter_mut().zip(&slope).for_each(|(preferred, slope)| *preferred -= dt * slope);
        }
        positions.clip(&mut preferred);
        preferred
    }

    /// Lowers the error as far as one tick allows, where Gauss-Newton fails.
    fn descend(&mut self, positions: &Bounds, found: &mut TickResult, tick: &mut Tick<'_>) {
        let StepContext { robot, aims, .. } = tick.context;
        let mut end = TickResult::at(&self.sample);
        tick.descend(
            &mut end,
            positions,
            Stop { max_evaluations: MOST_EVALUATIONS.min(tick.most_evaluations), ..Stop::default() },
        );
        found.evaluations += end.evaluations;
        found.iterations += end.iterations;
        let [before, after] = [&self.sample, &end.q].map(|q| aims.assess(robot, q).score);
        if after.solved || before.value.sqrt() - after.value.sqrt() > FLAT * distance(&self.sample, &end.q) {
            self.sample = end.q;
        }
    }
}

/// Moves the command of joints that pursue their goals one by one to the nearest that meets the lowest level of the targets, as far as
/// the tick allows. Under jerk limits the command stays: the corrections of one tick would set those of the next swinging.
fn keep_lowest_level(found: &mut TickResult, tick: &Tick<'_>) {
    let StepContext { robot, aims, limits, .. } = tick.context;
    if !tick.has_levels() || limits.is_finite(Field::Jerk) {
        return;
    }
    let levels = Levels::of(&aims);
    let mut descent = LevelDescent::new(robot, &levels, tick.bounds(), BY_LEVELS);
    descent.lower_lowest(&mut found.q);
    found.evaluations += descent.evaluations;
}
