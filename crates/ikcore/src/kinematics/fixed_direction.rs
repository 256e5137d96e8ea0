//! Arms whose joints all turn about parallel axes: planar ones, and such as carry a load upright.

use super::chain::Motion;
use crate::math::Frame;
use crate::math::arithmetic::Separate;
use crate::math::so3::{cross, norm};

/// Axes that lean by less are parallel (rad): over the length of an arm that is far below any tolerance.
const PARALLEL: f64 = 1e-12;

/// The direction that the tip keeps, whatever the joints do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Upright {
    /// Of unit length, in the base's coordinates.
    pub base: [f64; 3],
    /// The same in the tip's own.
    pub tip: [f64; 3],
}

impl Upright {
    /// That of a chain whose axes are parallel. `at_zero` holds a frame per moving element, z along its axis, and the tip's,
    /// with no joint turned; `motions` may end with some that move nothing.
    pub(crate) fn of_chain(at_zero: &[Frame], motions: &[Motion]) -> Option<Self> {
        let (tip, moving) = at_zero.split_last()?;
        let mut axes =
            moving.iter().zip(motions).filter(|(_, motion)| motion.turn_scale != 0.0).map(|(frame, _)| frame.axes[2]);
        let base = axes.next()?;
        let upright = Self { base, tip: tip.inverse().turn::<Separate>(&base) };
        axes.all(|axis| norm(&cross(&base, &axis)) < PARALLEL).then_some(upright)
    }

    /// How far the orientation of `frame` is, at least, from any that the tip can have (rad).
    pub fn lean(&self, frame: &Frame) -> f64 {
        let wanted = frame.turn::<Separate>(&self.tip);
        let cosine = (0..3).map(|k| wanted[k] * self.base[k]).sum::<f64>();
        norm(&cross(&self.base, &wanted)).atan2(cosine)
    }
}
