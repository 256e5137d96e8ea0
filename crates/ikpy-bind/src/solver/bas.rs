//! `BAS`.

use ikcore::solver::{Bas, BasVariant};
use pyo3::prelude::*;

use crate::convert::{count, optional_count};
use crate::error::raise;
use crate::options::options;

/// Beetle antennae search (Cheng et al. 2020, Algorithm 1): needs only values of the error, no derivatives.
///
/// Args:
///     variant: "star": all explorations of a pass start from the same point (eq. 8-11, literally); "chain": each
///         exploration starts where the last one ended (the original beetle search, faster); "greedy": each starts from
///         the better of the two points, and the antennae adapt to the error at once (fastest for small tolerances).
///     c1: ratio of antenna length to error, eq. (12) (rad per m); None: 3 for "star", 1 for "chain", 3 for "greedy".
///     c2: ratio of step length to antenna length, eq. (13); None: 1.
///     explorations: explorations per pass, n in the paper; None: 50 for "star", 30 for "chain", 5 for "greedy".
///     max_passes: largest number of passes; the paper has no such bound.
///
/// The error band of the paper is the tolerance of the call.
///
/// In `minimize`, antennae are c1 times the square root of the function's value: the minimum must be zero, and c1 must suit
/// the function. With the default c1, the sum of squares about (0.3, 0.3) in [-2, 2]^2 stayed at 0.5 to 2.9 (5 seeds, 30000
/// evaluations), where `DifferentialEvolution` and `PSO` found the minimum exactly.
#[pyclass(name = "BAS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyBas(pub Bas);

#[pymethods]
impl PyBas {
    #[new]
    #[pyo3(signature = (*, variant="star", c1=None, c2=None, explorations=None, max_passes=200))]
    fn new(
        #[pyo3(from_py_with = crate::convert::text)] variant: &str,
        c1: Option<f64>,
        c2: Option<f64>,
        explorations: Option<i128>,
        max_passes: i128,
    ) -> PyResult<Self> {
        let standard = Bas::of(variant.parse::<BasVariant>().map_err(raise)?);
        let bas = Bas {
            c1: c1.unwrap_or(standard.c1),
            c2: c2.unwrap_or(standard.c2),
            explorations: optional_count("explorations", explorations)?.unwrap_or(standard.explorations),
            max_passes: count("max_passes", max_passes)?,
            ..standard
        };
        bas.validate().map_err(raise)?;
        Ok(Self(bas))
    }
}

options! {
    PyBas, "BAS" {
        /// Variant of the algorithm: "star", "chain" or "greedy".
        variant: BasVariant,
        /// Ratio of antenna length to error (rad per m).
        c1: f64,
        /// Ratio of step length to antenna length.
        c2: f64,
        /// Explorations per pass.
        explorations: usize,
        /// Largest number of passes.
        max_passes: usize,
    }
}
