//! The way back of an arm that its rule cannot bring nearer to its target.
//!
//! A rule descends from where the arm is. At joint limits and in singular configurations the descent ends, though another
//! configuration may meet the target. When the error has ceased to fall, a search looks for such configurations, some work a tick;
//! the quickest to reach, along a straight line of the joints that is clear, becomes the goal of the arm. The rule of the joints
//! takes it there inside all limits, and the safety filter goes on filtering each command. An arm within a millimetre (milliradian) of its
//! target is not moved for the rest, by whole turns perhaps: it only says what is known.
//!
//! ```text
//! Following --error has ceased to fall--> Doubting --a descent ends too--> Looking --search ends--> Choosing --clear line--> Returning
//!     ^-- nearer by itself, none found, none clear, told to stay; arrived, no nearer to the goal ---------------------------|
//! ```
//!
//! | file | what |
//! |---|---|
//! | `goal_progress` | progress on the way back |
//! | `rest_watch` | detects that the error has ceased to fall |
//! | `search` | looks for configurations on the target |
//! | `tried` | remembers what a search has ended with |

mod goal_progress;
mod rest_watch;
mod search;
mod tried;

use goal_progress::GoalProgress;
use rest_watch::{NEAR, RestWatch};
use search::{DESCENT, GoalSearch, Means, descended, movable};
use tried::{Tried, is_still};

use super::away::{Away, Way};
use super::progress::patience_factor;
use super::safety_filter::SafetyFilter;
use super::step_context::StepContext;
use super::torque_pace::TorquePace;
use crate::limits::Limits;
use crate::math::vector::{largest_difference, write_between};
use crate::objective::{Bounds, Linearization, Point, Score};
use crate::rng::LazyRng;
use crate::solver::Monitor;

/// Distance of a joint from its limit (rad, m) at which it is at the limit.
const AT_LIMIT: f64 = 0.01;

/// Fraction of the velocity limit, and of 1 rad/s (m/s), below which a joint rests.
const RESTING: f64 = 0.02;

/// Least decrease of the error (m/rad) that a joint at its limit prevents; small, since a stretched elbow changes little.
const SLOPE: f64 = 1e-4;

/// Largest error of a goal, as a fraction of that of the resting arm.
const BETTER: f64 = 0.8;

/// Error of a descent, relative to that at rest, below which the rule of a moving arm reaches the target.
const NEARER: f64 = 0.5;
/// Number of further descents, one per tick, after one that does not show this.
const DOUBTS: usize = 5;

/// Distance of a joint (rad, m) up to which the rule gets to the target by itself, as it averages noise.
const WITHIN_NOISE: f64 = 0.05;

/// Evaluations of a descent that the way back leaves to the rule of the tick.
const LEFT_TO_RULE: usize = 20;

/// Distance of all joints from the goal (rad, m) at which the arm has arrived.
const ARRIVED: f64 = 0.02;

/// Time without progress towards the goal after which an arm gives up (s).
const PATIENCE: f64 = 1.0;

/// Sections of a line, of which a tick certifies one.
const SECTIONS: usize = 8;

/// The end of a tick.
pub(super) struct EndOfTick<'a> {
    /// The arm after the tick.
    pub context: StepContext<'a>,
    /// Score there.
    pub score: Score,
    /// Configuration before the tick.
    pub before: &'a [f64],
    /// Goal that the joints pursue, if they pursue one.
    pub goal: Option<&'a [f64]>,
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

/// Action from the next tick on.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "it is used at once, and a box would be on the heap")]
pub(super) enum Next {
    /// It goes on.
    Continue,
    /// It heads for this configuration.
    HeadFor(Point),
    /// It follows the target from where it is.
    Follow,
    /// It has arrived, and follows the target from there.
    Arrived,
}

