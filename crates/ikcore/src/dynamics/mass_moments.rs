//! Moments of a mass distribution up to the second order: those of bodies fixed to one another add up.

use nalgebra::{Matrix3, Vector3};

use super::inertia::Inertia;
use crate::math::Frame;

/// Moments about the origin of a frame: the integrals of 1, x and x x' over the mass. The inertia matrix is tr(S) 1 - S, with
/// the second moment S.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MassMoments {
    /// Mass (kg).
    pub mass: f64,
    /// First moment (kg m): mass times centre.
    pub first: [f64; 3],
    /// Second moment (kg m^2), symmetric.
    pub second: [[f64; 3]; 3],
}

impl MassMoments {
    /// No mass.
    pub const NONE: Self = Self { mass: 0.0, first: [0.0; 3], second: [[0.0; 3]; 3] };

    /// Returns the moments of `inertia`.
    pub fn of(inertia: &Inertia) -> Self {
        let Inertia { mass, center, matrix } = inertia;
        let half_trace = 0.5 * (matrix[0][0] + matrix[1][1] + matrix[2][2]);
        let about_center = |i: usize, j: usize| {
            let entry = 0.5 * (matrix[i][j] + matrix[j][i]);
            if i == j { half_trace - entry } else { -entry }
        };
        let second = |i: usize, j: usize| about_center(i, j) + mass * center[i] * center[j];
        Self {
            mass: *mass,
            first: center.map(|k| mass * k),
            second: std::array::from_fn(|i| std::array::from_fn(|j| second(i, j))),
        }
    }

    /// Returns the inertia with these moments.
    pub fn inertia(&self) -> Inertia {
        let Self { mass, first, second } = self;
        // Files give a matrix, but no mass, to frames of tools.
        let center = if *mass == 0.0 { [0.0; 3] } else { first.map(|k| k / mass) };
        let about_center = |i: usize, j: usize| second[i][j] - mass * center[i] * center[j];
        let trace: f64 = (0..3).map(|i| about_center(i, i)).sum();
        let entry = |i: usize, j: usize| if i == j { trace - about_center(i, i) } else { -about_center(i, j) };
        Inertia { mass: *mass, center, matrix: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))) }
    }

    /// Returns the moments in the axes and about the origin of the frame that `frame` is given in.
    pub fn moved(&self, frame: &Frame) -> Self {
        let rotation = Matrix3::from(frame.axes);
        let shift = Vector3::from(frame.origin);
        let first = rotation * Vector3::from(self.first);
        let second = rotation * Matrix3::from(self.second) * rotation.transpose()
            + first * shift.transpose()
            + shift * first.transpose()
            + self.mass * shift * shift.transpose();
        Self { mass: self.mass, first: (first + self.mass * shift).into(), second: second.into() }
    }

    /// Adds the moments of another body in the same frame.
    pub fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        for i in 0..3 {
            self.first[i] += other.first[i];
            for j in 0..3 {
                self.second[i][j] += other.second[i][j];
            }
        }
    }
}
