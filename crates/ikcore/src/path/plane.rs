//! The plane of a plane curve.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_finite};

/// Tolerance for orthonormal axes; axes within it are made exact.
const TOLERANCE: f64 = 1e-6;

/// A plane in space: a centre and two orthonormal axes `a` and `b`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    center: Vector3<f64>,
    a: Vector3<f64>,
    b: Vector3<f64>,
}

impl Plane {
    /// The plane through `center` (m) along `a` and `b`, in the frame of the robot's base.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::InvalidPath`] if the axes are not orthonormal to 1e-6.
    pub fn new(center: [f64; 3], a: [f64; 3], b: [f64; 3]) -> Result<Self> {
        for (what, vector) in [("path center", &center), ("path axis a", &a), ("path axis b", &b)] {
            require_finite(what, vector, |i| format!("entry {i}"))?;
        }
        let [center, a, b] = [center, a, b].map(Vector3::from);
        let deviations = [a.norm() - 1.0, b.norm() - 1.0, a.dot(&b)];
        if deviations.iter().any(|deviation| deviation.abs() > TOLERANCE) {
            let problem = format!(
                "axes a and b must be orthonormal, but |a| = {}, |b| = {} and a.b = {}",
                a.norm(),
                b.norm(),
                a.dot(&b)
            );
            return Err(Error::InvalidPath { problem });
        }
        let a = a.normalize();
        let b = (b - a * a.dot(&b)).normalize();
        Ok(Self { center, a, b })
    }

    /// The horizontal plane through `center` (m): a = x, b = y.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn xy(center: [f64; 3]) -> Result<Self> {
        Self::new(center, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    }

    /// The vertical plane through `center` (m) facing along x: a = y, b = z.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn yz(center: [f64; 3]) -> Result<Self> {
        Self::new(center, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    }

    /// The point (m) at the coordinates `[along a, along b]` (m).
    pub(super) fn point(&self, coordinates: [f64; 2]) -> [f64; 3] {
        (self.center + self.direction(coordinates)).into()
    }

    /// The velocity in space (m/s) of `[along a, along b]` (m/s).
    pub(super) fn vector(&self, rates: [f64; 2]) -> [f64; 3] {
        self.direction(rates).into()
    }

    fn direction(&self, [along_a, along_b]: [f64; 2]) -> Vector3<f64> {
        self.a * along_a + self.b * along_b
    }
}