/// State of the way back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Following,
    /// Descends, to see whether the rule gets to the target by itself.
    Doubting {
        descents: usize,
    },
    Looking,
    /// Certifies the line to a candidate, section by section.
    Choosing {
        candidate: usize,
        section: usize,
    },
    Returning,
}

/// Checks of straight lines in joint space.
pub(super) struct OpenLines<'a> {
    pub safety: Option<&'a mut SafetyFilter>,
    pub torques: Option<&'a mut TorquePace>,
}

/// Way back of one arm, with its state between ticks.
#[derive(Debug)]
pub(super) struct WayBack {
    /// Whether the arm goes back; otherwise a step only says that it could.
    goes: bool,
    state: State,
    watch: RestWatch,
    search: GoalSearch,
    away: Option<Away>,
    /// Error at which the arm was last found at rest.
    error_at_rest: f64,
    tried: Option<Tried>,
    progress: GoalProgress,
    patience: f64,
    linearization: Box<Linearization>,
    /// Evaluations of the last tick.
    evaluations: usize,
}

impl WayBack {
    /// Way back of an arm with these limits, which takes it if it `goes`.
    pub fn new(limits: &Limits, goes: bool) -> Self {
        let factor = patience_factor(limits);
        Self {
            goes,
            state: State::Following,
            watch: RestWatch::new(factor),
            search: GoalSearch::default(),
            away: None,
            error_at_rest: 0.0,
            tried: None,
            progress: GoalProgress::towards(&[]),
            patience: PATIENCE * factor,
            linearization: Box::default(),
            evaluations: 0,
        }
    }

    /// Obstruction that keeps the arm away from its target, if its rule does not bring it nearer.
    pub fn away(&self) -> Option<Away> {
        self.away
    }

    /// Whether the arm is on its way to a configuration on the target.
    #[inline]
    pub fn is_returning(&self) -> bool {
        self.state == State::Returning
    }

    /// Evaluations of a descent that the rule may spend in the next tick.
    #[inline]
    pub fn left_to_rule(&self) -> usize {
        if self.state == State::Following { usize::MAX } else { LEFT_TO_RULE }
    }

    /// Evaluations of the forward kinematics in the last tick.
    #[inline]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Forgets the way and all that was tried.
    pub fn restart(&mut self) {
        self.follow();
        (self.tried, self.evaluations) = (None, 0);
    }

    /// Records that obstacles were replaced: lines that were not clear may be now.
    pub fn note_replaced(&mut self) {
        self.tried.iter_mut().for_each(Tried::note_replaced);
    }

    /// Ends a tick. `lines` says which lines of the joints may be taken.
    #[inline]
    pub fn end_tick(&mut self, end: EndOfTick<'_>, lines: OpenLines<'_>) -> Next {
        self.evaluations = 0;
        let error = if end.score.solved { 0.0 } else { end.score.value.sqrt() };
        if self.state == State::Following {
            if self.away.is_some() && !is_still(error, self.error_at_rest) {
                self.away = None;
            }
            if !self.watch.has_ceased(error, end.context.dt) {
                return Next::Continue;
            }
        }
        self.decide(error, end, lines)
    }

    #[cold]
    fn decide(&mut self, error: f64, mut end: EndOfTick<'_>, lines: OpenLines<'_>) -> Next {
        match self.state {
            State::Returning => return self.check_return(&end),
            State::Following => self.doubt(error, &end),
            _ if !is_still(error, self.error_at_rest) => self.follow(),
            State::Doubting { descents } => self.begin_to_look(descents, &mut end),
            State::Looking => self.look(&mut end),
            State::Choosing { candidate, section } => return self.choose((candidate, section), &mut end, lines),
        }
        Next::Continue
    }

    /// Follows the target again.
    fn follow(&mut self) {
        (self.state, self.away) = (State::Following, None);
        self.watch.restart();
    }

