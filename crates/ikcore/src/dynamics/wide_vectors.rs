//! Vectors and matrices in registers, for the kernels of dynamics.

use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;

/// Returns the axes of a frame.
#[inline(always)]
pub(super) fn axes_of(frame: &Frame) -> [F64x4; 3] {
    // Unrolled by hand here and below: a closure would be compiled without the instructions of the calling kernel.
    let [x, y, z] = &frame.axes;
    [F64x4::from_vector(x), F64x4::from_vector(y), F64x4::from_vector(z)]
}

/// Returns the product of two matrices, of which the second is given by its columns.
#[inline(always)]
pub(super) fn products<A: Arithmetic>(columns: &[F64x4; 3], [x, y, z]: &[[f64; 3]; 3]) -> [F64x4; 3] {
    [product::<A>(columns, x), product::<A>(columns, y), product::<A>(columns, z)]
}

/// Returns the product of the matrix with these columns and a vector.
#[inline(always)]
pub(super) fn product<A: Arithmetic>(columns: &[F64x4; 3], v: &[f64; 3]) -> F64x4 {
    let along_x = A::mul_x4(columns[0], F64x4::splat(v[0]));
    A::mul_add_x4(columns[2], F64x4::splat(v[2]), A::mul_add_x4(columns[1], F64x4::splat(v[1]), along_x))
}

/// Returns the vector from the origin of `parent` to that of `frame`.
#[inline(always)]
pub(super) fn lever(frame: &Frame, parent: &Frame) -> [f64; 3] {
    let (to, from) = (&frame.origin, &parent.origin);
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}

/// Returns the scalar product.
#[inline(always)]
pub(super) fn dot(a: &[f64; 3], b: F64x4) -> f64 {
    a[0] * b.0[0] + a[1] * b.0[1] + a[2] * b.0[2]
}
