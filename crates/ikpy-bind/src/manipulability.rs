//! `VelocityEllipsoid`, and what `Robot` tells of its postures.

use ikcore::manipulability::{Ellipsoid, Manipulability, Motion};
use ikcore::robot::Robot;
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::convert::{row, table, vector};
use crate::error::raise;
use crate::stored::{self, Reduced};

/// The tip velocities that unit joint speeds give, |q'| = 1: an ellipsoid with one semi-axis per direction in which the
/// tip can move, the longest first.
#[pyclass(name = "VelocityEllipsoid", module = "beetle_ik", frozen, eq)]
#[derive(PartialEq)]
pub struct PyVelocityEllipsoid(Ellipsoid);

#[pymethods]
impl PyVelocityEllipsoid {
    /// Lengths of the semi-axes (directions,) (m/s, rad/s): the singular values of the Jacobian.
    #[getter]
    fn lengths<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.0.lengths.clone())
    }

    /// Unit vectors along them (directions, 6): linear, then angular part, in the base's axes.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        table(py, self.0.axes.as_flattened().to_vec(), &[self.0.axes.len(), 6])
    }

    /// Yoshikawa's index: the product of the lengths.
    #[getter]
    fn index(&self) -> f64 {
        self.0.index()
    }

    /// The longest over the shortest; inf where a direction is lost.
    #[getter]
    fn condition(&self) -> f64 {
        self.0.condition()
    }

    /// Geometric over arithmetic mean of the squared lengths (Kim and Khosla 1991): 1 for a sphere, 0 where a direction
    /// is lost.
    #[getter]
    fn isotropy(&self) -> f64 {
        self.0.isotropy()
    }

    fn __repr__(&self) -> String {
        let lengths: Vec<String> = self.0.lengths.iter().map(|length| format!("{length:.4}")).collect();
        format!("<VelocityEllipsoid: lengths {}>", lengths.join(", "))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::restored_from::<Self>(py, (stored::bytes(py, to_bytes("ellipsoid", &self.0))?,))
    }

    /// What pickle stored.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        from_bytes("ellipsoid", bytes).map(Self).map_err(raise)
    }
}

/// What `Robot`'s methods have in common: the words, the check, the measure.
fn at(robot: &Robot, q: &Bound<'_, PyAny>, motion: &str) -> PyResult<(Manipulability, Vec<f64>)> {
    let motion: Motion = motion.parse().map_err(raise)?;
    let q = vector("joint angles", q)?;
    robot.check("joint angles", &q).map_err(raise)?;
    Ok((Manipulability::of(robot, motion), q))
}

pub fn ellipsoid(robot: &Robot, q: &Bound<'_, PyAny>, motion: &str) -> PyResult<PyVelocityEllipsoid> {
    let (measure, q) = at(robot, q, motion)?;
    Ok(PyVelocityEllipsoid(measure.ellipsoid(robot, &q)))
}

pub fn gradient<'py>(robot: &Robot, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (measure, values) = at(robot, q, motion)?;
    let mut gradient = vec![0.0; values.len()];
    measure.gradient(robot, &values, &mut gradient);
    Ok(row(q.py(), gradient))
}

pub fn of_links<'py>(robot: &Robot, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (measure, values) = at(robot, q, motion)?;
    Ok(row(q.py(), measure.link_indices(robot, &values).values().to_vec()))
}
