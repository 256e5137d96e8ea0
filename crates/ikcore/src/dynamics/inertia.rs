//! Mass, centre of mass and inertia matrix of a rigid body.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Inertia of a rigid body in the frame of its link.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Inertia {
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass (m).
    pub center: [f64; 3],
    /// Inertia matrix about the centre, in the axes of the frame (kg m^2).
    pub matrix: [[f64; 3]; 3],
}

/// Largest entry (kg, m, kg m²): products of such entries with rates are finite.
const LARGEST: f64 = 1e50;

/// Rounding of an inertia matrix, relative to its largest entry: files have three to six digits.
const ROUNDING: f64 = 1e-3;
/// Moment of inertia that counts as none (kg m^2): that of a gram at a millimetre.
const NEGLIGIBLE: f64 = 1e-9;

impl Inertia {
    /// Returns a point of this mass (kg) at `center` (m).
    pub fn point(mass: f64, center: [f64; 3]) -> Self {
        Self { mass, center, matrix: [[0.0; 3]; 3] }
    }

    /// Returns a body whose inertia matrix is given in axes turned by `rotation`.
    pub fn turned(mass: f64, center: [f64; 3], rotation: &Matrix3<f64>, matrix: &Matrix3<f64>) -> Self {
        let turned = rotation * matrix * rotation.transpose();
        let entry = |i: usize, j: usize| 0.5 * (turned[(i, j)] + turned[(j, i)]);
        Self { mass, center, matrix: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))) }
    }

    /// Checks that a body can have this inertia; `what` names it.
    ///
    /// # Errors
    /// [`Error::ImpossibleInertia`].
    pub fn require_possible(&self, what: &str) -> Result<()> {
        match self.fault() {
            None => Ok(()),
            Some(problem) => Err(Error::ImpossibleInertia { what: what.into(), problem }),
        }
    }

    /// Returns the reason why no body has this inertia; `None` if one has. Rounding of files is taken, and a matrix without a mass, which files
    /// give to frames of tools.
    pub fn fault(&self) -> Option<String> {
        let Self { mass, center, matrix } = self;
        let flat = matrix.as_flattened();
        if let Some(value) = std::iter::once(mass).chain(center).chain(flat).find(|value| !value.is_finite()) {
            return Some(format!("mass, centre and inertia matrix must be finite, got {value}"));
        }
        if let Some(value) = std::iter::once(mass).chain(center).chain(flat).find(|value| value.abs() > LARGEST) {
            return Some(format!("mass, centre and inertia matrix must be at most {LARGEST:e}, got {value:e}"));
        }
        if *mass < 0.0 {
            return Some(format!("the mass is {mass} kg: it cannot be negative"));
        }
        let size = flat.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let (above, below) = (matrix[i][j], matrix[j][i]);
            if (above - below).abs() > ROUNDING * size + NEGLIGIBLE {
                let [row, column] = [i, j].map(|k| ["x", "y", "z"][k]);
                let names = (format!("{row}{column}"), format!("{column}{row}"));
                let problem = format!("{} = {above} differs from {} = {below}", names.0, names.1);
                return Some(format!("the inertia matrix is not symmetric: {problem}"));
            }
        }
        let moments = principal_moments(matrix);
        let [least, middle, largest] = moments;
        let shown = moments.map(|moment| format!("{moment:.3e}")).join(", ");
        if least < -ROUNDING * largest.abs().max(least.abs()) - NEGLIGIBLE {
            return Some(format!("the principal moments of inertia are {shown} kg m^2: none can be negative"));
        }
        if largest > (1.0 + ROUNDING) * (least + middle) + NEGLIGIBLE {
            return Some(format!(
                "the principal moments of inertia are {shown} kg m^2: the largest cannot exceed the sum of the others"
            ));
        }
        None
    }
}

/// Returns the principal moments of inertia, the least first.
fn principal_moments(matrix: &[[f64; 3]; 3]) -> [f64; 3] {
    let entry = |i: usize, j: usize| 0.5 * (matrix[i][j] + matrix[j][i]);
    let values = Matrix3::from_fn(entry).symmetric_eigenvalues();
    let mut moments: [f64; 3] = Vector3::from(values).into();
    moments.sort_by(f64::total_cmp);
    moments
}
