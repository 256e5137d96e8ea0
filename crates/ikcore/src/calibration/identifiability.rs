//! Identifiability: the combinations of parameters that the measurements determine, by singular values of the Jacobian with
//! columns in units of the prior (Hollerbach and Wampler, The Calibration Index, 1996).
//!
//! Some combinations have no effect at any configuration: N rotating and P sliding joints have 4 N + 2 P + 6 parameters (Everett,
//! Driels and Mooring 1987), whatever list describes them. These are apart from those that other configurations would determine.

use nalgebra::{DMatrix, DVector, SVD};
use serde::{Deserialize, Serialize};

use super::estimate::Estimate;
use super::normal_equations::Weighing;
use super::parameters::FitParameter;
use super::residual::Comparison;
use crate::error::Result;

/// Singular value, over the largest, below which a combination has no effect.
const NEGLIGIBLE: f64 = 1e-7;
/// Coefficient, over the largest of a combination, from which a parameter is named.
const NAMED: f64 = 0.35;
/// Rows that are reduced at once, as a multiple of the parameters.
const MOST_ROWS: usize = 8;
/// Parameters named of one combination.
const MOST_NAMED: usize = 3;

/// Identifiability of the parameters from the measurements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Identifiability {
    /// Number of independent combinations that these configurations determine.
    pub rank: usize,
    /// Number that configurations all over the joint ranges would determine.
    pub possible: usize,
    /// Largest over smallest singular value of those determined.
    pub condition: f64,
    /// Singular values of the weighted Jacobian, largest first: usual deviation of a combination over its standard deviation here.
    pub singular_values: Vec<f64>,
    /// Combinations that the measurements leave open or nearly so, by the names of their main parameters.
    pub unknown: Vec<String>,
}

/// Singular values (descending) and right singular vectors as rows.
struct Spectrum {
    values: Vec<f64>,
    vectors: DMatrix<f64>,
}

impl Spectrum {
    /// Decomposes the whitened Jacobian of all measurements in use; rows are reduced by QR as they come.
    fn of(comparison: &Comparison<'_>, estimate: &Estimate, weighing: &Weighing, scales: &[f64]) -> Result<Self> {
        let n = scales.len();
        let mut rows = Vec::new();
        comparison.each(estimate, weighing, scales, |index, block| {
            if weighing.weights[index] > 0.0 {
                rows.extend_from_slice(&block.jacobian);
            }
            if rows.len() > MOST_ROWS * n * n {
                rows = triangle(&rows, n).transpose().as_slice().to_vec();
            }
        })?;
        let svd = SVD::new(triangle(&rows, n), false, true);
        let vectors = svd.v_t.unwrap_or_else(|| DMatrix::identity(n, n));
        Ok(Self { values: svd.singular_values.iter().copied().collect(), vectors })
    }

    fn rank(&self) -> usize {
        let largest = self.values.first().copied().unwrap_or(0.0);
        self.values.iter().filter(|value| **value > NEGLIGIBLE * largest).count()
    }

    /// Number of combinations that are known better than arms usually are.
    fn told(&self) -> usize {
        self.values[..self.rank()].iter().filter(|value| **value > 1.0).count()
    }

    /// Vectors from this one on.
    fn vectors_from(&self, first: usize) -> impl Iterator<Item = DVector<f64>> {
        (first..self.vectors.nrows()).map(|row| self.vectors.row(row).transpose())
    }
}

/// Square matrix R with R'R = A'A for the rows of A.
fn triangle(rows: &[f64], n: usize) -> DMatrix<f64> {
    let matrix = DMatrix::from_row_slice(rows.len() / n, n, rows);
    if matrix.nrows() > n { matrix.qr().r() } else { matrix.resize_vertically(n, 0.0) }
}

/// Compares these configurations with `elsewhere`, the same kind of measurement all over the joint ranges.
pub(super) fn identifiability(
    comparison: &Comparison<'_>,
    elsewhere: (&Comparison<'_>, &Weighing),
    estimate: &Estimate,
    weighing: &Weighing,
    scales: &[f64],
) -> Result<Identifiability> {
    let here = Spectrum::of(comparison, estimate, weighing, scales)?;
    let anywhere = Spectrum::of(elsewhere.0, estimate, elsewhere.1, scales)?;
    let (rank, possible) = (here.rank(), anywhere.rank());
    // A combination whose standard deviation is above its usual deviation is as good as unknown.
    let mut basis: Vec<DVector<f64>> = anywhere.vectors_from(anywhere.told()).collect();
    let mut unknown = vec![];
    for vector in here.vectors_from(here.told()) {
        let mut rest = vector;
        for other in &basis {
            rest -= other * other.dot(&rest);
        }
        let length = rest.norm();
        if length > 0.5 {
            rest /= length;
            unknown.push(named(&rest, &comparison.model.parameters));
            basis.push(rest);
        }
    }
    let condition = if rank == 0 { f64::INFINITY } else { here.values[0] / here.values[rank - 1] };
    Ok(Identifiability { rank, possible: possible.max(rank), condition, singular_values: here.values, unknown })
}

/// Names the main parameters of a combination.
fn named(vector: &DVector<f64>, parameters: &[FitParameter]) -> String {
    let mut order: Vec<usize> = (0..vector.len()).collect();
    order.sort_by(|a, b| vector[*b].abs().total_cmp(&vector[*a].abs()));
    let least = NAMED * vector[order[0]].abs();
    let main = order.into_iter().take(MOST_NAMED).filter(|k| vector[*k].abs() >= least);
    main.map(|k| parameters[k].name.as_str()).collect::<Vec<_>>().join(" + ")
}
