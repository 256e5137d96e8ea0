//! Canonical subproblems: rotations about known axes that carry points to given positions.
//!
//! The numbers are those of Elias and Wen, "IK-Geo: Unified Robot Inverse Kinematics Using Subproblem Decomposition" (arXiv
//! 2211.05737); 1 to 3 go back to Paden and Kahan. All results are [`Angle`]s, so that no arctangent is taken before a branch
//! is verified. A square root with a slightly negative radicand is taken as zero ([`CLAMP`]): the branch is kept as a double
//! root, and forward kinematics decides whether it is a solution.

mod line_on_circle;
mod one_and_two;
mod quadratic_form;
mod three_and_four;

pub use line_on_circle::{line_on_circle, with_radicand};
pub use one_and_two::{subproblem1, subproblem2};
pub use quadratic_form::{Linear, QuadraticForm, solved, subproblem6};
pub use three_and_four::{subproblem3, subproblem4};

use crate::closed_form::angle::Angle;
use crate::closed_form::branches::Doubt;

/// Largest negative radicand, relative to its terms, that counts as a double root.
///
/// Rounding alone would need 1e-9; the larger value also keeps poses just beyond the edge of reach, within a caller's
/// tolerances.
pub const CLAMP: f64 = 1e-4;

/// Radicand, relative to its terms, below which two solutions are nearly one: they lie within a thousandth of a radian.
pub const NEARLY_DOUBLE: f64 = 1e-6;

/// Tolerance of a negative radicand, relative to its terms: a solution may be hidden by the error of the root before it.
pub const NEAR_MISS: f64 = 0.02;

/// Lever arm, as a multiple of its rounding error, below which a pose within a caller's tolerances may have solutions
/// although this one has none.
pub const SMALL_LEVER: f64 = 1e6;

/// At most `N` rotations.
#[derive(Debug, Clone, Copy)]
pub struct Angles<const N: usize> {
    turns: [Angle; N],
    count: usize,
    /// True if every angle is a solution; the listed one represents all.
    pub free: bool,
    /// Doubt about further solutions.
    pub doubt: Doubt,
    /// True if there is no solution, but a small change of the input would give one.
    pub near_miss: bool,
}

impl<const N: usize> Angles<N> {
    /// Empty set.
    pub const NONE: Self =
        Self { turns: [Angle::NONE; N], count: 0, free: false, doubt: Doubt::None, near_miss: false };

    /// Free angle, represented by zero; other angles may lead to further solutions.
    pub const FREE: Self =
        Self { turns: [Angle::NONE; N], count: 1, free: true, doubt: Doubt::Anywhere, near_miss: false };

    /// Adds a solution; ignored when full.
    #[inline(always)]
    pub fn push(&mut self, turn: Angle) {
        if self.count < N {
            self.turns[self.count] = turn;
            self.count += 1;
        }
    }
}

impl<const N: usize> std::ops::Deref for Angles<N> {
    type Target = [Angle];

    #[inline(always)]
    fn deref(&self) -> &[Angle] {
        &self.turns[..self.count]
    }
}
