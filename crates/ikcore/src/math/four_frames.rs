//! Four rigid transforms side by side.

use super::Frame;
use super::quad::Quad;

/// Four rigid transforms: what [`Frame`] has once, each number for all four in one register.
#[derive(Debug, Clone, Copy)]
pub struct FourFrames {
    /// x, y and z axes.
    pub axes: [[Quad; 3]; 3],
    /// Positions of the origins (m).
    pub origin: [Quad; 3],
}

impl FourFrames {
    /// These frames, in order.
    #[inline(always)]
    pub fn of(frames: [&Frame; 4]) -> Self {
        let mut all = Self { axes: [[Quad::ZERO; 3]; 3], origin: [Quad::ZERO; 3] };
        for (lane, frame) in frames.into_iter().enumerate() {
            for k in 0..3 {
                all.origin[k].0[lane] = frame.origin[k];
                for axis in 0..3 {
                    all.axes[axis][k].0[lane] = frame.axes[axis][k];
                }
            }
        }
        all
    }
}
