//! Forward kinematics and Jacobians, for one configuration or many.

use ikcore::math::pose;
use ikcore::rng;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::PyRobot;
use crate::convert::{Rows, count, pose_array, rows, table, vector};
use crate::error::raise;

#[pymethods]
impl PyRobot {
    /// Returns the pose of the tip, (4, 4) for q (n,), (m, 4, 4) for q (m, n): forward kinematics. With `link`, that of any link
    /// of the robot; `all_link_names` lists them.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (q, *, link=None))]
    fn fk<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = crate::convert::optional_text)] link: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robot = &*self.core;
        match rows("joint angles", robot.name(), robot.dof(), q)? {
            Rows::One(q) => {
                let q = q.as_slice()?;
                let pose = link.map_or_else(|| robot.fk(q), |link| robot.link_fk(link, q)).map_err(raise)?;
                Ok(pose_array(py, &pose)?.into_any())
            }
            Rows::Many(q, m) => {
                let poses = in_pieces(py, q.as_slice()?, robot.dof(), |q| match link {
                    None => robot.fk_all(q),
                    Some(link) => robot.link_fk_all(link, q),
                })?;
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
            Rows::Many(q, m) => table(py, self.core.clip_all(q.as_slice()?).map_err(raise)?, &[m, n]),
        }
    }

    /// Returns the poses of the links of the chain at q (n,), in the order of `link_names`: (links, 4, 4).
    fn link_poses<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let poses = self.core.link_poses(&vector("joint angles", q)?).map_err(raise)?;
        let count = poses.len();
        table(py, poses.iter().flat_map(pose::rows).collect(), &[count, 4, 4])
    }

    /// Returns the poses of all links at q (n,), in the order of `all_link_names`: (links, 4, 4).
    fn all_link_poses<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let poses = self.core.all_link_poses(&vector("joint angles", q)?).map_err(raise)?;
        let count = poses.len();
        table(py, poses.iter().flat_map(pose::rows).collect(), &[count, 4, 4])
    }

    /// Returns the geometric Jacobian at the tip, (6, n) for q (n,), (m, 6, n) for q (m, n): linear rows (m per rad or m),
    /// then angular rows, along the axes of the base. With `link`, that of the origin of any link of the robot;
    /// `all_link_names` lists them.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (q, *, link=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = crate::convert::optional_text)] link: Option<&str>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (robot, n) = (&*self.core, self.core.dof());
        let jacobians = |q: &[f64]| match link {
            None => robot.jacobian_all(q),
            Some(link) => robot.link_jacobian_all(link, q),
        };
        match rows("joint angles", robot.name(), n, q)? {
            Rows::One(q) => {
                robot.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, jacobians(q.as_slice()?).map_err(raise)?, &[6, n])
            }
            Rows::Many(q, m) => table(py, in_pieces(py, q.as_slice()?, n, jacobians)?, &[m, 6, n]),
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
        table(py, self.core.random_configurations(m, &mut rng::stream(seed, 0)).map_err(raise)?, &[m, self.core.dof()])
    }
}

/// Runs `work` on rows of `n` numbers without the interpreter, and checks for Ctrl-C in between.
pub fn in_pieces(
    py: Python<'_>,
    rows: &[f64],
    n: usize,
    work: impl Fn(&[f64]) -> ikcore::Result<Vec<f64>> + Sync,
) -> PyResult<Vec<f64>> {
    /// Rows that take about ten milliseconds.
    const PIECE: usize = 1 << 17;
    if rows.len() <= PIECE * n {
        return py.detach(|| work(rows)).map_err(raise);
    }
    let mut results = vec![];
    for piece in rows.chunks(PIECE * n) {
        py.check_signals()?;
        // On an error, run again on all rows: its message counts from the first one.
        results.extend(py.detach(|| work(piece).or_else(|_| work(rows))).map_err(raise)?);
    }
    Ok(results)
}
