//! Solvers minimise an [`Objective`](crate::objective::Objective) inside a box and know nothing of robots.
//!
//! A solver is an immutable value of named options; its progress is another value, its `State`. The
//! [driver](mod@driver) owns the loop, the [`Evaluator`] counts, clips, checks for finite values and keeps the best. So
//! exact budgets, "never outside the box" and "the best so far is never lost" hold for every algorithm by construction.
//!
//! | file | algorithm | needs |
//! |---|---|---|
//! | [`bas`] | beetle antennae search (Cheng et al. 2020): star, chain, greedy | values |
//! | [`levenberg_marquardt`] | Levenberg-Marquardt on the box | residual and Jacobian |
//! | [`multi_start`] | any of them, from many starts | what the wrapped solver needs |

pub mod bas;
pub mod driver;
pub mod evaluator;
pub mod levenberg_marquardt;
pub mod multi_start;
pub mod stop;

pub use bas::{Bas, Variant};
pub use driver::{Outcome, Solver, run};
pub use evaluator::{Best, Evaluator, Halt};
pub use levenberg_marquardt::LevenbergMarquardt;
pub use multi_start::{MultiStart, RestartRule};
pub use stop::{Monitor, Status, Stop, Unattended};

use crate::error::Result;
use crate::objective::LeastSquares;

/// The one list of algorithms: the binding and the contract test read it.
#[derive(Debug, Clone, PartialEq)]
pub enum Algorithm {
    /// Beetle antennae search.
    Bas(Bas),
    /// Levenberg-Marquardt.
    LevenbergMarquardt(LevenbergMarquardt),
}

/// What a caller chooses: an algorithm from one start, or from many.
#[derive(Debug, Clone, PartialEq)]
pub enum AnySolver {
    /// From the start alone.
    Single(Algorithm),
    /// Again from other starts, until solved or the budget is spent.
    MultiStart(MultiStart<Algorithm>),
}

impl Default for AnySolver {
    /// Levenberg-Marquardt from many starts.
    fn default() -> Self {
        Self::MultiStart(Algorithm::LevenbergMarquardt(LevenbergMarquardt::default()).into_multi_start())
    }
}

impl Algorithm {
    /// Every algorithm with its default options.
    pub fn all() -> Vec<Self> {
        vec![
            Self::Bas(Bas::of(Variant::Star)),
            Self::Bas(Bas::of(Variant::Chain)),
            Self::Bas(Bas::of(Variant::Greedy)),
            Self::LevenbergMarquardt(LevenbergMarquardt::default()),
        ]
    }

    /// The algorithm begun again from other starts, with the patience that suits it: a descent shows within a few
    /// iterations whether it leads anywhere, a beetle needs passes to shrink its antennae (of 100 positions for a 7-joint
    /// arm, patience 4 and 20 solved 90 and 99 by the star, 83 and 94 by the greedy variant).
    pub fn into_multi_start(self) -> MultiStart<Self> {
        let patience = match self {
            Self::Bas(_) => 20,
            Self::LevenbergMarquardt(_) => 3,
        };
        MultiStart { solver: self, rule: RestartRule::with_patience(patience) }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::Bas(bas) => bas.validate(),
            Self::LevenbergMarquardt(lm) => lm.validate(),
        }
    }
}

impl AnySolver {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::Single(algorithm) => algorithm.validate(),
            Self::MultiStart(multi_start) => multi_start.validate().and(multi_start.solver.validate()),
        }
    }

    /// Whether, along a path, a step that beats the last one is enough (line 16 of Algorithm 1 in Cheng et al. 2020). A
    /// random search could otherwise go on for long; a descent reaches its end in a few iterations.
    pub fn settles_for_improvement(&self) -> bool {
        let (Self::Single(algorithm) | Self::MultiStart(MultiStart { solver: algorithm, .. })) = self;
        matches!(algorithm, Algorithm::Bas(_))
    }

    /// The descent that is begun again and again, where this is one.
    pub fn restarted_descent(&self) -> Option<&LevenbergMarquardt> {
        match self {
            Self::MultiStart(MultiStart { solver: Algorithm::LevenbergMarquardt(descent), .. }) => Some(descent),
            _ => None,
        }
    }

    /// Runs from `x0` until solved, stopped or given up.
    pub fn run(&self, evaluator: &mut Evaluator<'_, dyn LeastSquares + '_>, x0: &[f64]) -> Outcome {
        match self {
            Self::Single(Algorithm::Bas(bas)) => run(bas, evaluator, x0),
            Self::Single(Algorithm::LevenbergMarquardt(lm)) => run(lm, evaluator, x0),
            Self::MultiStart(MultiStart { solver, rule }) => match solver {
                Algorithm::Bas(bas) => run(&MultiStart { solver: bas, rule: *rule }, evaluator, x0),
                Algorithm::LevenbergMarquardt(lm) => run(&MultiStart { solver: lm, rule: *rule }, evaluator, x0),
            },
        }
    }
}
