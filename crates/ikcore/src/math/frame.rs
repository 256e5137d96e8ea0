//! Rigid transform in plain arrays, for the kernels.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use super::arithmetic::Arithmetic;
use super::f32x8::F32x8;
use super::f64x4::F64x4;
use super::{Pose, pose};

/// Rigid transform: the columns of its rotation (its axes in base coordinates) and its origin (m). With `F64x4` entries it
/// holds four transforms, one per lane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame<T = f64> {
    /// Axes x, y and z.
    pub axes: [[T; 3]; 3],
    /// Position of the origin (m).
    pub origin: [T; 3],
}

impl Frame<F64x4> {
    /// Packs four frames, one per lane.
    #[inline(always)]
    pub(crate) fn of(frames: [&Frame; 4]) -> Self {
        let mut all = Self { axes: [[F64x4::ZERO; 3]; 3], origin: [F64x4::ZERO; 3] };
        frames.into_iter().enumerate().for_each(|(lane, frame)| all.set_lane(lane, frame));
        all
    }

    /// Returns the frame in lane `lane`.
    pub(crate) fn lane(&self, lane: usize) -> Frame {
        Frame { axes: self.axes.map(|axis| axis.map(|k| k.0[lane])), origin: self.origin.map(|k| k.0[lane]) }
    }

    /// Stores `frame` in lane `lane`.
    pub(crate) fn set_lane(&mut self, lane: usize, frame: &Frame) {
        for k in 0..3 {
            self.origin[k].0[lane] = frame.origin[k];
            for axis in 0..3 {
                self.axes[axis][k].0[lane] = frame.axes[axis][k];
            }
        }
    }
}

impl Frame<F32x8> {
    /// Returns the frame in lane `lane`.
    pub(crate) fn lane(&self, lane: usize) -> Frame {
        let number = |x: F32x8| f64::from(x.0[lane]);
        Frame { axes: self.axes.map(|axis| axis.map(number)), origin: self.origin.map(number) }
    }
}

impl Frame {
    /// Identity transform.
    pub const IDENTITY: Self = Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

    /// Rotates a vector from this frame into the base: R v.
    #[inline(always)]
    pub(crate) fn turn<A: Arithmetic>(&self, v: &[f64; 3]) -> [f64; 3] {
        let [x, y, z] = &self.axes;
        std::array::from_fn(|k| A::mul_add(z[k], v[2], A::mul_add(y[k], v[1], x[k] * v[0])))
    }

    /// Rotates a vector from the base into this frame: R'v.
    #[inline(always)]
    pub(crate) fn turn_back(&self, v: &[f64; 3]) -> [f64; 3] {
        // Unrolled by hand: a closure over the array would be compiled without the instructions of the caller.
        let [x, y, z] = &self.axes;
        [
            x[0] * v[0] + x[1] * v[1] + x[2] * v[2],
            y[0] * v[0] + y[1] * v[1] + y[2] * v[2],
            z[0] * v[0] + z[1] * v[1] + z[2] * v[2],
        ]
    }

    /// Maps a point from this frame into the base: R p + t.
    #[inline(always)]
    pub(crate) fn transform<A: Arithmetic>(&self, p: &[f64; 3]) -> [f64; 3] {
        let [x, y, z] = &self.axes;
        // Two short dependency chains instead of a long one: the latency of this sum determines the cost of a chain of
        // joints.
        std::array::from_fn(|k| A::mul_add(x[k], p[0], self.origin[k]) + A::mul_add(y[k], p[1], z[k] * p[2]))
    }

    /// Returns self * next.
    #[inline(always)]
    pub(crate) fn then<A: Arithmetic>(&self, next: &Self) -> Self {
        let axes = std::array::from_fn(|column| self.turn::<A>(&next.axes[column]));
        Self { axes, origin: self.transform::<A>(&next.origin) }
    }

    /// Returns the inverse transform.
    #[inline]
    pub fn inverse(&self) -> Self {
        let axes: [[f64; 3]; 3] = std::array::from_fn(|row| std::array::from_fn(|column| self.axes[column][row]));
        let origin = self.axes.map(|axis| -(0..3).map(|k| axis[k] * self.origin[k]).sum::<f64>());
        Self { axes, origin }
    }

    /// Returns the homogeneous matrix, row-major.
    pub(crate) fn rows(&self) -> [f64; 16] {
        let ([x, y, z], p) = (self.axes, self.origin);
        [
            x[0], y[0], z[0], p[0], //
            x[1], y[1], z[1], p[1], //
            x[2], y[2], z[2], p[2], //
            0.0, 0.0, 0.0, 1.0,
        ]
    }

    /// Rotates the frame about its own z axis, given sine and cosine of the angle.
    #[inline(always)]
    pub(crate) fn turned<A: Arithmetic>(&self, sine: f64, cosine: f64) -> Self {
        let [x, y, z] = self.axes;
        let new_x = std::array::from_fn(|k| A::mul_add(sine, y[k], cosine * x[k]));
        let new_y = std::array::from_fn(|k| A::mul_add(-sine, x[k], cosine * y[k]));
        Self { axes: [new_x, new_y, z], origin: self.origin }
    }
}

impl From<&Pose> for Frame {
    fn from(pose: &Pose) -> Self {
        Self { axes: (*pose.rotation.matrix()).into(), origin: pose.translation.vector.into() }
    }
}

impl From<Frame> for Pose {
    fn from(frame: Frame) -> Self {
        pose::from_parts(frame.origin, Matrix3::from(frame.axes))
    }
}
