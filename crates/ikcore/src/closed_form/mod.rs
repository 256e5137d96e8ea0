//! Inverse kinematics in closed form: all configurations of a six-joint arm for a pose, and whether they are surely all.
//!
//! Read `six` first: it decides the structure of a chain (`structure`) and its method (`spherical_wrist`, `sliding_arm`,
//! `three_parallel`, `general`) once, and solves poses. The methods reduce to canonical subproblems (`subproblem`) and to zeros of
//! trigonometric polynomials (`trigonometric`), and yield candidates as cosines and sines; `verify` keeps those that forward
//! kinematics confirms. `arm` takes the axes from a robot's chain and converts joint values.
//!
//! Sources: Pieper (1968); Raghavan and Roth (1990); Manocha and Canny (1994); Elias and Wen, "IK-Geo" (arXiv 2211.05737).

mod angle;
mod arm;
mod axis_chain;
mod branches;
mod general;
mod position;
mod six;
mod sliding_arm;
mod spherical_wrist;
mod structure;
mod subproblem;
mod three_parallel;
mod trigonometric;
mod vector;
mod verify;
mod wrist;

pub(crate) use arm::{ArmBranches, ClosedFormArm, NoClosedForm};
