//! Tick rules: what moves a modelled arm by one tick inside a given box.

mod each_tick;
mod mid_step;

use crate::error::Result;
use crate::math::Frame;
use crate::objective::{Bounds, Point, Score};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::{AnySolver, Monitor};
use crate::task::{Assessment, Criterion, Goals, SquaredError, Target};

/// What runs in every tick.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum TickRule {
    /// Steps by the model: one evaluation of kinematics and Jacobian is enough for most ticks.
    #[default]
    MidStep,
    /// A solver, begun anew from the accepted configuration.
    EachTick(AnySolver),
}

/// One tick, as a rule sees it.
pub(super) struct Tick<'a> {
    pub robot: &'a Robot,
    pub target: &'a Target,
    pub criterion: &'a Criterion,
    /// What to do with the freedom that the target leaves, if anything.
    pub goals: Option<Goals<'a>>,
    /// Length of the tick (s).
    pub dt: f64,
    /// Where the tick may end.
    pub tick_box: &'a Bounds,
    /// The value accepted in the tick before, if any.
    pub last_value: Option<f64>,
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

/// Where a rule would end the tick.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub q: Point,
    pub assessment: Assessment,
    /// Position of the tip there (m).
    pub position: [f64; 3],
    pub evaluations: usize,
    pub iterations: usize,
    /// The monitor asked to stop.
    pub interrupted: bool,
}

impl Found {
    /// At `q`, with nothing known of it yet.
    fn at(q: Point) -> Self {
        let score = Score { value: f64::INFINITY, solved: false };
        let assessment = Assessment { score, error: SquaredError { position: None, rotation: None } };
        Self { q, assessment, position: [f64::NAN; 3], evaluations: 0, iterations: 0, interrupted: false }
    }

    /// The tip is there.
    fn arrive(&mut self, tip: &Frame, tick: &Tick<'_>) {
        (self.assessment, self.position) = (tick.target.assess_tip(tip, tick.criterion), tip.origin);
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
    EachTick(AnySolver),
}

impl TickRule {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::MidStep => Ok(()),
            Self::EachTick(solver) => solver.validate(),
        }
    }

    pub(super) fn start(&self) -> Running {
        match self {
            Self::MidStep => Running::MidStep(mid_step::Memory::default()),
            Self::EachTick(solver) => Running::EachTick(solver.clone()),
        }
    }
}

impl Running {
    /// Ends one tick that begins at `q`.
    pub fn advance(&mut self, q: &[f64], tick: Tick<'_>) -> Found {
        match self {
            Self::MidStep(memory) => mid_step::advance(memory, q, tick),
            Self::EachTick(solver) => each_tick::advance(solver, q, tick),
        }
    }
}
