//! List of all algorithms, read by the binding and by the contract test.

use super::apps::Apps;
use super::bas::{Bas, BasVariant};
use super::broyden_bas::BroydenBas;
use super::driver::{Solver, run};
use super::evaluator::Evaluator;
use super::jacobian_transpose::JacobianTranspose;
use super::levenberg_marquardt::LevenbergMarquardt;
use super::multi_start::{MultiStart, RestartRule};
use super::newton_raphson::NewtonRaphson;
use super::status::Status;
use super::swarm::{BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, Pso, PsoForm, Qpso, Schedule};
use crate::error::Result;
use crate::objective::{Differentiable, Objective};

/// Algorithms that need only values, and therefore minimise any function.
#[derive(Debug, Clone, PartialEq)]
pub enum DerivativeFree {
    /// Beetle antennae search.
    Bas(Bas),
    /// Artificial bee colony.
    BeeColony(BeeColony),
    /// Beetle swarm.
    BeetleSwarm(BeetleSwarm),
    /// Differential evolution.
    DifferentialEvolution(DifferentialEvolution),
    /// Firefly algorithm.
    Firefly(Firefly),
    /// Genetic algorithm.
    Genetic(Genetic),
    /// Particle swarm.
    Pso(Pso),
    /// Quantum-behaved particle swarm.
    Qpso(Qpso),
}

/// All algorithms.
#[derive(Debug, Clone, PartialEq)]
pub enum Algorithm {
    /// Derivative-free algorithm.
    DerivativeFree(DerivativeFree),
    /// APPS, which needs a gradient.
    Apps(Apps),
    /// Jacobian transpose.
    JacobianTranspose(JacobianTranspose),
    /// Quasi-Newton with antenna differences as secants; needs residuals.
    BroydenBas(BroydenBas),
    /// Levenberg-Marquardt.
    LevenbergMarquardt(LevenbergMarquardt),
    /// Newton-Raphson.
    NewtonRaphson(NewtonRaphson),
}

/// Evaluates `$body` for the solver behind a derivative-free `$algorithm`.
macro_rules! whichever {
    ($algorithm:expr, $solver:ident => $body:expr) => {
        match $algorithm {
            DerivativeFree::Bas($solver) => $body,
            DerivativeFree::BeeColony($solver) => $body,
            DerivativeFree::BeetleSwarm($solver) => $body,
            DerivativeFree::DifferentialEvolution($solver) => $body,
            DerivativeFree::Firefly($solver) => $body,
            DerivativeFree::Genetic($solver) => $body,
            DerivativeFree::Pso($solver) => $body,
            DerivativeFree::Qpso($solver) => $body,
        }
    };
}

/// Conversions from derivative-free solvers.
macro_rules! listed {
    ($($solver:ident),*) => {$(
        impl From<$solver> for DerivativeFree {
            fn from(solver: $solver) -> Self {
                Self::$solver(solver)
            }
        }

        impl From<$solver> for Algorithm {
            fn from(solver: $solver) -> Self {
                Self::DerivativeFree(solver.into())
            }
        }
    )*};
}
listed!(Bas, BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, Pso, Qpso);

/// Conversions from solvers that need residuals or derivatives.
macro_rules! listed_with_more {
    ($($solver:ident),*) => {$(
        impl From<$solver> for Algorithm {
            fn from(solver: $solver) -> Self {
                Self::$solver(solver)
            }
        }
    )*};
}
listed_with_more!(Apps, BroydenBas, JacobianTranspose, LevenbergMarquardt, NewtonRaphson);

impl DerivativeFree {
    /// All derivative-free algorithms with default options.
    pub fn all() -> Vec<Self> {
        vec![
            Bas::of(BasVariant::Star).into(),
            Bas::of(BasVariant::Chain).into(),
            Bas::of(BasVariant::Greedy).into(),
            BeeColony::default().into(),
            BeetleSwarm::default().into(),
            DifferentialEvolution::default().into(),
            Firefly::default().into(),
            Genetic::default().into(),
            Pso::of(PsoForm::Constriction).into(),
            Pso::of(PsoForm::Inertia(0.729)).into(),
            Qpso::default().into(),
        ]
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        whichever!(self, solver => solver.validate())
    }

