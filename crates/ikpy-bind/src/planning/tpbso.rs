//! `TPBSO`, and reading of `method` arguments.

use std::str::FromStr;

use ikcore::Error;
use ikcore::planning::{Elbow, Tpbso};
use pyo3::prelude::*;

use crate::convert::summary;
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::{NewArguments, keywords};
use crate::solver::{derivative_free_solver, derivative_free_to_python};

/// Trajectory planning by beetle swarm optimisation (Wang et al. 2019), as `method=` of `plan_point_to_point` and
/// `plan_along_path`. The string "tpbso" means `TPBSO()`.
///
/// Args:
///     elbows: sign of the second joint's angle at start and end of a planar arm's motion, 1 or -1. At an end given by
///         start_q or end_q, those joint positions decide. Along a path both must be equal.
///     solver: solver of the search, a derivative-free one; None: the published beetle swarm.
#[pyclass(name = "TPBSO", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyTpbso(Tpbso);

#[pymethods]
impl PyTpbso {
    #[new]
    #[pyo3(signature = (*, elbows=None, solver=None), text_signature = "(*, elbows=(1, 1), solver=None)")]
    fn new(elbows: Option<[i128; 2]>, solver: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let tpbso = Tpbso {
            elbows: elbows.map_or(Ok(Tpbso::default().elbows), read_elbows)?,
            solver: solver.map(|solver| derivative_free_solver("TPBSO", solver)).transpose()?,
        };
        Ok(Self(tpbso))
    }

    /// Signs of the second joint's angle at start and end.
    #[getter]
    fn elbows(&self) -> (i8, i8) {
        let [start, end] = self.0.elbows.map(|elbow| elbow.sign() as i8);
        (start, end)
    }

    /// Solver of the search; None: the published beetle swarm.
    #[getter]
    fn solver<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.solver.as_ref().map(|solver| derivative_free_to_python(py, solver)).transpose()
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let solver = self.solver(py)?.map_or(Ok("None".into()), |solver| solver.repr()?.extract::<String>())?;
        let (start, end) = self.elbows();
        Ok(format!("TPBSO(elbows=({start}, {end}), solver={solver})"))
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["elbows", "solver"])
    }
}

fn read_elbows([start, end]: [i128; 2]) -> PyResult<[Elbow; 2]> {
    Ok([read_elbow("elbows[0]", start)?, read_elbow("elbows[1]", end)?])
}

fn read_elbow(name: &str, sign: i128) -> PyResult<Elbow> {
    match sign {
        1 => Ok(Elbow::Positive),
        -1 => Ok(Elbow::Negative),
        _ => Err(invalid(format!("{name} must be 1 or -1, the sign of the second joint's angle, got {sign}"))),
    }
}

/// Reads a planning method: a name or a `TPBSO`; None: the default.
pub fn read_method<M>(method: Option<&Bound<'_, PyAny>>) -> PyResult<M>
where
    M: Default + FromStr<Err = Error> + From<Tpbso>,
{
    let Some(method) = method else { return Ok(M::default()) };
    if let Ok(tpbso) = method.cast::<PyTpbso>() {
        return Ok(tpbso.get().0.clone().into());
    }
    match method.extract::<String>() {
        Ok(name) => name.parse().map_err(raise),
        Err(_) => {
            Err(invalid(format!("method must be a name, such as \"tpbso\", or a TPBSO, got {}", summary(method))))
        }
    }
}
