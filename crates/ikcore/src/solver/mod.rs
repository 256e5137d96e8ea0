//! Solvers, which minimise an [`Objective`](crate::objective::Objective) inside a box, independently of robots.
//!
//! A solver is a value of named options; its progress is another value, its `State`. `driver` owns the loop. The [`Evaluator`]
//! counts evaluations, clips points, treats values that are not finite as the worst, and keeps the best point. Every algorithm
//! therefore has exact budgets and results in the box, and never loses the best point.
//!
//! Read `stop` and `status` (how a run ends), `driver` (the loop), `evaluator`, then any algorithm. `algorithm` lists
//! all of them; `any_solver` is the caller's choice: an algorithm, with or without restarts.
//!
//! | file | algorithm | needs |
//! |---|---|---|
//! | `apps` | APPS (Yuan et al. 2016): gradient descent with limited joint steps | gradient |
//! | `bas` | BAS, beetle antennae search (Cheng et al. 2020): star, chain, greedy | values |
//! | `broyden_bas` | quasi-Newton with antenna differences as secants | residual |
//! | `jacobian_transpose` | Jacobian transpose: steepest descent | residual and Jacobian |
//! | `levenberg_marquardt` | Levenberg-Marquardt in a box | residual and Jacobian |
//! | `newton_raphson` | Newton-Raphson by the pseudo-inverse | residual and Jacobian |
//! | `swarm/beetle_swarm` | beetle swarm (Wang et al. 2019): particles with antennae | values |
//! | `swarm/pso`, `swarm/qpso` | particle swarms, with velocities and quantum-behaved | values |
//! | `swarm/firefly`, `swarm/bee_colony` | firefly algorithm, artificial bee colony | values |
//! | `swarm/genetic`, `swarm/differential_evolution` | genetic algorithm, differential evolution | values |
//! | `pattern_search` | pattern search (Hooke and Jeeves 1961), for planners alone | values |
//! | `multi_start` | any of them, from many starts | what the wrapped solver needs |

mod algorithm;
mod any_solver;
mod apps;
mod bas;
pub(crate) mod broyden_bas;
mod domain;
mod driver;
mod evaluator;
mod jacobian_transpose;
mod levenberg_marquardt;
mod monitor;
mod multi_start;
mod newton_raphson;
mod pattern_search;
mod status;
mod stop;
mod stopwatch;
mod swarm;

pub use algorithm::{Algorithm, DerivativeFree};
pub use any_solver::AnySolver;
pub use apps::{Apps, LearningRate};
pub use bas::{Bas, BasVariant};
pub use broyden_bas::BroydenBas;
pub use domain::Domain;
pub use driver::{Solver, run};
pub use evaluator::{BestPoint, Evaluator};
pub use jacobian_transpose::{JacobianTranspose, StepSize};
pub use levenberg_marquardt::LevenbergMarquardt;
pub(crate) use monitor::EvaluationMonitor;
pub use monitor::{Monitor, Unattended};
pub use multi_start::{MultiStart, RestartRule};
pub use newton_raphson::NewtonRaphson;
pub(crate) use pattern_search::PatternSearch;
pub use status::Status;
pub use stop::Stop;
pub use stopwatch::Stopwatch;
pub(crate) use swarm::constriction;
pub use swarm::{
    BeeColony, BeetleDirection, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, ParticleAcceptance, Pso, PsoForm,
    Qpso, Schedule, TrialUpdate, Walls,
};
