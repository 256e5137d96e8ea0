//! Solvers minimise an [`Objective`](crate::objective::Objective) inside a box and know nothing of robots.
//!
//! A solver is an immutable value of named options; its progress is another value, its `State`. The
//! [driver](mod@driver) owns the loop, the [`Evaluator`] counts, clips, checks for finite values and keeps the best. So
//! exact budgets, "never outside the box" and "the best so far is never lost" hold for every algorithm by construction.
//! [`algorithm`] lists all algorithms, [`any_solver`] is what a caller chooses: one of them, from one start or from many.
//!
//! | file | algorithm | needs |
//! |---|---|---|
//! | [`bas`] | beetle antennae search (Cheng et al. 2020): star, chain, greedy | values |
//! | [`levenberg_marquardt`] | Levenberg-Marquardt on the box | residual and Jacobian |
//! | [`multi_start`] | any of them, from many starts | what the wrapped solver needs |

pub mod algorithm;
pub mod any_solver;
pub mod bas;
pub mod driver;
pub mod evaluator;
pub mod levenberg_marquardt;
pub mod multi_start;
pub mod stop;

pub use algorithm::{Algorithm, DerivativeFree};
pub use any_solver::AnySolver;
pub use bas::{Bas, Variant};
pub use driver::{Outcome, Solver, run};
pub use evaluator::{Best, Evaluator, Halt};
pub use levenberg_marquardt::LevenbergMarquardt;
pub use multi_start::{MultiStart, RestartRule};
pub use stop::{Monitor, Status, Stop, Unattended};
