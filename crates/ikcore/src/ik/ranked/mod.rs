//! Poses of which one part comes first: the part that is met exactly, and the nearest of the other there.
//!
//! Several tips by levels: `level_solution` searches, `level_descent` lowers one level after another.
//!
//! `ranked_solution` searches from seeds on all branches (`seeds`), `ranked_descent` leads each to the nearest optimum; `given_up` is the
//! status of the result.

mod given_up;
mod level_descent;
mod level_solution;
mod ranked_descent;
mod ranked_solution;
mod seeds;

pub(crate) use given_up::given_up;
pub(crate) use level_descent::LevelDescent;
pub(super) use level_solution::level_solution;
pub(crate) use ranked_descent::RankedDescent;
pub(super) use ranked_solution::{ranked_at_once, ranked_solution};