    /// Stays at rest, for the targets at the `end` of a tick.
    fn stay(&mut self, way: Way, end: &EndOfTick<'_>, failed: bool) {
        self.state = State::Following;
        self.away = self.away.map(|away| Away { way, ..away });
        self.name_joints(&end.context);
        self.tried = Some(Tried::new(end.context.aims.targets, self.error_at_rest, self.away, failed));
    }

    /// Doubts that the rule gets to the target, unless this has been tried.
    fn doubt(&mut self, error: f64, end: &EndOfTick<'_>) {
        let context = end.context;
        if context.aims.is_empty() {
            return;
        }
        // Near its target a moving arm gets there by itself, or lags.
        if error <= NEAR && !is_resting(end) {
            return;
        }
        self.error_at_rest = error;
        if let Some(tried) = &mut self.tried
            && tried.holds(context.aims.targets, error)
            && !(tried.spares() && error > NEAR)
        {
            self.away = tried.away;
            self.name_joints(&context);
            return;
        }
        self.state = State::Doubting { descents: 0 };
    }

    /// Begins to look for configurations on the target, if the arm rests or no descent leads there.
    fn begin_to_look(&mut self, descents: usize, end: &mut EndOfTick<'_>) {
        let context = end.context;
        let bounds = movable(&context);
        let mut means = Means { rng: end.rng, monitor: end.monitor };
        let near = descended(context.q, DESCENT, &context, &bounds, &mut means);
        self.evaluations = near.evaluations;
        let rests = is_resting(end);
        if near.error < NEARER * self.error_at_rest && !rests
            || near.solved && largest_difference(&near.q, context.q) < WITHIN_NOISE
        {
            self.follow();
            return;
        }
        // Noise puts the target of a stretched arm out of reach in every other tick.
        if !rests && descents < DOUBTS {
            self.state = State::Doubting { descents: descents + 1 };
            return;
        }
        self.search.restart();
        if near.solved {
            self.search.offer(near.q, &context, &bounds);
        }
        self.state = State::Looking;
        self.away.get_or_insert(Away { way: Way::Unknown, held: [0; 2] });
        self.name_joints(&context);
    }

    /// Looks for configurations on the target.
    fn look(&mut self, end: &mut EndOfTick<'_>) {
        let before = self.search.evaluations;
        let mut means = Means { rng: end.rng, monitor: end.monitor };
        if self.search.advance(&end.context, &mut means) {
            self.state = State::Choosing { candidate: 0, section: 0 };
        }
        self.evaluations = self.search.evaluations - before;
    }

    /// Notes the joints that hold the arm where it is.
    fn name_joints(&mut self, context: &StepContext<'_>) {
        let held = self.held(context, &movable(context));
        self.away = self.away.map(|away| Away { held, ..away });
    }

    /// Joints at their lower and upper limits that would have to go beyond to lower the error. Those with equal limits are at both.
    fn held(&mut self, context: &StepContext<'_>, bounds: &Bounds) -> [u64; 2] {
        let mut slope = Point::from_elem(0.0, context.q.len());
        let score = context.aims.linearize(context.robot, context.q, &mut self.linearization, |_| ()).score;
        self.linearization.gradient(&mut slope);
        let least = SLOPE * score.value.sqrt();
        let mut held = [0; 2];
        for (j, q) in context.q.iter().enumerate() {
            let at = [q - bounds.lower()[j], bounds.upper()[j] - q].map(|room| room <= AT_LIMIT);
            let outward = [slope[j] > least, slope[j] < -least];
            let is_locked = bounds.lower()[j] >= bounds.upper()[j] && slope[j].abs() > least;
            (0..2).filter(|side| is_locked || at[*side] && outward[*side]).for_each(|side| held[side] |= 1 << j);
        }
        held
    }

