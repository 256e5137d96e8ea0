//! Forward kinematics and Jacobians, for one configuration or many.

use ikcore::math::pose;
use ikcore::rng;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::PyRobot;
use crate::convert::{Rows, count, pose_array, rows, table, vector};
use crate::error::raise;
use crate::monitor::{in_pieces, long_call};

#[pymethods]
impl PyRobot {
    /// Returns the pose of the tip, (4, 4) for q (n,), (m, 4, 4) for q (m, n): forward kinematics.
    fn fk<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        match rows("joint angles", self.core.name(), self.core.dof(), q)? {
            Rows::One(q) => Ok(pose_array(py, &self.core.fk(q.as_slice()?).map_err(raise)?)?.into_any()),
            Rows::Many(q, m) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                let poses = in_pieces(py, q, robot.dof(), |q| robot.fk_all(q))?;
                Ok(table(py, poses, &[m, 4, 4])?.into_any())
            }
        }
    }

    /// Clips q to the position limits: (n,) for q (n,), (m, n) for q (m, n).
    fn clip<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.core.dof();
        match rows("joint angles", self.core.name(), n, q)? {
            Rows::One(q) => {
                self.core.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, self.core.clip_all(q.as_slice()?).map_err(raise)?, &[n])
            }
            Rows::Many(q, m) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                table(py, in_pieces(py, q, n, |q| robot.clip_all(q))?, &[m, n])
            }
        }
    }

    /// Returns the poses of all links at q (n,), in the order of `link_names`: (links, 4, 4).
    fn link_poses<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let poses = self.core.link_poses(&vector("joint angles", q)?).map_err(raise)?;
        let count = poses.len();
        table(py, poses.iter().flat_map(pose::rows).collect(), &[count, 4, 4])
    }

    /// Returns the geometric Jacobian at the tip, (6, n) for q (n,), (m, 6, n) for q (m, n): linear rows (m per rad or m),
    /// then angular rows, along the axes of the base.
    fn jacobian<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.core.dof();
        match rows("joint angles", self.core.name(), n, q)? {
            Rows::One(q) => {
                self.core.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, self.core.jacobian_all(q.as_slice()?).map_err(raise)?, &[6, n])
            }
            Rows::Many(q, m) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                table(py, in_pieces(py, q, n, |q| robot.jacobian_all(q))?, &[m, 6, n])
            }
        }
    }

    /// Draws m configurations uniformly within the limits, (m, n). Joints without limits: one turn, or 2 m, around zero.
    #[pyo3(signature = (m, seed=0))]
    fn random_configurations<'py>(
        &self,
        py: Python<'py>,
        m: i128,
        seed: i128,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (m, seed) = (count("m", m)?, count("seed", seed)?);
        let drawn = long_call(py, || self.core.random_configurations(m, &mut rng::stream(seed, 0)))?;
        table(py, drawn, &[m, self.core.dof()])
    }
}
