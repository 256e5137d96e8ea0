//! Solvers minimise an [`Objective`](crate::objective::Objective) inside a box and know nothing of robots.
//!
//! A solver is an immutable value of named options; its progress is another value, its `State`. The
//! [driver](mod@driver) owns the loop, the [`Evaluator`] counts, clips, checks for finite values and keeps the best. So
//! exact budgets, "never outside the box" and "the best so far is never lost" hold for every algorithm by construction.
//! [Side by side](side_by_side) run four of the default solver's descents, for batches.
//! [`algorithm`] lists all algorithms, [`any_solver`] is what a caller chooses: one of them, from one start or from many.
//!
//! | file | algorithm | needs |
//! |---|---|---|
//! | [`apps`] | APPS (Yuan et al. 2016): descent by steps cut off joint by joint | gradient |
//! | [`bas`] | beetle antennae search (Cheng et al. 2020): star, chain, greedy | values |
//! | [`broyden_bas`] | antenna differences as secants: quasi-Newton without a Jacobian | residual |
//! | [`swarm::beetle_swarm`] | beetle swarm (Wang et al. 2019): particles with antennae | values |
//! | [`Pso`], [`Qpso`] | particle swarms, with velocities and quantum-behaved | values |
//! | [`Firefly`], [`BeeColony`] | firefly algorithm, artificial bee colony | values |
//! | [`Genetic`], [`swarm::differential_evolution`] | evolution by crossover and mutation, and by differences | values |
//! | [`jacobian_transpose`] | Jacobian transpose: steepest descent | residual and Jacobian |
//! | [`levenberg_marquardt`] | Levenberg-Marquardt on the box | residual and Jacobian |
//! | [`newton_raphson`] | Newton-Raphson by the pseudo-inverse | residual and Jacobian |
//! | [`multi_start`] | any of them, from many starts | what the wrapped solver needs |

pub mod algorithm;
pub mod any_solver;
pub mod apps;
pub mod bas;
pub mod broyden_bas;
pub mod domain;
pub mod driver;
pub mod evaluator;
pub mod jacobian_transpose;
pub mod levenberg_marquardt;
pub(crate) mod monitor;
pub mod multi_start;
pub mod newton_raphson;
pub mod side_by_side;
pub mod stop;
pub mod swarm;

pub use algorithm::{Algorithm, DerivativeFree};
pub use any_solver::AnySolver;
pub use apps::{Apps, LearningRate};
pub use bas::{Bas, Variant};
pub use broyden_bas::BroydenBas;
pub use domain::{Conduct, Domain, Termination};
pub use driver::{Outcome, Solver, run};
pub use evaluator::{Best, Evaluator, Halt};
pub use jacobian_transpose::{JacobianTranspose, StepSize};
pub use levenberg_marquardt::LevenbergMarquardt;
pub use multi_start::{MultiStart, RestartRule};
pub use newton_raphson::NewtonRaphson;
pub(crate) use side_by_side::run_side_by_side;
pub use stop::{Monitor, Status, Stop, Unattended};
pub use swarm::{BeeColony, BeetleSwarm, DifferentialEvolution, Firefly, Genetic, Pso, Qpso, Schedule};
