//! Inverse kinematics and trajectory tracking for robot manipulators, with a focus on redundant arms.
//!
//! ```
//! use ikcore::ik::{SolveOptions, solve};
//! use ikcore::robot::Robot;
//! use ikcore::solver::{Status, Unattended};
//! use ikcore::task::Target;
//!
//! let robot = Robot::named("iiwa14")?;
//! let target = Target::Position([0.4, 0.3, 0.8]);
//! let solution = solve(&robot, &target, &SolveOptions::default(), &mut Unattended)?;
//! assert_eq!(solution.status, Status::Solved);
//! assert!(solution.error.position <= 1e-6);
//! # Ok::<(), ikcore::Error>(())
//! ```
//!
//! # How data flows
//!
//! ```text
//!      robot ───────────────┐
//! path (reference)          ├─> task ─> problem ··implements··> objective <──uses── solver ─> solution
//!      limits ──────────────┘                                                                    │
//!                                tracking · planning · batch  <──────────────────────────────────┘
//!                                              │
//!                                          trajectory
//! ```
//!
//! Two sides meet in [`objective`] and nowhere else. The robot side ([`robot`], [`limits`], [`task`], [`problem`])
//! implements its small traits, and the solver side ([`solver`]) uses them: a solver file never mentions robots, a robot
//! file never mentions solvers. A solver therefore works with any objective, and the compiler rejects an objective
//! without a Jacobian where the solver needs one.
//!
//! # Contracts of every algorithm
//!
//! - Evaluation budgets are exact, results lie inside the box, and the best point found is never lost. The
//!   [`Evaluator`](solver::Evaluator) ensures this, not the algorithm.
//! - A search that does not converge returns a [`Status`](solver::Status) with advice in a sentence. An [`Error`] is a
//!   caller's mistake; it names the argument, its value and what would be valid.
//! - The same seed gives the same bits, on one build and instruction set.
//! - Models are immutable and shared between threads without locks; hot loops do not allocate.
//!
//! # Layers
//!
//! A file imports its own module and modules of lower layers only, never in a circle. `docs/architecture.md` describes
//! the content of each module; a test checks the layers.
//!
//! | layer | modules |
//! |---|---|
//! | 0 | [`message`], [`error`], [`interrupt`], [`rng`], [`math`], [`stored`], `wording` |
//! | 1 | [`kinematics`], [`shape`], [`path`], [`trajectory`], [`objective`] |
//! | 2 | [`starts`], `closed_form`, `bodies`, [`dynamics`] |
//! | 3 | [`robot`] |
//! | 4 | [`limits`], [`obstacle`], [`manipulability`] |
//! | 5 | [`units`], [`motion`], [`task`], [`solver`] |
//! | 6 | [`load`], [`problem`], [`calibration`], [`constraint`] |
//! | 7 | [`ik`], [`minimize`](mod@minimize) |
//! | 8 | [`tracking`], `timing`, `plan`, [`posture`], [`map`] |
//! | 9 | `free_path`, `along_path` |
//! | 10 | `approach_retreat`, `moves`, `tpbso` |
//! | 11 | [`planning`] |
//! | 12 | [`batch`] |

#[cfg(not(target_pointer_width = "64"))]
compile_error!("ikcore needs a 64-bit processor: seeds, hashes and stored bytes are defined for 64-bit sizes");

#[cfg(not(target_endian = "little"))]
compile_error!("ikcore needs a little-endian processor: stored bytes and the lanes of its kernels assume that order");

mod along_path;
mod approach_retreat;
pub mod batch;
mod bodies;
pub mod calibration;
mod closed_form;
pub mod constraint;
pub mod dynamics;
pub mod error;
mod free_path;
pub mod ik;
pub mod interrupt;
pub mod kinematics;
pub mod limits;
pub mod load;
pub mod manipulability;
pub mod map;
pub mod math;
pub mod message;
pub mod minimize;
pub mod motion;
mod moves;
pub mod objective;
pub mod obstacle;
pub mod path;
mod plan;
pub mod planning;
pub mod posture;
pub mod problem;
pub mod rng;
pub mod robot;
pub mod shape;
pub mod solver;
pub mod starts;
pub mod stored;
pub mod task;
mod timing;
mod tpbso;
pub mod tracking;
pub mod trajectory;
pub mod units;
mod wording;

pub use error::{Error, Result};
pub use nalgebra;
