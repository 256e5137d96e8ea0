//! Direction that the tip keeps if all joints rotate about parallel axes, as in planar arms and palletisers.

use super::chain::Transmission;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::{cross, norm};

/// Largest angle between parallel axes (rad): far below any tolerance over the length of an arm.
const PARALLEL: f64 = 1e-12;

/// Direction that is constant in base and in tip coordinates at every configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedDirection {
    /// Unit vector in base coordinates.
    pub base: [f64; 3],
    /// Unit vector in tip coordinates.
    pub tip: [f64; 3],
}

impl FixedDirection {
    /// Returns the fixed direction of a chain with parallel axes; `None` for other chains. `at_zero` holds the frames of the
    /// moving elements at zero joint angles, z along their axes, followed by the tip frame.
    pub(super) fn of_chain(at_zero: &[Frame], motions: &[Transmission]) -> Option<Self> {
        let (tip, moving) = at_zero.split_last()?;
        let mut axes =
            moving.iter().zip(motions).filter(|(_, motion)| motion.turn_scale != 0.0).map(|(frame, _)| frame.axes[2]);
        let base = axes.next()?;
        let fixed = Self { base, tip: tip.inverse().turn::<NoFma>(&base) };
        axes.all(|axis| norm(&cross(&base, &axis)) < PARALLEL).then_some(fixed)
    }

    /// Returns the smallest angle between the orientation of `frame` and an orientation that the tip can have (rad).
    pub fn angle_to(&self, frame: &Frame) -> f64 {
        let wanted = frame.turn::<NoFma>(&self.tip);
        let cosine = (0..3).map(|k| wanted[k] * self.base[k]).sum::<f64>();
        norm(&cross(&self.base, &wanted)).atan2(cosine)
    }
}
