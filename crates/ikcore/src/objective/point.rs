//! Points of a search space.

use smallvec::SmallVec;

use crate::math::STACK_DOF;

/// Point of the search space; on the stack up to [`STACK_DOF`] entries. `clone` copies entry by entry, so hot paths use
/// `from_slice`, which copies all entries at once.
pub type Point = SmallVec<[f64; STACK_DOF]>;
