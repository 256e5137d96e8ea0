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
        let lanes = |number: &dyn Fn(&Frame) -> f64| Quad(frames.map(number));
        Self {
            axes: std::array::from_fn(|axis| std::array::from_fn(|k| lanes(&|frame| frame.axes[axis][k]))),
            origin: std::array::from_fn(|k| lanes(&|frame| frame.origin[k])),
        }
    }
}
