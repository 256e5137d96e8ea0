//! Vectors of three numbers, inlined into the closed forms.

pub use crate::math::so3::{cross, dot, norm};

/// Vector or point (m).
pub type Vector = [f64; 3];

/// Returns a + b.
#[inline(always)]
pub fn add(a: &Vector, b: &Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns a - b.
#[inline(always)]
pub fn sub(a: &Vector, b: &Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns v * factor.
#[inline(always)]
pub fn scaled(v: &Vector, factor: f64) -> Vector {
    [v[0] * factor, v[1] * factor, v[2] * factor]
}

/// Returns a + b * factor.
#[inline(always)]
pub fn add_scaled(a: &Vector, b: &Vector, factor: f64) -> Vector {
    [a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor]
}

/// Returns v / |v|; NaN for the zero vector.
pub fn unit(v: &Vector) -> Vector {
    scaled(v, 1.0 / norm(v))
}

/// Returns v / |v| of a vector of any size, near the largest or the smallest numbers too; NaN for the zero vector.
pub fn direction(v: &Vector) -> Vector {
    let largest = v.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    let near_one = v.map(|entry| entry / largest);
    near_one.map(|entry| entry / norm(&near_one))
}

/// Returns a unit vector perpendicular to the unit vector `axis`.
pub fn perpendicular(axis: &Vector) -> Vector {
    let helper = if axis[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    unit(&add_scaled(&helper, axis, -dot(axis, &helper)))
}

/// Returns a right-handed frame whose third vector is the unit vector `axis`.
pub fn across(axis: &Vector) -> [Vector; 3] {
    let x = perpendicular(axis);
    [x, cross(axis, &x), *axis]
}