    /// Schedule of a population; `None` for a single beetle.
    fn schedule(&self) -> Option<Schedule> {
        match self {
            Self::Bas(_) => None,
            Self::BeeColony(BeeColony { schedule, .. })
            | Self::BeetleSwarm(BeetleSwarm { schedule, .. })
            | Self::DifferentialEvolution(DifferentialEvolution { schedule, .. })
            | Self::Firefly(Firefly { schedule, .. })
            | Self::Genetic(Genetic { schedule, .. })
            | Self::Pso(Pso { schedule, .. })
            | Self::Qpso(Qpso { schedule, .. }) => Some(*schedule),
        }
    }

    /// Number of members of a generation; `None` for a single beetle.
    pub fn population(&self) -> Option<usize> {
        self.schedule().map(|schedule| schedule.population)
    }

    /// Steps with too little progress after which an attempt is abandoned (see [`RestartRule::patience`]). A beetle
    /// needs passes to shrink its antennae: of 100 positions for a 7-joint arm, patience 4 and 20 solved 90 and 99 by
    /// the star, 83 and 94 by the greedy variant.
    fn patience(&self) -> usize {
        const BEETLE: usize = 20;
        let generations = self.schedule().map_or(BEETLE, |schedule| schedule.stall_generations);
        match self {
            // A step moves one firefly; a generation moves each of them.
            Self::Firefly(firefly) => generations.saturating_mul(firefly.schedule.population),
            _ => generations,
        }
    }

    /// Runs from one start or, with a rule for restarts, from many.
    pub(super) fn run(
        &self,
        restarts: Option<RestartRule>,
        evaluator: &mut Evaluator<'_, dyn Objective + '_>,
        x0: &[f64],
    ) -> Status {
        whichever!(self, solver => run_or_restart(solver, restarts, evaluator, x0))
    }
}

impl Algorithm {
    /// Every algorithm with its default options.
    pub fn all() -> Vec<Self> {
        let mut all: Vec<_> = DerivativeFree::all().into_iter().map(Self::DerivativeFree).collect();
        all.extend([
            Apps::default().into(),
            BroydenBas::default().into(),
            JacobianTranspose::default().into(),
            LevenbergMarquardt::default().into(),
            NewtonRaphson::default().into(),
        ]);
        all
    }

    /// Adds restarts with a suitable patience: a descent shows within a few iterations whether it converges.
    pub fn into_multi_start(self) -> MultiStart<Self> {
        let patience = match &self {
            Self::DerivativeFree(solver) => solver.patience(),
            Self::Apps(_) | Self::JacobianTranspose(_) => 50,
            Self::BroydenBas(_) | Self::LevenbergMarquardt(_) => 3,
            Self::NewtonRaphson(_) => 10,
        };
        MultiStart { solver: self, rule: RestartRule::with_patience(patience) }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        match self {
            Self::DerivativeFree(solver) => solver.validate(),
            Self::BroydenBas(broyden) => broyden.validate(),
            Self::Apps(apps) => apps.validate(),
            Self::JacobianTranspose(transpose) => transpose.validate(),
            Self::LevenbergMarquardt(lm) => lm.validate(),
            Self::NewtonRaphson(newton) => newton.validate(),
        }
    }

    /// Runs from one start or, with a rule for restarts, from many.
    pub(super) fn run(
        &self,
        restarts: Option<RestartRule>,
        evaluator: &mut Evaluator<'_, dyn Differentiable + '_>,
        x0: &[f64],
    ) -> Status {
        match self {
            Self::DerivativeFree(solver) => evaluator.with_values_only(|evaluator| solver.run(restarts, evaluator, x0)),
            Self::BroydenBas(broyden) => run_or_restart(broyden, restarts, evaluator, x0),
            Self::Apps(apps) => run_or_restart(apps, restarts, evaluator, x0),
            Self::JacobianTranspose(transpose) => run_or_restart(transpose, restarts, evaluator, x0),
            Self::LevenbergMarquardt(lm) => run_or_restart(lm, restarts, evaluator, x0),
            Self::NewtonRaphson(newton) => run_or_restart(newton, restarts, evaluator, x0),
        }
    }
}

fn run_or_restart<O, S>(
    solver: &S,
    restarts: Option<RestartRule>,
    evaluator: &mut Evaluator<'_, O>,
    x0: &[f64],
) -> Status
where
    O: Objective + ?Sized,
    S: Solver<O>,
{
    match restarts {
        None => run(solver, evaluator, x0),
        Some(rule) => run(&MultiStart { solver, rule }, evaluator, x0),
    }
}