    /// Tries the candidates in their order, and takes the first that is clear.
    fn choose(
        &mut self,
        (candidate, section): (usize, usize),
        end: &mut EndOfTick<'_>,
        mut lines: OpenLines<'_>,
    ) -> Next {
        let context = end.context;
        let Some(to) = self.search.found.get(candidate) else {
            self.stay(if candidate == 0 { Way::Unknown } else { Way::Blocked }, end, false);
            return Next::Continue;
        };
        // The way would part a pair, or leave the lowest level.
        if context.aims.has_pairs() || context.aims.has_levels(context.robot) {
            self.stay(Way::Blocked, end, false);
            return Next::Continue;
        }
        if lines.are_limited() {
            let is_clear = lines.allow_section(&context, &to.q, section);
            if !is_clear || section + 1 < SECTIONS {
                let next = if is_clear { (candidate, section + 1) } else { (candidate + 1, 0) };
                self.state = State::Choosing { candidate: next.0, section: next.1 };
                return Next::Continue;
            }
        }
        self.take(candidate, end)
    }

    /// Takes a candidate, moved onto the present targets.
    fn take(&mut self, candidate: usize, end: &mut EndOfTick<'_>) -> Next {
        let context = end.context;
        let bounds = movable(&context);
        let mut means = Means { rng: end.rng, monitor: end.monitor };
        let from = &self.search.found[candidate].q;
        let to = descended(from, DESCENT, &context, &bounds, &mut means);
        self.evaluations = to.evaluations;
        if !to.solved {
            // The targets have moved away since.
            self.follow();
            return Next::Continue;
        }
        if self.error_at_rest <= NEAR {
            self.stay(Way::Spared, end, false);
            return Next::Continue;
        }
        if !self.goes {
            self.stay(Way::Declined, end, false);
            return Next::Continue;
        }
        self.away = self.away.map(|away| Away { way: Way::Taken, ..away });
        (self.state, self.progress) = (State::Returning, GoalProgress::towards(&to.q));
        Next::HeadFor(to.q)
    }

    /// Ends the way back where the arm has arrived, comes no nearer to the goal, or the goal no longer meets the target.
    fn check_return(&mut self, end: &EndOfTick<'_>) -> Next {
        let context = end.context;
        let Some(goal) = end.goal else {
            self.follow();
            return Next::Continue;
        };
        let distance = largest_difference(context.q, goal);
        if distance <= ARRIVED {
            self.follow();
            self.tried = None;
            return Next::Arrived;
        }
        self.progress.note(goal, distance, context.dt);
        self.evaluations = 1;
        let error = context.aims.assess(context.robot, goal).score.value.sqrt();
        if error > BETTER * self.error_at_rest {
            self.follow();
            return Next::Follow;
        }
        if self.progress.waited > self.patience {
            self.watch.restart();
            self.stay(Way::Blocked, end, true);
            return Next::Follow;
        }
        Next::Continue
    }
}

/// Whether all joints rest.
fn is_resting(end: &EndOfTick<'_>) -> bool {
    let StepContext { q, tick_box, dt, .. } = end.context;
    let steps = q.iter().zip(end.before).zip(&tick_box.velocity);
    steps.map(|((q, before), velocity)| (q - before).abs() - RESTING * dt * velocity.min(1.0)).all(|over| over <= 0.0)
}

impl OpenLines<'_> {
    fn are_limited(&self) -> bool {
        self.safety.is_some() || self.torques.is_some()
    }

    /// Whether a section of the line from the arm to `to` is certified clear, and the joints can hold the arm at its ends.
    fn allow_section(&mut self, context: &StepContext<'_>, to: &[f64], section: usize) -> bool {
        let mut ends = [(); 2].map(|()| Point::from_slice(context.q));
        for (k, end) in ends.iter_mut().enumerate() {
            write_between(context.q, to, (section + k) as f64 / SECTIONS as f64, end);
        }
        self.torques.as_mut().is_none_or(|torques| torques.can_hold(&ends[1]))
            && self.safety.as_mut().is_none_or(|safety| safety.certifies_line(&ends[0], &ends[1]))
    }
}
