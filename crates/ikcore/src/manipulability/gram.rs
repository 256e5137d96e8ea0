//! Manipulability index from the LDL' factors of J J', at a tenth of the cost of singular values. `None` near singularities,
//! where squaring J loses digits and singular values are used instead.

use crate::math::Columns;
use crate::math::arithmetic::NoFma;
use crate::math::gram::gram;
use crate::math::ldl::{Ldl, trace};

use super::motion::Motion;

/// Pivot, as a fraction of the trace, below which a singularity is near: ten of sixteen digits remain there.
const NEAR: f64 = 1e-6;

/// Index w = sqrt(det(J J')) on the rows of `motion`.
pub(super) fn index(columns: &[[f64; 6]], motion: Motion) -> Option<f64> {
    match motion {
        Motion::Pose => Some(GramFactor::<6>::of(columns, 0)?.index()),
        Motion::Position => Some(GramFactor::<3>::of(columns, 0)?.index()),
        Motion::Rotation => Some(GramFactor::<3>::of(columns, 3)?.index()),
    }
}

/// Returns w, and writes dw/dJ to `out` by column.
pub(super) fn index_and_sensitivity(columns: &[[f64; 6]], motion: Motion, out: &mut Columns) -> Option<f64> {
    match motion {
        Motion::Pose => Some(GramFactor::<6>::of(columns, 0)?.write_sensitivity(columns, out)),
        Motion::Position => Some(GramFactor::<3>::of(columns, 0)?.write_sensitivity(columns, out)),
        Motion::Rotation => Some(GramFactor::<3>::of(columns, 3)?.write_sensitivity(columns, out)),
    }
}

/// Factorization J J' = L D L' of `R` rows from `first` on.
struct GramFactor<const R: usize> {
    first: usize,
    ldl: Ldl<R>,
}

impl<const R: usize> GramFactor<R> {
    /// Factorizes J J'; `None` near a singularity.
    fn of(columns: &[[f64; 6]], first: usize) -> Option<Self> {
        let matrix = gram::<NoFma, R>(columns.iter().map(|column| leading(column, first)), 0.0);
        let smallest = NEAR * trace(&matrix);
        let ldl = Ldl::of::<NoFma>(matrix);
        // Formulated so that NaN counts as near, too.
        (0..R).all(|j| ldl.pivot(j) > smallest).then_some(Self { first, ldl })
    }

    fn index(&self) -> f64 {
        (0..R).map(|j| self.ldl.pivot(j)).product::<f64>().sqrt()
    }

    /// Writes dw/dJ = w (J J')^-1 J, zero in the other rows, and returns w.
    fn write_sensitivity(&self, columns: &[[f64; 6]], out: &mut Columns) -> f64 {
        let index = self.index();
        for (out, column) in out.iter_mut().zip(columns) {
            let z = self.ldl.solve::<NoFma>(std::array::from_fn(|i| column[self.first + i]));
            *out = [0.0; 6];
            z.into_iter().enumerate().for_each(|(i, entry)| out[self.first + i] = index * entry);
        }
        index
    }
}

/// Moves the rows from `first` on to the front, and pads with zeros.
fn leading(column: &[f64; 6], first: usize) -> [f64; 6] {
    std::array::from_fn(|row| column.get(first + row).copied().unwrap_or(0.0))
}
