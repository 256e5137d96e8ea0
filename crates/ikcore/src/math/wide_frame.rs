//! A frame in four registers: what runs along a chain of joints.

use super::Frame;
use super::arithmetic::Arithmetic;
use super::quad::Quad;

/// A rigid transform, each axis and the origin in a register of its own. The last lanes mean nothing.
#[derive(Debug, Clone, Copy)]
pub struct WideFrame {
    /// x, y and z axis.
    pub axes: [Quad; 3],
    /// Position of the origin (m).
    pub origin: Quad,
}

impl WideFrame {
    /// The frame reached by `next` from here: self * next.
    #[inline(always)]
    pub fn then<A: Arithmetic>(&self, next: &Frame) -> Self {
        let [x, y, z] = self.axes;
        let turned = |[vx, vy, vz]: [f64; 3]| {
            let along_x = A::mul_quad(x, Quad::splat(vx));
            A::mul_add_quad(z, Quad::splat(vz), A::mul_add_quad(y, Quad::splat(vy), along_x))
        };
        let [new_x, new_y, new_z] = next.axes;
        let [px, py, pz] = next.origin;
        let [px, py, pz] = [Quad::splat(px), Quad::splat(py), Quad::splat(pz)];
        // Two short chains instead of one long one: the latency of this sum is what a chain of joints costs.
        let origin = A::add_quad(A::mul_add_quad(x, px, self.origin), A::mul_add_quad(y, py, A::mul_quad(z, pz)));
        Self { axes: [turned(new_x), turned(new_y), turned(new_z)], origin }
    }
}

impl From<&Frame> for WideFrame {
    #[inline(always)]
    fn from(frame: &Frame) -> Self {
        Self { axes: frame.axes.map(|axis| Quad::from_vector(&axis)), origin: Quad::from_vector(&frame.origin) }
    }
}

impl From<WideFrame> for Frame {
    #[inline(always)]
    fn from(frame: WideFrame) -> Self {
        Self { axes: frame.axes.map(Quad::vector), origin: frame.origin.vector() }
    }
}
