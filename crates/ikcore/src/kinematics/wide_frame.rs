//! Frame in four registers for the forward pass: with plain arrays a Jacobian takes a tenth longer.

use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;

/// Rigid transform with each axis and the origin in its own register. The fourth lanes are unused.
#[derive(Debug, Clone, Copy)]
pub(super) struct WideFrame {
    /// Axes x, y and z.
    pub axes: [F64x4; 3],
    /// Position of the origin (m).
    pub origin: F64x4,
}

impl WideFrame {
    /// Returns self * next.
    #[inline(always)]
    pub fn then<A: Arithmetic>(&self, next: &Frame) -> Self {
        let [x, y, z] = self.axes;
        let turned = |[vx, vy, vz]: [f64; 3]| {
            let along_x = A::mul_x4(x, F64x4::splat(vx));
            A::mul_add_x4(z, F64x4::splat(vz), A::mul_add_x4(y, F64x4::splat(vy), along_x))
        };
        let [new_x, new_y, new_z] = next.axes;
        let [px, py, pz] = next.origin;
        let [px, py, pz] = [F64x4::splat(px), F64x4::splat(py), F64x4::splat(pz)];
        // Two short dependency chains instead of a long one: the latency of this sum determines the cost of a chain of
        // joints.
        let origin = A::add_x4(A::mul_add_x4(x, px, self.origin), A::mul_add_x4(y, py, A::mul_x4(z, pz)));
        Self { axes: [turned(new_x), turned(new_y), turned(new_z)], origin }
    }
}

impl From<&Frame> for WideFrame {
    #[inline(always)]
    fn from(frame: &Frame) -> Self {
        Self { axes: frame.axes.map(|axis| F64x4::from_vector(&axis)), origin: F64x4::from_vector(&frame.origin) }
    }
}

impl From<WideFrame> for Frame {
    #[inline(always)]
    fn from(frame: WideFrame) -> Self {
        Self { axes: frame.axes.map(F64x4::vector), origin: frame.origin.vector() }
    }
}
