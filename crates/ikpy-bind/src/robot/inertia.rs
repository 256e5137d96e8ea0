//! `Inertia`: mass, centre and inertia matrix of a link.

use ikcore::dynamics::Inertia;
use ikcore::robot::LinkInertia;
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{copied, matrix3, point, shortened, summary, table};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::pickling::{self, Reduced};

/// Mass, centre of mass and inertia matrix of a link, in its frame.
///
/// Args:
///     link: name of the link.
///     mass: mass (kg).
///     center: centre of mass (3,) (m).
///     matrix: inertia matrix (3, 3) about the centre, in the axes of the link (kg m^2); None: a point.
///
/// Raises:
///     InvalidInputError: a negative mass, a matrix that is not symmetric, or principal moments that no body has: negative, or one
///         above the sum of the others. Rounding to three digits is taken.
#[pyclass(name = "Inertia", module = "beetle_ik", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyInertia {
    pub core: LinkInertia,
}

#[pymethods]
impl PyInertia {
    #[new]
    #[pyo3(signature = (link, mass, center=None, matrix=None))]
    fn new(
        #[pyo3(from_py_with = crate::convert::text)] link: &str,
        mass: f64,
        center: Option<&Bound<'_, PyAny>>,
        matrix: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let inertia = inertia(mass, center, matrix)?;
        inertia.require_possible(&format!("inertia of link '{link}'")).map_err(raise)?;
        Ok(Self { core: LinkInertia { link: link.into(), inertia } })
    }

    /// Name of the link.
    #[getter]
    fn link(&self) -> &str {
        &self.core.link
    }

    /// Mass (kg).
    #[getter]
    fn mass(&self) -> f64 {
        self.core.inertia.mass
    }

    /// Centre of mass (3,) in the frame of the link (m).
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.core.inertia.center)
    }

    /// Inertia matrix (3, 3) about the centre, in the axes of the link (kg m^2).
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        table(py, self.core.inertia.matrix.as_flattened().to_vec(), &[3, 3])
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickling::restored_from::<Self>(py, (pickling::bytes(py, to_bytes("inertia", &self.core))?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        Ok(Self { core: from_bytes("inertia", bytes).map_err(raise)? })
    }

    fn __repr__(&self) -> String {
        let LinkInertia { link, inertia } = &self.core;
        let [x, y, z] = inertia.center.map(shortened);
        format!("<Inertia of '{link}': {} kg at ({x}, {y}, {z}) m>", shortened(inertia.mass))
    }
}

/// Reads an inertia; nothing is checked but shapes.
pub fn inertia(mass: f64, center: Option<&Bound<'_, PyAny>>, matrix: Option<&Bound<'_, PyAny>>) -> PyResult<Inertia> {
    let center = center.map_or(Ok([0.0; 3]), |center| point("centre", center))?;
    // Row by row: a matrix of the core holds columns.
    let matrix = matrix.map(|matrix| matrix3("matrix", matrix)).transpose()?;
    let matrix = matrix.map_or([[0.0; 3]; 3], |matrix| matrix.transpose().into());
    Ok(Inertia { mass, center, matrix })
}

/// Reads inertias: a dict by link, or a list.
pub fn inertias(given: &Bound<'_, PyAny>) -> PyResult<Vec<LinkInertia>> {
    let wrong = |value: &Bound<'_, PyAny>| {
        invalid(format!("inertias must be a dict {{link: Inertia(...)}} or a list of Inertia, got {}", summary(value)))
    };
    if let Ok(by_link) = given.cast::<PyDict>() {
        let read = |(link, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let link: String = link.extract().map_err(|_| wrong(given))?;
            let inertia = value.extract::<PyRef<'_, PyInertia>>().map_err(|_| wrong(given))?;
            match inertia.core.link == link {
                true => Ok(inertia.core.clone()),
                false => Err(invalid(format!(
                    "inertias: the entry '{link}' has the inertia of link '{}'",
                    inertia.core.link
                ))),
            }
        };
        return by_link.iter().map(read).collect();
    }
    let list = given.extract::<Vec<PyRef<'_, PyInertia>>>().map_err(|_| wrong(given))?;
    Ok(list.iter().map(|inertia| inertia.core.clone()).collect())
}

/// Inertias as Python objects.
pub fn shown<'py>(py: Python<'py>, inertias: &[LinkInertia]) -> PyResult<Vec<Bound<'py, PyInertia>>> {
    inertias.iter().map(|core| Bound::new(py, PyInertia { core: core.clone() })).collect()
}
