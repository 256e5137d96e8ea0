//! Self-motion of an arm with one joint more than its task needs: curves of configurations that keep the tip at a target.
//!
//! `curves` is the call. `seeds` finds configurations on the curves: by the closed form, which omits no branch, or by search.
//! `crossings` finds where curves cross, and seeds of those that cross. `trace` walks along a curve past the joint limits by the steps of `curve_walk`; `cut` clips it to the limits, which
//! `wrapped_limits` holds up to whole turns; `unwrapping` turns the parts into a `curve`.

mod crossings;
mod curve;
mod curve_walk;
mod curves;
mod cut;
mod seeds;
mod trace;
mod unwrapping;
mod wrapped_limits;

pub use curve::SelfMotion;
pub(super) use curve_walk::{CurvePoint, LONGEST, StepKind, Walk};
pub use curves::{SelfMotionOptions, self_motion};
pub(super) use wrapped_limits::WrappedLimits;
