//! Tick rules: what moves a modelled arm by one tick inside a given box.

mod any_solver;
mod approach;
mod mid_step;
mod weighted_pseudo_inverse;

pub use weighted_pseudo_inverse::{Integrator, WeightedPseudoInverse};

use crate::error::Result;
use crate::limits::Limits;
use crate::math::Frame;
use crate::objective::{Bounds, Point, Score};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::{AnySolver, Monitor};
use crate::task::{Assessment, Criterion, Goals, SquaredError, Target, TargetMotion, Twist};

/// What runs in every tick.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TickRule {
    /// Steps by the model: one evaluation of kinematics and Jacobian is enough for most ticks.
    #[default]
    MidStep,
    /// A solver, begun anew from the accepted configuration.
    Solver(AnySolver),
    /// Velocities by the weighted pseudo-inverse of the Jacobian.
    WeightedPseudoInverse(WeightedPseudoInverse),
}

/// One tick, as a rule sees it.
pub(super) struct Tick<'a> {
    pub robot: &'a Robot,
    pub target: &'a Target,
    pub criterion: &'a Criterion,
    /// What to do with the freedom that the target leaves.
    pub goals: &'a mut Goals,
    /// The velocity of the target at the end of the tick (m/s), if it is known.
    pub velocity: Option<[f64; 3]>,
    /// The target and its velocity at the end of the tick before, if there was one.
    pub before: Option<&'a (Target, Option<[f64; 3]>)>,
    /// When the tick begins (s).
    pub time: f64,
    /// Length of the tick (s).
    pub dt: f64,
    /// The limits that the tick's box comes from.
    pub limits: &'a Limits,
    /// The velocity limits of the tick (n,) (rad/s, m/s).
    pub velocity_limit: &'a [f64],
    /// Where the tick may end.
    pub tick_box: &'a Bounds,
    /// The value accepted in the tick before, if any.
    pub last_value: Option<f64>,
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

impl Tick<'_> {
    /// How the target moves during the tick. Where nothing is known of the tick before, it has moved with its velocity, or
    /// stood still.
    fn motion(&self) -> TargetMotion {
        let Self { target: end, dt, velocity, .. } = *self;
        match (self.before, velocity) {
            (Some((begin, before)), _) => {
                let velocities = before.zip(velocity).map(|(before, velocity)| [before, velocity]);
                TargetMotion { begin: *begin, end: *end, velocities, dt }
            }
            (None, None) => TargetMotion { begin: *end, end: *end, velocities: None, dt },
            (None, Some(linear)) => {
                let begin = end.moved(&Twist { linear, angular: [0.0; 3] }, -dt);
                TargetMotion { begin, end: *end, velocities: Some([linear; 2]), dt }
            }
        }
    }
}

/// Where a rule ends the tick, and what it took to get there.
#[derive(Debug, Clone)]
pub(super) struct TickResult {
    pub q: Point,
    pub assessment: Assessment,
    /// Position of the tip there (m).
    pub position: [f64; 3],
    pub evaluations: usize,
    pub iterations: usize,
    /// The monitor asked to stop.
    pub interrupted: bool,
}

impl TickResult {
    /// At `q`, with nothing known of it yet.
    fn at(q: &[f64]) -> Self {
        let score = Score { value: f64::INFINITY, solved: false };
        let assessment = Assessment { score, error: SquaredError { position: None, rotation: None } };
        let (q, position) = (Point::from_slice(q), [f64::NAN; 3]);
        Self { q, assessment, position, evaluations: 0, iterations: 0, interrupted: false }
    }

    /// Takes over the tip at `q`.
    pub fn set_tip(&mut self, tip: &Frame, target: &Target, criterion: &Criterion) {
        (self.assessment, self.position) = (target.assess_tip(tip, criterion), tip.origin);
    }

    fn value(&self) -> f64 {
        self.assessment.score.value
    }

    fn is_solved(&self) -> bool {
        self.assessment.score.solved
    }
}

/// A rule at work, with what it remembers from tick to tick.
#[derive(Debug)]
pub(super) enum Running {
    MidStep(mid_step::Memory),
    Solver(AnySolver),
    WeightedPseudoInverse(WeightedPseudoInverse, weighted_pseudo_inverse::Scratch),
}

impl TickRule {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::MidStep => Ok(()),
            Self::Solver(solver) => solver.validate(),
            Self::WeightedPseudoInverse(rule) => rule.validate(),
        }
    }

    /// Checks them for `robot` and ticks of `dt` (s).
    pub(super) fn validate_for(&self, robot: &Robot, dt: f64) -> Result<()> {
        match self {
            Self::MidStep | Self::Solver(_) => Ok(()),
            Self::WeightedPseudoInverse(rule) => rule.validate_for(robot, dt),
        }
    }

    /// Whether goals beside the path are served.
    pub(super) fn serves_goals(&self) -> bool {
        !matches!(self, Self::Solver(_))
    }

    /// Whether the velocity of the target makes a difference.
    pub fn uses_velocities(&self) -> bool {
        matches!(self, Self::WeightedPseudoInverse(_))
    }

    pub(super) fn start(&self) -> Running {
        match self {
            Self::MidStep => Running::MidStep(mid_step::Memory::default()),
            Self::Solver(solver) => Running::Solver(solver.clone()),
            Self::WeightedPseudoInverse(rule) => {
                Running::WeightedPseudoInverse(rule.clone(), weighted_pseudo_inverse::Scratch::default())
            }
        }
    }
}

impl Running {
    /// Drops what is remembered of the last tick: the arm is not where the rule left it.
    pub fn forget(&mut self) {
        if let Self::MidStep(memory) = self {
            memory.forget();
        }
    }

    /// Ends one tick that begins at `q`.
    pub fn advance(&mut self, q: &[f64], tick: Tick<'_>) -> TickResult {
        match self {
            Self::MidStep(memory) => mid_step::advance(memory, q, tick),
            Self::Solver(solver) => any_solver::advance(solver, q, tick),
            Self::WeightedPseudoInverse(rule, scratch) => weighted_pseudo_inverse::advance(rule, scratch, q, tick),
        }
    }
}
