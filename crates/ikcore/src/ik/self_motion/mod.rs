//! The self-motion of an arm with one joint more than its task: curves of configurations that keep the tip at a target.
//!
//! `curves` is the call. `seeds` finds configurations on the curves: by the closed form, which leaves out no branch, or by search.
//! `trace` walks a curve past the joint limits by the steps of `curve_walk`; `cut` keeps what lies within the limits, which
//! `wrapped_limits` knows up to whole turns; `unwrapping` makes a `curve` of it.

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
