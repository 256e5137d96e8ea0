//! `BAS`.

use ikcore::solver::{Bas, BasVariant};
use pyo3::prelude::*;

use crate::convert::{count, optional_count};
use crate::error::raise;
use crate::options::options;

/// Beetle antennae search (Cheng et al. 2020, Algorithm 1): uses values of the error alone, no derivative.
///
/// Args:
///     variant: "star", each exploration of a pass from the same point (eq. 8-11 to the letter); "chain", from where
///         the beetle went (the original beetle search, faster); "greedy", from the better of the two, the antennae
///         following the error at once (fastest for small tolerances).
///     c1: antenna length over error, eq. (12) (rad per m); None: what suits the variant (3, 1 and 3).
///     c2: step length over antenna length, eq. (13); None: 1.
///     explorations: per pass, the paper's n; None: what suits the variant (50, 30 and 5).
///     max_passes: after so many it gives up; the paper would go on for ever.
///
/// The error band of the paper is the tolerance of the call.
#[pyclass(name = "BAS", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyBas(pub Bas);

#[pymethods]
impl PyBas {
    #[new]
    #[pyo3(signature = (*, variant="star", c1=None, c2=None, explorations=None, max_passes=200))]
    fn new(
        variant: &str,
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
        /// "star", "chain" or "greedy".
        variant: BasVariant,
        /// Antenna length over error (rad per m).
        c1: f64,
        /// Step length over antenna length.
        c2: f64,
        /// Explorations per pass.
        explorations: usize,
        /// Passes after which it gives up.
        max_passes: usize,
    }
}
