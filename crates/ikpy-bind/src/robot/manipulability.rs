//! Manipulability and `VelocityEllipsoid`.

use ikcore::manipulability::{Ellipsoid, Manipulability, Motion, manipulability, manipulability_all};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use super::PyRobot;
use crate::convert::{Rows, own, row, table};
use crate::error::raise;
use crate::joint_order::{joint_rows, joint_vector};
use crate::monitor::{QUICK_ROWS, in_pieces};
use crate::pickling::stored_value;

/// The ellipsoid of tip velocities for unit joint speeds, |q'| = 1. It has one semi-axis for each direction in which the
/// tip can move, longest first.
#[pyclass(name = "VelocityEllipsoid", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyVelocityEllipsoid(Ellipsoid);

#[pymethods]
impl PyVelocityEllipsoid {
    /// Lengths of the semi-axes (directions,) (m/s, rad/s): the singular values of the Jacobian.
    #[getter]
    fn lengths<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.0.lengths.clone())
    }

    /// Unit vectors along the semi-axes (directions, 6): linear, then angular part, along the axes of the base.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        table(py, self.0.axes.as_flattened().to_vec(), &[self.0.axes.len(), 6])
    }

    /// Yoshikawa's manipulability index: the product of the lengths.
    #[getter]
    fn index(&self) -> f64 {
        self.0.index()
    }

    /// Ratio of the longest to the shortest length; inf if a direction is lost.
    #[getter]
    fn condition(&self) -> f64 {
        self.0.condition()
    }

    /// Ratio of geometric to arithmetic mean of the squared lengths (Kim and Khosla 1991): 1 for a sphere, 0 if a direction
    /// is lost.
    #[getter]
    fn isotropy(&self) -> f64 {
        self.0.isotropy()
    }

    fn __repr__(&self) -> String {
        let lengths: Vec<String> = self.0.lengths.iter().map(|length| format!("{length:.4}")).collect();
        format!("<VelocityEllipsoid: lengths {}>", lengths.join(", "))
    }
}

stored_value!(PyVelocityEllipsoid, "ellipsoid");

#[pymethods]
impl PyRobot {
    /// Returns Yoshikawa's manipulability index, a number for q (n,), (m,) for q (m, n): sqrt(det(J J')), the product of the
    /// singular values of the Jacobian, over the directions in which the tip can move at all.
    ///
    /// Args:
    ///     motion: motion of the tip that counts, "pose", "position" or "rotation".
    #[pyo3(signature = (q, *, motion="pose"))]
    fn manipulability<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyAny>> {
        let motion: Motion = motion.parse().map_err(raise)?;
        match joint_rows(&self.core, "joint angles", q)? {
            Rows::One(q) => {
                let value = manipulability(&self.core, motion, q.as_slice()?).map_err(raise)?;
                Ok(value.into_pyobject(py)?.into_any())
            }
            Rows::Many(q, _) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                let values = in_pieces(py, q, robot.dof(), QUICK_ROWS / 4, |q| manipulability_all(robot, motion, q))?;
                Ok(own(row(py, values)).into_any())
            }
        }
    }

    /// Returns the exact gradient (n,) of `manipulability` at q (n,).
    #[pyo3(signature = (q, *, motion="pose"))]
    fn manipulability_gradient<'py>(&self, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.core.require_linear_couplings("the gradient of manipulability").map_err(raise)?;
        let (measure, values) = self.measure_at(q, motion)?;
        let mut gradient = vec![0.0; values.len()];
        measure.gradient(&self.core, &values, &mut gradient);
        Ok(row(q.py(), gradient))
    }

    /// Returns the manipulability of each moving link (links,), the tip's last: of the link's tip, moved by the joints
    /// before it, times the volume of the unit ball (pi in the plane). The sum measures the manipulability of the whole
    /// arm.
    ///
    /// It is zero for a link with fewer joints before it than directions. `motion` is as in `manipulability`.
    #[pyo3(signature = (q, *, motion="position"))]
    fn link_manipulability<'py>(&self, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.core.require_linear_couplings("the manipulability of links").map_err(raise)?;
        let (measure, values) = self.measure_at(q, motion)?;
        Ok(own(row(q.py(), measure.link_indices(&self.core, &values).values().to_vec())))
    }

    /// Returns the velocity ellipsoid of the tip at q (n,) for unit joint speeds; `motion` is as in `manipulability`.
    #[pyo3(signature = (q, *, motion="position"))]
    fn velocity_ellipsoid(&self, q: &Bound<'_, PyAny>, motion: &str) -> PyResult<PyVelocityEllipsoid> {
        let (measure, values) = self.measure_at(q, motion)?;
        Ok(PyVelocityEllipsoid(measure.ellipsoid(&self.core, &values)))
    }
}

impl PyRobot {
    /// Reads the arguments of the manipulability methods.
    fn measure_at(&self, q: &Bound<'_, PyAny>, motion: &str) -> PyResult<(Manipulability, Vec<f64>)> {
        let motion: Motion = motion.parse().map_err(raise)?;
        let q = joint_vector(&self.core, "joint angles", q)?;
        self.core.check("joint angles", &q).map_err(raise)?;
        Ok((Manipulability::of(&self.core, motion), q))
    }
}
