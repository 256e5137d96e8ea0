//! Columns of a Jacobian.

use std::ops::{Deref, DerefMut};

use smallvec::SmallVec;

use super::{MAX_DOF, STACK_DOF};

/// Columns of a 6 x n matrix, one per joint: linear rows (m/rad, or 1 for a prismatic joint), then angular rows; the first n
/// are in use. Up to [`STACK_DOF`] columns are stored on the stack; [`fit`](Self::fit) allocates more.
#[derive(Debug, Clone)]
pub struct Columns(SmallVec<[[f64; 6]; STACK_DOF]>);

impl Default for Columns {
    #[inline]
    fn default() -> Self {
        Self(SmallVec::from_buf([[0.0; 6]; STACK_DOF]))
    }
}

impl Columns {
    /// Grows to at least `n` columns, at most [`MAX_DOF`].
    #[inline]
    pub fn fit(&mut self, n: usize) {
        if n > self.0.len() {
            self.0.resize(MAX_DOF, [0.0; 6]);
        }
    }
}

impl Deref for Columns {
    type Target = [[f64; 6]];

    #[inline]
    fn deref(&self) -> &[[f64; 6]] {
        &self.0
    }
}

impl DerefMut for Columns {
    #[inline]
    fn deref_mut(&mut self) -> &mut [[f64; 6]] {
        &mut self.0
    }
}
